#pragma once

/// @file Visibility: the crack side of each node as a particle sees it. A particle contributes to the field
/// of the side on which it lies; particles with the same sides form a group with slots of its own.

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "engine/cracks/crack_sides.hpp"
#include "engine/cracks/cracked_nodes.hpp"
#include "engine/cracks/crossings.hpp"
#include "engine/cracks/supports.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// One bit for each node of a window.
template <int Dim>
using WindowBits = std::bitset<kWindowNodes<Dim>>;

/// Crack sides on the nodes of a window: right of the first crack of the node, right of its second crack.
template <int Dim>
using WindowSides = std::array<WindowBits<Dim>, 2>;

/// The crack sides of a particle.
template <int Dim>
struct ParticleSides {
  std::uint32_t particle;
  WindowBits<Dim> reach;   ///< nodes on which it has weight, or soon will have
  WindowSides<Dim> right;  ///< on these nodes
};

/// How the sides of particles differ from those of their groups, in rising order of what follows.
enum class SideChange {
  none,       ///< groups stay
  regroup,    ///< particles must be grouped anew
  sort_first  ///< particles left the windows of their tiles: they must be sorted before they are grouped
};

/// Nodes on which two sets of sides differ.
template <int Dim>
WindowBits<Dim> difference(const WindowSides<Dim>& a, const WindowSides<Dim>& b) {
  return (a[0] ^ b[0]) | (a[1] ^ b[1]);
}

/// The nodes of a range that lie in the window of a tile.
template <int Dim>
WindowBits<Dim> window_bits(const NodeRange<Dim>& nodes, const ParticleTile<Dim>& tile);

/// The sides of the nodes themselves: those of a particle with no crossing.
template <int Dim>
WindowSides<Dim> sides_of_nodes(const typename CrackedNodes<Dim>::Window& window);

/// Finds the sides of the particles of a tile.
/// @param crossings  of these particles, in their order
/// @param group      sides of the group that the tile is; null: side 0 everywhere
/// @param out        the particles with another side than 0, appended
template <int Dim>
SideChange classify_tile(const State<Dim>& state, const Supports<Dim>& supports,
                         const CrackedNodes<Dim>& nodes, const ParticleTile<Dim>& tile,
                         const SideMap<Dim>* group, const std::vector<CrackCrossing<Dim>>& crossings,
                         std::vector<ParticleSides<Dim>>& out);

/// Does a particle of the tile reach a cracked node, or soon will?
template <int Dim>
bool reaches_crack(const State<Dim>& state, const Supports<Dim>& supports, const CrackedNodes<Dim>& nodes,
                   const ParticleTile<Dim>& tile);

/// Groups the particles of each tile by their sides, and numbers the slots anew.
/// @param sides  by tile: the particles with another side than 0
template <int Dim>
void group_by_sides(State<Dim>& state, const CrackedNodes<Dim>& nodes,
                    const std::vector<std::vector<ParticleSides<Dim>>>& sides);

}  // namespace mpmfast
