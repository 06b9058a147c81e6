#pragma once

/// @file What a correction asks of one pair of the active set (tools/manual/theory.md, "The energy of a
/// contact").

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/laws.hpp"
#include "kernels/contact/node_solver.hpp"

namespace mpmfast {

template <int Dim>
struct SetRule {
  bool acts = false;        ///< the pair may have an impulse
  bool bilateral = false;   ///< its normal velocity is held in both directions
  bool holds_slip = false;  ///< its tangential velocity is held too, whatever friction allows
  bool friction = false;    ///< friction acts. (An impulse for the strain alone must be a projection.)
  bool may_bond = false;    ///< the gap is within the reach of a bond

  /// The impulse of the pair while other pairs stay.
  /// @param normal           unit, from a to b
  /// @param target_approach  approach velocity that closes the gap by the end of the step, m/s
  /// @param trial            Δp_a that sticking would need, N s
  /// @param reduced          kg
  /// @param area_time        A_c Δt, m² s, for laws that use the area
  /// @param force_of         force_of(J_n): the part of a normal impulse that counts as a force, N s
  template <class Law, class Force>
  Response<Dim> response(const Vec<Dim>& normal, double target_approach, const Vec<Dim>& trial,
                         double reduced, const Law& law, double area_time, const Force& force_of) const {
    constexpr double kLeast = std::numeric_limits<double>::min();  // a pair without load does not stick
    const double along = trial.dot(normal);
    const Vec<Dim> tangential = trial - along * normal;
    if constexpr (Law::scope == LawScope::bonded) {
      const double needed = tangential.norm();
      if (may_bond && law.holds({-along, needed, reduced, area_time})) return {trial, ContactStatus::stick};
    }
    const double end = along + reduced * target_approach;
    if (!acts || (end > 0 && !bilateral)) return {Vec<Dim>::Zero(), ContactStatus::open};
    if (holds_slip) return {end * normal + tangential, ContactStatus::stick};
    if (kDryFriction<Law> && !friction) return {end * normal, ContactStatus::slip};  // no root, no quotient
    const double needed = tangential.norm();
    const double force = Law::scope == LawScope::contact ? force_of(end) : end;
    const double limit = law(
        {friction ? std::max(0.0, -force) : 0, std::max(needed, kLeast), reduced, friction ? area_time : 0});
    if (needed <= limit && limit > 0) return {end * normal + tangential, ContactStatus::stick};
    return {end * normal + (needed > 0 ? limit / needed : 0) * tangential, ContactStatus::slip};
  }
};

}  // namespace mpmfast
