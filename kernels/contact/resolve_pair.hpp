#pragma once

/// @file The impulse of a contact law between two fields of a node.

#include "kernels/contact/friction_cone.hpp"
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
                             double reduced_mass = 0, double area_time = 0) {
  if constexpr (Law::scope == LawScope::nowhere || Law::scope == LawScope::interface) return Vec<Dim>::Zero();
  if constexpr (Law::scope == LawScope::everywhere) return stick;
  const SplitVector<Vec<Dim>> trial = split(stick, normal);
  if constexpr (Law::scope == LawScope::bonded) {
    const double shear = trial.tangential.norm();
    if (separation < law.longest_gap() && law.holds({-trial.normal, shear, reduced_mass, area_time}))
      return stick;
  }
  if (!(trial.normal < 0 && separation < 0)) return Vec<Dim>::Zero();
  const double needed = trial.tangential.norm();
  const double limit = law({-trial.normal, needed, reduced_mass, area_time});
  const Friction<Vec<Dim>> friction = into_cone(trial.tangential, needed, limit);
  return friction.sticks ? stick : Vec<Dim>(trial.normal * normal + friction.impulse);
}

}  // namespace mpmfast
