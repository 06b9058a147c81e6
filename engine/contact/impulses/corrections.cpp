#include "engine/contact/impulses/corrections.hpp"

#include <omp.h>

#include <atomic>

#include "engine/constants.hpp"
#include "engine/contact/published/explicit_pairs.hpp"
#include "engine/contact/solver/solve_nodes.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// Adds the impulses of a node's pairs to its fields. @param with_forces  also what counts as a force beside
/// them
template <int Dim>
void sum_impulses(const ContactNode<Dim>& node, const PairColumns<Dim>& pairs, bool with_forces,
                  NodeMotion<Dim>& motion) {
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    const PairImpulses<Dim>& impulse = pairs.impulse[e];
    const bool moves_other = !pair.is_lumped() && pair.b != node.rigid;
    motion[pair.a].impulse += impulse.now;
    if (moves_other) motion[pair.b].impulse -= impulse.now;
    if (!with_forces) continue;
    motion[pair.a].as_force += impulse.as_force;
    if (moves_other) motion[pair.b].as_force -= impulse.as_force;
  }
}

template <int Dim>
void change_momenta(State<Dim>& state, NodeMotion<Dim>& motion) {
  for (auto& field : motion) {
    if (field.impulse.isZero(0)) continue;
    field.momentum += field.impulse;
    state.nodes.set(Nodal::momentum, field.slot, field.momentum);
  }
}

template <int Dim>
void change_forces(State<Dim>& state, double dt, NodeMotion<Dim>& motion) {
  for (const auto& field : motion) {
    const Vec<Dim> force = (field.impulse + field.as_force) / dt;
    if (!force.isZero(0))
      state.nodes.set(Nodal::force, field.slot, state.nodes.vector(Nodal::force, field.slot) + force);
  }
}

/// For contact-aware XPIC: Δv of the first correction beside v*.
template <int Dim>
void store_velocity_changes(State<Dim>& state, NodeMotion<Dim>& motion) {
  for (const auto& field : motion)
    for (int d = 0; d < Dim; ++d)
      state.nodes.column(Nodal::star, Dim + d)[field.slot] += field.impulse[d] * field.inverse_mass;
}

/// The part of the second impulse of a sole pair that is no force is taken off what counts as one
/// (force_part).
template <int Dim>
void take_off_approach(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                       const NodeWorkspace<Dim>& work) {
  if (!pass.method.one_set) return;
  PairColumns<Dim>& pairs = pass.list.pairs;
  for (int e = node.pair_begin; e < node.explicit_begin; ++e) {
    const ContactPair& pair = pairs.pair[e];
    if (!pair.sole || !pairs.status[e].separable) continue;
    const Vec<Dim>& normal = pairs.geometry[e].normal;
    PairImpulses<Dim>& impulse = pairs.impulse[e];
    const double along = impulse.now.dot(normal);
    const Trial<Dim>& trial = work.trials[static_cast<std::size_t>(e - node.pair_begin)];
    impulse.as_force -=
        (along - force_part(pass.method, pair, pairs.status[e], pairs.slip[e], normal, trial, along)) *
        normal;
  }
}

/// 1/m_red of a pair, 1/kg.
template <int Dim>
double inverse_reduced(const ContactNode<Dim>& node, const ContactPair& pair, const NodeMotion<Dim>& motion) {
  return motion[pair.a].inverse_mass + (meets_rigid(node, pair) ? 0 : motion.inverse_mass_of(pair.a, pair.b));
}

}  // namespace

template <int Dim>
Corrections<Dim>::Corrections(const Scene& scene, const Plan& plan, const PairLaws& laws)
    : spec_(scene.contact),
      laws_(laws),
      method_(scene, plan),
      solves_in_lanes_(
          plan.one_set && !plan.interface_springs && scene.cracks.empty() && !laws.any([](const AnyLaw& law) {
            return !std::visit([](const auto& l) { return kDryFriction<std::decay_t<decltype(l)>>; }, law);
          })),
      workspaces_(static_cast<std::size_t>(omp_get_max_threads())) {}

