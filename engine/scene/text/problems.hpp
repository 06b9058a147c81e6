#pragma once

/// @file Collects what is wrong while a scene is read, so that all of it is reported at once.

#include <string>
#include <utility>
#include <vector>

#include "engine/scene/text/diagnostic.hpp"

namespace mpmfast {

/// Where a piece of the scene was written: source 0 is the file, k the k-th override; then come included
/// files.
struct SourceLocation {
  int line{}, column{};  ///< 1-based
  int source{};
};

class Problems {
 public:
  /// @param sources names as messages show them: the file, then "--set path=value" of each override.
  explicit Problems(std::vector<std::string> sources)
      : sources_(std::move(sources)), overrides_(static_cast<int>(sources_.size()) - 1) {}

  /// One more file, whose places have lines as those of the first; returns its number.
  int add_file(std::string name);
  bool is_included(int source) const { return source > overrides_; }

  void add(const SourceLocation& location, std::string path, std::string message, std::string hint = "");
  bool empty() const { return found_.empty(); }
  std::size_t count() const { return found_.size(); }

  /// In the order of the text, each once.
  std::vector<Diagnostic> sorted() const;

 private:
  struct Found {
    SourceLocation location;
    Diagnostic diagnostic;
  };
  std::vector<std::string> sources_;
  int overrides_;  ///< how many
  std::vector<Found> found_;
};

}  // namespace mpmfast
