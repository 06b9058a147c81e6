#pragma once

/// @file Penetration depth of a point in a body whose surface has several patches.
///
/// Notation: d_j is the distance to the closest point on patch j, e_j the exit direction there. The depth d
/// of a point near a convex crease satisfies 1/d² = Σ 1/d_j² over the patches that count. Three properties
/// follow:
/// 1. d vanishes on each patch, so that the force of the potential k d²/2 is continuous across the crease.
/// 2. −∂d/∂x = Σ (d/d_j)³ e_j, so that the forces k d (d/d_j)³ e_j on the patches derive from the potential.
/// 3. With one patch, or at a reentrant crease, d is the least distance.
/// A patch other than the nearest enters with 1/d_j² − 1/Δh², which vanishes at the reach of one cell Δh.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/constants.hpp"
#include "kernels/contact/closest_point.hpp"

namespace mpmfast::penalty {

/// Closest point on a patch, and the facet that it is on.
template <int Dim>
struct PatchProjection {
  int body, patch, facet;
  ClosestPoint<Dim> closest;

  /// Of two facets with equal distance, as at a corner of both, the lower number precedes. The result does
  /// not depend on the order of the candidates.
  bool precedes(const PatchProjection& other) const {
    return closest.distance < other.closest.distance ||
           (closest.distance == other.closest.distance && facet < other.facet);
  }
};

enum class PointStatus {
  outside,       ///< of the body
  undetermined,  ///< on the surface, or where exit directions cancel: no force
  inside,
};

template <int Dim>
struct Penetration {
  PointStatus status = PointStatus::undetermined;
  double depth = 0;                          ///< d, m
  Vec<Dim> exit_direction;                   ///< unit, along −∂d/∂x
  std::array<double, kMaxPatches> share{};   ///< (d/d_j)³ by patch; 0: it does not count
  const PatchProjection<Dim>* nearest = {};  ///< the patch with the least d_j
};

/// Penetration of a point into the patches of one body.
/// @param patches  one or more, at most kMaxPatches
/// @param cell     Δh, m
template <int Dim>
Penetration<Dim> find_penetration(std::span<const PatchProjection<Dim>> patches, double cell) {
  Penetration<Dim> out;
  out.nearest = &*std::min_element(patches.begin(), patches.end(), [](const auto& a, const auto& b) {
    return a.closest.distance < b.closest.distance;
  });
  const ClosestPoint<Dim>& first = out.nearest->closest;
  if (!(first.distance > 0)) return out;
  // Beyond a convex crease a point is outside, beyond a reentrant one it is inside.
  if (first.at_crease ? first.convex : !first.inside) {
    out.status = PointStatus::outside;
    return out;
  }
  out.depth = first.distance;
  out.exit_direction = first.exit_direction;
  if (patches.size() == 1) {
    out.share[0] = 1;
    out.status = PointStatus::inside;
    return out;
  }
  const auto weight = [&](const PatchProjection<Dim>& patch) {  // its part of 1/d²
    const ClosestPoint<Dim>& c = patch.closest;
    const double d = c.distance;
    if (&patch == out.nearest) return 1 / (d * d);
    const bool counts = (c.at_crease ? c.convex : c.inside) && d > 0 && !first.at_crease;
    return counts ? std::max(0.0, 1 / (d * d) - 1 / (cell * cell)) : 0.0;
  };
  double sum = 0;
  for (const auto& patch : patches) sum += weight(patch);
  out.depth = 1 / std::sqrt(sum);
  out.exit_direction.setZero();
  for (std::size_t j = 0; j < patches.size(); ++j) {
    const double ratio = out.depth / patches[j].closest.distance;
    out.share[j] = weight(patches[j]) > 0 ? ratio * ratio * ratio : 0.0;
    out.exit_direction += out.share[j] * patches[j].closest.exit_direction;
  }
  const double length = out.exit_direction.norm();
  if (!(length > 0)) return out;
  out.exit_direction /= length;
  out.status = PointStatus::inside;
  return out;
}

}  // namespace mpmfast::penalty
