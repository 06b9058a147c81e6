/// The explicit pairs of nodes where three or more fields meet (N20 §3.4).

#include "engine/contact/contact.hpp"
#include "kernels/contact/two_pairs.hpp"

namespace mpmfast {

/// The pairs of one node that are in touch, at most two.
template <int Dim>
struct Contact<Dim>::Touching {
  int count = 0;
  ContactEntry<Dim>* entry[2];
  const AnyLaw* law[2];
  Vec<Dim> stick[2];
  PairContact<Dim> pair[2];
};

/// Beside the lumps: every two fields of a node of three or more that have an entry.
template <int Dim>
void Contact<Dim>::add_pairs(const ContactNode<Dim>& node, std::vector<ListedEntry<Dim>>& entries) const {
  if (node.field_end - node.field_begin < 3) return;
  ListedEntry<Dim> pair;
  for (int e = node.entry_begin; e < node.pair_begin; ++e)
    for (int f = e + 1; f < node.pair_begin; ++f) {
      pair.a = entries[static_cast<std::size_t>(e)].a;
      pair.b = entries[static_cast<std::size_t>(f)].a;
      entries.push_back(pair);
    }
}

/// Pairs that overlap count as touching: one that does not approach by itself may be pushed by the other.
/// @return false when there are more than two, or one of them may be bonded
template <int Dim>
bool Contact<Dim>::find_touching(const State<Dim>& state, double dt, const ContactNode<Dim>& node,
                                 const NodeMotion<Dim>& motion, Touching& out) {
  const auto field_of = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  };
  for (int e = node.pair_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const int own = pairs_.empty() ? 0 : pairs_.pair[pairs_.at(field_of(entry.a), field_of(entry.b))] + 1;
    const AnyLaw& law = laws_[static_cast<std::size_t>(own)];
    const LawScope scope = std::visit([](const auto& l) { return l.scope; }, law);
    if (scope == LawScope::bonded) return false;
    const Meeting meeting = meet(node, motion, entry.a, motion.total(entry.a, entry.b));
    const bool overlap = separation_of(entry, meeting, dt) < 0;
    if (!(scope == LawScope::everywhere || (scope == LawScope::contact && overlap))) continue;
    if (out.count == 2) return false;
    const int k = out.count++;
    out.entry[k] = &entry;
    out.law[k] = &law;
    out.stick[k] = meeting.stick;
    out.pair[k].normal = entry.normal;
    out.pair[k].jump = meeting.stick / meeting.reduced;
    out.pair[k].inverse_mass = 1 / meeting.reduced;
    if (std::visit([](const auto& l) { return l.uses_area; }, law))
      out.pair[k].area_time = area(state, node, entry) * dt;
  }
  return true;
}

/// One or two pairs that touch are solved by themselves; more than two, bonds, and pairs that do not settle
/// are left to the lump.
template <int Dim>
PairOutcome Contact<Dim>::resolve_pairs(const State<Dim>& state, Correction correction, double dt,
                                        const ContactNode<Dim>& node, const NodeMotion<Dim>& motion) {
  Touching touching;
  rest(node.entry_begin, node.entry_end);
  if (!find_touching(state, dt, node, motion, touching)) return PairOutcome::lump;
  if (touching.count == 0) return PairOutcome::none;
  auto& pair = touching.pair;
  if (touching.count == 1) {
    auto& p = pair[0];
    p.impulse = std::visit(
        [&](const auto& law) {
          return resolve_pair<Dim>(touching.stick[0], p.normal, -1.0, law, 1 / p.inverse_mass, p.area_time);
        },
        *touching.law[0]);
  } else {
    const auto &one = *touching.entry[0], &two = *touching.entry[1];
    const bool same = one.a == two.a || one.b == two.b, crossed = one.a == two.b || one.b == two.a;
    const int shared = one.a == two.a || one.a == two.b ? one.a : one.b;
    const double coupling = same || crossed ? (same ? 1.0 : -1.0) * motion[shared].inverse_mass : 0.0;
    if (!solve_two_pairs(pair, coupling, *touching.law[0], *touching.law[1])) return PairOutcome::lump;
  }
  for (int k = 0; k < touching.count; ++k) {
    auto& entry = *touching.entry[k];
    entry.impulse = pair[k].impulse;
    pass_on(entry, correction, std::visit([](const auto& law) { return law.scope; }, *touching.law[k]));
  }
  return PairOutcome::solved;
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