template <int Dim>
CorrectionPass<Dim> Corrections<Dim>::pass(State<Dim>& state, const FreeDirections<Dim>& free, double dt,
                                           RuleOf<Dim> rule, bool may_stick, ContactList<Dim>& list) const {
  return {state, list, spec_, laws_, method_, free, rule, may_stick, dt};
}

/// FLIP's particles take a share of what the first correction changes on surfaces that touch. They get forces
/// only, and the first correction is none (N20 Eq. 33): an approach that it takes from the grid in every step
/// stays in the particles for good. Forces then act on velocities that the bodies do not have, and noise
/// grows. A small share ends it within as many steps as its inverse.
template <int Dim>
void Corrections<Dim>::correct_first(State<Dim>& state, const FreeDirections<Dim>& free,
                                     const StepTimes& times, ContactList<Dim>& list) {
  const bool may_stick = method_.holds_sticking || method_.first_stays;
  const CorrectionPass<Dim> all = pass(state, free, times.dt, first_rule<Dim>, may_stick, list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    work.motion.read(all.fields(node));
    begin_set(all, node, work.motion);
  };
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    PairColumns<Dim>& pairs = list.pairs;
    sum_impulses(node, pairs, false, work.motion);
    change_momenta(state, work.motion);
    if (method_.keeps_velocity_change) store_velocity_changes(state, work.motion);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      PairImpulses<Dim>& impulse = pairs.impulse[e];
      impulse.first = impulse.now;
      if (pairs.status[e].separable) impulse.as_force = method_.first_share * impulse.now;
      pairs.status[e].active_in_first = !impulse.now.isZero(0);
      if (method_.one_set || method_.first_stays)
        pairs.slip[e].after_first = free(node, work.motion.slip_of(node, pairs.pair[e]));
    }
  };
  solve_nodes(all, begin, finish);
}

template <int Dim>
void Corrections<Dim>::correct_second(State<Dim>& state, const FreeDirections<Dim>& free,
                                      const StepTimes& times, Interfaces<Dim>& interfaces,
                                      ContactList<Dim>& list) {
  const CorrectionPass<Dim> all = pass(state, free, times.dt, second_rule<Dim>, true, list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    if (interfaces.active()) interfaces.apply(state, node, free, times.dt, list);
    work.motion.read(all.fields(node));
    if (!method_.has_first) begin_set(all, node, work.motion);
  };
  const bool shares_first = method_.first_share > 0 || method_.one_set;
  const bool ends_here = !method_.one_set || method_.first_stays;
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    PairColumns<Dim>& pairs = list.pairs;
    take_off_approach(all, node, work);
    sum_impulses(node, pairs, shares_first, work.motion);
    change_momenta(state, work.motion);
    change_forces(state, times.dt, work.motion);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      PairImpulses<Dim>& impulse = pairs.impulse[e];
      PairStatus& status = pairs.status[e];
      impulse.second = impulse.now + impulse.as_force;
      status.stuck = status.now == ContactStatus::stick;
      status.touching = !impulse.now.isZero(0);
      if (!method_.one_set && !ends_here) continue;
      const Vec<Dim> slip = free(node, work.motion.slip_of(node, pair));
      if (ends_here) pairs.slip[e].end = slip;
      if (!method_.one_set) continue;
      const Vec<Dim>& normal = pairs.geometry[e].normal;
      pairs.slip[e].after_second = slip;
      status.touching =
          still_touches(impulse, normal, status, work.motion[pair.a].mass, slip, state.grid.cell, times.dt);
      status.recovery_length =
          recovery_length(impulse, normal, pairs.before[e], inverse_reduced(node, pair, work.motion),
                          times.crossing, times.dt);
    }
  };
  const Counts counts = solve_nodes(all, begin, finish);
  list.counters.pair_nodes += counts.converged;
  list.counters.pair_fallbacks += counts.unconverged;
}

template <int Dim>
void Corrections<Dim>::correct_re_extrapolated(State<Dim>& state, const FreeDirections<Dim>& free,
                                               const StepTimes& times, ContactList<Dim>& list) {
  const bool may_stick = method_.holds_sticking || method_.first_stays;
  const CorrectionPass<Dim> all = pass(state, free, times.dt, re_extrapolated_rule<Dim>, may_stick, list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    work.motion.read(all.fields(node));
  };
  const bool ends_here = method_.one_set && !method_.first_stays;
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    PairColumns<Dim>& pairs = list.pairs;
    sum_impulses(node, pairs, false, work.motion);
    change_momenta(state, work.motion);
    if (!ends_here) return;
    for (int e = node.pair_begin; e < node.pair_end; ++e)
      pairs.slip[e].end = free(node, work.motion.slip_of(node, pairs.pair[e]));
  };
  solve_nodes(all, begin, finish);
}

