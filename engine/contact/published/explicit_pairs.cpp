#include "engine/contact/published/explicit_pairs.hpp"

#include <variant>

#include "kernels/contact/two_pairs.hpp"

namespace mpmfast {

namespace {

/// The touching pairs of one node, at most two.
template <int Dim>
struct TouchingPairs {
  int count = 0;
  int pair[2];  ///< into ContactList::pairs
  const AnyLaw* law[2];
  Vec<Dim> trial[2];  ///< Δp_a(0), N s
  PairContact<Dim> contact[2];
};

/// Pairs that overlap count as touching: one that does not approach by itself may be pushed by the other.
/// @return false when there are more than two, or one of them may be bonded
template <int Dim>
bool find_touching(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                   const NodeMotion<Dim>& motion, TouchingPairs<Dim>& out) {
  const NodeFields<Dim> fields = pass.fields(node);
  const PairColumns<Dim>& pairs = pass.list.pairs;
  for (int e = node.explicit_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    const PairGeometry<Dim>& geometry = pairs.geometry[e];
    const AnyLaw& law = pass.laws.law(pass.laws.number_between(fields, pair, pair.b));
    const LawScope scope = std::visit([](const auto& l) { return l.scope; }, law);
    if (scope == LawScope::bonded) return false;
    const Trial<Dim> trial = trial_of(pass.free, node, motion, pair.a, motion.total(pair.a, pair.b));
    const bool overlap = predicted_gap(pass.method, geometry, pairs.before[e], trial, pass.dt) < 0;
    if (!(scope == LawScope::everywhere || (scope == LawScope::contact && overlap))) continue;
    if (out.count == 2) return false;
    const int k = out.count++;
    out.pair[k] = e;
    out.law[k] = &law;
    out.trial[k] = trial.impulse;
    out.contact[k].normal = geometry.normal;
    out.contact[k].jump = trial.impulse / trial.reduced_mass;
    out.contact[k].inverse_mass = 1 / trial.reduced_mass;
    if (std::visit([](const auto& l) { return l.uses_area; }, law))
      out.contact[k].area_time =
          contact_area(pass.spec.area, pass.cell(), fields, pair, geometry.normal) * pass.dt;
  }
  return true;
}

/// The impulse of the only touching pair.
template <int Dim>
void solve_one(TouchingPairs<Dim>& touching) {
  PairContact<Dim>& contact = touching.contact[0];
  contact.impulse = std::visit(
      [&](const auto& law) {
        return resolve_pair<Dim>(touching.trial[0], contact.normal, -1.0, law, 1 / contact.inverse_mass,
                                 contact.area_time);
      },
      *touching.law[0]);
}

/// The impulses of both touching pairs. @return whether they converged
template <int Dim>
bool solve_two(const PairColumns<Dim>& pairs, const NodeMotion<Dim>& motion, TouchingPairs<Dim>& touching) {
  const ContactPair &one = pairs.pair[touching.pair[0]], &two = pairs.pair[touching.pair[1]];
  const bool same = one.a == two.a || one.b == two.b, crossed = one.a == two.b || one.b == two.a;
  const int shared = one.a == two.a || one.a == two.b ? one.a : one.b;
  const double coupling = same || crossed ? (same ? 1.0 : -1.0) * motion[shared].inverse_mass : 0.0;
  return solve_two_pairs(touching.contact, coupling, *touching.law[0], *touching.law[1]);
}

}  // namespace

template <int Dim>
ExplicitOutcome solve_explicit_pairs(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                                     const NodeMotion<Dim>& motion) {
  PairColumns<Dim>& pairs = pass.list.pairs;
  TouchingPairs<Dim> touching;
  open_pairs(pairs, node.pair_begin, node.pair_end);
  if (!find_touching(pass, node, motion, touching)) return ExplicitOutcome::lumped;
  if (touching.count == 0) return ExplicitOutcome::none;
  if (touching.count == 1)
    solve_one(touching);
  else if (!solve_two(pairs, motion, touching))
    return ExplicitOutcome::lumped;
  for (int k = 0; k < touching.count; ++k) {
    const int e = touching.pair[k];
    pairs.impulse[e].now = touching.contact[k].impulse;
    pairs.status[e].separable =
        std::visit([](const auto& law) { return law.scope == LawScope::contact; }, *touching.law[k]);
  }
  return ExplicitOutcome::solved;
}

template ExplicitOutcome solve_explicit_pairs(const CorrectionPass<2>&, const ContactNode<2>&,
                                              const NodeMotion<2>&);
template ExplicitOutcome solve_explicit_pairs(const CorrectionPass<3>&, const ContactNode<3>&,
                                              const NodeMotion<3>&);

}  // namespace mpmfast
