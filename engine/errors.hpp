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
  using Place = std::array<double, 3>;  ///< m
  /// @param place  where it failed, if that is known
  explicit RunFailure(const std::string& what, std::optional<Place> place = std::nullopt)
      : std::runtime_error(what), place_(place) {}
  const std::optional<Place>& place() const { return place_; }
  /// What the run had given reason to doubt until then: the likeliest cause first, each with a remedy.
  const std::vector<std::string>& warnings() const { return warnings_; }
  void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }

 private:
  std::vector<std::string> warnings_;
  std::optional<Place> place_;
};

}  // namespace mpmfast