/// The slips before any correction, and the persistent pairs.
template <int Dim>
void Corrections<Dim>::begin_set(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                                 const NodeMotion<Dim>& motion) const {
  PairColumns<Dim>& pairs = pass.list.pairs;
  if (method_.one_set || method_.first_stays)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      PairSlips<Dim>& slip = pairs.slip[e];
      slip.start = slip.after_first = pass.free(node, motion.slip_of(node, pairs.pair[e]));
    }
  find_persistent(method_, node, pass.cell(), pass.dt, pairs);
}

/// Solves all contact nodes, in parallel. Nodes of three and four fields may wait to be solved in lanes.
/// @param begin   begin(node, workspace): reads the motion of a node
/// @param finish  finish(node, workspace): gives the impulses of its pairs to its fields
template <int Dim>
template <class Begin, class Finish>
auto Corrections<Dim>::solve_nodes(const CorrectionPass<Dim>& pass, const Begin& begin, const Finish& finish)
    -> Counts {
  const ContactList<Dim>& list = pass.list;
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  const int asked = n <= constants::threads::kFewSolved ? 1 : pass.state.threads;
  std::atomic<std::uint64_t> all_converged{0}, all_unconverged{0};
  shares_.cut(asked, n, constants::threads::kSolvedAtOnce);
  on_threads(asked, [&](const TeamThread& me) {
    std::uint64_t converged = 0, unconverged = 0;
    NodeWorkspace<Dim>& work = workspaces_[static_cast<std::size_t>(thread_index())];
    const auto solve_alone = [&](const ContactNode<Dim>& node) {
      ++(solve_together(pass, node, work) ? converged : unconverged);
      finish(node, work);
    };
    const auto solve_waiting = [&](auto& waiting) {
      const int count = waiting.solver.count();
      const unsigned solved = waiting.solver.solve(pass.may_stick);
      for (int lane = 0; lane < count; ++lane) {
        const ContactNode<Dim>& node = *waiting.nodes[static_cast<std::size_t>(lane)];
        work.motion.read(pass.fields(node));
        if (!(solved >> lane & 1)) {
          find_responding(pass, node, work);
          solve_alone(node);
          continue;
        }
        ++converged;
        take_from_lane(node, waiting.solver, lane, pass.list.pairs);
        finish(node, work);
      }
    };
    const auto wait = [&](const ContactNode<Dim>& node, auto& waiting) {
      wait_in_lane(pass, node, work, waiting);
      if (waiting.solver.is_full()) solve_waiting(waiting);
    };
    shares_.for_each(me.thread, [&](std::int64_t k) {
      const ContactNode<Dim>& node = list.nodes[k];
      const int fields = node.field_end - node.field_begin;
      begin(node, work);
      if (spec_.fields == ManyFields::simultaneous && fields > 2) {
        find_responding(pass, node, work);
        const bool waits = solves_in_lanes_ && work.responding.size() > 1;
        if (waits && fields == 3)
          wait(node, work.of_three);
        else if (waits && fields == 4)
          wait(node, work.of_four);
        else
          solve_alone(node);
        return;
      }
      auto outcome = ExplicitOutcome::lumped;
      if (node.explicit_begin < node.pair_end) {
        outcome = solve_explicit_pairs(pass, node, work.motion);
        converged += outcome == ExplicitOutcome::solved;
        unconverged += outcome == ExplicitOutcome::lumped;
      }
      if (outcome == ExplicitOutcome::lumped) solve_pairs(pass, node, work);
      finish(node, work);
    });
    solve_waiting(work.of_three);
    solve_waiting(work.of_four);
    all_converged += converged;
    all_unconverged += unconverged;
  });
  return {all_converged, all_unconverged};
}

template class Corrections<2>;
template class Corrections<3>;

}  // namespace mpmfast
