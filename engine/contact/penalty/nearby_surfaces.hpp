#pragma once

/// @file Parts of surfaces that may come into contact before particles are sorted again: those in tiles with
/// nodes that two velocity fields share.

#include <cstdint>
#include <vector>

#include "engine/state/state.hpp"

namespace mpmfast::penalty {

struct NearbySurfaces {
  std::vector<int> facets;             ///< with a corner in a shared tile
  std::vector<int> points;             ///< all corners of these facets
  std::vector<std::uint8_t> in_reach;  ///< by point: in a shared tile, when `facets` was last built

  // Workspace of update_nearby().
  std::vector<std::uint8_t> marked;  ///< by point
  std::vector<std::uint8_t> shared;  ///< by tile of nodes
};

/// Brings the parts up to date after a sort. Parts stay until another point comes into reach, so that a part
/// that leaves and returns does not cost a rebuild.
/// @return are `facets` and `points` new?
template <int Dim>
bool update_nearby(const State<Dim>& state, NearbySurfaces& nearby);

}  // namespace mpmfast::penalty
