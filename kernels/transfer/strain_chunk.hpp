#pragma once

/// @file Strain and stress of a chunk of particles by one law: no basis in sight, so that each law is
/// compiled once (engine/state/materials.cpp) and not with every basis.

#include "kernels/constants.hpp"
#include "kernels/materials/evolving.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/shape_memory.hpp"
#include "kernels/transfer/strain_out_of_plane.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// What the caller stages of a chunk, by component.
template <int Dim>
struct StrainWorkspace {
  alignas(64) double gradient[4 * Dim][kChunk<Dim>];  ///< ∂v/∂x_d of a particle, [4 d + component of v]
  alignas(64) double hoop_rate[kChunk<Dim>];          ///< v_r/r in axisymmetry
  alignas(64) double stress[kSymmetric<Dim>][kChunk<Dim>];  ///< τ that needs no column (stress_can_wait)
};

/// Where the Kirchhoff stresses of a chunk are: by component, from its first particle on.
template <int Dim>
struct ChunkStress {
  double* component[kSymmetric<Dim>];
};
template <int Dim>
inline ChunkStress<Dim> stress_columns(const ParticleView<Dim>& p, std::uint32_t begin) {
  ChunkStress<Dim> out;
  for (int s = 0; s < kSymmetric<Dim>; ++s) out.component[s] = p.stress[s] + begin;
  return out;
}
template <int Dim>
inline ChunkStress<Dim> staged_stress(StrainWorkspace<Dim>& workspace) {
  ChunkStress<Dim> out;
  for (int s = 0; s < kSymmetric<Dim>; ++s) out.component[s] = workspace.stress[s];
  return out;
}

/// What of F a law answers to: all of it where heat stretches nothing. (Planes that heat stretches are asked
/// in three dimensions: strain_chunk_out_of_plane.) @return whether heat does
template <int Dim>
inline bool remove_thermal_strain(const StateView<Dim>& view, std::uint32_t at, const Lanes (&f)[Dim * Dim],
                                  Lanes (&seen)[Dim * Dim]) {
  for (int e = 0; e < Dim * Dim; ++e) seen[e] = f[e];
  if (Dim == 2 || !view.thermal_stretch) return false;
  detail::cool(detail::cooling(view, at), seen);
  return true;
}

/// F ← (I + a) F, τ and c of up to kLanes particles from `at`, `count` of which are the caller's.
/// @return J: of an evolving law by its own rate, else det F
template <int Dim, class Law>
inline Lanes advance_law(const StateView<Dim>& view, const Law& law, const Lanes (&l)[Dim * Dim], double dt,
                         int terms, std::uint32_t at, int count, Lanes (&f)[Dim * Dim],
                         Lanes (&tau)[kSymmetric<Dim>], Lanes& wave_speed_squared) {
  if constexpr (Evolving<Law>) {
    Lanes a[Dim * Dim], seen[Dim * Dim];
    deformation_increment<Dim>(l, dt, terms, a);
    deform<Dim>(a, f);
    const Lanes before = load_lanes(view.volume_ratio + at), now = before * volume_change<Dim>(a);
    Lanes expansion = l[0], of_volume = broadcast<Lanes>(1.0);
    for (int d = 1; d < Dim; ++d) expansion += l[(Dim + 1) * d];
    if (remove_thermal_strain<Dim>(view, at, f, seen)) of_volume = detail::volume_cooling(view, at);
    MaterialState<Dim, Lanes> state;
    detail::load_state<Law>(view, at, state);
    law.template advance<Dim>(
        StrainStep<Dim, Lanes>{a, seen, of_volume * before, of_volume * now, expansion, dt}, state, tau,
        wave_speed_squared);
    detail::store_state(view, law, at, count, state);
    if (law.shape_limit() < constants::kWholeShape) limit_shape<Dim>(law.shape_limit(), now, count, f);
    return now;
  } else {
    Lanes seen[Dim * Dim];
    advance_deformation<Dim>(l, dt, terms, f);
    remove_thermal_strain<Dim>(view, at, f, seen);
    law.template stress<Dim>(seen, tau, wave_speed_squared);
    return determinant<Dim>(f);
  }
}

/// Stores the results of up to kLanes particles, from the k-th of a chunk that begins at `begin`; `count` of
/// them are the caller's.
/// (Always inline, for what deform says.)
/// @return whether each J is a positive number
template <int Dim>
[[gnu::always_inline]] inline bool store_strain(const ParticleView<Dim>& p, std::uint32_t begin, int k,
                                                int count, const Lanes (&f)[Dim * Dim],
                                                const Lanes (&tau)[kSymmetric<Dim>], Lanes wave_speed_squared,
                                                Lanes jacobian, const ChunkStress<Dim>& stress) {
  const std::uint32_t at = begin + static_cast<std::uint32_t>(k);
  for (int e = 0; e < Dim * Dim; ++e) store_first(p.deformation[e] + at, f[e], count);
  for (int s = 0; s < kSymmetric<Dim>; ++s) store_first(stress.component[s] + k, tau[s], count);
  store_first(p.wave_speed + at, square_root(wave_speed_squared), count);
  if (p.state.volume_ratio) store_first(p.state.volume_ratio + at, jacobian, count);
  const LaneSet all = leading_lanes(count);
  return same_lanes(where_less(all, broadcast<Lanes>(0.0), jacobian), all);
}

