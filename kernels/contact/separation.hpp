#pragma once

/// @file The distance between two surfaces at a contact node: from the particles' ellipsoids, or from the
/// grid. Negative: they overlap.

#include <cmath>
#include <limits>

#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/simd/math.hpp"
#include "kernels/simd/support.hpp"

namespace mpmfast {

/// How far a particle reaches along n. Its deformed domain has half-edge vectors E = F diag(R0).
enum class Extent {
  radial,         ///< of the ellipsoid E S (S the unit sphere): the point straight ahead (N20 Eq. 25)
  ellipsoid,      ///< of the same ellipsoid: the furthest of its points, the support function |Eᵀn|
  parallelepiped  ///< of the domain itself (2-D: parallelogram): Σ_k |E_k·n|
};

/// Numbers that an extent asks of a domain: a packed symmetric matrix, or the half-edge vectors.
template <int Dim>
constexpr int shape_size(Extent extent) {
  return extent == Extent::parallelepiped ? Dim * Dim : Dim * (Dim + 1) / 2;
}

/// What an extent asks of a domain, found once for any number of directions.
///
/// Radial: x = R n is E ζ with |ζ| = 1, so R = 1/|E⁻¹ n| = 1/sqrt(n·G n) with G = E⁻ᵀE⁻¹; with E = F diag(R0)
/// this is N20 Eq. 25, 1/sqrt(Σ_k (n0_k/R0_k)²), n0 = F⁻¹ n. The furthest point along n is max_ζ n·Eζ = |Eᵀn|
/// = sqrt(n·M n) with M = E Eᵀ, which is larger unless n is one of the ellipsoid's axes; over the domain's
/// corners it is Σ_k |(Eᵀn)_k|.
/// @param edges row-major E in any unit of length, that of the extents
/// @param shape G or M, the lower triangle row by row, or E
template <Extent E, int Dim, class V>
inline void domain_shape(const V (&edges)[Dim * Dim], V (&shape)[shape_size<Dim>(E)]) {
  if constexpr (E == Extent::parallelepiped) {
    for (int e = 0; e < Dim * Dim; ++e) shape[e] = edges[e];
    return;
  } else {
    V rows[Dim * Dim];  // whose products among each other are the matrix
    if constexpr (E == Extent::radial) {
      V inverse[Dim * Dim];
      invert<Dim>(edges, inverse);
      for (int i = 0; i < Dim; ++i)
        for (int k = 0; k < Dim; ++k) rows[Dim * i + k] = inverse[Dim * k + i];
    } else {
      for (int e = 0; e < Dim * Dim; ++e) rows[e] = edges[e];
    }
    for (int i = 0, e = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j, ++e) {
        shape[e] = rows[Dim * i] * rows[Dim * j];
        for (int k = 1; k < Dim; ++k) shape[e] += rows[Dim * i + k] * rows[Dim * j + k];
      }
  }
}

/// Half the extent of a particle along the unit vector n, from its shape.
template <Extent E, int Dim, class V>
inline V extent_along(const V (&shape)[shape_size<Dim>(E)], const Vec<Dim>& n) {
  V sum = broadcast<V>(0.0);
  if constexpr (E == Extent::parallelepiped) {
    for (int k = 0; k < Dim; ++k) {
      V along = shape[k] * n[0];
      for (int j = 1; j < Dim; ++j) along += shape[Dim * j + k] * n[j];
      sum += magnitude(along);
    }
    return sum;
  } else {
    for (int i = 0, e = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j, ++e) sum += shape[e] * ((i == j ? 1 : 2) * n[i] * n[j]);
    if constexpr (E == Extent::radial) return inverse_root(sum);
    return square_root(sum);
  }
}

/// How far the surface of some particles reaches along the unit vector n, max_p (ξ_p·n + R_p), cells, and
/// which of them does; −∞ if there are none. Two surfaces a and b with n from a to b are d = −reach_b(−n) −
/// reach_a(n) apart (N20 Eq. 24).
template <Extent E, int Dim>
inline SupportSearch::Found reach_along(const CloudColumns<Dim>& particles, const Vec<Dim>& n) {
  SupportSearch furthest;
  for (int k = 0; k < particles.count; k += kLanes) {
    Lanes shape[shape_size<Dim>(E)];
    for (int e = 0; e < shape_size<Dim>(E); ++e) shape[e] = load_lanes(particles.shape[e] + k);
    Lanes ahead = extent_along<E, Dim>(shape, n);
    for (int d = 0; d < Dim; ++d) ahead += load_lanes(particles.xi[d] + k) * n[d];
    furthest.take(ahead, lanes_before(particles.count - k));
  }
  return furthest.found();
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

/// The same by the piecewise fits that are exact where the means are far (NN Eq. 3.52, 3.55), for two or one
/// particles a cell side: with u = −e_a or e_b, a surface lies u − ¼ (or u − ½) from the node beyond u = ¾
/// (½), and 3/2 (4u/3)^0.5546 − 1 (or (2u)^0.5387 − 1) below, continued as an odd function.
inline double position_piecewise(double e_a, double e_b, int particles_a_side) {
  const auto distance = [particles_a_side](double u) {
    const double joint = particles_a_side == 1 ? 0.5 : 0.75,
                 exponent = particles_a_side == 1 ? 0.5387 : 0.5546;
    if (u > joint) return u - (particles_a_side == 1 ? 0.5 : 0.25);
    return 2.0 * joint * std::copysign(std::pow(std::abs(u) / joint, exponent), u) - 1.0;
  };
  return distance(e_b) + distance(-e_a);
}

}  // namespace mpmfast
