#pragma once

/// @file Strain and stress of a chunk of particles by one law: no basis in sight, so that each law is
/// compiled once (engine/state/materials.hpp) and not with every basis.

#include "kernels/materials/evolving.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Staging of a chunk by component.
template <int Dim>
struct StrainRoom {
  alignas(64) double gradient[4 * Dim][kChunk<Dim>];  ///< ∂v/∂x_d of a particle, [4 d + component of v]
  alignas(64) double deformation[Dim * Dim][kChunk<Dim>];
  alignas(64) double stress[kSymmetric<Dim>][kChunk<Dim>];
  alignas(64) double wave_speed[kChunk<Dim>];
  alignas(64) double jacobian[kChunk<Dim>];
};

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

/// F ← (I + a) F, τ and c of up to kLanes particles from `at`, `count` of which are the caller's.
template <int Dim, class Law>
inline void advance_law(const StateView<Dim>& view, const Law& law, const Lanes (&l)[Dim * Dim], double dt,
                        int terms, std::uint32_t at, int count, Lanes (&f)[Dim * Dim],
                        Lanes (&tau)[kSymmetric<Dim>], Lanes& wave_speed_squared) {
  if constexpr (Evolving<Law>) {
    Lanes a[Dim * Dim];
    const Lanes before = determinant<Dim>(f);
    deformation_increment<Dim>(l, dt, terms, a);
    deform<Dim>(a, f);
    Lanes expansion = l[0];
    for (int d = 1; d < Dim; ++d) expansion += l[(Dim + 1) * d];
    MaterialState<Dim, Lanes> state;
    detail::for_each_state_column<Dim, Law>(
        view, state, [&](const double* column, Lanes& value) { value = load_lanes(column + at); });
    law.template advance<Dim>(StrainStep<Dim, Lanes>{a, f, before, determinant<Dim>(f), expansion, dt}, state,
                              tau, wave_speed_squared);
    detail::for_each_state_column<Dim, Law>(
        view, state, [&](double* column, Lanes value) { store_first(column + at, value, count); });
  } else {
    advance_deformation<Dim>(l, dt, terms, f);
    law.template stress<Dim>(f, tau, wave_speed_squared);
  }
}

/// Strain and stress of a chunk whose velocity gradients are staged in room.gradient: F by the truncated
/// exponential, τ, c and the evolving state by the material's law; all columns written back.
/// @return smallest J of the chunk
template <int Dim, class Law>
double strain_chunk(const ParticleView<Dim>& p, const Law& law, std::uint32_t begin, int count, double dt,
                    int terms, StrainRoom<Dim>& room) {
  for (int k = 0; k < count; k += kLanes) {
    Lanes l[Dim * Dim], f[Dim * Dim], tau[kSymmetric<Dim>], c2;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        l[Dim * i + j] = load_lanes(&room.gradient[4 * j + i][k]);
        f[Dim * i + j] = load_lanes(p.deformation[Dim * i + j] + begin + k);
      }
    advance_law<Dim>(p.state, law, l, dt, terms, begin + static_cast<std::uint32_t>(k), count - k, f, tau,
                     c2);
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

}  // namespace mpmfast
