#include "engine/step/check_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/errors.hpp"

namespace mpmfast {

template <int Dim>
std::vector<std::uint16_t> bodies_by_id(const Particles<Dim>& particles) {
  std::vector<std::uint16_t> bodies(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) bodies[particles.id()[p]] = particles.body()[p];
  return bodies;
}

template <int Dim>
void check_particles(const Particles<Dim>& particles, const std::vector<std::uint16_t>& seeded) {
  const std::size_t ids = particles.has(Quantity::domain_share) ? particles.next_id() : seeded.size();
  const std::uint16_t last = seeded.empty() ? 0 : *std::max_element(seeded.begin(), seeded.end());
  std::vector<bool> met(ids);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::uint32_t id = particles.id()[p];
    if (id >= ids || met[id]) refuse_checkpoint(fmt::format("a particle has the id {}", id));
    met[id] = true;
    const std::uint16_t body = particles.body()[p];
    if (id < seeded.size() ? body != seeded[id] : body > last)  // what a split made is of any body
      refuse_checkpoint(fmt::format("particle {} is of body {}", id, particles.body()[p]));
  }
  for (const Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      check_finite(kQuantityTable[static_cast<std::size_t>(q)].name, particles.column(q, k),
                   particles.size());
  for (const Quantity q : {Quantity::mass, Quantity::initial_volume, Quantity::wave_speed})
    for (std::size_t p = 0; particles.has(q) && p < particles.size(); ++p)
      check_not_negative(kQuantityTable[static_cast<std::size_t>(q)].name, particles.column(q)[p]);
}

/// A cell more is let go, since walls and what leaves the grid are judged after a step.
template <int Dim>
void check_positions(const State<Dim>& state, const Vec<Dim>& lower, const Vec<Dim>& upper) {
  const double cell = state.grid.cell;
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    const Vec<Dim> x = state.particles.vector(Quantity::position, p);
    if (!((x.array() >= lower.array() - cell).all() && (x.array() <= upper.array() + cell).all()))
      refuse_checkpoint(fmt::format("particle {} lies outside of the grid", state.particles.id()[p]));
    for (int e = 0; state.particles.has(Quantity::domain_edges) && e < Dim * Dim; ++e)
      if (std::abs(state.particles.column(Quantity::domain_edges, e)[p]) > cell)
        refuse_checkpoint(fmt::format("the domain of particle {} is too large", state.particles.id()[p]));
  }
  // The sides that a map of cracks names are sides of the field that its particles have.
  for (const auto& nodes : state.tiling.node_tiles)
    for (const int t : nodes.particle_tile)
      if (nodes.field >= static_cast<int>(state.field_base.size()) ||
          (t >= 0 && state.field_base[static_cast<std::size_t>(nodes.field)] !=
                         state.tiling.tiles[static_cast<std::size_t>(t)].field))
        refuse_checkpoint("a crack has a side that its body lacks");
  std::size_t placed = 0;
  for (const auto& tile : state.tiling.tiles)
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
      for (std::uint32_t p = run.begin; p < run.end; ++p, ++placed)
        if (state.particles.body()[p] != run.body ||
            state.body_field[static_cast<std::size_t>(run.body)] != tile.field ||
            state.surfaces.holds(run.body, state.particles.id()[p]) != run.on_surface)
          refuse_checkpoint(fmt::format("particle {} is listed with others", state.particles.id()[p]));
    }
  if (!state.tiling.tiles.empty() && placed != state.particles.size())
    refuse_checkpoint("some particles are in no tile");
}

template std::vector<std::uint16_t> bodies_by_id(const Particles<2>&);
template std::vector<std::uint16_t> bodies_by_id(const Particles<3>&);
template void check_particles(const Particles<2>&, const std::vector<std::uint16_t>&);
template void check_particles(const Particles<3>&, const std::vector<std::uint16_t>&);
template void check_positions(const State<2>&, const Vec<2>&, const Vec<2>&);
template void check_positions(const State<3>&, const Vec<3>&, const Vec<3>&);

}  // namespace mpmfast
