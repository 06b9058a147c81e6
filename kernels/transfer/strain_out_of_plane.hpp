#pragma once

/// @file Strain and stress of particles in planes that stretch along their normal
/// (materials/out_of_plane.hpp).

#include "kernels/constants.hpp"
#include "kernels/materials/out_of_plane.hpp"
#include "kernels/materials/shape_memory.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

namespace detail {

/// Calls f(column, entry of the state) for each state column that the law names.
template <int Dim, class Law, class State, class F>
inline void for_each_state_column(const StateView<Dim>& view, State& state, const F& f) {
  constexpr StateColumns columns = Law::kColumns;
  if constexpr (columns.dissipated) f(view.dissipated, state.dissipated);
  if constexpr (columns.internal_energy) f(view.internal_energy, state.internal_energy);
  if constexpr (columns.plastic_strain) f(view.plastic_strain, state.plastic_strain);
  if constexpr (columns.temperature) f(view.temperature, state.temperature);
  if constexpr (columns.elastic_strain)
    for (int c = 0; c < kSymmetric<Dim>; ++c) f(view.elastic_strain[c], state.elastic_strain[c]);
}

/// 1/θ of kLanes particles.
template <int Dim>
inline Lanes cooling(const StateView<Dim>& view, std::uint32_t at) {
  return 1.0 / load_lanes(view.thermal_stretch + at);
}

/// 1/θ³: what heat has added to their volumes, taken out.
template <int Dim>
inline Lanes volume_cooling(const StateView<Dim>& view, std::uint32_t at) {
  const Lanes once = cooling(view, at);
  return once * once * once;
}

/// What of F a law answers to where heat has stretched the material: F/θ, since F = θ F_e. What it stores is
/// W(F/θ) of an undeformed volume, whose stress τ(F/θ) is the law's.
template <int N>
inline void cool(Lanes cooling, Lanes (&f)[N]) {
  for (Lanes& entry : f) entry *= cooling;
}

/// The state before a step, and after it; work that a law without a temperature of its own dissipates heats
/// the particles where a scene has temperatures.
template <class Law, int Dim, int StateDim>
inline void load_state(const StateView<Dim>& view, std::uint32_t at, MaterialState<StateDim, Lanes>& state) {
  for_each_state_column<Dim, Law>(
      view, state, [&](const double* column, Lanes& value) { value = load_lanes(column + at); });
}
template <class Law, int Dim>
inline void store_state(const StateView<Dim>& view, const Law& law, std::uint32_t at, int count,
                        MaterialState<Dim, Lanes>& state) {
  if constexpr (Law::kColumns.dissipated && !Law::kColumns.temperature) {
    if (view.temperature) {
      const Lanes work = state.dissipated - load_lanes(view.dissipated + at);
      store_first(view.temperature + at, load_lanes(view.temperature + at) + law.heating * work, count);
    }
  }
  for_each_state_column<Dim, Law>(
      view, state, [&](double* column, Lanes value) { store_first(column + at, value, count); });
}

}  // namespace detail

/// Plane stress: F ← (I + a) F, then s where τ_zz vanishes.
template <class Law>
inline void advance_plane_stress(const StateView<2>& view, const Law& law, const Lanes (&l)[4], double dt,
                                 int terms, std::uint32_t at, Lanes (&f)[4], Lanes& s, Lanes (&tau)[6],
                                 Lanes& wave_speed_squared) {
  advance_deformation<2>(l, dt, terms, f);
  Lanes seen[4] = {f[0], f[1], f[2], f[3]}, plane_stress = s, full[9];
  if (view.thermal_stretch) {
    const Lanes cooling = detail::cooling(view, at);
    detail::cool(cooling, seen);
    plane_stress *= cooling;
  }
  plane_stress = law.out_of_plane_stretch(seen, plane_stress);
  embed(seen, plane_stress, full);
  law.template stress<3>(full, tau, wave_speed_squared);
  wave_speed_squared = law.plate_wave_speed_squared(seen, plane_stress);
  s = view.thermal_stretch ? plane_stress * load_lanes(view.thermal_stretch + at) : plane_stress;
}

/// Axisymmetry: F ← (I + a) F and s ← (1 + b) s, b the increment of the hoop rate v_r/r. Plane strain that
/// heat stretches is the same with s = 1.
/// @return J, as advance_law
template <class Law>
inline Lanes advance_hoop(const StateView<2>& view, const Law& law, const Lanes (&l)[4], Lanes rate,
                          double dt, int terms, std::uint32_t at, int count, Lanes (&f)[4], Lanes& s,
                          Lanes (&tau)[6], Lanes& wave_speed_squared) {
  const Lanes around = stretch_increment(rate, dt, terms);
  Lanes a[4], full[9];
  deformation_increment<2>(l, dt, terms, a);
  deform<2>(a, f);
  s += around * s;
  embed(f, s, full);
  if (view.thermal_stretch) detail::cool(detail::cooling(view, at), full);
  if constexpr (Evolving<Law>) {
    Lanes increment[9], of_volume = broadcast<Lanes>(1.0);
    embed(a, around, increment);
    const Lanes before = load_lanes(view.volume_ratio + at),
                now = before * (1.0 + around) * volume_change<2>(a);
    if (view.thermal_stretch) of_volume = detail::volume_cooling(view, at);
    MaterialState<2, Lanes> plane{};
    detail::load_state<Law>(view, at, plane);
    MaterialState<3, Lanes> state = widened(plane);
    law.template advance<3>(
        StrainStep<3, Lanes>{increment, full, of_volume * before, of_volume * now, l[0] + l[3] + rate, dt},
        state, tau, wave_speed_squared);
    plane = narrowed(state);
    detail::store_state(view, law, at, count, plane);
    if (law.shape_limit() < constants::kWholeShape) limit_shape<2>(law.shape_limit(), now / s, count, f);
    return now;
  } else {
    law.template stress<3>(full, tau, wave_speed_squared);
    return s * determinant<2>(f);
  }
}

/// As advance_law, with the stretch s. A law that cannot relax is refused by the reader in plane stress.
template <class Law>
inline Lanes advance_law_with_depth(const ParticleView<2>& p, const Law& law, const Lanes (&l)[4], Lanes rate,
                                    double dt, int terms, std::uint32_t at, int count, Lanes (&f)[4],
                                    Lanes& s, Lanes (&tau)[4], Lanes& wave_speed_squared) {
  Lanes all[6], j;
  bool plane_stress = false;
  if constexpr (HasPlaneStress<Law>) plane_stress = p.plane_kind == PlaneKind::plane_stress;
  if (plane_stress) {
    if constexpr (HasPlaneStress<Law>)
      advance_plane_stress(p.state, law, l, dt, terms, at, f, s, all, wave_speed_squared);
    j = s * determinant<2>(f);
  } else {
    j = advance_hoop(p.state, law, l, rate, dt, terms, at, count, f, s, all, wave_speed_squared);
  }
  for (int c = 0; c < kSymmetric<2>; ++c) tau[c] = all[c];
  return j;
}

}  // namespace mpmfast
