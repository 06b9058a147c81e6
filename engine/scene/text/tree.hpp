#pragma once

/// @file The strict layer over yaml-cpp: text → a tree that knows where each node was written.
/// Closed here: duplicate keys, merge keys, tags, more than one document, empty files, text that is not
/// UTF-8, control characters, deep nesting, aliases that multiply or contain themselves.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/text/problems.hpp"

namespace mpmfast {

struct Key {
  std::string text;
  SourceLocation location;
};

struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  SourceLocation location;
  std::string scalar;
  std::string written;      ///< where `scalar` was computed: what stood there, "${dx/2}"
  bool faulty = false;      ///< reported already: readers keep silent
  std::vector<Key> keys;    ///< of a map; keys[i] names items[i]
  std::vector<Node> items;  ///< of a list or a map
};

/// Index of a key in a map; −1 when it is absent or the node is no map.
int index_of(const Node& node, const std::string& key);
/// The value under the key; null where there is none.
const Node* find_value(const Node& node, const std::string& key);
Node* find_value(Node& node, const std::string& key);

/// "'text'", "a list of 3", "a map", "nothing": what a message says was got.
std::string describe(const Node& node);

/// Joins a dotted path.
std::string join(const std::string& path, const std::string& key);

/// Parses one document, in which `${…}` may stand anywhere in a value, braces and commas and all. Adds to
/// `problems`; returns nothing when the text cannot be read as YAML at all.
/// @param empty  what is said of a text that holds nothing
std::optional<Node> parse_tree(const std::string& text, int source, Problems& problems,
                               const std::string& empty = "empty (a scene was expected)");

/// What a node and all that is in it take.
struct TreeSize {
  std::size_t nodes{}, text{}, levels{};
};
TreeSize size_of(const Node& node);

// What a tree may take after aliases, expressions and included files are expanded.
inline constexpr std::size_t kDeepest = 32;         ///< levels; a scene has about six
inline constexpr std::size_t kMostNodes = 200000;   ///< keys and values
inline constexpr std::size_t kMostText = 16 << 20;  ///< bytes of keys and values, as a file may have

/// Replaces or adds the value at a dotted path (list entries by index). `source` is the override's number.
void apply_override(Node& root, const std::string& path, const std::string& value, int source,
                    Problems& problems);

}  // namespace mpmfast
