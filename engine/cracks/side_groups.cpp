#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/cracks/visibility.hpp"
#include "engine/errors.hpp"

namespace mpmfast {

namespace {

/// Particles with the same sides on the nodes that they share.
template <int Dim>
struct SideGroup {
  WindowBits<Dim> reach;   ///< nodes that any of them reaches
  WindowSides<Dim> right;  ///< on these nodes

  bool fits(const ParticleSides<Dim>& sides) const {
    return (difference<Dim>(right, sides.right) & reach & sides.reach).none();
  }
  void add(const ParticleSides<Dim>& sides) {
    reach |= sides.reach;
    for (std::size_t k = 0; k < right.size(); ++k) right[k] |= sides.right[k];
  }
  /// The sides on all nodes of the window.
  /// @param elsewhere  sides of the nodes that the group does not reach
  SideMap<Dim> map(const WindowSides<Dim>& elsewhere) const {
    SideMap<Dim> map;
    for (std::size_t w = 0; w < map.side.size(); ++w) {
      const WindowSides<Dim>& sides = reach[w] ? right : elsewhere;
      map.side[w] = static_cast<std::int8_t>(sides[0][w] + 2 * sides[1][w]);
    }
    return map;
  }
};

/// Adds a particle to the first group that it fits, or to a new one. @return the number of the group
template <int Dim>
std::size_t add_to_groups(const ParticleSides<Dim>& sides, std::vector<SideGroup<Dim>>& groups) {
  std::size_t g = 0;
  while (g < groups.size() && !groups[g].fits(sides)) ++g;
  if (g == groups.size()) groups.emplace_back();
  groups[g].add(sides);
  return g;
}

}  // namespace

template <int Dim>
void group_by_sides(State<Dim>& state, const CrackedNodes<Dim>& nodes,
                    const std::vector<std::vector<ParticleSides<Dim>>>& sides) {
  auto& tiling = state.tiling;
  tiling.start_groups();
  std::vector<SideGroup<Dim>> groups;
  std::vector<SideMap<Dim>> maps;
  typename CrackedNodes<Dim>::Window window;
  for (std::size_t first = 0, next = 0; first < tiling.tiles.size(); first = next) {
    const ParticleTile<Dim>& tile = tiling.tiles[first];
    next = first + 1 + static_cast<std::size_t>(tile.others);
    groups.clear();
    for (std::size_t t = first; t < next; ++t)
      for (const ParticleSides<Dim>& one : sides[t])
        tiling.set_group(one.particle, 1 + static_cast<int>(add_to_groups(one, groups)));
    if (groups.empty()) continue;
    if (groups.size() >= static_cast<std::size_t>(Tiling<Dim>::kMostGroups))
      throw RunFailure("too many cracks within a few cells");
    nodes.find_window(tile, window);
    const WindowSides<Dim> elsewhere = sides_of_nodes<Dim>(window);
    maps.clear();
    for (const SideGroup<Dim>& group : groups) maps.push_back(group.map(elsewhere));
    tiling.set_groups(tile, maps);
  }
  tiling.regroup(state.particles, state.body_field);
}

template void group_by_sides(State<2>&, const CrackedNodes<2>&,
                             const std::vector<std::vector<ParticleSides<2>>>&);
template void group_by_sides(State<3>&, const CrackedNodes<3>&,
                             const std::vector<std::vector<ParticleSides<3>>>&);

}  // namespace mpmfast
