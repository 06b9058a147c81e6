#pragma once

/// @file An interface between two surfaces on a node: springs on the jump of their displacements (NN chapter
/// 5), over one step. δ is the jump along one direction at the step's start, g its rate, m the reduced mass
/// of the two fields there, f what all other forces pull it open with.
///
/// NN Eq. 5.42 takes the force from the exact motion of an oscillator, m δ″ = f − kδ. It brings δ where that
/// has it, but the velocities of the fields then are not those of the oscillator, and |λ|² = 2 sin φ/φ − cos
/// φ > 1: vibrations grow by φ²/12 a step, φ = Δt √(k/m). Here instead
///
///   m_e (g₁ − g)/Δt = f − F̄,  F̄ = (W(δ₁) − W(δ))/(δ₁ − δ),  δ₁ = δ + ½Δt (g + g₁):
///
/// what the springs store is what they take, to round-off, whatever their law, and no step is too long (the
/// mean force is that of an energy, Gonzalez 1996). With m_e = m (φ/2)²/tan²(φ/2) the frequency is the
/// oscillator's too (tan(½ω Δt) = ½Δt √(k/m_e)); at rest F̄ = f, so stiffness and strain of what stands still
/// are the law's at any φ. Beyond φ = π/2, four steps a period, m_e/m stays what it is there.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/friction_cone.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// m_e/m: for φ = Δt √(k/m).
inline double oscillator_mass(double stiffness, double mass, double dt) {
  const double half = 0.5 * std::min(constants::kMostPhase, dt * std::sqrt(stiffness / mass));
  if (half < constants::kLeastHalfPhase) return 1;
  const double share = half / std::tan(half);
  return share * share;
}

/// The jump of one direction at the start of a step.
struct JumpStart {
  double jump;     ///< δ, m
  double rate;     ///< g, m/s
  double opening;  ///< f, N
};

/// Its rate at the end of the step with a spring of one stiffness (N/m), m/s.
/// @param inertia  m_e/Δt, kg/s
inline double rate_with_spring(double stiffness, double inertia, double dt, const JumpStart& start) {
  const double give = 0.25 * stiffness * dt;
  return ((inertia - give) * start.rate + start.opening - stiffness * start.jump) / (inertia + give);
}

/// @param alone  no other spring acts on the two fields; else m_e = m, with which springs that are solved
///               together keep energy
inline double rate_after_spring(double stiffness, double mass, double dt, const JumpStart& start,
                                bool alone = true) {
  const double share = alone ? oscillator_mass(stiffness, mass, dt) : 1;
  return rate_with_spring(stiffness, share * mass / dt, dt, start);
}

/// The same with one stiffness where the surfaces are apart and another where they overlap (NN §5.5). Where
/// the jump changes its sign within the step, with s = δ₁ − δ and a = 2m_e/Δt²:
/// (a + ½k₁)s² + (k₁δ − a gΔt − f)s + ½(k₁ − k)δ² = 0, k of the side it leaves and k₁ of the one it comes to.
inline double rate_after_springs(double tension, double compression, double mass, double dt,
                                 const JumpStart& start, bool alone = true) {
  const auto end_of = [&](double rate) { return start.jump + 0.5 * dt * (start.rate + rate); };
  if (start.jump >= 0)
    if (const double rate = rate_after_spring(tension, mass, dt, start, alone); end_of(rate) >= 0)
      return rate;
  if (start.jump <= 0)
    if (const double rate = rate_after_spring(compression, mass, dt, start, alone); end_of(rate) <= 0)
      return rate;
  const bool opens = start.jump < 0;
  const double left = opens ? compression : tension, entered = opens ? tension : compression;
  // Of the stiffer side: the same whichever way it crosses.
  const double share = alone ? oscillator_mass(std::max(left, entered), mass, dt) : 1;
  const double inertia = 2 * share * mass / (dt * dt);
  const double a = inertia + 0.5 * entered,
               b = entered * start.jump - inertia * start.rate * dt - start.opening,
               c = 0.5 * (entered - left) * start.jump * start.jump;
  if (const double square = b * b - 4 * a * c; square >= 0) {
    const double twice =
        -(b + std::copysign(std::sqrt(square), b));  // the root that does not cancel, then the other
    const double first = 0.5 * twice / a, second = twice != 0 ? 2 * c / twice : 0;
    const double way = opens ? std::max(first, second) : std::min(first, second);
    if (opens ? start.jump + way >= 0 : start.jump + way <= 0) return 2 * way / dt - start.rate;
  }
  // With the inertia of the stiffer side it stays where it is.
  return rate_with_spring(left, share * mass / dt, dt, start);
}

