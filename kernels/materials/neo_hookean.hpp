#pragma once

/// @file Compressible neo-Hookean solid of N20 Eq. 18.

#include "kernels/dimension.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// W = ½G(I1 J^{−2/3} − 3) + ½K(½(J² − 1) − ln J), so that
/// τ = Jσ = G J^{−2/3} dev(B) + ½K(J² − 1) I  (N20 Eq. 18). I1 and dev are of the 3-D tensor; plane strain
/// has B_zz = 1.
struct NeoHookean {
  double density = 0;  ///< kg/m³, undeformed
  double bulk = 0;     ///< K, Pa
  double shear = 0;    ///< G, Pa

  /// Kirchhoff stress (components as kSymmetric) and squared longitudinal wave speed of the deformed solid.
  ///
  /// Wave speed: perturb with δL = n⊗n. Then δB_nn = 2B_nn, δI1 = 2B_nn, δJ = J, and with
  /// ρc² = (δτ_nn − τ_nn)/J the parts are ½K(J + 1/J) and G J^{−5/3}(5/9 I1 − ⅓ B_nn); ρ = ρ0/J.
  /// The largest over n has the smallest B_nn, bounded from below by smallest_stretch_squared.
  template <int Dim, class V>
  void stress(const V (&f)[Dim * Dim], V (&tau)[kSymmetric<Dim>], V& wave_speed_squared) const {
    V b[kSymmetric<Dim>];
    left_cauchy_green<Dim>(f, b);
    const V j = determinant<Dim>(f);
    const V scale = shear * isochoric_factor(j);
    const V i1 = b[0] + b[1] + b[2];
    const V pressure_part = 0.5 * bulk * (j * j - 1.0);
    for (int c = 0; c < 3; ++c) tau[c] = scale * (b[c] - i1 * (1.0 / 3.0)) + pressure_part;
    for (int c = 3; c < kSymmetric<Dim>; ++c) tau[c] = scale * b[c];
    const V modulus = 0.5 * bulk * (j * j + 1.0) +
                      scale * (i1 * (5.0 / 9.0) - smallest_stretch_squared<Dim>(b, j) * (1.0 / 3.0));
    wave_speed_squared = modulus * (1.0 / density);
  }

  /// Stored energy per undeformed volume, J/m³.
  template <int Dim, class V>
  V energy(const V (&f)[Dim * Dim]) const {
    V b[kSymmetric<Dim>];
    left_cauchy_green<Dim>(f, b);
    const V j = determinant<Dim>(f);
    return 0.5 * shear * ((b[0] + b[1] + b[2]) * isochoric_factor(j) - 3.0) +
           0.5 * bulk * (0.5 * (j * j - 1.0) - logarithm(j));
  }
};

}  // namespace mpmfast
