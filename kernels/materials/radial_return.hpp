#pragma once

/// @file Plastic shear of a neo-Hookean solid (N20 Eq. 18), τ = G dev(b̄) + …, by radial return.

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// The trial state of a step: b̄ = d + m I, the isochoric elastic left Cauchy–Green tensor, d its deviator.
template <int Dim, class V>
class Shear {
 public:
  V measure;  ///< q, the von Mises measure of the trial Kirchhoff stress, Pa
  V slope;    ///< 3Ḡ, Ḡ = G tr(b̄)/3: q falls by 3Ḡ x for an equivalent plastic strain x, Pa

  Shear(const V (&b)[kSymmetric<Dim>], double modulus)
      : modulus_(modulus), mean_((b[0] + b[1] + b[2]) * (1.0 / 3.0)) {
    for (int c = 0; c < kSymmetric<Dim>; ++c) d_[c] = c < 3 ? b[c] - mean_ : b[c];
    measure = modulus * square_root(1.5 * contraction<Dim>(d_));
    slope = 3.0 * modulus * mean_;
  }

  /// Returns b̄ by an equivalent plastic strain x in [0, q/3Ḡ]: d shrinks along its direction, and the mean m
  /// follows from det(d + m I) = 1, m³ − ½(d:d) m + det d = 1: Newton's method from the trial's mean, above
  /// the root, where the cubic is convex; five rounds reach round-off from any trial below tr b̄ = 6.
  /// @return work of the deviator, J/m³: the elastic energy 3/2 G dm that the return takes out, by its rate
  /// at the end, (3m² − ½d:d) dm = ½ m d(d:d) − d(det d). (The difference over the return counts the trial's
  /// overshoot twice: it misses by the first order of the step.) To the order of the elastic strain it is
  /// q x. The shear energy that sudden melting lets go, a thousandth of the plastic work before it, is not
  /// seen.
  V flow(V x, V (&b)[kSymmetric<Dim>]) const {
    const auto flows = x > broadcast<V>(0.0);
    const V scale = flows ? 1.0 - slope * x / measure : broadcast<V>(1.0);
    const V trial_half = 0.5 * contraction<Dim>(d_), trial_third = symmetric_determinant<Dim>(d_);
    const V half = scale * scale * trial_half, third = scale * scale * scale * trial_third - 1.0;
    V m = mean_;
    for (int k = 0; k < constants::kReturnIterations; ++k)
      m -= ((m * m - half) * m + third) / (3.0 * m * m - half);
    for (int c = 0; c < kSymmetric<Dim>; ++c)
      b[c] = flows ? (c < 3 ? scale * d_[c] + m : scale * d_[c]) : b[c];
    const V share = scale * (1.0 - scale);
    return 1.5 * modulus_ * share * (2.0 * m * trial_half - 3.0 * scale * trial_third) / (3.0 * m * m - half);
  }

 private:
  double modulus_;
  V mean_, d_[kSymmetric<Dim>];
};

}  // namespace mpmfast
