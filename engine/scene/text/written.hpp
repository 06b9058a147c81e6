#pragma once

/// @file YAML that is written: a tree of text, and how it is laid out.

#include <string>
#include <utility>
#include <vector>

namespace mpmfast {

struct Written {
  enum class Kind { nothing, scalar, list, map };
  struct Item;  // (with a pair, clang 14 finds no end)
  Kind kind = Kind::nothing;
  std::string text;         ///< of a scalar, as YAML has it
  std::vector<Item> items;  ///< of a map by key, of a list in order

  void set(std::string scalar) {
    kind = Kind::scalar;
    text = std::move(scalar);
  }
  void add(std::string key, Written value);

  /// On one line.
  std::string flow() const;
};

struct Written::Item {
  std::string key;
  Written value;
};

inline void Written::add(std::string key, Written value) {
  items.push_back({std::move(key), std::move(value)});
}

/// Sections and the entries of a section's lists stand on lines of their own, what they hold on one line.
std::string layout(const Written& scene);

/// Double quotes with the escapes of YAML, and one for what would be an expression.
std::string quoted_text(const std::string& text);
/// Names that YAML would read as nothing, or as the start of a list, get quotes.
std::string name_text(const std::string& name);

}  // namespace mpmfast
