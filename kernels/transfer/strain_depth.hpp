#pragma once

/// @file Strain and stress of particles in planes that stretch along their normal (materials/depth.hpp).

#include "kernels/materials/depth.hpp"
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

}  // namespace detail

/// Plane stress: F ← (I + a) F, then s where τ_zz vanishes.
template <class Law>
inline void advance_relaxed(const Law& law, const Lanes (&l)[4], double dt, int terms, Lanes (&f)[4],
                            Lanes& s, Lanes (&tau)[6], Lanes& wave_speed_squared) {
  advance_deformation<2>(l, dt, terms, f);
  s = law.relaxed_stretch(f, s);
  Lanes full[9];
  embed(f, s, full);
  law.template stress<3>(full, tau, wave_speed_squared);
  wave_speed_squared = law.plate_wave_speed_squared(f, s);
}

/// Axisymmetry: F ← (I + a) F and s ← (1 + b) s, b the increment of the hoop rate v_r/r.
template <class Law>
inline void advance_hoop(const StateView<2>& view, const Law& law, const Lanes (&l)[4], Lanes rate, double dt,
                         int terms, std::uint32_t at, int count, Lanes (&f)[4], Lanes& s, Lanes (&tau)[6],
                         Lanes& wave_speed_squared) {
  const Lanes before = s * determinant<2>(f), around = stretch_increment(rate, dt, terms);
  Lanes a[4], full[9];
  deformation_increment<2>(l, dt, terms, a);
  deform<2>(a, f);
  s += around * s;
  embed(f, s, full);
  if constexpr (Evolving<Law>) {
    Lanes increment[9];
    embed(a, around, increment);
    MaterialState<2, Lanes> plane{};
    detail::for_each_state_column<2, Law>(
        view, plane, [&](const double* column, Lanes& value) { value = load_lanes(column + at); });
    MaterialState<3, Lanes> state = widened(plane);
    const StrainStep<3, Lanes> step{increment, full, before, s * determinant<2>(f), l[0] + l[3] + rate, dt};
    law.template advance<3>(step, state, tau, wave_speed_squared);
    plane = narrowed(state);
    detail::for_each_state_column<2, Law>(
        view, plane, [&](double* column, Lanes value) { store_first(column + at, value, count); });
  } else {
    law.template stress<3>(full, tau, wave_speed_squared);
  }
}

/// As advance_law, with the stretch s. A law that cannot relax is refused by the reader in plane stress.
template <class Law>
inline void advance_law_with_depth(const ParticleView<2>& p, const Law& law, const Lanes (&l)[4], Lanes rate,
                                   double dt, int terms, std::uint32_t at, int count, Lanes (&f)[4], Lanes& s,
                                   Lanes (&tau)[4], Lanes& wave_speed_squared) {
  Lanes all[6];
  if constexpr (Relaxes<Law>) {
    if (p.depth == Depth::relaxed)
      advance_relaxed(law, l, dt, terms, f, s, all, wave_speed_squared);
    else
      advance_hoop(p.state, law, l, rate, dt, terms, at, count, f, s, all, wave_speed_squared);
  } else {
    advance_hoop(p.state, law, l, rate, dt, terms, at, count, f, s, all, wave_speed_squared);
  }
  for (int c = 0; c < kSymmetric<2>; ++c) tau[c] = all[c];
}

}  // namespace mpmfast
