#pragma once

/// @file Crossings: straight lines from particles to nodes of their supports that cross a crack. A crossed
/// line puts the particle and the node on different crack sides (NN section 1.1).

#include <cstdint>
#include <vector>

#include "engine/cracks/segments.hpp"
#include "engine/cracks/supports.hpp"
#include "engine/geometry/crossing.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// The line from a particle to a node, and a crack that it crosses in total once.
template <int Dim>
struct CrackCrossing {
  std::uint32_t particle;
  NodeIndex<Dim> node;
  int crack;
  int direction;    ///< +1: to the left of the crack, −1: to its right
  Vec<Dim> normal;  ///< of the first crossed segment, unit, to the left
};

/// Memory of one thread.
template <int Dim>
struct CrossingWorkspace {
  std::vector<const CrackSegment<Dim>*> near;  ///< segments near the window of the tile
  SegmentBoxes boxes;                          ///< around these
  std::vector<int> reached;                    ///< those that a particle may have crossings with
  LineCrossings lines;                         ///< from the particle to its nodes
};

/// Appends the crossings of the particles of a tile, in the order of the particles. A line that crosses a
/// crack and comes back has none.
template <int Dim>
void find_crossings(const State<Dim>& state, const Supports<Dim>& supports, const ParticleTile<Dim>& tile,
                    const CrackSegments<Dim>& segments, CrossingWorkspace<Dim>& workspace,
                    std::vector<CrackCrossing<Dim>>& out);

}  // namespace mpmfast
