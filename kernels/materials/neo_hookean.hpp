#pragma once

/// @file Compressible neo-Hookean solid of N20 Eq. 18.

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/simd/math.hpp"
#include "kernels/tensor.hpp"

namespace mpmfast {

/// W = ½G(I1 J^{−2/3} − 3) + ½K(½(J² − 1) − ln J), so that
/// τ = Jσ = G J^{−2/3} dev(B) + ½K(J² − 1) I  (N20 Eq. 18). I1 and dev are of the 3-D tensor; plane strain
/// has B_zz = 1.
struct NeoHookean {
  static constexpr const char *kModel = "neo_hookean", *kDescription = "large elastic strains";
  double density{};  ///< kg/m³, undeformed
  double bulk{};     ///< K, Pa
  double shear{};    ///< G, Pa

  template <class Keys>
  void describe(Keys& map) {
    describe_density(map, density);
    describe_bulk_and_shear(map, bulk, shear);
  }
  /// Of a longitudinal wave at rest, Pa.
  double modulus() const { return bulk + 4 * shear / 3; }

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
    V dev[kSymmetric<Dim>];
    deviator<Dim>(b, dev);
    for (int c = 0; c < kSymmetric<Dim>; ++c)
      tau[c] = c < 3 ? scale * dev[c] + pressure_part : scale * dev[c];
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

  /// τ_zz = 0 times J^{2/3}: with w = s^{2/3} and A, I the determinant and first invariant in the plane,
  ///   ½K A^{8/3} w⁴ + ⅔G w³ − ½K A^{2/3} w − ⅓G I = 0,
  /// which has one positive root and is convex there: Newton's method from the last step's.
  template <class V>
  V out_of_plane_stretch(const V (&f)[4], V last) const {
    const V area = determinant<2>(f), q = 0.5 * bulk / isochoric_factor(area);
    const V fourth = q * area * area, cubic = broadcast<V>(2.0 / 3.0 * shear);
    const V constant = (shear / 3.0) * (f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]);
    V w = 1.0 / isochoric_factor(last);
    for (int k = 0; k < constants::kPlaneStressIterations; ++k) {
      const V square = w * w, high = (fourth * w + cubic) * square;
      w -= (high * w - q * w - constant) / (4.0 * fourth * square * w + 3.0 * cubic * square - q);
    }
    return w * square_root(w);
  }

  /// ∂τ_nn/∂y = K J² − ⅔g (B_nn − ⅓I1 + s²), ∂τ_zz/∂y = K J² + g (⅔s² + 2/9 I1), g = G J^{−2/3}. The modulus
  /// is concave in B_nn, between its extremes in the plane: largest where its derivative vanishes, or at the
  /// nearest extreme.
  template <class V>
  V plate_wave_speed_squared(const V (&f)[4], V s) const {
    V b[kSymmetric<2>];
    left_cauchy_green<2>(f, b);
    const V j = s * determinant<2>(f), s2 = s * s, i1 = b[0] + b[1] + s2;
    const V g = shear * isochoric_factor(j), stiff = bulk * j * j;
    const V relief = stiff + g * (s2 * (2.0 / 3.0) + i1 * (2.0 / 9.0));
    const V best = i1 * (1.0 / 3.0) - s2 + 1.5 * (stiff - 0.25 * relief) / g;
    const V stretch = smaller(larger(best, smallest_stretch_squared<2>(b, j)), largest_stretch_squared<2>(b));
    const V coupling = stiff - g * (stretch - i1 * (1.0 / 3.0) + s2) * (2.0 / 3.0);
    const V modulus =
        0.5 * (stiff + bulk) + g * (i1 * (5.0 / 9.0) - stretch * (1.0 / 3.0)) - coupling * coupling / relief;
    return modulus * (1.0 / density);
  }
};

}  // namespace mpmfast
