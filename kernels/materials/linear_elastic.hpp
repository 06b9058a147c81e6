#pragma once

/// @file Infinitesimal isotropic elasticity (K24's 'linear elastic').

#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/simd/lanes.hpp"
#include "kernels/tensor.hpp"

namespace mpmfast {

/// σ = λ tr(ε) I + 2G ε with ε = sym(F) − I; small strains and rotations only (a turned body is seen as
/// strained). The first Piola–Kirchhoff stress of W(ε) is σ itself and the force integral is Σ V0 P·∇0 S; at
/// this order τ = σ.
struct LinearElastic {
  static constexpr const char *kModel = "linear_elastic",
                              *kDescription = "infinitesimal strains and turns only";
  double density{};  ///< kg/m³
  double young{};    ///< E, Pa
  double poisson{};  ///< ν

  template <class Keys>
  void describe(Keys& map) {
    describe_density(map, density);
    map.need("young", kYoungDescription, young, kModulus);
    map.need("poisson", kPoissonDescription, poisson, kPoisson);
  }
  double lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }  ///< Pa
  double shear() const { return young / (2 * (1 + poisson)); }                             ///< G, Pa
  /// Of a longitudinal wave, Pa.
  double modulus() const { return lambda() + 2 * shear(); }

  template <int Dim, class V>
  void stress(const V (&f)[Dim * Dim], V (&tau)[kSymmetric<Dim>], V& wave_speed_squared) const {
    const double g = shear();
    V strain[kSymmetric<Dim>];
    small_strain<Dim>(f, strain);
    const V pressure_part = lambda() * (strain[0] + strain[1] + strain[2]);
    for (int c = 0; c < 3; ++c) tau[c] = pressure_part + 2.0 * g * strain[c];
    for (int c = 3; c < kSymmetric<Dim>; ++c) tau[c] = 2.0 * g * strain[c];
    wave_speed_squared = broadcast<V>((lambda() + 2.0 * g) / density);
  }

  /// Stored energy per volume, J/m³: ½λ tr(ε)² + G ε:ε.
  template <int Dim, class V>
  V energy(const V (&f)[Dim * Dim]) const {
    V e[kSymmetric<Dim>];
    small_strain<Dim>(f, e);
    const V trace = e[0] + e[1] + e[2];
    V squares = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    for (int c = 3; c < kSymmetric<Dim>; ++c) squares += 2.0 * e[c] * e[c];
    return 0.5 * lambda() * trace * trace + shear() * squares;
  }

  /// ε_zz = −λ/(λ + 2G) (ε_xx + ε_yy).
  template <class V>
  V out_of_plane_stretch(const V (&f)[4], V) const {
    return 1.0 - lambda() / modulus() * (f[0] + f[3] - 2.0);
  }

  /// λ + 2G − λ²/(λ + 2G) = E/(1 − ν²).
  template <class V>
  V plate_wave_speed_squared(const V (&)[4], V) const {
    return broadcast<V>((modulus() - lambda() * lambda() / modulus()) / density);
  }
};

}  // namespace mpmfast
