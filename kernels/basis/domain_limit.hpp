#pragma once

/// @file The domain over which CPDI weights are taken, where a particle's own has become long or thin.
///
/// A domain that has grown over several cells averages grid functions far from its particle. One that has
/// been sheared has edges that are nearly parallel, and Σ_i |G_pi| grows with the square of the shear: steps
/// become unstable. Homel, Brannon and Guilkey (2016) scale half-diagonals that are longer than a length l to
/// it. That bounds the domain, and in the mean the slopes; their largest still grow with the shear. So the
/// domain is replaced, where it is too long or too thin, by the rectangle (box) with the same second moments
/// R Rᵀ along its principal axes, whose Σ_i |G_pi| does not depend on the shear, and its longest edges are
/// shortened until the half-diagonal is l.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/principal_axes.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

namespace detail {

/// In the plane: r_1 turned to the long principal axis, r_2 across it.
template <class V>
inline void bound_edges(double length, V (&edge)[4]) {
  const V first = edge[0] * edge[0] + edge[2] * edge[2], second = edge[1] * edge[1] + edge[3] * edge[3];
  const V twice = 2.0 * (edge[0] * edge[1] + edge[2] * edge[3]), difference = first - second;
  const V tiny =
      constants::kEqualEdges * (first + second);  // no axis is the longer one: the edges stay as they lie
  const V spread = square_root(difference * difference + twice * twice) + tiny;
  const V cosine = (difference + tiny) / spread;  // of twice the angle from r_1 to the axis
  const V along = square_root(larger(0.5 * (1.0 + cosine), broadcast<V>(0.0)));
  V across = square_root(larger(0.5 * (1.0 - cosine), broadcast<V>(0.0)));
  across = twice < 0.0 ? -across : across;
  const V det = determinant<2>(edge);
  const V x = along * edge[0] + across * edge[1], y = along * edge[2] + across * edge[3];
  const V longer = x * x + y * y, shorter = det * det / longer, most = broadcast<V>(length * length);
  // Lengths squared that make up l² together, the shorter one as it is if it can be.
  const V short_kept = smaller(shorter, 0.5 * most), long_kept = smaller(longer, most - short_kept);
  const V scale = square_root(long_kept / longer), aside = square_root(short_kept / shorter) * det / longer;
  edge[0] = scale * x;
  edge[2] = scale * y;
  edge[1] = -aside * y;
  edge[3] = aside * x;
}

/// In space.
inline void bound_edges(double length, double (&edge)[9]) {
  double axes[9], squares[3], left = length * length;
  turn_to_principal_axes<3>(edge, axes);
  for (int d = 0; d < 3; ++d)
    squares[d] = edge[d] * edge[d] + edge[3 + d] * edge[3 + d] + edge[6 + d] * edge[6 + d];
  int rising[3] = {0, 1, 2};
  std::sort(rising, rising + 3, [&](int a, int b) { return squares[a] < squares[b]; });
  for (int k = 0; k < 3; ++k) {
    const int d = rising[k];
    const double kept = std::min(squares[d], left / (3 - k)), scale = std::sqrt(kept / squares[d]);
    left -= kept;
    for (int i = 0; i < 3; ++i) edge[3 * i + d] *= scale;
  }
}

template <class Lane>
inline void bound_edges(double length, Lane keeps, Lanes (&edge)[9]) {
  for (int k = 0; k < kLanes; ++k) {
    if (keeps[k]) continue;
    double one[9];
    for (int e = 0; e < 9; ++e) one[e] = edge[e][k];
    bound_edges(length, one);
    for (int e = 0; e < 9; ++e) edge[e][k] = one[e];
  }
}

}  // namespace detail

/// Replaces half-edge vectors (row-major [r_1 … r_Dim]) of domains that are too long or too thin.
/// @param length  l, in the unit of the vectors
template <int Dim, class V>
inline void limit_domain(double length, V (&edge)[Dim * Dim]) {
  V norm[Dim], sum = broadcast<V>(0.0), product = broadcast<V>(1.0);
  for (int j = 0; j < Dim; ++j) {
    norm[j] = edge[j] * edge[j];
    for (int i = 1; i < Dim; ++i) norm[j] += edge[Dim * i + j] * edge[Dim * i + j];
    sum += norm[j];
    product *= norm[j];
  }
  const V det = determinant<Dim>(edge);
  // Of half-diagonals Σ_j ±r_j squared the largest is at most Σ_j |r_j|² + 2 Σ_{j<k} |r_j·r_k|.
  V longest = sum;
  for (int j = 0; j < Dim; ++j)
    for (int k = j + 1; k < Dim; ++k) {
      V dot = edge[j] * edge[k];
      for (int i = 1; i < Dim; ++i) dot += edge[Dim * i + j] * edge[Dim * i + k];
      longest += 2.0 * magnitude(dot);
    }
  const auto keeps =
      (longest <= length * length) & (det * det >= constants::kLeastSine * constants::kLeastSine * product);
  if constexpr (std::is_same_v<V, double>) {
    if (!keeps) detail::bound_edges(length, edge);
  } else {
    if (!any_of(~keeps)) return;
    if constexpr (Dim == 2) {
      V bounded[4] = {edge[0], edge[1], edge[2], edge[3]};
      detail::bound_edges(length, bounded);
      for (int e = 0; e < 4; ++e) edge[e] = keeps ? edge[e] : bounded[e];
    } else {
      detail::bound_edges(length, keeps, edge);
    }
  }
}

/// The half-edge vectors R = F diag(l), of a domain that is scaled where its half-diagonals outgrow
/// constants::kMostHalfDiagonal cells: CpdiBasis::kMaxSupport nodes a side then always suffice.
/// @param f row-major deformation gradient; @param edge row-major result, m
template <int Dim, class V>
inline void convect_domain(const V (&f)[Dim * Dim], const double (&half_size)[Dim], double inverse_cell,
                           V (&edge)[Dim * Dim]) {
  for (int e = 0; e < Dim * Dim; ++e) edge[e] = f[e] * half_size[e % Dim];
  limit_domain<Dim>(constants::kMostHalfDiagonal / inverse_cell, edge);
}

}  // namespace mpmfast
