#pragma once

/// @file Planes that stretch along their normal by a factor s: plane stress and axisymmetry. A law is then
/// asked in three dimensions, with F = diag(F_plane, s); of its tensors xx, yy, zz and xy are kept, the rest
/// is zero.

#include "kernels/materials/evolving.hpp"
#include "kernels/materials/kinematics.hpp"

namespace mpmfast {

template <class V>
inline void embed(const V (&plane)[4], V s, V (&f)[9]) {
  for (auto& v : f) v = broadcast<V>(0.0);
  f[0] = plane[0];
  f[1] = plane[1];
  f[3] = plane[2];
  f[4] = plane[3];
  f[8] = s;
}

/// The same state for a law in three dimensions, and back.
template <class V>
inline MaterialState<3, V> widened(const MaterialState<2, V>& s) {
  MaterialState<3, V> w{s.dissipated, s.internal_energy, s.plastic_strain, s.temperature, {}, s.volume_ratio};
  for (int c = 0; c < kSymmetric<2>; ++c) w.elastic_strain[c] = s.elastic_strain[c];
  return w;
}
template <class V>
inline MaterialState<2, V> narrowed(const MaterialState<3, V>& w) {
  MaterialState<2, V> s{w.dissipated, w.internal_energy, w.plastic_strain, w.temperature, {}, w.volume_ratio};
  for (int c = 0; c < kSymmetric<2>; ++c) s.elastic_strain[c] = w.elastic_strain[c];
  return s;
}

/// The increment b of s ← (1 + b) s at a rate of stretch, to the terms of deformation_increment.
template <class V>
inline V stretch_increment(V rate, double dt, int terms) {
  const V x = dt * rate;
  if (terms == kAllTerms) return exponential(x) - 1.0;
  if (terms == kInverse) return x / (1.0 - x);
  return terms > 1 ? x + 0.5 * x * x : x;
}

/// Laws for plane stress:
///   s = out_of_plane_stretch(F_plane, s of the last step): where τ_zz = 0;
///   plate_wave_speed_squared(F_plane, s): of in-plane waves through the energy W(F_plane, s(F_plane)). With
///   y = ln s its modulus along n is that at fixed s less (∂τ_nn/∂y)²/(∂τ_zz/∂y).
template <class Law>
concept HasPlaneStress = requires(const Law& law, const double (&f)[4], double s) {
  law.out_of_plane_stretch(f, s);
  law.plate_wave_speed_squared(f, s);
};

}  // namespace mpmfast
