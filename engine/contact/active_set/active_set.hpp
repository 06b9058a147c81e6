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
#include "kernels/contact/active_set_rule.hpp"

namespace mpmfast {

/// The trial state of a pair, without contact.
template <int Dim>
struct Trial {
  Vec<Dim> impulse;     ///< Δp_a(0) = m_red (v_b − v_a): with it, both fields have one velocity, N s
  double reduced_mass;  ///< m_red = 1/(1/m_a + 1/m_b), kg
};

/// How a correction treats one pair.
template <int Dim>
struct PairRule {
  ActiveSetRule<Dim> set;      ///< with CorrectionMethod::one_set
  bool holds_overlap = false;  ///< without: an overlapping pair that parts is constrained along the normal
};

/// Which pairs a correction acts on, and how it treats them.
struct CorrectionRule {
  bool on_closing = false;     ///< acts on gaps that close by the end of the step
  bool on_persistent = false;  ///< acts on persistent pairs
  bool on_active = false;      ///< acts on pairs that the first correction acted on
  bool on_touching = false;    ///< acts on pairs that the second correction left in contact
  bool bilateral = false;      ///< constrains the normal velocities of persistent pairs in both directions
  bool holds_stuck_before =
      false;                 ///< constrains persistent pairs that stuck in the last step along the surface
  bool holds_stuck = false;  ///< constrains pairs that stuck in the second correction along the surface
  bool friction = false;     ///< friction acts
  bool overlap_is_contact = false;  ///< pairs that overlap are in contact, also if they part
  bool touched_is_contact = false;  ///< so are pairs that were in contact before the step
};

/// The first correction acts on gaps that close by the end of the step and on persistent pairs. The normal
/// velocities of persistent pairs are constrained in both directions. A pair that stuck is also constrained
/// along the surface. Otherwise friction would do work on the relative velocities in the strains, and add
/// energy.
inline CorrectionRule first_rule(const CorrectionMethod& method) {
  CorrectionRule rule;
  rule.on_closing = true;
  rule.on_persistent = true;
  rule.bilateral = true;
  rule.holds_stuck_before = method.holds_sticking;
  rule.friction = method.first_stays;
  rule.overlap_is_contact = method.overlap_is_contact;
  rule.touched_is_contact = method.persistent;
  return rule;
}

/// The second correction also acts on pairs that forces bring together. It only presses: a pulling impulse
/// ends the contact.
inline CorrectionRule second_rule(const CorrectionMethod& method) {
  CorrectionRule rule;
  rule.on_closing = true;
  rule.on_persistent = true;
  rule.on_active = true;
  rule.friction = true;
  rule.overlap_is_contact = method.overlap_is_contact;
  return rule;
}

/// The correction of re-extrapolated momenta acts on pairs that the second correction left in contact.
inline CorrectionRule re_extrapolated_rule(const CorrectionMethod& method) {
  CorrectionRule rule;
  rule.on_touching = true;
  rule.bilateral = true;
  rule.holds_stuck = method.holds_sticking;
  rule.friction = method.first_stays;
  rule.overlap_is_contact = method.overlap_is_contact;
  return rule;
}

/// The rule of a correction for one pair. @param gap  predicted, m
template <int Dim>
[[gnu::always_inline]] inline PairRule<Dim> pair_rule(const CorrectionRule& rule, const PairStatus& status,
                                                      const PairHistory& before, double gap) {
  PairRule<Dim> own;
  own.set.acts = (rule.on_closing && gap < 0) || (rule.on_persistent && status.persistent) ||
                 (rule.on_active && status.active_in_first) || (rule.on_touching && status.touching);
  own.set.bilateral = rule.bilateral && status.persistent;
  own.set.must_stick =
      (rule.holds_stuck_before && status.persistent && before.stuck) || (rule.holds_stuck && status.stuck);
  own.set.friction = rule.friction;
  own.holds_overlap = rule.overlap_is_contact || (rule.touched_is_contact && before.touched);
  return own;
}

/// The gap at the end of the step if no contact impulse acted, m (NN Eq. 3.56). Corrections decide by it.
/// (The present gap cannot decide: positions follow corrected velocities, so surfaces hardly ever overlap.)
/// For a pair that was in contact, the hysteresis of the scene is subtracted.
template <int Dim>
double predicted_gap(const CorrectionMethod& method, const PairGeometry<Dim>& geometry,
                     const PairHistory& before, const Trial<Dim>& trial, double dt) {
  double gap = geometry.separation;
  if (before.touched) gap -= method.hysteresis;
  if (method.predicts_gap) gap += trial.impulse.dot(geometry.normal) * dt / trial.reduced_mass;
  return gap;
}

/// Decides whether a pair persists. If not, sets the approach velocity that closes its gap by the end of the
/// step.
///
/// A persistent pair stays in contact until a force pulls it apart, and its gap δ is not closed. The gap of a
/// surface drifts from the particles' domains while its velocities are constrained; closing it against a
/// normal force F would take the energy F δ in every step. A pair whose gap exceeds its elastic recovery
/// length does not persist: the bodies do not touch there (beside a round contact, at the ends of a sliding
/// block).
inline void decide_persistence(const PairHistory& before, double separation, double cell, double dt,
                               PairStatus& status) {
  using constants::contact::kLeastRecovery, constants::contact::kMostRecovery;
  status.persistent = before.touched && separation < std::clamp(before.recovery_length, kLeastRecovery * cell,
                                                                kMostRecovery * cell);
  status.target_approach = status.persistent ? 0 : std::max(0.0, separation) / dt;
}

/// Decides it for all pairs of a node. Without one active set no pair persists.
template <int Dim>
void decide_persistence(const CorrectionMethod& method, const ContactNode<Dim>& node, double cell, double dt,
                        PairColumns<Dim>& pairs) {
  for (int e = node.pair_begin; e < node.pair_end; ++e)
    decide_persistence(method.one_set ? pairs.before[e] : PairHistory{}, pairs.geometry[e].separation, cell,
                       dt, pairs.status[e]);
}

/// Is the pair in contact after the second correction? True if that correction presses, or if the first one
/// acted and the surfaces still approach as fast as the gap needs. Velocities below kVelocityRoundOff cells a
/// step are round-off.
/// @param mass  scale of round-off: that of field a, or m_red of a point, kg
/// @param relative  v_b − v_a after the correction, m/s
template <int Dim>
bool still_touches(const PairImpulses<Dim>& impulse, const Vec<Dim>& normal, const PairStatus& status,
                   double mass, const Vec<Dim>& relative, double cell, double dt) {
  const double least = constants::contact::kVelocityRoundOff * cell / dt;
  if (impulse.now.dot(normal) < -least * mass) return true;
  if (!(std::abs(impulse.first.dot(normal)) > least * mass)) return false;
  return status.target_approach + relative.dot(normal) <= least;
}

/// The elastic recovery length of a pair, m: how far its surfaces would approach each other without the
/// contact force F. It is F T²/(2 m_red) with the time T in which the fastest wave crosses a cell. Between
/// bodies that F strains by ε it is 2 h ε, with a layer of h and the mass ½ ρ h³ on each side. The result is
/// a moving mean in which the new value has the weight kRecoveryShare; a new contact begins with its own
/// value.
/// @param crossing      T, s
/// @param inverse_mass  1/m_red, 1/kg
template <int Dim>
double updated_recovery_length(const PairImpulses<Dim>& impulse, const Vec<Dim>& normal,
                               const PairHistory& before, double inverse_mass, double crossing, double dt) {
  using constants::contact::kRecoveryShare;
  const double normal_impulse = std::max(0.0, -impulse.second.dot(normal));
  const double now = 0.5 * normal_impulse * crossing * crossing * inverse_mass / dt;
  return before.touched ? before.recovery_length + kRecoveryShare * (now - before.recovery_length) : now;
}

/// The part of a normal impulse of the second correction that counts as a force, N s (theory, "The energy of
/// a contact"). The rest only closes the gap.
///
/// Opening rates (v_b − v_a)·n, m/s: r_0 at the start, r_1 after the first correction, a the change by
/// forces, r_3 = −δ/Δt at the end. Contact adds no energy if particles keep the rate r_2 ≤ 0 with r_2² = r_0²
/// + a (r_1 + r_3). The force part is m_red (r_0 + a − r_2). All of the impulse counts where there is no gap
/// to close. It also does on nodes of more than two fields, where the other impulses depend on it.
/// @param normal_impulse  N s
template <int Dim>
double force_part(const CorrectionMethod& method, const ContactPair& pair, const PairStatus& status,
                  const RelativeVelocities<Dim>& relative, const Vec<Dim>& normal, const Trial<Dim>& trial,
                  double normal_impulse) {
  const double target = status.target_approach;
  if (!method.one_set || method.first_stays || !pair.sole || !(normal_impulse < 0) || !(target > 0))
    return normal_impulse;
  const double r_0 = relative.start.dot(normal), r_1 = relative.after_first.dot(normal);
  const double a = trial.impulse.dot(normal) / trial.reduced_mass - r_1;
  const double r_2 = -std::sqrt(std::max(0.0, r_0 * r_0 + a * (r_1 - target)));
  return trial.reduced_mass * (r_0 + a - r_2);
}

}  // namespace mpmfast
