#pragma once

/// @file Velocity gradient, strain and stress of the particles, and the internal force on the nodes.

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct StrainForceRoom {
  WeightRoom<Dim, Basis> weights;
  Window<Dim, 1> velocity, force;
  Record gathered[Dim][kChunk<Dim>];                  ///< ∂v/∂x_d of a particle, components of v
  alignas(64) double gradient[4 * Dim][kChunk<Dim>];  ///< the same, [4 d + component]
  alignas(64) double deformation[Dim * Dim][kChunk<Dim>];
  alignas(64) double stress[kSymmetric<Dim>][kChunk<Dim>];
  alignas(64) double wave_speed[kChunk<Dim>];
  alignas(64) double jacobian[kChunk<Dim>];
};

/// Component of the symmetric tensor storage that holds (i, j).
template <int Dim>
constexpr int symmetric_index(int i, int j) {
  return i == j ? i : (Dim == 2 ? 3 : i + j == 1 ? 3 : i + j == 3 ? 4 : 5);
}

/// Strain and stress of a chunk whose velocity gradients are staged in room.gradient: F by the truncated
/// exponential, τ and c by the material's law; all columns written back.
/// @return smallest J of the chunk
template <int Dim, class Material, class Room>
inline double strain_chunk(const ParticleView<Dim>& p, const Material& material, std::uint32_t begin,
                           int count, double dt, int terms, Room& room) {
  for (int k = 0; k < count; k += kLanes) {
    Lanes l[Dim * Dim], f[Dim * Dim], tau[kSymmetric<Dim>], c2;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        l[Dim * i + j] = load_lanes(&room.gradient[4 * j + i][k]);
        f[Dim * i + j] = load_lanes(p.deformation[Dim * i + j] + begin + k);
      }
    advance_deformation<Dim>(l, dt, terms, f);
    material.template stress<Dim>(f, tau, c2);
    for (int e = 0; e < Dim * Dim; ++e) store_lanes(&room.deformation[e][k], f[e]);
    for (int s = 0; s < kSymmetric<Dim>; ++s) store_lanes(&room.stress[s][k], tau[s]);
    store_lanes(&room.wave_speed[k], square_root(c2));
    store_lanes(&room.jacobian[k], determinant<Dim>(f));
  }
  const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
  for (int e = 0; e < Dim * Dim; ++e) std::memcpy(p.deformation[e] + begin, room.deformation[e], bytes);
  for (int s = 0; s < kSymmetric<Dim>; ++s) std::memcpy(p.stress[s] + begin, room.stress[s], bytes);
  std::memcpy(p.wave_speed + begin, room.wave_speed, bytes);
  double smallest = room.jacobian[0];
  for (int k = 1; k < count; ++k) smallest = room.jacobian[k] < smallest ? room.jacobian[k] : smallest;
  for (int k = 0; k < count; ++k)
    if (!(room.jacobian[k] > 0)) smallest = -1;  // catches NaN, which the comparison above lets pass
  return smallest;
}

/// Velocity gradients of a chunk, ∇v_p = Σ_i v_i ⊗ G_pi (N20 Eq. 28), staged in room.gradient.
template <int Dim, int K, class Room>
inline void gather_velocity_gradient(const ChunkWeights<Dim, K>& w, int count, const Record* velocity,
                                     Room& room) {
  for (int k = 0; k < count; ++k) {
    Record out[Dim];
    gather_gradients(w, k, velocity, out);
    for (int d = 0; d < Dim; ++d) room.gathered[d][k] = out[d];
  }
  unstack<Dim, Dim>(room.gathered, count, room.gradient);
}

/// Scatters the internal force of a chunk, f_i −= Σ_p V_p0 τ_p·G_pi (V_p σ_p = V_p0 τ_p).
template <int Dim, int K, class Room>
inline void scatter_force(const ParticleView<Dim>& p, const ChunkWeights<Dim, K>& w, std::uint32_t begin,
                          int count, Room& room) {
  for (int s = 0; s < kSymmetric<Dim>; ++s)
    for (int k = 0; k < count; k += kLanes)
      store_lanes(&room.stress[s][k],
                  -load_lanes(p.volume + begin + k) * load_lanes(p.stress[s] + begin + k));
  for (int d = 0; d < Dim; ++d) {
    const double* row[Dim];
    for (int i = 0; i < Dim; ++i) row[i] = room.stress[symmetric_index<Dim>(i, d)];
    stack(row, count, room.gathered[d]);
  }
  for (int k = 0; k < count; ++k) {
    Record row[Dim];
    for (int d = 0; d < Dim; ++d) row[d] = room.gathered[d][k];
    scatter_gradients(w, k, row, room.force.at[0]);
  }
}

/// One tile: strain first from the nodal velocities (if `dt_strain` > 0), then the internal force.
/// @param visit_material called as visit_material(index, f): f(law) with the material's law
/// @return smallest J of the tile (≤ 0: inverted)
template <int Dim, class Basis, class VisitMaterial>
double strain_force_tile(const TileContext<Dim>& c, StrainForceRoom<Dim, Basis>& room,
                         const NodeColumns<Dim>& velocity, double dt_strain, int terms,
                         const VisitMaterial& visit_material, const NodeColumns<Dim>& force) {
  const ParticleView<Dim>& p = *c.particles;
  double smallest = 1e300;
  if (dt_strain > 0) load_window<Dim, Dim>(velocity, c.tile->slot, room.velocity);
  clear(room.force);
  for_each_chunk<Dim, Basis, Wanted::gradients>(
      c, room.weights, [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        if (dt_strain > 0) {
          gather_velocity_gradient(w, count, room.velocity.at[0], room);
          visit_material(c.bodies[run.body].material, [&](const auto& law) {
            const double j = strain_chunk<Dim>(p, law, begin, count, dt_strain, terms, room);
            smallest = j < smallest ? j : smallest;
          });
        }
        scatter_force(p, w, begin, count, room);
      });
  flush_window<Dim, Dim>(room.force, c.tile->slot, force);
  return smallest;
}

}  // namespace mpmfast
