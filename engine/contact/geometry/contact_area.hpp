#pragma once

/// @file The contact area of a pair on a node, for laws that use it.

#include <algorithm>
#include <cmath>

#include "engine/contact/pairs/node_fields.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Contact area of a pair, m² (in 2-D for the thickness of the scene).
///
/// volume_gradient: g = Σ G_pi V_p = ∫ N_i n dS over the surface of a field, so g_a·n and −g_b·n are each the
/// node's share of a surface. Over a flat interface the shares add up to its area exactly, since Σ N_i = 1.
/// The smaller one leaves out what one surface has beyond the edge of the other. nodal_volume: sqrt(2 Ω_min
/// Ω_tot)/h (theory §4), exact for linear functions and an interface along the grid.
template <int Dim>
double contact_area(AreaKind kind, double cell, const NodeFields<Dim>& fields, const ContactPair& pair,
                    const Vec<Dim>& normal) {
  const bool by_volume = kind == AreaKind::nodal_volume;
  double own = 0, others = 0;
  for (int k = 0; k < fields.count(); ++k) {
    if (!pair.is_lumped() && k != pair.a && k != pair.b) continue;
    const double sign = k == pair.a ? 1 : -1;
    (k == pair.a ? own : others) +=
        by_volume ? fields.volume(k) : sign * fields.vector(Nodal::volume_gradient, k).dot(normal);
  }
  if (by_volume) return std::sqrt(2 * std::min(own, others) * (own + others)) / cell;
  return std::max(0.0, std::min(own, others));
}

}  // namespace mpmfast
