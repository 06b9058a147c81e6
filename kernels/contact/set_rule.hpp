#pragma once

/// @file What a correction asks of a pair of the step's one set (tools/manual/theory.md, "The energy of a
/// contact"), whatever its momenta are.

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/laws.hpp"
#include "kernels/contact/together.hpp"

namespace mpmfast {

template <int Dim>
struct SetRule {
  bool acts = false;        ///< it may have an impulse
  bool both_ways = false;   ///< it is held whichever way it goes
  bool holds_slip = false;  ///< it is held along the surface too, by no friction
  bool friction = false;    ///< friction acts. (What is held for the strain alone must be a projection.)
  bool may_bond = false;    ///< it is near enough for a bond

  /// @param normal     unit, from a to b
  /// @param closing    the approach that closes a gap within the step, and is left, m/s
  /// @param stick      Δp_a that sticking would need, N s
  /// @param reduced    kg
  /// @param area_time  A_c Δt, m² s, for laws that use the area
  /// @param force_of   force_of(J_n): what of that impulse presses, N s
  template <class Law, class Force>
  Demand<Dim> demand(const Vec<Dim>& normal, double closing, const Vec<Dim>& stick, double reduced,
                     const Law& law, double area_time, const Force& force_of) const {
    constexpr double kLeast = std::numeric_limits<double>::min();  // what carries nothing does not stick
    const double along = stick.dot(normal);
    const Vec<Dim> tangential = stick - along * normal;
    if constexpr (Law::scope == LawScope::bonded) {
      const double needed = tangential.norm();
      if (may_bond && law.holds({-along, needed, reduced, area_time})) return {stick, Hinders::slip};
    }
    const double end = along + reduced * closing;
    if (!acts || (end > 0 && !both_ways)) return {Vec<Dim>::Zero(), Hinders::nothing};
    if (holds_slip) return {end * normal + tangential, Hinders::slip};
    if (kDryFriction<Law> && !friction) return {end * normal, Hinders::approach};  // no roots and quotients
    const double needed = tangential.norm();
    const double presses = Law::scope == LawScope::contact ? force_of(end) : end;
    const double limit = law({friction ? std::max(0.0, -presses) : 0, std::max(needed, kLeast), reduced,
                              friction ? area_time : 0});
    if (needed <= limit && limit > 0) return {end * normal + tangential, Hinders::slip};
    return {end * normal + (needed > 0 ? limit / needed : 0) * tangential, Hinders::approach};
  }
};

}  // namespace mpmfast
