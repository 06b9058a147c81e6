#pragma once

/// @file What a correction asks of a pair and what it leaves: the members of Contact that resolve.cpp calls
/// for each entry, where the compiler sees them. Other files call those that resolve.cpp instantiates.

#include <algorithm>
#include <cmath>

#include "engine/contact/contact.hpp"

namespace mpmfast {

/// The fields of a node as they move before a correction.
template <int Dim>
void Contact<Dim>::read_motion(const State<Dim>& state, const ContactNode<Dim>& node,
                               NodeMotion<Dim>& motion) const {
  const double* mass = state.nodes.column(Nodal::mass);
  motion.clear();
  for (int k = node.field_begin; k < node.field_end; ++k) {
    const int slot = list_.fields[static_cast<std::size_t>(k)].slot;
    motion.push(slot, mass[slot], state.nodes.vector(Nodal::momentum, slot));
  }
}

/// v_a − v_b, b the others of a lump or the rigid body, m/s.
template <int Dim>
Vec<Dim> Contact<Dim>::slip_of(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                               const NodeMotion<Dim>& motion) const {
  const Vec<Dim> slip = motion.slip_of(entry.a, entry.b >= 0 ? entry.b : node.rigid);
  return node.constrained ? free_part(node, slip) : slip;
}

/// Field a against the others of `all`; a rigid body has m_b → ∞ and keeps its velocity.
template <int Dim>
typename Contact<Dim>::Meeting Contact<Dim>::meet(const ContactNode<Dim>& node, const NodeMotion<Dim>& motion,
                                                  int a, const typename NodeMotion<Dim>::Total& all) const {
  const auto& own = motion[a];
  Meeting meeting{(own.mass / all.mass) * all.momentum - own.momentum,
                  own.mass * (all.mass - own.mass) / all.mass};
  if (node.rigid >= 0) {
    const auto& rigid = motion[node.rigid];
    meeting = {(own.mass / rigid.mass) * rigid.momentum - own.momentum, own.mass};
  }
  if (node.constrained) meeting.stick = free_part(node, meeting.stick);
  return meeting;
}

/// The separation that decides on contact. Both corrections judge by where the free velocities take the
/// surfaces: positions that follow the end velocity close a gap up to a touch and no further, so that the
/// first correction, asked for an overlap now, would hardly ever act.
template <int Dim>
double Contact<Dim>::separation_of(const ContactEntry<Dim>& entry, const Meeting& meeting, double dt) const {
  double separation = entry.separation;
  if (entry.touched) separation -= spec_.hysteresis * cell_;
  if (spec_.advance_separation)
    separation += meeting.stick.dot(entry.normal) * dt / meeting.reduced;  // NN Eq. 3.56
  return separation;
}

/// Is the pair held whichever way it goes?
template <int Dim>
bool Contact<Dim>::both_ways(const ContactEntry<Dim>& entry, Correction correction) const {
  return correction != Correction::final && entry.lasts;
}

/// Is the slip of the pair held where friction is no force: has it stuck at the last step's second
/// correction, or this one's? (With FLIP alone: XPIC's filter takes what particles slip of itself, and more
/// of them that are held.)
template <int Dim>
bool Contact<Dim>::holds_slip(const ContactEntry<Dim>& entry, Correction correction) const {
  if (!holds_sticking_) return false;
  return correction == Correction::initial  ? entry.lasts && entry.stuck_before
         : correction == Correction::strain ? entry.stuck
                                            : false;
}

/// Does the second correction leave the pair of the set in contact: has it pressed, or did the first and no
/// force pulls? Speeds of 1e-10 cells a step are round-off, which must not decide.
/// @param mass  of its field a, kg
/// @param slip  that it leaves
template <int Dim>
bool Contact<Dim>::touches_on(const ContactEntry<Dim>& entry, double mass, const Vec<Dim>& slip) const {
  const double least = 1e-10 * cell_ / dt_;
  if (entry.impulse.dot(entry.normal) < -least * mass) return true;
  if (!(std::abs(entry.first.dot(entry.normal)) > least * mass)) return false;
  return entry.closing - slip.dot(entry.normal) <= least;
}

/// What of the second correction's impulse along n is a force, N s: all of it, but where a gap closes within
/// the step nothing of the time before. The approach v' that particles then keep is such that contact makes
/// no energy, v'² = v² + a (v^c + v'^c): a is what forces change, v^c what the first correction left, v'^c =
/// −δ/Δt what the last will leave. Where more fields meet, the others' impulses depend on it: there all of it
/// is.
/// @param normal  the impulse
template <int Dim>
double Contact<Dim>::force_of(const ContactEntry<Dim>& entry, const Meeting& meeting, double normal) const {
  const double closing = entry.closing;
  if (!one_set_ || first_correction_stays_ || !entry.alone || !(normal < 0) || !(closing > 0)) return normal;
  const double before = -entry.slip_start.dot(entry.normal), held = -entry.slip_held.dot(entry.normal);
  const double forces = meeting.stick.dot(entry.normal) / meeting.reduced - held;
  const double after = -std::sqrt(std::max(0.0, before * before + forces * (held - closing)));
  return meeting.reduced * (before + forces - after);
}

/// How far the surfaces of a pair would come together if the force F between them were gone: F T²/(2 m_red),
/// T the time in which the fastest of all waves and motions crosses a cell. That is 2 h ε between bodies that
/// are strained by ε, a layer of h on each side. A mean over some ten steps.
template <int Dim>
double Contact<Dim>::spring_of(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                               const NodeMotion<Dim>& motion) const {
  constexpr double kNew = 0.1;
  const bool on_rigid = node.rigid >= 0 && (entry.b < 0 || entry.b == node.rigid);
  const double inverse_mass =
      motion[entry.a].inverse_mass + (on_rigid ? 0 : motion.inverse_mass_of(entry.a, entry.b));
  const double pressed = std::max(0.0, -entry.second.dot(entry.normal));
  const double now = 0.5 * pressed * crossing_ * crossing_ * inverse_mass / dt_;
  return entry.touched ? entry.spring_before + kNew * (now - entry.spring_before) : now;
}

/// What the slips are before the first correction.
template <int Dim>
void Contact<Dim>::see_slips(const ContactNode<Dim>& node, const NodeMotion<Dim>& motion) {
  if (!one_set_ && !first_correction_stays_) return;
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    entry.slip_start = entry.slip_held = slip_of(node, entry, motion);
  }
}

