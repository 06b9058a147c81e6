#pragma once

/// @file The active set: which contact pairs act in a correction, and how (theory, "The energy of a
/// contact").

#include <algorithm>
#include <cmath>

#include "engine/constants.hpp"
#include "engine/contact/active_set/correction_method.hpp"
#include "engine/contact/impulses/node_motion.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/node_fields.hpp"
#include "kernels/contact/set_rule.hpp"

namespace mpmfast {

/// What sticking would need of a pair.
template <int Dim>
struct Trial {
  Vec<Dim> impulse;  ///< Δp_a(0), N s
  double reduced;    ///< m_red, kg
};

/// What a correction asks of a pair.
template <int Dim>
struct PairRule {
  SetRule<Dim> set;            ///< where the active set of the step is one
  bool holds_parting = false;  ///< else: an overlapping pair that parts is held along the normal
};

/// A correction's rule, from what is known of a pair. @param gap  predicted, m
template <int Dim>
using RuleOf = PairRule<Dim> (*)(const CorrectionMethod& method, const PairStatus& status,
                                 const PairHistory& before, double gap);

/// The first correction acts on gaps that close by the end of the step and on persistent pairs, whose normal
/// velocities are held in both directions. A pair that stuck is held along the surface too: otherwise the
/// friction of a pair at rest works on the slips that the strains see, and makes energy.
template <int Dim>
PairRule<Dim> first_rule(const CorrectionMethod& method, const PairStatus& status, const PairHistory& before,
                         double gap) {
  PairRule<Dim> rule;
  rule.set.acts = gap < 0 || status.persistent;
  rule.set.bilateral = status.persistent;
  rule.set.holds_slip = method.holds_sticking && status.persistent && before.stuck;
  rule.set.friction = method.first_stays;
  rule.holds_parting = method.overlap_is_contact || (method.persistent && before.touched);
  return rule;
}

/// The second correction adds the pairs that forces close. Forces are held where they press, and end the
/// contact where they pull.
template <int Dim>
PairRule<Dim> second_rule(const CorrectionMethod& method, const PairStatus& status, const PairHistory&,
                          double gap) {
  PairRule<Dim> rule;
  rule.set.acts = gap < 0 || status.persistent || status.active_in_first;
  rule.set.friction = true;
  rule.holds_parting = method.overlap_is_contact;
  return rule;
}

/// Re-extrapolated momenta are held where the second correction left pairs in contact.
template <int Dim>
PairRule<Dim> re_extrapolated_rule(const CorrectionMethod& method, const PairStatus& status,
                                   const PairHistory&, double) {
  PairRule<Dim> rule;
  rule.set.acts = status.touching;
  rule.set.bilateral = status.persistent;
  rule.set.holds_slip = method.holds_sticking && status.stuck;
  rule.set.friction = method.first_stays;
  rule.holds_parting = method.overlap_is_contact;
  return rule;
}

/// The separation by which a correction decides, m: where the free velocities take the surfaces by the end of
/// the step (NN Eq. 3.56). Positions that follow the end velocity close a gap up to a touch and no further,
/// so a correction that asked for an overlap now would hardly ever act.
template <int Dim>
double predicted_gap(const CorrectionMethod& method, const PairGeometry<Dim>& geometry,
                     const PairHistory& before, const Trial<Dim>& trial, double dt) {
  double gap = geometry.separation;
  if (before.touched) gap -= method.hysteresis;
  if (method.predicts_gap) gap += trial.impulse.dot(geometry.normal) * dt / trial.reduced;
  return gap;
}

/// Which pairs of a node persist, and the approach velocities that close the gaps of the others.
///
/// A pair stays in contact until a force pulls it apart. A surface that is held by its velocities drifts from
/// where the particles' domains say that it is; closing such a gap δ against a normal impulse N would lose N
/// δ time and again. A gap that elastic recovery would not close is none of this kind: there the pair carries
/// a load where the bodies do not touch (beside a round contact, at the ends of a sliding block).
template <int Dim>
void find_persistent(const CorrectionMethod& method, const ContactNode<Dim>& node, double cell, double dt,
                     PairColumns<Dim>& pairs) {
  using constants::contact::kLeastRecovery, constants::contact::kMostRecovery;
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    PairStatus& status = pairs.status[e];
    const PairHistory& before = pairs.before[e];
    const double separation = pairs.geometry[e].separation;
    status.persistent =
        method.one_set && before.touched &&
        separation < std::clamp(before.recovery_length, kLeastRecovery * cell, kMostRecovery * cell);
    status.target_approach = status.persistent ? 0 : std::max(0.0, separation) / dt;
  }
}

/// Does the second correction leave the pair in contact? It does if the pair presses, or if the first
/// correction acted and no force pulls. Velocities of kVelocityRoundOff cells a step are round-off, which
/// must not decide.
/// @param mass  of field a, kg
/// @param slip  v_a − v_b after the correction, m/s
template <int Dim>
bool still_touches(const PairImpulses<Dim>& impulse, const Vec<Dim>& normal, const PairStatus& status,
                   double mass, const Vec<Dim>& slip, double cell, double dt) {
  const double least = constants::contact::kVelocityRoundOff * cell / dt;
  if (impulse.now.dot(normal) < -least * mass) return true;
  if (!(std::abs(impulse.first.dot(normal)) > least * mass)) return false;
  return status.target_approach - slip.dot(normal) <= least;
}

/// How far the surfaces would approach each other if the contact force F were gone, m: F T²/(2 m_red), T the
/// time in which the fastest wave crosses a cell. That is 2 h ε between bodies strained by ε, a layer of h on
/// each side. A mean over some 1/kRecoveryShare steps.
/// @param crossing      T, s
/// @param inverse_mass  1/m_red, 1/kg
template <int Dim>
double recovery_length(const PairImpulses<Dim>& impulse, const Vec<Dim>& normal, const PairHistory& before,
                       double inverse_mass, double crossing, double dt) {
  using constants::contact::kRecoveryShare;
  const double normal_impulse = std::max(0.0, -impulse.second.dot(normal));
  const double now = 0.5 * normal_impulse * crossing * crossing * inverse_mass / dt;
  return before.touched ? before.recovery_length + kRecoveryShare * (now - before.recovery_length) : now;
}

/// The part of a normal impulse of the second correction that counts as a force, N s: all of it, except where
/// a gap closes within the step. The approach v' that particles keep then is such that contact makes no
/// energy, v'² = v² + a (v^c + v'^c): a is the change by forces, v^c the approach after the first correction,
/// v'^c = −δ/Δt the approach after the last. On nodes of more fields the other impulses depend on it, and all
/// counts.
/// @param normal_impulse  N s
template <int Dim>
double force_part(const CorrectionMethod& method, const ContactPair& pair, const PairStatus& status,
                  const PairSlips<Dim>& slip, const Vec<Dim>& normal, const Trial<Dim>& trial,
                  double normal_impulse) {
  const double target = status.target_approach;
  if (!method.one_set || method.first_stays || !pair.sole || !(normal_impulse < 0) || !(target > 0))
    return normal_impulse;
  const double before = -slip.start.dot(normal), held = -slip.after_first.dot(normal);
  const double forces = trial.impulse.dot(normal) / trial.reduced - held;
  const double after = -std::sqrt(std::max(0.0, before * before + forces * (held - target)));
  return trial.reduced * (before + forces - after);
}

}  // namespace mpmfast
