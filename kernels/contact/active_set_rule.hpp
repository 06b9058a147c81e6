#pragma once

/// @file The impulse of one pair of the active set in a correction (tools/manual/theory.md, "The energy of a
/// contact").

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/friction_cone.hpp"
#include "kernels/contact/laws.hpp"
#include "kernels/contact/node_solver.hpp"

namespace mpmfast {

template <int Dim>
struct ActiveSetRule {
  bool acts = false;        ///< the pair may have an impulse
  bool bilateral = false;   ///< its normal velocity is constrained in both directions
  bool must_stick = false;  ///< its tangential velocity is constrained too, without a friction limit
  bool friction = false;    ///< friction acts. (An impulse for the strain alone must be a projection.)
  bool may_bond = false;    ///< the gap is within the reach of a bond

  /// The impulse of the pair while the other pairs of its node stay.
  /// @param normal           unit, from a to b
  /// @param target_approach  approach velocity that closes the gap by the end of the step, m/s
  /// @param trial            Δp_a that sticking would need, N s
  /// @param reduced_mass     m_red, kg
  /// @param area_time        A_c Δt, m² s, for laws that use the area
  /// @param force_of         force_of(J_n): the part of a normal impulse that counts as a force, N s
  template <class Law, class Force>
  Response<Dim> response(const Vec<Dim>& normal, double target_approach, const Vec<Dim>& trial,
                         double reduced_mass, const Law& law, double area_time, const Force& force_of) const {
    constexpr double kLeast = std::numeric_limits<double>::min();  // a pair without load does not stick
    const auto [normal_impulse, tangential] = split(trial, normal);
    if constexpr (Law::scope == LawScope::bonded) {
      const double needed = tangential.norm();
      if (may_bond && law.holds({-normal_impulse, needed, reduced_mass, area_time}))
        return {trial, ContactStatus::stick};
    }
    const double end = normal_impulse + reduced_mass * target_approach;  // leaves the target approach
    if (!acts || (end > 0 && !bilateral)) return {Vec<Dim>::Zero(), ContactStatus::open};
    if (must_stick) return {end * normal + tangential, ContactStatus::stick};
    if (kDryFriction<Law> && !friction) return {end * normal, ContactStatus::slip};  // no root, no quotient
    const double needed = std::max(tangential.norm(), kLeast);
    const double force = Law::scope == LawScope::contact ? force_of(end) : end;
    const double limit =
        law({friction ? std::max(0.0, -force) : 0, needed, reduced_mass, friction ? area_time : 0});
    const Friction<Vec<Dim>> after = into_cone(tangential, needed, limit);
    return {end * normal + after.impulse, after.sticks ? ContactStatus::stick : ContactStatus::slip};
  }
};

}  // namespace mpmfast
