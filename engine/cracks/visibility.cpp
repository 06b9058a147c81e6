#include "engine/cracks/visibility.hpp"

#include <algorithm>
#include <cstddef>

#include "engine/cracks/element.hpp"

namespace mpmfast {

namespace {

/// Number of a node in the window of a tile; −1: outside.
template <int Dim>
int index_in_window(const NodeIndex<Dim>& node, const ParticleTile<Dim>& tile) {
  int w = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    const int offset = node[d] - tile.window[d];
    if (offset < 0 || offset >= kWindowSide) return -1;
    w = w * kWindowSide + offset;
  }
  return w;
}

template <int Dim>
bool in_window(const Supports<Dim>& supports, std::uint32_t particle, const ParticleTile<Dim>& tile) {
  const NodeIndex<Dim> first = supports.first(particle, 0),
                       last = first + NodeIndex<Dim>::Constant(supports.nodes - 1);
  return index_in_window(first, tile) >= 0 && index_in_window(last, tile) >= 0;
}

template <int Dim>
WindowSides<Dim> sides_of_group(const SideMap<Dim>* group) {
  WindowSides<Dim> right;
  for (std::size_t w = 0; group && w < group->side.size(); ++w)
    for (std::size_t k = 0; k < right.size(); ++k) right[k][w] = group->side[w] >> k & 1;
  return right;
}

/// Moves the node of a crossing to the other side of the crack.
template <int Dim>
void apply(const CrackCrossing<Dim>& crossing, const typename CrackedNodes<Dim>::Window& window,
           const ParticleTile<Dim>& tile, WindowSides<Dim>& right) {
  const int w = index_in_window(crossing.node, tile);
  if (w < 0) return;
  for (std::size_t k = 0; k < right.size(); ++k)
    if (element(window, w)->crack[k] == crossing.crack)
      right[k][static_cast<std::size_t>(w)] = crossing.direction > 0;
}

}  // namespace

template <int Dim>
WindowBits<Dim> window_bits(const NodeRange<Dim>& nodes, const ParticleTile<Dim>& tile) {
  WindowBits<Dim> bits;
  for (int k = 0; k < nodes.size(); ++k) {
    const int w = index_in_window<Dim>(nodes.node(k), tile);
    if (w >= 0) bits.set(static_cast<std::size_t>(w));
  }
  return bits;
}

template <int Dim>
WindowSides<Dim> sides_of_nodes(const typename CrackedNodes<Dim>::Window& window) {
  WindowSides<Dim> right;
  for (std::size_t w = 0; w < window.size(); ++w)
    for (std::size_t k = 0; window[w] && k < right.size(); ++k)
      right[k][w] = window[w]->crack[k] >= 0 && !window[w]->is_left(k);
  return right;
}

template <int Dim>
SideChange classify_tile(const State<Dim>& state, const Supports<Dim>& supports,
                         const CrackedNodes<Dim>& nodes, const ParticleTile<Dim>& tile,
                         const SideMap<Dim>* group, const std::vector<CrackCrossing<Dim>>& crossings,
                         std::vector<ParticleSides<Dim>>& out) {
  typename CrackedNodes<Dim>::Window window;
  if (!nodes.find_window(tile, window) && !group) return SideChange::none;
  const WindowSides<Dim> of_nodes = sides_of_nodes<Dim>(window), of_group = sides_of_group(group);
  SideChange change = SideChange::none;
  auto next = crossings.begin();
  for_each_particle(state.tiling.runs, tile, [&](std::uint32_t p) {
    if (!in_window(supports, p, tile)) change = SideChange::sort_first;
    ParticleSides<Dim> sides{p, window_bits(nodes_ahead(supports, p, state.grid.cell), tile), {}};
    for (std::size_t k = 0; k < of_nodes.size(); ++k) sides.right[k] = of_nodes[k] & sides.reach;
    for (; next != crossings.end() && next->particle == p; ++next) apply(*next, window, tile, sides.right);
    if ((difference<Dim>(sides.right, of_group) & sides.reach).any())
      change = std::max(change, SideChange::regroup);
    if ((sides.right[0] | sides.right[1]).any()) out.push_back(sides);
  });
  return change;
}

template <int Dim>
bool reaches_crack(const State<Dim>& state, const Supports<Dim>& supports, const CrackedNodes<Dim>& nodes,
                   const ParticleTile<Dim>& tile) {
  typename CrackedNodes<Dim>::Window window;
  if (!nodes.find_window(tile, window)) return false;
  WindowBits<Dim> cracked;
  for (std::size_t w = 0; w < window.size(); ++w) cracked[w] = window[w] != nullptr;
  const std::uint32_t begin = element(state.tiling.runs, tile.run_begin).begin,
                      end = element(state.tiling.runs, tile.run_end - 1).end;
  for (std::uint32_t p = begin; p < end; ++p)
    if ((window_bits(nodes_ahead(supports, p, state.grid.cell), tile) & cracked).any()) return true;
  return false;
}

template WindowBits<2> window_bits(const NodeRange<2>&, const ParticleTile<2>&);
template WindowSides<2> sides_of_nodes<2>(const CrackedNodes<2>::Window&);
template SideChange classify_tile(const State<2>&, const Supports<2>&, const CrackedNodes<2>&,
                                  const ParticleTile<2>&, const SideMap<2>*,
                                  const std::vector<CrackCrossing<2>>&, std::vector<ParticleSides<2>>&);
template bool reaches_crack(const State<2>&, const Supports<2>&, const CrackedNodes<2>&,
                            const ParticleTile<2>&);
template WindowBits<3> window_bits(const NodeRange<3>&, const ParticleTile<3>&);
template WindowSides<3> sides_of_nodes<3>(const CrackedNodes<3>::Window&);
template SideChange classify_tile(const State<3>&, const Supports<3>&, const CrackedNodes<3>&,
                                  const ParticleTile<3>&, const SideMap<3>*,
                                  const std::vector<CrackCrossing<3>>&, std::vector<ParticleSides<3>>&);
template bool reaches_crack(const State<3>&, const Supports<3>&, const CrackedNodes<3>&,
                            const ParticleTile<3>&);

}  // namespace mpmfast
