/// The impulses of a correction: what each law makes of its pair, alone or with the others of a node.

#include <omp.h>

#include <algorithm>
#include <atomic>

#include "engine/contact/contact.hpp"
#include "engine/contact/nodal/correct.hpp"
#include "engine/plan/contact_law.hpp"
#include "engine/state/team.hpp"

namespace mpmfast {

namespace {

/// One law for every pair: nothing is looked up.
template <class Law>
struct OneLaw {
  const Law& law;
  static constexpr bool by_pair = false;
  template <class F>
  void with(int, F f) const {
    f(law);
  }
};

/// The law of each pair, or of a crack, from the list.
struct LawsByPair {
  const std::vector<AnyLaw>& laws;
  static constexpr bool by_pair = true;
  template <class F>
  void with(int law, F f) const {
    std::visit(f, laws[static_cast<std::size_t>(law + 1)]);
  }
};

}  // namespace

template <int Dim>
void Contact<Dim>::resolve(State<Dim>& state, Correction correction, double dt) {
  dt_ = dt;
  if (pairs_.empty() && !cracks_.active())
    std::visit(
        [&](const auto& law) {
          resolve_all(state, OneLaw<std::decay_t<decltype(law)>>{law}, correction, dt);
        },
        laws_.front());
  else
    resolve_all(state, LawsByPair{laws_}, correction, dt);
}

template <int Dim>
template <class Laws>
void Contact<Dim>::resolve_all(State<Dim>& state, const Laws& laws, Correction correction, double dt) {
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
  std::atomic<std::uint64_t> all_solved{0}, all_lumped{0};
  constexpr std::int64_t kAtOnce = 32, kFew = 64;  // nodes
  const int asked = n <= kFew ? 1 : state.threads;
  shares_.cut(asked, n, kAtOnce);
  on_threads(asked, [&](const Member& me) {
    std::uint64_t solved = 0, lumped = 0;
    const bool may_stick = holds_sticking_ || first_correction_stays_ || correction == Correction::final;
    Together& together = together_[static_cast<std::size_t>(own_number())];
    const auto finish_node = [&](const ContactNode<Dim>& node) {
      apply(state, correction, dt, node, together.motion);
      settle(correction, node, together.motion);
    };
    const auto solve_alone = [&](const ContactNode<Dim>& node) {
      pose(state, correction, node, together);
      const bool settled = resolve_together(laws, correction, node, together);
      solved += settled;
      lumped += !settled;
      finish_node(node);
    };
    const auto solve_waiting = [&](auto& waiting) {
      const int count = waiting.solver.count();
      const unsigned settled = waiting.solver.solve(may_stick);
      for (int lane = 0; lane < count; ++lane) {
        const ContactNode<Dim>& node = *waiting.nodes[static_cast<std::size_t>(lane)];
        read_motion(state, node, together.motion);
        if (!(settled >> lane & 1)) {
          find_acting(state, laws, correction, dt, node, together);
          solve_alone(node);
          continue;
        }
        ++solved;
        finish_lane(correction, node, waiting.solver, lane);
        finish_node(node);
      }
    };
    const auto wait_in = [&](auto& waiting, const ContactNode<Dim>& node) {
      put_in_lane(state, together, node, waiting);
      if (waiting.solver.is_full()) solve_waiting(waiting);
    };
    shares_.for_each(me.thread, [&](std::int64_t k) {
      const ContactNode<Dim>& node = list_.nodes[static_cast<std::size_t>(k)];
      const int fields = node.field_end - node.field_begin;
      if (bridges_ && correction == Correction::final) bridge(state, dt, node);
      read_motion(state, node, together.motion);
      if (correction == (first_correction_ ? Correction::initial : Correction::final)) {
        see_slips(node, together.motion);
        judge(node);
      }
      auto outcome = PairOutcome::lump;
      if (node.pair_begin < node.entry_end) {
        outcome = resolve_pairs(state, correction, dt, node, together.motion);
        solved += outcome == PairOutcome::solved;
        lumped += outcome == PairOutcome::lump;
      }
      if (spec_.fields == ManyFields::simultaneous && fields > 2) {
        find_acting(state, laws, correction, dt, node, together);
        const bool waits = solves_in_lanes_ && together.acting.size() > 1;
        if (waits && fields == 3)
          wait_in(together.of_three, node);
        else if (waits && fields == 4)
          wait_in(together.of_four, node);
        else
          solve_alone(node);
        return;
      }
      if (outcome == PairOutcome::lump) resolve_each(state, laws, correction, dt, node, together.motion);
      finish_node(node);
    });
    solve_waiting(together.of_three);
    solve_waiting(together.of_four);
    all_solved += solved;
    all_lumped += lumped;
  });
  if (bridges_ && correction == (one_set_ ? Correction::strain : Correction::final)) end_bridges(state, dt);
  if (correction == Correction::final) {
    list_.counters.pair_nodes += all_solved;
    list_.counters.pair_fallbacks += all_lumped;
  }
  if (correction == Correction::final || (correction == Correction::initial && first_correction_stays_))
    book(state);
  if (correction == (one_set_ ? Correction::strain : Correction::final)) book_friction(state);
}

/// Impulses of all entries but the explicit pairs, from the momenta before any of them changes; what of the
/// second correction is no force is taken off what passes for one.
template <int Dim>
template <class Laws>
void Contact<Dim>::resolve_each(const State<Dim>& state, const Laws& laws, Correction correction, double dt,
                                const ContactNode<Dim>& node, const NodeMotion<Dim>& motion) {
  const auto all = motion.total();
  for (int e = node.entry_begin; e < node.pair_begin; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const Meeting meeting = meet(node, motion, entry.a, all);
    const double separation = separation_of(entry, meeting, dt);
    const auto act_by = [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      double area_time = 0;
      if constexpr (Law::uses_area) area_time = area(state, node, entry) * dt;
      const Response<Dim> demand = impulse_of(entry, meeting, separation, correction, law, area_time);
      entry.impulse = demand.impulse;
      if (correction == Correction::final) entry.stuck = demand.hinders == ContactStatus::stick;
      pass_on(entry, correction, Law::scope);
      if (correction != Correction::final || !one_set_ || !entry.parts || !entry.alone) return;
      const double normal = entry.impulse.dot(entry.normal);
      entry.passed -= (normal - force_of(entry, meeting, normal)) * entry.normal;
    };
    const auto act = [&](const auto& law) { as_it_is(entry, law, act_by); };
    laws.with(Laws::by_pair ? law_between(entry, node, partner(state, node, entry)) : -1, act);
  }
  rest(node.pair_begin, node.entry_end);
}

/// The impulse of one entry by itself.
///
/// A pair that touched and now would part is held by the first correction (`persistent`): contact ends where
/// the forces pull, not where noise does. Over a step in which only the second correction acts, its force
/// does work on the parting velocity, F·½ v_rel Δt > 0; with both, the surfaces' mean relative velocity is
/// zero along n and no energy comes from the contact.
template <int Dim>
template <class Law>
Response<Dim> Contact<Dim>::impulse_of(const ContactEntry<Dim>& entry, const Meeting& meeting,
                                     double separation, Correction correction, const Law& law,
                                     double area_time) const {
  if (one_set_ && (Law::scope == LawScope::contact || Law::scope == LawScope::bonded))
    return impulse_of_set(entry, meeting, separation, correction, law, area_time);
  const Vec<Dim> free =
      resolve_pair<Dim>(meeting.stick, entry.normal, separation, law, meeting.reduced, area_time);
  const double along = meeting.stick.dot(entry.normal);
  const bool overlaps = spec_.detection == DetectionKind::separation;  // in contact, parting or not
  const bool lasts = correction == Correction::initial && spec_.persistent && entry.touched;
  const bool holds = Law::scope == LawScope::contact && (overlaps || lasts) && separation < 0 && along > 0;
  return response_of<Dim>(holds ? Vec<Dim>(along * entry.normal) : free, meeting.stick);
}

/// The impulse of a pair of the step's one set (tools/manual/theory.md, "The energy of a contact").
///
/// In the set are pairs that will touch by the end of the step as the first correction sees it, and those
/// that last; the second may add what the forces bring. A gap δ that closes leaves the approach δ/Δt. The
/// normal velocities of pairs that last are held, whichever way they go; forces are held where they press,
/// and end the contact where they pull. Momenta that are re-extrapolated are held where forces were. Pairs
/// that stick are held along the surface too: else the friction of a pair at rest works on the slips that the
/// strains see, and makes energy.
template <int Dim>
template <class Law>
Response<Dim> Contact<Dim>::impulse_of_set(const ContactEntry<Dim>& entry, const Meeting& meeting,
                                         double separation, Correction correction, const Law& law,
                                         double area_time) const {
  const SetRule<Dim> rule = rule_of(entry, separation, correction, law);
  return rule.demand(entry.normal, entry.closing, meeting.stick, meeting.reduced, law, area_time,
                     [&](double normal) { return force_of(entry, meeting, normal); });
}

/// What a correction asks of a pair of the set.
template <int Dim>
template <class Law>
SetRule<Dim> Contact<Dim>::rule_of(const ContactEntry<Dim>& entry, double separation, Correction correction,
                                   const Law& law) const {
  SetRule<Dim> rule;
  if constexpr (Law::scope == LawScope::bonded) rule.may_bond = entry.separation < law.longest_gap();
  const bool closes = separation < 0 || entry.lasts;
  rule.acts = correction == Correction::initial ? closes
              : correction == Correction::final ? closes || entry.held
                                                : entry.touching;
  rule.both_ways = both_ways(entry, correction);
  rule.holds_slip = Law::scope == LawScope::contact && holds_slip(entry, correction);
  rule.friction = correction == Correction::final || first_correction_stays_;
  return rule;
}

/// All pairs of a node of three or more fields at once, as find_acting has found them: impulses J_ab on a,
/// −J_ab on b, such that each obeys its law with the velocities that all of them leave.
/// @return whether they settled
template <int Dim>
template <class Laws>
bool Contact<Dim>::resolve_together(const Laws& laws, Correction correction, const ContactNode<Dim>& node,
                                    Together& together) const {
  const bool settled = together.solver.solve([&](std::size_t k, const Vec<Dim>& stick) {
    const Acting& acting = together.acting[k];
    const FieldContact<Dim>& contact = together.solver.contacts[k];
    Response<Dim> demand;
    with_law(laws, node, *acting.entry, [&](const auto& law) {
      demand = acting.in_set ? acting.rule.demand(contact.normal, contact.closing, stick, contact.reduced,
                                                  law, acting.area_time, [](double normal) { return normal; })
                             : impulse_of(*acting.entry, {stick, contact.reduced}, acting.entry->advanced,
                                          correction, law, acting.area_time);
    });
    return demand;
  });
  finish(laws, correction, node, together);
  return settled;
}

/// A node that find_acting has been at, to be solved alone.
template <int Dim>
void Contact<Dim>::pose(const State<Dim>& state, Correction correction, const ContactNode<Dim>& node,
                        Together& together) const {
  auto& solver = together.solver;
  solver.fields.clear();
  solver.contacts.clear();
  for (int k = 0; k < node.field_end - node.field_begin; ++k)
    solver.fields.push_back({together.velocities[static_cast<std::size_t>(k)],
                             is_rigid(state, node, k) ? 0.0 : together.motion[k].inverse_mass});
  for (const Acting& acting : together.acting) {
    const auto& entry = *acting.entry;
    auto& contact = solver.contacts.emplace_back();
    contact.a = entry.a, contact.b = entry.b;
    contact.normal = entry.normal;
    contact.reduced = acting.reduced;
    if (!one_set_) continue;
    contact.closing = entry.closing;
    contact.both_ways = both_ways(entry, correction);
  }
}

/// The same, in the next lane.
template <int Dim>
template <int kFields>
void Contact<Dim>::put_in_lane(const State<Dim>& state, const Together& together,
                               const ContactNode<Dim>& node, Waiting<kFields>& waiting) const {
  const int lane = waiting.solver.begin_node();
  waiting.nodes[static_cast<std::size_t>(lane)] = &node;
  for (int k = 0; k < kFields; ++k)
    waiting.solver.set_field(lane, k, together.velocities[static_cast<std::size_t>(k)],
                             is_rigid(state, node, k) ? 0.0 : together.motion[k].inverse_mass);
  for (const Acting& acting : together.acting) {
    const auto& entry = *acting.entry;
    waiting.solver.add_contact(lane, entry.a, entry.b, entry.normal, acting.reduced, entry.closing,
                               acting.rule, acting.friction);
  }
}

/// The impulses of a node that was solved in a lane.
template <int Dim>
template <int kFields>
void Contact<Dim>::finish_lane(Correction correction, const ContactNode<Dim>& node,
                               const LaneSolver<Dim, kFields>& solver, int lane) {
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    if (!solver.has(lane, entry.a, entry.b)) continue;
    entry.impulse = solver.impulse(lane, entry.a, entry.b);
    if (correction == Correction::final) entry.stuck = solver.sticks(lane, entry.a, entry.b);
    pass_on(entry, correction, LawScope::contact);
  }
}

