#include "engine/contact/penalty/nearby_surfaces.hpp"

#include <algorithm>

#include "engine/contact/penalty/item.hpp"

namespace mpmfast::penalty {

namespace {

/// Marks the tiles of nodes that two velocity fields have at one place.
template <int Dim>
void mark_shared_tiles(const Tiling<Dim>& tiling, std::vector<std::uint8_t>& shared) {
  shared.assign(tiling.node_tiles.size(), 0);
  for (const auto& block : tiling.node_blocks)
    if (block.end - block.begin > 1)
      for (int t = block.begin; t < block.end; ++t) item(shared, t) = 1;
}

/// Marks the boundary points whose particles act on shared tiles.
template <int Dim>
void mark_points(const State<Dim>& state, const std::vector<std::uint8_t>& shared,
                 std::vector<std::uint8_t>& marked) {
  const auto& tiling = state.tiling;
  marked.assign(state.surfaces.points(), 0);
  for (const auto& tile : tiling.tiles) {
    const bool meets = std::any_of(std::begin(tile.slot), std::end(tile.slot),
                                   [&](int slot) { return item(shared, slot / kTileNodes<Dim>) != 0; });
    if (!meets) continue;
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = item(tiling.runs, r);
      if (!run.on_surface) continue;
      for (std::uint32_t p = run.begin; p < run.end; ++p)
        item(marked, state.surfaces.number(run.body, state.particles.id()[p])) = 1;
    }
  }
}

/// Lists the facets with a marked corner. Marks all of their corners and lists these.
template <int Dim>
void list_facets(const Surfaces<Dim>& surfaces, NearbySurfaces& nearby) {
  nearby.facets.clear();
  for (std::size_t f = 0; f < surfaces.facets.size(); ++f) {
    const auto& corner = surfaces.facets[f].point;
    if (std::none_of(corner.begin(), corner.end(), [&](int p) { return item(nearby.in_reach, p) != 0; }))
      continue;
    nearby.facets.push_back(static_cast<int>(f));
    for (int p : corner) item(nearby.marked, p) = 1;
  }
  nearby.points.clear();
  for (std::size_t p = 0; p < nearby.marked.size(); ++p)
    if (nearby.marked[p]) nearby.points.push_back(static_cast<int>(p));
}

}  // namespace

template <int Dim>
bool update_nearby(const State<Dim>& state, NearbySurfaces& nearby) {
  mark_shared_tiles(state.tiling, nearby.shared);
  mark_points(state, nearby.shared, nearby.marked);
  bool grown = nearby.in_reach.empty();
  for (std::size_t p = 0; p < nearby.in_reach.size(); ++p) grown |= nearby.marked[p] > nearby.in_reach[p];
  if (!grown) return false;
  nearby.in_reach = nearby.marked;
  list_facets(state.surfaces, nearby);
  return true;
}

template bool update_nearby<2>(const State<2>&, NearbySurfaces&);
template bool update_nearby<3>(const State<3>&, NearbySurfaces&);

}  // namespace mpmfast::penalty
