#pragma once

/// @file Compressible neo-Hookean solid of K24 Eq. 46.

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/simd/math.hpp"
#include "kernels/tensor.hpp"

namespace mpmfast {

/// W = ½μ(I1 − 3) − μ ln J + ½λ (ln J)², so that τ = Jσ = μ(B − I) + λ ln J I  (K24 Eq. 46).
struct LogarithmicNeoHookean {
  static constexpr const char *kModel = "logarithmic_neo_hookean",
                              *kDescription = "large elastic strains, pressure by ln J";
  double density{};  ///< kg/m³, undeformed
  double lambda{};   ///< Lamé's first constant, Pa
  double shear{};    ///< μ, Pa

  template <class Keys>
  void describe(Keys& map) {
    describe_density(map, density);
    describe_lambda_and_shear(map, lambda, shear);
  }
  /// Of a longitudinal wave at rest, Pa.
  double modulus() const { return lambda + 2 * shear; }

  /// Wave speed: δL = n⊗n gives ρ0 c² = δτ_nn − τ_nn = μ(B_nn + 1) + λ(1 − ln J), largest where B_nn is;
  /// shear waves have μ B_nn, which remains where ln J > 1 makes the first fall below it.
  template <int Dim, class V>
  void stress(const V (&f)[Dim * Dim], V (&tau)[kSymmetric<Dim>], V& wave_speed_squared) const {
    V b[kSymmetric<Dim>];
    left_cauchy_green<Dim>(f, b);
    const V log_j = logarithm(determinant<Dim>(f));
    for (int c = 0; c < 3; ++c) tau[c] = shear * (b[c] - 1.0) + lambda * log_j;
    for (int c = 3; c < kSymmetric<Dim>; ++c) tau[c] = shear * b[c];
    const V stretch = largest_stretch_squared<Dim>(b);
    const V modulus = shear * stretch + larger(shear + lambda * (1.0 - log_j), broadcast<V>(0.0));
    wave_speed_squared = modulus * (1.0 / density);
  }

  /// Stored energy per undeformed volume, J/m³.
  template <int Dim, class V>
  V energy(const V (&f)[Dim * Dim]) const {
    V b[kSymmetric<Dim>];
    left_cauchy_green<Dim>(f, b);
    const V log_j = logarithm(determinant<Dim>(f));
    return 0.5 * shear * (b[0] + b[1] + b[2] - 3.0) + log_j * (0.5 * lambda * log_j - shear);
  }

  /// τ_zz = μ(e^{2y} − 1) + λ(ln A + y) = 0 for y = ln s, A the determinant in the plane: rising and convex,
  /// Newton's method from the last step's.
  template <class V>
  V out_of_plane_stretch(const V (&f)[4], V last) const {
    const V offset = lambda * logarithm(determinant<2>(f)) - shear;
    V y = logarithm(last);
    for (int k = 0; k < constants::kPlaneStressIterations; ++k) {
      const V term = shear * exponential(2.0 * y);
      y -= (term + lambda * y + offset) / (2.0 * term + lambda);
    }
    return exponential(y);
  }

  /// ∂τ_nn/∂y = λ, ∂τ_zz/∂y = 2μ s² + λ.
  template <class V>
  V plate_wave_speed_squared(const V (&f)[4], V s) const {
    V b[kSymmetric<2>];
    left_cauchy_green<2>(f, b);
    const V log_j = logarithm(s * determinant<2>(f)), stretch = largest_stretch_squared<2>(b);
    const V longitudinal = shear + lambda * (1.0 - log_j) - lambda * lambda / (2.0 * shear * s * s + lambda);
    return (shear * stretch + larger(longitudinal, broadcast<V>(0.0))) * (1.0 / density);
  }
};

}  // namespace mpmfast
