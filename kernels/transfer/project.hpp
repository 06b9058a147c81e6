#pragma once

/// @file Particles to nodes: mass and momentum, and what grid-based contact asks for beside them.

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct ProjectRoom {
  WeightRoom<Dim, Basis> weights;
  Window<Dim, 1> mass_momentum, gradient_volume, mass_position, volume;
  alignas(64) double row[1 + Dim][kChunk<Dim>];  ///< mass and momentum of the particles
  Record record[kChunk<Dim>];
};

/// Nodal mass and momentum of one tile (N20 Eq. 5): m_i = Σ S_pi M_p, p_i = Σ S_pi M_p V_p.
/// @param out  mass, momentum; accumulated
/// @return     false if the tile must be sorted anew (out is then untouched)
template <int Dim, class Basis>
bool project_tile(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room, const NodeColumns<1 + Dim>& out) {
  const ParticleView<Dim>& p = *c.particles;
  clear(room.mass_momentum);
  const bool inside = for_each_chunk<Dim, Basis, Wanted::values>(
      c, room.weights, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; k += kLanes) {
          const Lanes m = load_lanes(p.mass + begin + k);
          store_lanes(&room.row[0][k], m);
          for (int d = 0; d < Dim; ++d)
            store_lanes(&room.row[1 + d][k], m * load_lanes(p.velocity[d] + begin + k));
        }
        const double* row[1 + Dim];
        for (int e = 0; e <= Dim; ++e) row[e] = room.row[e];
        stack(row, count, room.record);
        for (int k = 0; k < count; ++k) scatter_values(w, k, room.record[k], room.mass_momentum.at[0]);
      });
  if (inside) flush_window<Dim, 1 + Dim>(room.mass_momentum, c.tile->slot, out);
  return inside;
}

/// For gradient normals, grid-based separation and contact areas (theory §2): the volume gradient g_i = Σ
/// G_pi V_p (pointing out of the material: G_pi turns from the particle to the node), m_i x_i = Σ S_pi M_p
/// X_p with positions relative to the grid origin, and the nodal volume Ω_i = Σ S_pi V_p. Columns that are
/// null are not wanted.
template <int Dim, class Basis>
void project_geometry_tile(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room,
                           const NodeColumns<Dim>& volume_gradient, const NodeColumns<Dim>& mass_position,
                           const NodeColumns<1>& nodal_volume) {
  const ParticleView<Dim>& p = *c.particles;
  const bool gradients = volume_gradient.column[0], positions = mass_position.column[0],
             volumes = nodal_volume.column[0];
  clear(room.gradient_volume);
  clear(room.mass_position);
  clear(room.volume);
  for_each_chunk<Dim, Basis, Wanted::both>(
      c, room.weights, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          double f[Dim * Dim];
          for (int e = 0; e < Dim * Dim; ++e) f[e] = p.deformation[e][q];
          const double m = p.mass[q], volume = p.volume[q] * determinant<Dim>(f);
          Record x{};
          Record unit[Dim] = {};
          for (int d = 0; d < Dim; ++d) {
            x[d] = m * (p.position[d][q] - c.grid->origin[d]);
            unit[d][d] = volume;
          }
          if (positions) scatter_values(w, k, x, room.mass_position.at[0]);
          if (volumes) scatter_values(w, k, Record{volume}, room.volume.at[0]);
          if (gradients) scatter_gradients(w, k, unit, room.gradient_volume.at[0]);
        }
      });
  if (gradients) flush_window<Dim, Dim>(room.gradient_volume, c.tile->slot, volume_gradient);
  if (positions) flush_window<Dim, Dim>(room.mass_position, c.tile->slot, mass_position);
  if (volumes) flush_window<Dim, 1>(room.volume, c.tile->slot, nodal_volume);
}

}  // namespace mpmfast