/// The fields of a node, and its pairs that may have an impulse, with their separations at the end of the
/// step, before contact: a law of touching surfaces asks nothing of surfaces that are apart, however they
/// move.
template <int Dim>
template <class Laws>
void Contact<Dim>::find_acting(const State<Dim>& state, const Laws& laws, Correction correction, double dt,
                               const ContactNode<Dim>& node, Together& together) {
  const NodeMotion<Dim>& motion = together.motion;
  auto& velocities = together.velocities;
  velocities.clear();
  for (int k = 0; k < node.field_end - node.field_begin; ++k)
    velocities.push_back(node.constrained ? free_part(node, motion.velocity(k)) : motion.velocity(k));
  together.acting.clear();
  rest(node.entry_begin, node.entry_end);
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const double reduced = 1 / ((is_rigid(state, node, entry.a) ? 0 : motion[entry.a].inverse_mass) +
                                (is_rigid(state, node, entry.b) ? 0 : motion[entry.b].inverse_mass));
    const Meeting meeting{reduced * (velocities[static_cast<std::size_t>(entry.b)] -
                                     velocities[static_cast<std::size_t>(entry.a)]),
                          reduced};
    entry.advanced = separation_of(entry, meeting, dt);
    with_law(laws, node, entry, [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      const bool in_set = one_set_ && (entry.lasts || entry.held || entry.touching);
      const bool apart = !(entry.advanced < 0) && !in_set;
      if (Law::scope == LawScope::nowhere || Law::scope == LawScope::interface) return;
      if (Law::scope == LawScope::contact && apart) return;
      Acting& acting = together.acting.emplace_back();
      acting.entry = &entry;
      acting.reduced = reduced;
      if constexpr (Law::uses_area) acting.area_time = area(state, node, entry) * dt;
      acting.in_set = one_set_ && (Law::scope == LawScope::contact || Law::scope == LawScope::bonded);
      if (acting.in_set) acting.rule = rule_of(entry, entry.advanced, correction, law);
      if constexpr (std::is_same_v<Law, Coulomb>) acting.friction = law;
    });
  }
}

