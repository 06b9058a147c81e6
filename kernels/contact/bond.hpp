#pragma once

/// @file A cohesive bond between two surfaces on a node over one step: its damage, and a force that takes
/// from the fields exactly what the bond stores and dissipates (cohesive.hpp, interface.hpp).
///
/// With a mean integrity ω̄ of the step the force is F̄ = ω̄ K ½(δ + δ₁) (for overlap, the whole stiffness of
/// overlap). Its work is ω̄ (E₁ − E), E = ½ K (p² + s²). For any ω̄ between ω₁ and ω this is the growth of the
/// stored energy ωE and a loss that is not negative,
///
///   ω̄ (E₁ − E) = (ω₁E₁ − ωE) + (ω̄ − ω₁) E₁ + (ω − ω̄) E.
///
/// ω̄ is the mean of ω over λ². Along one direction of the jump, where E grows with λ², the work is then the
/// area below the traction for any step, and the losses add up to the toughness. ω̄ gives the jump δ₁ at the
/// end of the step, and δ₁ gives ω̄: one equation ω̄ = M(ω̄) in (0, ω]. M ≤ ω, so a root exists. Where softening
/// is faster than the inertia of the surfaces there are three; the search from above finds the one of least
/// damage.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/cohesive.hpp"
#include "kernels/contact/friction_cone.hpp"
#include "kernels/contact/interface.hpp"
#include "kernels/contact/largest_root.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// The parts of a displacement jump that load a bond.
struct Parted {
  double opening;       ///< m; 0 where surfaces overlap
  double slip_squared;  ///< m²
  double squared() const { return opening * opening + slip_squared; }
};

template <int Dim>
Parted parted(const Vec<Dim>& jump, const Vec<Dim>& normal) {
  const auto [opening, slip] = split(jump, normal);
  return {std::max(0.0, opening), slip.squaredNorm()};
}

/// ω̄ of a step, and ω at its end.
struct Integrity {
  double mean, end;
};

/// From one jump to another. @param before  ω at the start, above 0
inline Integrity integrity_over(const Cohesive& law, double before, const Parted& from, const Parted& to) {
  const double q0 = law.measure(from.opening, from.slip_squared),
               q1 = law.measure(to.opening, to.slip_squared);
  const double length = law.length(q1 > 0 ? law.measure(to.opening, 0) / q1 : 1);
  const double last = std::sqrt(q1), end = std::min(before, law.integrity(last, length));
  if (end >= before) return {before, before};
  if (q1 <= q0) return {end, end};  // another direction, of less toughness
  const double first = std::sqrt(q0);
  if (q1 - q0 < constants::kSmallJumpChange * q1)
    return {0.5 * (std::min(before, law.integrity(first, length)) + end), end};
  const double turn = law.lambda_of(before, length);  // from here on it softens
  const double elastic = before * std::max(0.0, turn * turn - q0);
  const double softening = law.work(last, length) - law.work(std::max(first, turn), length);
  return {std::clamp((elastic + softening) / (q1 - q0), end, before), end};
}

/// The energy that the bond dissipates from one jump to another, J. @param stiffness  of the bond unharmed,
/// N/m
inline double lost_over(double stiffness, double before, const Integrity& integrity, const Parted& from,
                        const Parted& to) {
  return 0.5 * stiffness *
         ((integrity.mean - integrity.end) * to.squared() + (before - integrity.mean) * from.squared());
}

/// A bond on a node at the start of a step.
template <int Dim>
struct BondStart {
  const Cohesive& law;
  double integrity;               ///< above 0
  double stiffness, compression;  ///< of the bond unharmed and of overlap, N/m
  PairStart<Dim> joint;
};

/// The rate of the jump at the end of the step with a mean integrity, m/s.
template <int Dim>
Vec<Dim> rate_with(const BondStart<Dim>& bond, double mean, double dt) {
  const double spring = mean * bond.stiffness;
  return rate_after({spring, bond.compression, spring}, bond.joint, dt, false);
}

/// The largest root of ω̄ = M(ω̄).
template <int Dim>
double mean_integrity(const BondStart<Dim>& bond, double dt) {
  const PairStart<Dim>& joint = bond.joint;
  const Parted from = parted<Dim>(joint.jump, joint.normal);
  return largest_root(bond.integrity, [&](double mean) {
    const Parted to = parted<Dim>(joint.jump_with(rate_with(bond, mean, dt), dt), joint.normal);
    return integrity_over(bond.law, bond.integrity, from, to).mean - mean;
  });
}

/// The rate of the jump at the end of a step, m/s.
template <int Dim>
Vec<Dim> rate_after_bond(const BondStart<Dim>& bond, double dt) {
  return rate_with(bond, mean_integrity(bond, dt), dt);
}

}  // namespace mpmfast
