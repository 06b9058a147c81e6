#pragma once

/// @file Velocity gradient, strain and stress of the particles, and the internal force on the nodes.

#include "kernels/transfer/strain_chunk.hpp"
#include "kernels/transfer/stress.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct StrainForceWorkspace : StrainWorkspace<Dim> {
  WeightWorkspace<Dim, Basis> weights;
  static constexpr int kEntries = Dim == 2 ? 4 : Dim;  ///< in 2-D a vector twice, for a record of pairs
  Window<Dim, kEntries> velocity, force;
  Record row[kGradientRecords<Dim>][kChunk<Dim>];  ///< ∇v of a particle; then its stress
};

/// A nodal vector as the windows above have it.
template <int Dim>
inline auto for_gradients(const NodeColumns<Dim>& vector) {
  NodeColumns<Dim == 2 ? 4 : Dim> entries;
  int at = 0;
  for (double*& column : entries.column) column = vector.column[at++ % Dim];
  return entries;
}

/// Gradients in pairs, at quad `quad` of the records, to workspace.gradient.
template <class R, class Workspace>
inline void unpack_pairs(const R* in, int count, int quad, Workspace& workspace) {
  for (int k = 0; k < count; k += 4) {
    Record row[4];
    for (int i = 0; i < 4; ++i)
      row[i] = detail::load_record(reinterpret_cast<const Real*>(in + k + i) + 4 * quad);
    transpose(row);
    for (int i = 0; i < 4; ++i)
      detail::store_row(&workspace.gradient[4 * (i / 2) + i % 2][k], detail::to_row(row[i]));
  }
}

/// Velocity gradients of a chunk, ∇v_p = Σ_i v_i ⊗ G_pi (N20 Eq. 28), staged in workspace.gradient.
template <int Dim, class Weights, class Workspace>
inline void gather_velocity_gradient(const Weights& w, int count, const Record* velocity,
                                     Workspace& workspace) {
  if constexpr (Dim == 2) {
    gather_chunk_pairs(w, count, velocity, workspace.row[0]);
    unpack_pairs(workspace.row[0], count, 0, workspace);
  } else {
    for (int k = 0; k < count; ++k) {
      Record out[Dim];
      gather_gradients(w, k, velocity, out);
      for (int d = 0; d < Dim; ++d) workspace.row[d][k] = out[d];
    }
    for (int d = 0; d < Dim; ++d) unpack<Dim, Dim>(workspace.row[d], count, &workspace.gradient[4 * d]);
  }
}

/// Scatters the internal force of a chunk, f_i −= Σ_p V_p0 τ_p·G_pi (V_p σ_p = V_p0 τ_p).
/// @param beside  called with each particle
template <int Dim, class Weights, class Workspace, class F>
inline void scatter_force(const ParticleView<Dim>& p, const ChunkStress<Dim>& stress, const Weights& w,
                          std::uint32_t begin, int count, Workspace& workspace, const F& beside) {
  pack_stress(p, stress, begin, count, 0, workspace.row);
  scatter_stress<Dim>(w, count, workspace.row, workspace.force.at[0], beside);
}

/// Hoop rates of a chunk about the axis x = 0, (v_r/r)_p = Σ_i v_ir S_pi/r_p, staged in workspace.hoop_rate.
/// The hoop function of Nairn and Guilkey (2015), the mean of N_i/r over the domain weighted by r, is
/// S_pi/r_p.
template <int Dim, class Weights, class Workspace>
inline void gather_hoop_rate(const ParticleView<Dim>& p, const Weights& w, std::uint32_t begin, int count,
                             const Record* velocity, Workspace& workspace) {
  for (int k = 0; k < count; ++k)
    workspace.hoop_rate[k] =
        gather_values(w, k, velocity)[0] / p.position[0][begin + static_cast<std::uint32_t>(k)];
}

/// The hoop part of the internal force, f_ir −= Σ_p V_p0 τ_θθ S_pi/r_p: with S_pi/r_p in the rate too, the
/// power of the nodal forces is that of the stresses, and V_p0 being that of a full turn, forces are too.
template <int Dim, class Weights, class Workspace>
inline void scatter_hoop_force(const ParticleView<Dim>& p, const Weights& w, std::uint32_t begin, int count,
                               Workspace& workspace) {
  for (int k = 0; k < count; ++k) {
    const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
    const double force = p.volume[q] * p.stress[2][q] / p.position[0][q];
    scatter_values(w, k, Record{static_cast<Real>(-force)}, workspace.force.at[0]);
  }
}

/// One tile: strain first from the nodal velocities (if `dt_strain` > 0), then the internal force. Stresses
/// that follow from F are then for this force alone: no column gets them. (Flattened, as update_tile.)
/// @tparam D  PlaneKind::axisymmetric for the hoop terms of axisymmetry (2-D); the others differ in nothing
/// here
/// @param visit_material called as visit_material(index, f): f(law) with the material's law
/// @return whether each J of the tile is a positive number
template <int Dim, class Basis, PlaneKind D = PlaneKind::plane_strain, class VisitMaterial>
[[gnu::flatten]] bool strain_force_tile(const TileContext<Dim>& c,
                                        StrainForceWorkspace<Dim, Basis>& workspace,
                                        const NodeColumns<Dim>& velocity, double dt_strain, int terms,
                                        const VisitMaterial& visit_material, const NodeColumns<Dim>& force) {
  constexpr bool hoop = D == PlaneKind::axisymmetric;
  const ParticleView<Dim>& p = *c.particles;
  bool sound = true;
  if (dt_strain > 0) load_window(for_gradients(velocity), *c.tile, workspace.velocity);
  auto ahead = fetch_ahead<Basis, 1>(p);
  ahead.add(p.volume);
  begin_sums(c, workspace.force, for_gradients(force));
  for_each_chunk<Dim, Basis>(c, workspace.weights, hoop ? Wanted::both : Wanted::gradients,
                             [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
                               ahead.start_at(begin + static_cast<std::uint32_t>(count));
                               ChunkStress<Dim> stress = stress_columns(p, begin);
                               if (dt_strain > 0) {
                                 gather_velocity_gradient<Dim>(w, count, workspace.velocity.at[0], workspace);
                                 if constexpr (hoop)
                                   gather_hoop_rate(p, w, begin, count, workspace.velocity.at[0], workspace);
                                 visit_material(c.bodies[run.body].material, [&]<class Law>(const Law& law) {
                                   if (stress_can_wait<Law>(p)) stress = staged_stress<Dim>(workspace);
                                   sound &= strain_chunk<Dim>(p, law, begin, count, dt_strain, terms,
                                                              workspace, stress);
                                 });
                               }
                               scatter_force(p, stress, w, begin, count, workspace, ahead);
                               if constexpr (hoop) scatter_hoop_force(p, w, begin, count, workspace);
                             });
  end_sums(c, workspace.force, for_gradients(force));
  return sound;
}

}  // namespace mpmfast