/// The impulses of pairs that are solved, with their friction work.
template <int Dim>
template <class Laws>
void Contact<Dim>::finish(const Laws& laws, Correction correction, const ContactNode<Dim>& node,
                          const Together& together) const {
  for (std::size_t k = 0; k < together.acting.size(); ++k) {
    const FieldContact<Dim>& contact = together.solver.contacts[k];
    auto& entry = *together.acting[k].entry;
    entry.impulse = contact.impulse;
    if (correction == Correction::final) entry.stuck = contact.hinders == ContactStatus::stick;
    with_law(laws, node, entry, [&](const auto& law) { pass_on(entry, correction, law.scope); });
  }
}

/// Which law acts between field a of an entry and another: of ContactSpec::pairs, behind them of cracks; −1:
/// the default.
template <int Dim>
int Contact<Dim>::law_between(const ListedEntry<Dim>& entry, const ContactNode<Dim>& node, int other) const {
  if (entry.crack >= 0) return static_cast<int>(spec_.pairs.size()) + entry.crack;
  if (pairs_.empty()) return -1;
  const auto field = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  };
  return pairs_.pair[pairs_.at(field(entry.a), field(other))];
}

/// Calls f(law of the entry's two fields).
template <int Dim>
template <class Laws, class F>
void Contact<Dim>::with_law(const Laws& laws, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                            F f) const {
  const auto act = [&](const auto& law) { as_it_is(entry, law, f); };
  laws.with(Laws::by_pair ? law_between(entry, node, entry.b) : -1, act);
}

/// FLIP's particles take a share of what surfaces that touch change in the first correction.
///
/// They are given forces only, and the first correction is none (N20 Eq. 33). So an approach that it takes
/// from the grid in every step stays in the particles for good: forces then act on velocities that the bodies
/// do not have, and the noise grows. A small share ends it within as many steps as its inverse.
template <int Dim>
void Contact<Dim>::pass_on(ContactEntry<Dim>& entry, Correction correction, LawScope scope) const {
  entry.parts = scope == LawScope::contact;
  if (correction == Correction::initial && entry.parts) entry.passed = first_share_ * entry.impulse;
}

/// No contact at the entries [begin, end).
template <int Dim>
void Contact<Dim>::rest(int begin, int end) {
  for (int e = begin; e < end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    entry.impulse.setZero();
  }
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
