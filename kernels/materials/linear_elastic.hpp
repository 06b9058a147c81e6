#pragma once

/// @file Infinitesimal isotropic elasticity (K24's 'linear elastic').

#include "kernels/dimension.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

/// σ = λ tr(ε) I + 2G ε with ε = sym(F) − I; small strains and rotations only (a turned body is seen as
/// strained). The first Piola–Kirchhoff stress of W(ε) is σ itself and the force integral is Σ V0 P·∇0 S; at
/// this order τ = σ.
struct LinearElastic {
  double density = 0;  ///< kg/m³
  double lambda = 0;   ///< Lamé's first constant, Pa
  double shear = 0;    ///< G, Pa

  template <int Dim, class V>
  void stress(const V (&f)[Dim * Dim], V (&tau)[kSymmetric<Dim>], V& wave_speed_squared) const {
    V strain[kSymmetric<Dim>];
    small_strain<Dim>(f, strain);
    const V pressure_part = lambda * (strain[0] + strain[1] + strain[2]);
    for (int c = 0; c < 3; ++c) tau[c] = pressure_part + 2.0 * shear * strain[c];
    for (int c = 3; c < kSymmetric<Dim>; ++c) tau[c] = 2.0 * shear * strain[c];
    wave_speed_squared = broadcast<V>((lambda + 2.0 * shear) / density);
  }

  /// Stored energy per volume, J/m³: ½λ tr(ε)² + G ε:ε.
  template <int Dim, class V>
  V energy(const V (&f)[Dim * Dim]) const {
    V e[kSymmetric<Dim>];
    small_strain<Dim>(f, e);
    const V trace = e[0] + e[1] + e[2];
    V squares = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    for (int c = 3; c < kSymmetric<Dim>; ++c) squares += 2.0 * e[c] * e[c];
    return 0.5 * lambda * trace * trace + shear * squares;
  }

  /// ε_zz = −λ/(λ + 2G) (ε_xx + ε_yy).
  template <class V>
  V relaxed_stretch(const V (&f)[4], V) const {
    return 1.0 - lambda / (lambda + 2.0 * shear) * (f[0] + f[3] - 2.0);
  }

  /// λ + 2G − λ²/(λ + 2G) = E/(1 − ν²).
  template <class V>
  V plate_wave_speed_squared(const V (&)[4], V) const {
    const double modulus = lambda + 2.0 * shear;
    return broadcast<V>((modulus - lambda * lambda / modulus) / density);
  }
};

}  // namespace mpmfast
