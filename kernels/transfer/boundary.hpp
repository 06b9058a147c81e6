#pragma once

/// @file Boundary points beside the other particles: what pushes them, and what they leave to the grid.

#include "kernels/transfer/project.hpp"

namespace mpmfast {

template <int Dim>
bool has_boundary_points(const TileContext<Dim>& c) {
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r)
    if (c.runs[r].on_surface) return true;
  return false;
}

/// Calls f(weights, run, begin, count) for the chunks of a tile's boundary points.
template <int Dim, class Basis, class F>
void for_each_boundary_chunk(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room, F f) {
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r)
    if (c.runs[r].on_surface)
      for_each_chunk_of_run<Dim, Basis>(c, c.runs[r], room.weights, Wanted::values, f);
}

/// f_i += Σ_p S_pi F_p over boundary points. @param force_of  of a particle, N
template <int Dim, class Basis, class Force>
void push_tile(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room, const Force& force_of,
               const NodeColumns<Dim>& out) {
  auto& window = room.mass_position;
  clear(window);
  for_each_boundary_chunk<Dim, Basis>(
      c, room, [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const Vec<Dim> force = force_of(run, begin + static_cast<std::uint32_t>(k));
          Record f{};
          for (int d = 0; d < Dim; ++d) f[d] = static_cast<Real>(force[d]);
          scatter_values(w, k, f, window.at[0]);
        }
      });
  flush_window(window, c.tile->slot, out);
}

/// V ← S v of boundary points. @param excess_of  of a particle, set to M (V − S v), kg m/s
template <int Dim, class Basis, class Excess>
void settle_tile(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room, const NodeColumns<Dim>& velocity,
                 const Excess& excess_of) {
  if (!has_boundary_points(c)) return;
  const ParticleView<Dim>& particles = *c.particles;
  auto& window = room.mass_position;
  load_window(velocity, c.tile->slot, window);
  for_each_boundary_chunk<Dim, Basis>(
      c, room, [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t p = begin + static_cast<std::uint32_t>(k);
          const Record settled = gather_values(w, k, window.at[0]);
          Vec<Dim>& excess = excess_of(run, p);
          for (int d = 0; d < Dim; ++d) {
            excess[d] = particles.mass[p] * (particles.velocity[d][p] - settled[d]);
            particles.velocity[d][p] = settled[d];
          }
        }
      });
}

}  // namespace mpmfast
