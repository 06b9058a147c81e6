#pragma once

/// @file Strain and stress of a chunk of particles by one law: no basis in sight, so that each law is
/// compiled once (engine/state/materials.hpp) and not with every basis.

#include "kernels/materials/evolving.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/strain_depth.hpp"
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
  alignas(64) double hoop_rate[kChunk<Dim>];  ///< v_r/r, staged by the caller in axisymmetry
  alignas(64) double stretch[kChunk<Dim>];
};

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

/// The results of a chunk, staged in its room, to the columns. @return smallest J of the chunk
template <int Dim>
inline double store_strain(const ParticleView<Dim>& p, std::uint32_t begin, int count,
                           const StrainRoom<Dim>& room) {
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

/// As strain_chunk, in a plane that stretches along its normal.
template <class Law>
double strain_chunk_with_depth(const ParticleView<2>& p, const Law& law, std::uint32_t begin, int count,
                               double dt, int terms, StrainRoom<2>& room) {
  const bool hoop = p.depth == Depth::hoop;
  for (int k = 0; k < count; k += kLanes) {
    Lanes l[4], f[4], tau[4], c2, s = load_lanes(p.stretch + begin + k);
    const Lanes rate = hoop ? load_lanes(&room.hoop_rate[k]) : broadcast<Lanes>(0.0);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        l[2 * i + j] = load_lanes(&room.gradient[4 * j + i][k]);
        f[2 * i + j] = load_lanes(p.deformation[2 * i + j] + begin + k);
      }
    advance_law_with_depth(p, law, l, rate, dt, terms, begin + static_cast<std::uint32_t>(k), count - k, f, s,
                           tau, c2);
    for (int e = 0; e < 4; ++e) store_lanes(&room.deformation[e][k], f[e]);
    for (int c = 0; c < kSymmetric<2>; ++c) store_lanes(&room.stress[c][k], tau[c]);
    store_lanes(&room.stretch[k], s);
    store_lanes(&room.wave_speed[k], square_root(c2));
    store_lanes(&room.jacobian[k], s * determinant<2>(f));
  }
  std::memcpy(p.stretch + begin, room.stretch, static_cast<std::size_t>(count) * sizeof(double));
  return store_strain<2>(p, begin, count, room);
}

/// Strain and stress of a chunk whose velocity gradients are staged in room.gradient: F by the truncated
/// exponential, τ, c and the evolving state by the material's law; all columns written back.
/// @return smallest J of the chunk
template <int Dim, class Law>
double strain_chunk(const ParticleView<Dim>& p, const Law& law, std::uint32_t begin, int count, double dt,
                    int terms, StrainRoom<Dim>& room) {
  if constexpr (Dim == 2) {
    if (p.depth != Depth::held) return strain_chunk_with_depth(p, law, begin, count, dt, terms, room);
  }
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
  return store_strain(p, begin, count, room);
}

}  // namespace mpmfast
