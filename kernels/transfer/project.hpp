#pragma once

/// @file Particles to nodes: mass and momentum, and what grid-based contact asks for beside them.

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct ProjectRoom {
  WeightRoom<Dim, Basis> weights;
  Window<Dim, 1> mass_momentum, gradient_volume, mass_position, mass_displacement, volume;
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

/// What grid-based contact asks for; null columns are not wanted.
template <int Dim>
struct GeometryColumns {
  NodeColumns<Dim> volume_gradient;    ///< g_i = Σ G_pi V_p: out of the material (G_pi turns from p to i)
  NodeColumns<Dim> mass_position;      ///< Σ S_pi M_p X_p, relative to the grid's origin
  NodeColumns<Dim> mass_displacement;  ///< Σ S_pi M_p (X_p − X_p0)
  NodeColumns<1> volume;               ///< Σ S_pi V_p
};

/// J V_p0 as surfaces see it: of planes that stretch along their normal, at the undeformed depth; of rings,
/// the section (the volume of a turn grows with the radius, inside a body too).
template <int Dim>
inline double section_volume(const ParticleView<Dim>& p, std::uint32_t q) {
  double f[Dim * Dim];
  for (int e = 0; e < Dim * Dim; ++e) f[e] = p.deformation[e][q];
  const double volume = p.volume[q] * determinant<Dim>(f);
  const bool ring = Dim == 2 && p.depth == Depth::hoop;
  return ring ? volume * p.stretch[q] / (kFullTurn * p.position[0][q]) : volume;
}

/// The sums that gradient normals, volume screening, contact areas and grid-based separations are made of
/// (theory §2).
template <int Dim, class Basis>
void project_geometry_tile(const TileContext<Dim>& c, ProjectRoom<Dim, Basis>& room,
                           const GeometryColumns<Dim>& out) {
  const ParticleView<Dim>& p = *c.particles;
  const bool displaced = out.mass_displacement.column[0];
  clear(room.gradient_volume);
  clear(room.mass_position);
  clear(room.mass_displacement);
  clear(room.volume);
  for_each_chunk<Dim, Basis, Wanted::both>(
      c, room.weights, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          const double volume = section_volume<Dim>(p, q),
                       m = p.mass[q];  // m³ (of rings the section, m²) and kg
          Record x{}, u{};
          Record unit[Dim] = {};
          for (int d = 0; d < Dim; ++d) {
            x[d] = m * (p.position[d][q] - c.grid->origin[d]);
            if (displaced) u[d] = m * (p.position[d][q] - p.reference_position[d][q]);
            unit[d][d] = volume;
          }
          if (out.mass_position.column[0]) scatter_values(w, k, x, room.mass_position.at[0]);
          if (out.volume.column[0]) scatter_values(w, k, Record{volume}, room.volume.at[0]);
          if (displaced) scatter_values(w, k, u, room.mass_displacement.at[0]);
          if (out.volume_gradient.column[0]) scatter_gradients(w, k, unit, room.gradient_volume.at[0]);
        }
      });
  const auto flush = [&](auto& window, const auto& columns) {
    constexpr int N = sizeof(columns.column) / sizeof(double*);
    if (columns.column[0]) flush_window<Dim, N>(window, c.tile->slot, columns);
  };
  flush(room.gradient_volume, out.volume_gradient);
  flush(room.mass_position, out.mass_position);
  flush(room.mass_displacement, out.mass_displacement);
  flush(room.volume, out.volume);
}

}  // namespace mpmfast