/// The velocity gradient and F of kLanes particles.
template <int Dim>
inline void load_strain(const ParticleView<Dim>& p, const StrainWorkspace<Dim>& workspace,
                        std::uint32_t begin, int k, Lanes (&l)[Dim * Dim], Lanes (&f)[Dim * Dim]) {
  fetch_further(p.deformation, begin + static_cast<std::uint32_t>(k));
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      l[Dim * i + j] = load_lanes(&workspace.gradient[4 * j + i][k]);
      f[Dim * i + j] = load_lanes(p.deformation[Dim * i + j] + begin + k);
    }
}

/// As strain_chunk, in a plane that stretches along its normal.
template <class Law>
bool strain_chunk_out_of_plane(const ParticleView<2>& p, const Law& law, std::uint32_t begin, int count,
                               double dt, int terms, const StrainWorkspace<2>& workspace,
                               const ChunkStress<2>& stress) {
  const bool hoop = p.plane_kind == PlaneKind::axisymmetric;
  bool sound = true;
  for (int k = 0; k < count; k += kLanes) {
    const std::uint32_t at = begin + static_cast<std::uint32_t>(k);
    Lanes l[4], f[4], tau[4], c2, s = p.stretch ? load_lanes(p.stretch + at) : broadcast<Lanes>(1.0);
    const Lanes rate = hoop ? load_lanes(&workspace.hoop_rate[k]) : broadcast<Lanes>(0.0);
    load_strain(p, workspace, begin, k, l, f);
    const Lanes j = advance_law_with_depth(p, law, l, rate, dt, terms, at, count - k, f, s, tau, c2);
    if (p.stretch) store_first(p.stretch + at, s, count - k);
    sound &= store_strain(p, begin, k, count - k, f, tau, c2, j, stress);
  }
  return sound;
}

/// Need nobody keep the stresses of this law, because they follow from F? Not where it has a history, nor in
/// planes that stretch along their normal, nor where heat stretches.
template <class Law, int Dim>
inline bool stress_can_wait(const ParticleView<Dim>& p) {
  return !Evolving<Law> && p.plane_kind == PlaneKind::plane_strain && !p.state.thermal_stretch;
}

/// F of a chunk whose velocity gradients are staged in workspace.gradient, and nothing else: what
/// strain_chunk costs is the columns that it goes through. τ and c stay those of an earlier F.
/// @return whether each J of the chunk is a positive number
template <int Dim>
bool deform_chunk(const ParticleView<Dim>& p, std::uint32_t begin, int count, double dt, int terms,
                  const StrainWorkspace<Dim>& workspace) {
  bool sound = true;
  for (int k = 0; k < count; k += kLanes) {
    const std::uint32_t at = begin + static_cast<std::uint32_t>(k);
    Lanes l[Dim * Dim], f[Dim * Dim];
    load_strain(p, workspace, begin, k, l, f);
    advance_deformation<Dim>(l, dt, terms, f);
    for (int e = 0; e < Dim * Dim; ++e) store_first(p.deformation[e] + at, f[e], count - k);
    const Lanes j = determinant<Dim>(f);
    if (p.state.volume_ratio) store_first(p.state.volume_ratio + at, j, count - k);
    const LaneSet all = leading_lanes(count - k);
    sound &= same_lanes(where_less(all, broadcast<Lanes>(0.0), j), all);
  }
  return sound;
}

/// τ of a chunk from F as it is, for whoever reads it.
template <int Dim, class Law>
inline void stress_chunk(const ParticleView<Dim>& p, const Law& law, std::uint32_t begin, int count) {
  for (int k = 0; k < count; k += kLanes) {
    const std::uint32_t at = begin + static_cast<std::uint32_t>(k);
    Lanes f[Dim * Dim], tau[kSymmetric<Dim>], wave_speed_squared;
    for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(p.deformation[e] + at);
    law.template stress<Dim>(f, tau, wave_speed_squared);
    for (int s = 0; s < kSymmetric<Dim>; ++s) store_first(p.stress[s] + at, tau[s], count - k);
  }
}

/// Strain and stress of a chunk whose velocity gradients are staged in workspace.gradient: F by the truncated
/// exponential, τ, c and the evolving state by the material's law; all columns written back, τ to `stress`.
/// @return whether each J of the chunk is a positive number
template <int Dim, class Law>
bool strain_chunk(const ParticleView<Dim>& p, const Law& law, std::uint32_t begin, int count, double dt,
                  int terms, const StrainWorkspace<Dim>& workspace, const ChunkStress<Dim>& stress) {
  if constexpr (Dim == 2) {
    if (p.plane_kind != PlaneKind::plane_strain || p.state.thermal_stretch)
      return strain_chunk_out_of_plane(p, law, begin, count, dt, terms, workspace, stress);
  }
  bool sound = true;
  for (int k = 0; k < count; k += kLanes) {
    const std::uint32_t at = begin + static_cast<std::uint32_t>(k);
    Lanes l[Dim * Dim], f[Dim * Dim], tau[kSymmetric<Dim>], c2;
    load_strain(p, workspace, begin, k, l, f);
    const Lanes j = advance_law<Dim>(p.state, law, l, dt, terms, at, count - k, f, tau, c2);
    sound &= store_strain(p, begin, k, count - k, f, tau, c2, j, stress);
  }
  return sound;
}

}  // namespace mpmfast
