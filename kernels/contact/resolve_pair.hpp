#pragma once

/// @file What a contact law does to a pair of fields on a node.

#include "kernels/contact/laws.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// Momentum change Δp_a of field a against the rest of the node, which takes −Δp_a (theory §4).
///
/// In contact ⇔ Δp_a(0)·n < 0 and separation < 0. Then the normal part is kept whole, so that the surfaces do
/// not approach; the tangential part is kept (stick) or cut to what the law carries (slide).
/// @param stick  Δp_a(0) = (m_a/m) p − p_a, which gives both sides one velocity
/// @param normal unit, from a to b
template <int Dim, class Law>
inline Vec<Dim> resolve_pair(const Vec<Dim>& stick, const Vec<Dim>& normal, double separation, const Law& law,
                             double reduced = 0, double area_time = 0) {
  if constexpr (Law::scope == LawScope::nowhere || Law::scope == LawScope::interface) return Vec<Dim>::Zero();
  if constexpr (Law::scope == LawScope::everywhere) return stick;
  const double along = stick.dot(normal);
  if constexpr (Law::scope == LawScope::bonded) {
    const double shear = (stick - along * normal).norm();
    if (separation < law.longest_gap() && law.holds({-along, shear, reduced, area_time})) return stick;
  }
  if (!(along < 0 && separation < 0)) return Vec<Dim>::Zero();
  const Vec<Dim> tangential = stick - along * normal;
  const double needed = tangential.norm(), limit = law({-along, needed, reduced, area_time});
  if (!(needed > limit)) return stick;
  return along * normal + (limit / needed) * tangential;
}

}  // namespace mpmfast
