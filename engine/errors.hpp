#pragma once

/// @file The two ways a run ends badly besides a bad scene (SceneError).

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mpmfast {

/// A file could not be read or written (exit 4).
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run failed physically (exit 3). what() says step, time, particle, body, position and cause.
class RunFailure : public std::runtime_error {
 public:
  using Position = std::array<double, 3>;  ///< m
  /// @param place  where it failed, if that is known
  explicit RunFailure(const std::string& what, std::optional<Position> position = std::nullopt)
      : std::runtime_error(what), position_(position) {}
  const std::optional<Position>& position() const { return position_; }
  /// What the run had given reason to doubt until then: the likeliest cause first, each with a remedy.
  const std::vector<std::string>& warnings() const { return warnings_; }
  void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }

 private:
  std::vector<std::string> warnings_;
  std::optional<Position> position_;
};

}  // namespace mpmfast
