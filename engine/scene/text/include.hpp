#pragma once

/// @file `include:` of a scene: other files whose sections it takes over.

#include <filesystem>

#include "engine/scene/text/tree.hpp"

namespace mpmfast {

/// Merges the files that `include` names into the tree, key by key: maps join, of everything else the file
/// that includes has the last word, and a later included file before an earlier one. Paths count from the
/// file that they stand in. The key itself is gone afterwards.
void merge_includes(Node& root, const std::filesystem::path& file, Problems& problems);

}  // namespace mpmfast
