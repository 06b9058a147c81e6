#pragma once

/// @file The distance between two surfaces at a contact node: from the particles' ellipsoids, or from the
/// grid. Negative: they overlap.

#include <cmath>
#include <limits>

#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/materials/kinematics.hpp"

namespace mpmfast {

/// Row-major inverse of a deformation gradient.
template <int Dim, class V>
inline void inverse_deformation(const V (&f)[Dim * Dim], V (&inverse)[Dim * Dim]) {
  const V scale = 1.0 / determinant<Dim>(f);
  if constexpr (Dim == 2) {
    inverse[0] = scale * f[3];
    inverse[1] = -scale * f[1];
    inverse[2] = -scale * f[2];
    inverse[3] = scale * f[0];
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int r = (j + 1) % 3, s = (j + 2) % 3, t = (i + 1) % 3, u = (i + 2) % 3;
        inverse[3 * i + j] = scale * (f[3 * r + t] * f[3 * s + u] - f[3 * r + u] * f[3 * s + t]);
      }
  }
}

/// Radius of a particle along n (N20 Eq. 25): R_p = 1/sqrt(Σ_k (n0_k/R0_k)²), n0 = F⁻¹ n.
///
/// The undeformed particle is the ellipsoid Σ_k (X_k/R0_k)² = 1 about its centre; F carries X to x = F X. The
/// point x = R n of the deformed surface, straight ahead along n, comes from X = R F⁻¹n = R n0, hence R² Σ
/// (n0_k/R0_k)² = 1. This is the radial distance; the ellipsoid's extent along n, sqrt(Σ_k R0_k² (Fᵀn)_k²),
/// is larger unless n is one of its axes.
/// @param inverse_f row-major F⁻¹; @param half_size R0 in any unit of length, that of the result
template <int Dim, class V, class H>
inline V ellipsoid_radius(const V (&inverse_f)[Dim * Dim], const H (&half_size)[Dim], const Vec<Dim>& n) {
  V sum = broadcast<V>(0.0);
  for (int k = 0; k < Dim; ++k) {
    V n0 = inverse_f[Dim * k] * n[0];
    for (int j = 1; j < Dim; ++j) n0 += inverse_f[Dim * k + j] * n[j];
    n0 = n0 / half_size[k];
    sum += n0 * n0;
  }
  return 1.0 / square_root(sum);
}

/// d = min_{p∈b}(ξ_p·n − R_p) − max_{p∈a}(ξ_p·n + R_p) in cells (N20 Eq. 24); infinite if a class is empty.
/// @param radius R_p in cells, as long as the cloud's arrays; the padding does not count
template <int Dim>
inline double cloud_separation(const CloudView<Dim>& cloud, const double* radius, const Vec<Dim>& n) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Lanes none = broadcast<Lanes>(infinity);
  Lanes nearest_b = none, nearest_a = none;  // of a: min of −(ξ·n + R)
  for (int k = 0; k < cloud.count; k += kLanes) {
    const Lanes side = load_lanes(cloud.side + k);
    Lanes ahead = load_lanes(cloud.xi[0] + k) * n[0];
    for (int d = 1; d < Dim; ++d) ahead += load_lanes(cloud.xi[d] + k) * n[d];
    const Lanes edge = side * ahead - load_lanes(radius + k);
    nearest_b = smaller(nearest_b, side > 0.0 ? edge : none);
    nearest_a = smaller(nearest_a, side < 0.0 ? edge : none);
  }
  double b = infinity, a = infinity;
  for (int i = 0; i < kLanes; ++i) {
    b = smaller<double>(b, nearest_b[i]);
    a = smaller<double>(a, nearest_a[i]);
  }
  return a + b;
}

/// From the nodal mean positions e = (x − x_i)·n of each side, in cells: the surfaces are taken to touch
/// where the means are c apart (0.8 with two particles a cell side, 1.07 with one).
inline double position_offset(double e_a, double e_b, double c) { return e_b - e_a - c; }

/// The same with the distance of each surface from the node by a power law, d_a = 1 − 2(−e_a/1.25)^0.58 and
/// d_b = 2(e_b/1.25)^0.58 − 1 in cells; a mean that lies beyond the node continues the power as an odd
/// function.
inline double position_power(double e_a, double e_b) {
  const auto odd_power = [](double e) { return std::copysign(std::pow(std::abs(e) / 1.25, 0.58), e); };
  return 2.0 * odd_power(e_b) - 1.0 - (1.0 - 2.0 * odd_power(-e_a));
}

}  // namespace mpmfast
