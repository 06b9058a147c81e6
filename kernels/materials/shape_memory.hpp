#pragma once

/// @file What is left of F in laws that flow. Fluids, and soils and metals that have yielded, do not answer
/// to F but to J and to a history of their own. Their F only says how the domain of a particle is shaped, and
/// after much shear it says nothing: the neighbours have changed. A law that flows states `shape_limit()`,
/// the largest principal stretch of the isochoric part of F that it keeps; 1: no shape at all.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/principal_axes.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// J of F ← (I + a) F over J before: det(I + a).
template <int Dim, class V>
inline V volume_change(const V (&a)[Dim * Dim]) {
  V whole[Dim * Dim];
  for (int e = 0; e < Dim * Dim; ++e) whole[e] = e % (Dim + 1) == 0 ? 1.0 + a[e] : a[e];
  return determinant<Dim>(whole);
}

namespace detail {

/// x^(1/Dim).
template <int Dim, class V>
inline V root_of_volume(V x) {
  if constexpr (Dim == 2)
    return square_root(x);
  else
    return x * isochoric_factor(x);
}

/// F with the determinant `volume`, and with the principal stretches λ_i of its isochoric part raised to the
/// power that takes the largest of them to the limit; its rotation stays.
template <int Dim>
void bound_shape(double limit, double volume, double (&f)[Dim * Dim]) {
  double turned[Dim * Dim], axes[Dim * Dim], logs[Dim], mean = 0, largest = 0;
  for (int e = 0; e < Dim * Dim; ++e) turned[e] = f[e];
  turn_to_principal_axes<Dim>(turned, axes);
  for (int d = 0; d < Dim; ++d) {
    double squares = 0;
    for (int i = 0; i < Dim; ++i) squares += turned[Dim * i + d] * turned[Dim * i + d];
    if (!(squares > 0)) return;  // no volume is left: the step says so
    logs[d] = 0.5 * std::log(squares);
    mean += logs[d] / Dim;
  }
  for (double log : logs) largest = std::max(largest, log - mean);
  const double most = std::log(limit), power = largest > most ? most / largest : 1.0;
  for (double& entry : f) entry = 0;
  for (int d = 0; d < Dim; ++d) {
    const double factor = std::exp(std::log(volume) / Dim + power * (logs[d] - mean) - logs[d]);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f[Dim * i + j] += factor * turned[Dim * i + d] * axes[Dim * j + d];
  }
}

}  // namespace detail

/// Bounds what F of `count` particles keeps of their shape.
/// @param limit  of the law
/// @param volume det F as J says, of a plane that stretches along its normal without that stretch
template <int Dim>
inline void limit_shape(double limit, Lanes volume, int count, Lanes (&f)[Dim * Dim]) {
  using constants::kMostOpening;
  constexpr double most = Dim == 2 ? kMostOpening * kMostOpening : kMostOpening * kMostOpening * kMostOpening;
  volume = smaller(volume, broadcast<Lanes>(most));
  const Lanes root = detail::root_of_volume<Dim>(volume);
  if (limit <= 1) {
    for (int e = 0; e < Dim * Dim; ++e) f[e] = e % (Dim + 1) == 0 ? root : broadcast<Lanes>(0.0);
    return;
  }
  Lanes squares = f[0] * f[0];
  for (int e = 1; e < Dim * Dim; ++e) squares += f[e] * f[e];
  // In the plane Σ λ² is largest where λ and 1/λ are the limit; in space λ² ≤ Σ λ².
  const double bound = Dim == 2 ? limit * limit + 1 / (limit * limit) : limit * limit;
  const Lanes drift = magnitude(determinant<Dim>(f) - volume);
  LaneSet all = leading_lanes(count);
  LaneSet kept = where_less(all, squares, bound * root * root * (1 + constants::kShapeRoundOff));
  kept = where_less(kept, drift, constants::kVolumeDrift * volume);
  if (same_lanes(kept, all)) return;
  for (int k = 0; k < (count < kLanes ? count : kLanes); ++k) {
    if (squares[k] < bound * root[k] * root[k] * (1 + constants::kShapeRoundOff) &&
        drift[k] < constants::kVolumeDrift * volume[k])
      continue;
    double one[Dim * Dim];
    for (int e = 0; e < Dim * Dim; ++e) one[e] = f[e][k];
    detail::bound_shape<Dim>(limit, volume[k], one);
    for (int e = 0; e < Dim * Dim; ++e) f[e][k] = one[e];
  }
}

}  // namespace mpmfast
