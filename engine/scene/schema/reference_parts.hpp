#pragma once

/// @file What the reference page is made of: its sections in order, each with a fragment of one scene.

#include <span>
#include <string_view>
#include <vector>

namespace mpmfast {

/// A table of keys. The keys of a map that no table of a part names stand in the part's last table of that
/// map.
struct KeyTable {
  const char* says;  ///< a line above it
  const char* map;   ///< pattern
  std::vector<std::string_view> keys;
};

struct ReferencePart {
  const char* title;
  const char* key;  ///< of the scene, whose note opens the section; may be empty
  const char* says;
  const char* example;  ///< YAML; those of all parts together are a scene
  std::vector<KeyTable> tables;
  enum class List { none, units, models, shapes, laws } list = List::none;  ///< what stands before the tables
};

std::span<const ReferencePart> reference_parts();

}  // namespace mpmfast
