#pragma once

/// @file Springs whose tractions are curves (NN §5.4), over one step: the mean force of the step is that
/// which takes from the fields what the springs store (interface.hpp).
///
/// NN's scheme of two stages (Eq. 5.55 to 5.63) evaluates F at the start and at a guess of the mean jump,
/// keeps no energy, and gives up where √(|F′|/m) Δt > π/2. Here the energy below a curve of straight pieces
/// is a parabola in each of them, so that the jump of the step's end is the root of one quadratic, found
/// piece by piece on the way that the jump takes: the first it comes to. Where the curve falls faster than
/// the inertia of the surfaces follows, the jump leaps to the next place at which it is held; nothing becomes
/// unstable, and no energy is made.

#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/interface.hpp"
#include "kernels/contact/largest_root.hpp"
#include "kernels/contact/traction_curve.hpp"

namespace mpmfast {

/// The root of a u² + b u + c that is nearest to 0 on one side of it; 0 where there is none.
inline double nearest_root(double a, double b, double c, bool above) {
  const double q = -0.5 * (b + std::copysign(std::sqrt(std::max(0.0, b * b - 4 * a * c)), b));
  const double first = a != 0 ? q / a : 0, second = q != 0 ? c / q : 0;
  const auto fits = [&](double u) { return above ? u > 0 : u < 0; };
  if (fits(first) && fits(second)) return above ? std::min(first, second) : std::max(first, second);
  return fits(first) ? first : fits(second) ? second : 0;
}

/// The rate of a jump along one direction at the end of the step, m/s: with s = δ₁ − δ, a = 2m_e/(A Δt²) and
/// W = ∫T dδ the root of a s² − (a gΔt + f/A) s + W(δ + s) − W(δ) that is not s = 0.
/// @param area  of the surface, m²
inline double rate_after_curve(const TractionCurve& curve, double area, double mass, double dt,
                               const JumpStart& start, bool alone) {
  if (!(area > 0)) return start.rate + dt / mass * start.opening;
  const double share = alone ? oscillator_mass(curve.steepest() * area, mass, dt) : 1;
  const double a = 2 * share * mass / (dt * dt * area), drive = a * start.rate * dt + start.opening / area;
  const bool opens = drive > curve.at(start.jump);
  double from = start.jump, way = 0, stored = 0;
  for (int k = curve.piece_of(from, opens);; k += opens ? 1 : -1) {
    const double traction = curve.at(from), slope = curve.slope(k);
    const double length = (opens ? curve.upper(k) : curve.lower(k)) - from;
    const double square = a + 0.5 * slope, linear = 2 * a * way - drive + traction,
                 constant = (a * way - drive) * way + stored;
    const double root = nearest_root(square, linear, constant, opens);
    const bool inside =
        linear * linear >= 4 * square * constant && root != 0 && std::abs(root) <= std::abs(length);
    if (inside || !std::isfinite(length) || (square * length + linear) * length + constant >= 0) {
      way += opens ? std::min(root, length) : std::max(root, length);
      break;
    }
    stored += (traction + 0.5 * slope * length) * length;
    from += length;
    way += length;
  }
  return 2 * way / dt - start.rate;
}

/// The stiffness by area that over a step, as ½(δ + δ₁) times it, has the work of the curve: the mean of
/// T(s)/s over s². @param from, to  |δ| at the start and the end, m
inline double mean_secant(const TractionCurve& curve, double from, double to) {
  const double difference = (to - from) * (to + from);
  if (std::abs(difference) > constants::kSmallJumpChange * std::max(from, to) * std::max(from, to))
    return 2 * (curve.energy(to) - curve.energy(from)) / difference;
  const double middle = 0.5 * (from + to);
  return middle > 0 ? curve.at(middle) / middle : curve.slope(curve.piece_of(0, true));
}

/// A curve of tractions along the surface.
struct CurvedSlip {
  const TractionCurve& curve;
  double area;  ///< m²

  /// m_e, kg: of the steepest stiffness whatever the mean one, since a constant inertia keeps the energy.
  double inertia(double mass, double dt, bool alone) const {
    return (alone ? oscillator_mass(curve.steepest() * area, mass, dt) : 1) * mass;
  }
  /// The rate of the slip at the end of the step, m/s. Where several fit, it is the one that moves least.
  template <int Dim>
  Vec<Dim> rate_after(const PairStart<Dim>& joint, double dt, bool alone) const {
    const double per_time = inertia(joint.mass, dt, alone) / dt;
    const auto rate_with = [&](double secant) { return slip_rate_with(secant * area, per_time, joint, dt); };
    const Vec<Dim> slip = joint.across(joint.jump), rate = joint.across(joint.rate);
    const double from = slip.norm();
    const double secant = largest_root(curve.largest_secant(), [&](double mean) {
      return mean_secant(curve, from, (slip + 0.5 * dt * (rate + rate_with(mean))).norm()) - mean;
    });
    return rate_with(secant);
  }
  /// Its mean force between two slips, N.
  template <int Dim>
  Vec<Dim> mean_force(const Vec<Dim>& from, const Vec<Dim>& to) const {
    return 0.5 * area * mean_secant(curve, from.norm(), to.norm()) * (from + to);
  }
};

/// The rate of the jump at the end of the step, m/s.
template <int Dim>
Vec<Dim> rate_after_curves(const TractionCurve& normal, const TractionCurve& shear, double area,
                           const PairStart<Dim>& joint, double dt, bool alone) {
  return rate_after_curve(normal, area, joint.mass, dt, joint.along(), alone) * joint.normal +
         CurvedSlip{shear, area}.rate_after(joint, dt, alone);
}

}  // namespace mpmfast
