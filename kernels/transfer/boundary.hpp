#pragma once

/// @file Boundary points beside the other particles: what pushes them, and what they leave to the grid.

#include <cstring>

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
void for_each_boundary_chunk(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace, F f) {
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r)
    if (c.runs[r].on_surface)
      for_each_chunk_of_run<Dim, Basis>(c, c.runs[r], workspace.weights, Wanted::values, f);
}

/// f_i += Σ_p S_pi F_p over boundary points. @param force_of  of a particle, N
template <int Dim, class Basis, class Force>
void push_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace, const Force& force_of,
               const NodeColumns<Dim>& out) {
  auto& window = workspace.mass_position;
  clear(window);
  for_each_boundary_chunk<Dim, Basis>(
      c, workspace, [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const Vec<Dim> force = force_of(run, begin + static_cast<std::uint32_t>(k));
          Record f{};
          for (int d = 0; d < Dim; ++d) f[d] = static_cast<Real>(force[d]);
          scatter_values(w, k, f, window.at[0]);
        }
      });
  flush_window(window, *c.tile, out);
}

/// V ← S v of boundary points, P = M (V − S v) beside: momentum −= Σ_p S_pi P_p, and
/// f_i += Σ_p S_pi (P_p/Δt + F_p).
/// @param out  momentum, force
template <int Dim, class Basis, class Force>
void settle_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                 const NodeColumns<Dim>& velocity, double dt, const Force& force_of,
                 const NodeColumns<2 * Dim>& out) {
  using Given = Window<Dim, 2 * Dim>;
  if (!has_boundary_points(c)) return;
  const ParticleView<Dim>& particles = *c.particles;
  auto& grid = workspace.mass_position;
  Given& given = workspace.given;
  load_window(velocity, *c.tile, grid);
  clear(given);
  for_each_boundary_chunk<Dim, Basis>(
      c, workspace, [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t p = begin + static_cast<std::uint32_t>(k);
          const Record settled = gather_values(w, k, grid.at[0]);
          const Vec<Dim>& force = force_of(run, p);
          alignas(typename Given::Node) Real gives[Given::kRecords * Given::kPerNode] = {};
          for (int d = 0; d < Dim; ++d) {
            const double excess = particles.mass[p] * (particles.velocity[d][p] - settled[d]);
            gives[d] = static_cast<Real>(-excess);
            gives[Dim + d] = static_cast<Real>(excess / dt + force[d]);
            particles.velocity[d][p] = settled[d];
          }
          for (int r = 0; r < Given::kRecords; ++r) {
            typename Given::Node record;
            std::memcpy(&record, gives + r * Given::kPerNode, sizeof record);
            scatter_values(w, k, record, given.at[r]);
          }
        }
      });
  flush_window(given, *c.tile, out);
}

}  // namespace mpmfast