/// x turned as the least rotation turns one unit vector into another; where these are more than a right angle
/// apart, x.
template <int Dim>
Vec<Dim> turned(const Vec<Dim>& from, const Vec<Dim>& to, const Vec<Dim>& x) {
  const double cosine = from.dot(to);
  if (!(cosine > 0)) return x;
  const Vec<Dim> both = from + to;
  return x - both.dot(x) / (1 + cosine) * both + 2 * from.dot(x) * to;
}

/// Two fields of a node at the start of a step, as what joins them sees them.
template <int Dim>
struct PairStart {
  double mass;                   ///< m_red, kg
  Vec<Dim> normal;               ///< unit
  Vec<Dim> jump, rate, opening;  ///< δ, m; its rate, m/s; what all other forces pull it open with, N

  JumpStart along() const { return {jump.dot(normal), rate.dot(normal), opening.dot(normal)}; }
  Vec<Dim> across(const Vec<Dim>& x) const { return x - x.dot(normal) * normal; }
  /// The jump of the end, if its rate is this then.
  Vec<Dim> jump_with(const Vec<Dim>& end, double dt) const { return jump + 0.5 * dt * (rate + end); }
};

/// The rate of the slip at the end of the step with a spring of one stiffness (N/m) along the surface, m/s.
/// @param inertia  m_e/Δt, kg/s
template <int Dim>
Vec<Dim> slip_rate_with(double stiffness, double inertia, const PairStart<Dim>& joint, double dt) {
  const Vec<Dim> slip = joint.across(joint.jump), rate = joint.across(joint.rate),
                 drawn = joint.across(joint.opening);
  Vec<Dim> end;
  for (int d = 0; d < Dim; ++d)
    end[d] = rate_with_spring(stiffness, inertia, dt, {slip[d], rate[d], drawn[d]});
  return end;
}

/// A straight spring along the surface, N/m.
struct SlipSpring {
  double stiffness;

  /// m_e, kg.
  double inertia(double mass, double dt, bool alone) const {
    return (alone ? oscillator_mass(stiffness, mass, dt) : 1) * mass;
  }
  template <int Dim>
  Vec<Dim> rate_after(const PairStart<Dim>& joint, double dt, bool alone) const {
    return slip_rate_with(stiffness, inertia(joint.mass, dt, alone) / dt, joint, dt);
  }
  /// Its mean force between two slips, N.
  template <int Dim>
  Vec<Dim> mean_force(const Vec<Dim>& from, const Vec<Dim>& to) const {
    return 0.5 * stiffness * (from + to);
  }
};

/// Straight springs of two fields, N/m.
struct Springs {
  double tension, compression, shear;
};

/// The rate of the jump at the end of the step, m/s.
template <int Dim>
Vec<Dim> rate_after(const Springs& springs, const PairStart<Dim>& joint, double dt, bool alone) {
  return rate_after_springs(springs.tension, springs.compression, joint.mass, dt, joint.along(), alone) *
             joint.normal +
         SlipSpring{springs.shear}.rate_after(joint, dt, alone);
}

/// A slip at the end of a step with friction.
template <int Dim>
struct FrictionResult {
  Vec<Dim> rate;     ///< of the slip at the end of the step, m/s
  Vec<Dim> impulse;  ///< of friction on the first field, N s
};

/// Friction of surfaces that springs press together (NN §5.7), in parallel with a spring along them. The
/// momentum that rest would take is limited by the law. The inertia is that of the spring without friction,
/// since an inertia that changed as surfaces press and part would add energy.
/// @param law             of Sliding (sliding.hpp)
/// @param normal_impulse  of the normal springs, N s, positive in compression
/// @param alone           no other pair of the node has springs
template <int Dim, class Law, class Spring>
FrictionResult<Dim> apply_friction(const Law& law, double normal_impulse, const Spring& spring,
                                   const PairStart<Dim>& joint, double dt, bool alone) {
  const Vec<Dim> slip = joint.across(joint.jump), rate = joint.across(joint.rate),
                 drawn = joint.across(joint.opening);
  const Vec<Dim> spring_force = spring.mean_force(slip, Vec<Dim>(slip + 0.5 * dt * rate));
  const Vec<Dim> stick = spring.inertia(joint.mass, dt, alone) * rate + dt * (drawn - spring_force);
  const double needed = stick.norm();
  const Friction<Vec<Dim>> friction = into_cone(stick, needed, law({normal_impulse, needed, joint.mass}));
  if (friction.sticks) return {Vec<Dim>::Zero(), stick};
  PairStart<Dim> sliding = joint;
  sliding.opening -= friction.impulse / dt;
  return {spring.rate_after(sliding, dt, alone), friction.impulse};
}

}  // namespace mpmfast