/// What a correction leaves to know.
template <int Dim>
void Contact<Dim>::settle(Correction correction, const ContactNode<Dim>& node,
                          const NodeMotion<Dim>& motion) {
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const bool acts = !entry.impulse.isZero(0);
    if (correction == Correction::initial) {
      entry.first = entry.impulse;
      entry.held = acts;
      if (one_set_ || first_correction_stays_) entry.slip_held = slip_of(node, entry, motion);
    } else if (correction == Correction::final) {
      entry.second = entry.impulse + entry.passed;
      entry.touching = acts;
      if (one_set_) {
        entry.slip_pulled = slip_of(node, entry, motion);
        entry.touching = touches_on(entry, motion[entry.a].mass, entry.slip_pulled);
        entry.spring = spring_of(node, entry, motion);
      }
    }
    if (correction == (one_set_ && !first_correction_stays_ ? Correction::strain : Correction::final))
      entry.slip_end = slip_of(node, entry, motion);
  }
}

/// Gives the impulses of a correction to the fields of its node; those of the second change forces too.
template <int Dim>
void Contact<Dim>::apply(State<Dim>& state, Correction correction, double dt, const ContactNode<Dim>& node,
                         NodeMotion<Dim>& motion) const {
  const bool forces = correction == Correction::final, passes = forces && (first_share_ > 0 || one_set_);
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    const auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const bool moves_other = entry.b >= 0 && entry.b != node.rigid;
    motion[entry.a].impulse += entry.impulse;
    if (moves_other) motion[entry.b].impulse -= entry.impulse;
    if (!passes) continue;
    motion[entry.a].passed += entry.passed;
    if (moves_other) motion[entry.b].passed -= entry.passed;
  }
  auto& nodes = state.nodes;
  for (auto& field : motion) {
    if (!field.impulse.isZero(0)) {
      field.momentum += field.impulse;
      nodes.set(Nodal::momentum, field.slot, field.momentum);
    }
    if (forces) {
      const Vec<Dim> force = (field.impulse + field.passed) / dt;
      if (!force.isZero(0))
        nodes.set(Nodal::force, field.slot, nodes.vector(Nodal::force, field.slot) + force);
    } else if (keep_velocity_change_ && correction == Correction::initial) {
      for (int d = 0; d < Dim; ++d)
        nodes.column(Nodal::star, Dim + d)[field.slot] += field.impulse[d] * field.inverse_mass;
    }
  }
}

}  // namespace mpmfast
