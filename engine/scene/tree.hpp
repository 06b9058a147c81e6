#pragma once

/// @file The strict layer over yaml-cpp: text → a tree that knows where each node was written.
/// Closed here: duplicate keys, merge keys, tags, more than one document, empty files, text that is not
/// UTF-8, control characters, deep nesting, aliases that multiply or contain themselves.

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/problems.hpp"

namespace mpmfast {

struct Key {
  std::string text;
  Place place;
};

struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  Place place;
  std::string scalar;
  std::vector<Key> keys;    ///< of a map; keys[i] names items[i]
  std::vector<Node> items;  ///< of a list or a map
};

/// Index of a key in a map; −1 when it is absent or the node is no map.
int index_of(const Node& node, const std::string& key);

/// "'text'", "a list of 3", "a map", "nothing": what a message says was got.
std::string describe(const Node& node);

/// Joins a dotted path.
std::string join(const std::string& path, const std::string& key);

/// Parses one document. Adds to `problems`; returns nothing when the text cannot be read as YAML at all.
std::optional<Node> parse_tree(const std::string& text, int source, Problems& problems);

/// Replaces or adds the value at a dotted path (list entries by index). `source` is the override's number.
void apply_override(Node& root, const std::string& path, const std::string& value, int source,
                    Problems& problems);

}  // namespace mpmfast
