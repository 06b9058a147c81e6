#pragma once

/// @file One contact correction, as all nodes see it, and the response of one pair.

#include "engine/contact/active_set/active_set.hpp"
#include "engine/contact/geometry/contact_area.hpp"
#include "engine/contact/geometry/free_directions.hpp"
#include "engine/contact/impulses/node_motion.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "kernels/contact/resolve_pair.hpp"

namespace mpmfast {

template <int Dim>
struct CorrectionPass {
  State<Dim>& state;
  ContactList<Dim>& list;
  const ContactSpec& spec;
  const PairLaws& laws;
  const CorrectionMethod& method;
  const FreeDirections<Dim>& free;
  CorrectionRule rule;
  bool may_stick;  ///< pairs may stick in this correction
  double dt;       ///< s

  NodeFields<Dim> fields(const ContactNode<Dim>& node) const { return {state, list, node}; }
  double cell() const { return state.grid.cell; }
};

/// The trial state of field a against the others of `total`. A rigid body has m_b → ∞ and keeps its velocity.
template <int Dim>
Trial<Dim> trial_of(const FreeDirections<Dim>& free, const ContactNode<Dim>& node,
                    const NodeMotion<Dim>& motion, int a, const typename NodeMotion<Dim>::Total& total) {
  const auto& own = motion[a];
  if (node.rigid >= 0) {
    const auto& rigid = motion[node.rigid];
    return {free.part(node, (own.mass / rigid.mass) * rigid.momentum - own.momentum), own.mass};
  }
  return {free.part(node, (own.mass / total.mass) * total.momentum - own.momentum),
          own.mass * (total.mass - own.mass) / total.mass};
}

/// Do pairs of a law act by the active set of the step?
template <class Law>
bool uses_active_set(const CorrectionMethod& method) {
  return method.one_set && (Law::scope == LawScope::contact || Law::scope == LawScope::bonded);
}

/// The rule of a pair with a given law. @param gap  predicted, m
template <int Dim, class Law>
PairRule<Dim> rule_for(const CorrectionPass<Dim>& pass, const Law& law, int e, double gap) {
  const PairColumns<Dim>& pairs = pass.list.pairs;
  PairRule<Dim> rule = pair_rule<Dim>(pass.rule, pairs.status[e], pairs.before[e], gap);
  rule.set.must_stick &= Law::scope == LawScope::contact;
  rule.holds_overlap &= Law::scope == LawScope::contact;
  if constexpr (Law::scope == LawScope::bonded)
    rule.set.may_bond = pairs.geometry[e].separation < law.longest_gap();
  return rule;
}

/// The response of a pair without an active set: its law decides in each correction anew.
///
/// With `holds_overlap`, an overlapping pair that parts is constrained along the normal. Contact then ends
/// where forces pull, not where noise does. If only the second correction acts, the impulse does the work
/// F·½ v_rel Δt > 0 on the parting velocity. With both, the mean relative velocity along n is zero, and
/// contact adds no energy.
template <int Dim, class Law>
Response<Dim> own_response(const PairRule<Dim>& rule, const Vec<Dim>& normal, const Trial<Dim>& trial,
                           double gap, const Law& law, double area_time) {
  const double normal_impulse = trial.impulse.dot(normal);
  if (rule.holds_overlap && gap < 0 && normal_impulse > 0)
    return response_of<Dim>(Vec<Dim>(normal_impulse * normal), trial.impulse);
  return response_of<Dim>(resolve_pair<Dim>(trial.impulse, normal, gap, law, trial.reduced_mass, area_time),
                          trial.impulse);
}

/// The response of pair e, by the active set or by its law alone. @param gap  predicted, m
template <int Dim, class Law>
Response<Dim> pair_response(const CorrectionPass<Dim>& pass, int e, const Trial<Dim>& trial, double gap,
                            const Law& law, double area_time) {
  const PairColumns<Dim>& pairs = pass.list.pairs;
  const PairRule<Dim> rule = rule_for(pass, law, e, gap);
  const Vec<Dim>& normal = pairs.geometry[e].normal;
  if (!uses_active_set<Law>(pass.method)) return own_response(rule, normal, trial, gap, law, area_time);
  const PairStatus& status = pairs.status[e];
  return rule.set.response(normal, status.target_approach, trial.impulse, trial.reduced_mass, law, area_time,
                           [&](double normal_impulse) {
                             return force_part(pass.method, pairs.pair[e], status, pairs.relative[e], normal,
                                               trial, normal_impulse);
                           });
}

/// A_c Δt of a pair, m² s; 0 for laws that do not use it.
template <class Law, int Dim>
double area_time_of(const CorrectionPass<Dim>& pass, const NodeFields<Dim>& fields, int e) {
  if constexpr (!Law::uses_area) return 0;
  const PairColumns<Dim>& pairs = pass.list.pairs;
  return contact_area(pass.spec.area, pass.cell(), fields, pairs.pair[e], pairs.geometry[e].normal) * pass.dt;
}

/// Opens the pairs [begin, end): no impulse.
template <int Dim>
void open_pairs(PairColumns<Dim>& pairs, int begin, int end) {
  for (int e = begin; e < end; ++e) {
    pairs.impulse[e].now.setZero();
    pairs.status[e].now = ContactStatus::open;
  }
}

}  // namespace mpmfast
