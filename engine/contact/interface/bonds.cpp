#include "engine/contact/interface/bonds.hpp"

#include <algorithm>
#include <limits>
#include <variant>

#include "engine/constants.hpp"
#include "engine/contact/interface/bond_steps.hpp"
#include "engine/contact/pairs/neighbours.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// f(node, fields, e, law) for each pair e with a cohesive law, in parallel.
template <int Dim>
template <class F>
void Bonds<Dim>::for_each(const State<Dim>& state, const ContactList<Dim>& list, const F& f) const {
  using constants::threads::kFewSolved;
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), state.threads, kFewSolved, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    const NodeFields<Dim> fields(state, list, node);
    for (int e = node.pair_begin; e < node.pair_end; ++e)
      if (const auto* law = std::get_if<Cohesive>(&laws_.law_of(fields, node, list.pairs.pair[e])))
        f(node, fields, e, *law);
  });
}

/// At the start of the run surfaces are bonded that touch. Later a pair has the bond that its node had, or
/// the nodes around. Surfaces that meet where there was no bond have a broken one.
template <int Dim>
void Bonds<Dim>::find(const State<Dim>& state, ContactList<Dim>& list) const {
  PairColumns<Dim>& pairs = list.pairs;
  for_each(state, list, [&](const auto& node, const auto&, int e, const Cohesive&) {
    const ContactPair& pair = pairs.pair[e];
    Bond<Dim>& bond = pairs.bond[e];
    bond.damage = bond.damage_before, bond.offset = bond.offset_before;
    if (pair.crack >= 0 && state.step > 0 && cracks_.is_fresh(state, pair.crack, node.index)) {
      // The sides were one body: ahead of the last tip they have hardly any mass, and the jump that their
      // displacements give is noise.
      bond.damage = 0;
      bond.offset.setZero();
      DisplacementJump<Dim>& jump = pairs.spring[e].jump;
      jump.known = true;
      jump.value.setZero();
      jump.normal = pairs.geometry[e].normal;
      return;
    }
    if (bond.damage_before >= 0) return;
    if (state.step == 0) {
      const bool touch = pairs.geometry[e].separation < constants::contact::kBondedGap * state.grid.cell;
      bond.damage = touch && !is_cracked(state, node, pair) ? 0 : 1;
    } else {
      take_nearest(state, node, e, list);
    }
  });
}

/// Does the scene have a crack there at the start?
template <int Dim>
bool Bonds<Dim>::is_cracked(const State<Dim>& state, const ContactNode<Dim>& node,
                            const ContactPair& pair) const {
  if (pair.crack >= 0 && cracks_.grows(pair.crack)) return true;
  if (!spec_.cracked) return false;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const double x = state.grid.origin[d] + node.index[d] * state.grid.cell;
    if (x < spec_.crack_lower[k] || x > spec_.crack_upper[k]) return false;
  }
  return true;
}

/// Takes the damage of the nearest material point along the surface that a node around (or this one) had at
/// the end of the last step. Nodes with little of the surface do not count. Broken where there is none.
template <int Dim>
void Bonds<Dim>::take_nearest(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                              ContactList<Dim>& list) const {
  const Vec<Dim>& normal = list.pairs.geometry[e].normal;
  Bond<Dim>& bond = list.pairs.bond[e];
  double nearest = std::numeric_limits<double>::infinity();
  bond.damage = 1;
  bond.offset.setZero();
  for (int position = 0; position < power(3, Dim); ++position) {
    const int f = same_pair(state, list, node, list.pairs.pair[e], position);
    if (f < 0) continue;
    const Bond<Dim>& beside = list.pairs.bond[f];
    if (beside.damage_before < 0 || beside.area < bond.least_area) continue;
    Vec<Dim> offset = beside.offset_before;
    for (int d = 0, rest = position; d < Dim; ++d, rest /= 3) offset[d] += rest % 3 - 1;
    const double across = offset.dot(normal);
    const double distance = offset.squaredNorm() - (1 - constants::contact::kAcrossWeight) * across * across;
    if (!(distance < nearest)) continue;
    nearest = distance;
    bond.damage = beside.damage_before;
    bond.offset = offset;
  }
}

/// The jump of a node with little of the surface is noise: by itself its bond breaks too early or too late,
/// and passes that on when the surface has come to the next node.
template <int Dim>
void Bonds<Dim>::find_followers(const State<Dim>& state, ContactList<Dim>& list) const {
  using constants::contact::kLittleArea;
  for_each(state, list, [&](const auto& node, const auto&, int e, const Cohesive&) {
    Bond<Dim>& bond = list.pairs.bond[e];
    for (int position = 0; position < power(3, Dim); ++position)
      if (const int f = same_pair(state, list, node, list.pairs.pair[e], position); f >= 0)
        bond.least_area = std::max(bond.least_area, kLittleArea * list.pairs.bond[f].area);
  });
}

/// The material point of a bond moves with the mean velocity of its two fields. When it is kBondOffset cells
/// off along the surface, the next node takes it over. (If a node took |v| Δt/h of the last node's damage in
/// each step, every vibration would mend what is broken beside what is whole.)
template <int Dim>
void Bonds<Dim>::carry(const State<Dim>& state, double dt, ContactList<Dim>& list) const {
  using constants::contact::kBondOffset;
  PairColumns<Dim>& pairs = list.pairs;
  for_each(state, list, [&](const auto& node, const auto& fields, int e, const Cohesive&) {
    const ContactPair& pair = pairs.pair[e];
    Bond<Dim>& bond = pairs.bond[e];
    const int b = partner(fields, node, pair);
    bond.offset += dt / state.grid.cell *
                   (fields.vector(Nodal::momentum, pair.a) + fields.vector(Nodal::momentum, b)) /
                   (fields.mass(pair.a) + fields.mass(b));
    bond.damage_before = bond.damage;
    bond.offset_before = bond.offset;
  });
  for_each(state, list, [&](const auto& node, const auto&, int e, const Cohesive& law) {
    const Vec<Dim>& normal = pairs.geometry[e].normal;
    Bond<Dim>& bond = pairs.bond[e];
    const Vec<Dim> along = bond.offset - bond.offset.dot(normal) * normal;
    if (!bond.follows() && !(along.template lpNorm<Eigen::Infinity>() > kBondOffset)) return;
    const double before = law.integrity_of(bond.damage);
    take_nearest(state, node, e, list);
    InterfaceSpring<Dim>& spring = pairs.spring[e];
    if (bond.follows() && spring.acts) record_damage(law, before, spring, bond);
    if (bond.is_broken()) spring.acts = false;
  });
}

template class Bonds<2>;
template class Bonds<3>;

}  // namespace mpmfast
