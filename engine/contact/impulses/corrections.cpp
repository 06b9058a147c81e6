#include "engine/contact/impulses/corrections.hpp"

#include <omp.h>

#include <atomic>

#include "engine/constants.hpp"
#include "engine/contact/published/explicit_pairs.hpp"
#include "engine/contact/solver/solve_node.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// Sums the impulses of a node's pairs into its fields. Field b takes the opposite of field a; a rigid field
/// and the rest of a lumped pair take nothing.
/// @param include_as_force  also sum PairImpulses::as_force
template <int Dim>
void sum_impulses(const ContactNode<Dim>& node, const PairColumns<Dim>& pairs, bool include_as_force,
                  NodeMotion<Dim>& motion) {
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    const PairImpulses<Dim>& impulse = pairs.impulse[e];
    const bool moves_other = !pair.is_lumped() && pair.b != node.rigid;
    motion[pair.a].impulse += impulse.now;
    if (moves_other) motion[pair.b].impulse -= impulse.now;
    if (!include_as_force) continue;
    motion[pair.a].as_force += impulse.as_force;
    if (moves_other) motion[pair.b].as_force -= impulse.as_force;
  }
}

/// Adds the impulses to the momenta of the fields, here and on the grid.
template <int Dim>
void change_momenta(State<Dim>& state, NodeMotion<Dim>& motion) {
  for (auto& field : motion) {
    if (field.impulse.isZero(0)) continue;
    field.momentum += field.impulse;
    state.nodes.set(Nodal::momentum, field.slot, field.momentum);
  }
}

/// Adds (impulse + as_force)/Δt to the nodal forces, N.
template <int Dim>
void change_forces(State<Dim>& state, double dt, NodeMotion<Dim>& motion) {
  for (const auto& field : motion) {
    const Vec<Dim> force = (field.impulse + field.as_force) / dt;
    if (!force.isZero(0))
      state.nodes.set(Nodal::force, field.slot, state.nodes.vector(Nodal::force, field.slot) + force);
  }
}

/// Adds Δv = impulse/m of the first correction to the second half of Nodal::star, m/s (contact-aware XPIC).
template <int Dim>
void store_velocity_changes(State<Dim>& state, NodeMotion<Dim>& motion) {
  for (const auto& field : motion)
    for (int d = 0; d < Dim; ++d)
      state.nodes.column(Nodal::star, Dim + d)[field.slot] += field.impulse[d] * field.inverse_mass;
}

/// Subtracts from `as_force` the part of the second impulse that only closes the gap (force_part), on nodes
/// of two fields.
/// @pre solve_each_pair has left the trial states in the workspace
template <int Dim>
void remove_closing_part(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                         const NodeWorkspace<Dim>& work) {
  if (!pass.method.one_set) return;
  PairColumns<Dim>& pairs = pass.list.pairs;
  for (int e = node.pair_begin; e < node.explicit_begin; ++e) {
    const ContactPair& pair = pairs.pair[e];
    if (!pair.sole || !pairs.status[e].separable) continue;
    const Vec<Dim>& normal = pairs.geometry[e].normal;
    PairImpulses<Dim>& impulse = pairs.impulse[e];
    const double normal_impulse = impulse.now.dot(normal);
    const Trial<Dim>& trial = work.trials[static_cast<std::size_t>(e - node.pair_begin)];
    const double as_force =
        force_part(pass.method, pair, pairs.status[e], pairs.relative[e], normal, trial, normal_impulse);
    impulse.as_force -= (normal_impulse - as_force) * normal;
  }
}

/// 1/m_red of a pair, 1/kg.
template <int Dim>
double inverse_reduced_mass(const ContactNode<Dim>& node, const ContactPair& pair,
                            const NodeMotion<Dim>& motion) {
  return motion[pair.a].inverse_mass + (meets_rigid(node, pair) ? 0 : motion.inverse_mass_of(pair.a, pair.b));
}

bool is_lane_law(const AnyLaw& law) {
  return std::visit([](const auto& l) { return kDryFriction<std::decay_t<decltype(l)>>; }, law);
}

}  // namespace

template <int Dim>
Corrections<Dim>::Corrections(const Scene& scene, const Plan& plan, const PairLaws& laws)
    : spec_(scene.contact),
      laws_(laws),
      method_(scene, plan),
      solves_in_lanes_(plan.one_set && !plan.interface_springs && scene.cracks.empty() &&
                       laws.all(is_lane_law)),
      workspaces_(static_cast<std::size_t>(omp_get_max_threads())) {}

template <int Dim>
CorrectionPass<Dim> Corrections<Dim>::make_pass(State<Dim>& state, const FreeDirections<Dim>& free, double dt,
                                                const CorrectionRule& rule, bool may_stick,
                                                ContactList<Dim>& list) const {
  return {state, list, spec_, laws_, method_, free, rule, may_stick, dt};
}

/// FLIP moves particles by forces only. An approach that this correction removes from the grid in every step
/// would stay in the particles (N20 Eq. 33), and forces would act on velocities that the bodies do not have.
/// Therefore `first_share` of the impulse also counts as a force. The approach then decays within about
/// 1/first_share steps.
template <int Dim>
void Corrections<Dim>::correct_first(State<Dim>& state, const FreeDirections<Dim>& free,
                                     const StepTimes& times, ContactList<Dim>& list) {
  const CorrectionPass<Dim> pass =
      make_pass(state, free, times.dt, first_rule(method_), method_.strain_may_stick(), list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    work.motion.read(pass.fields(node));
    begin_active_set(pass, node, work.motion);
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
      if (method_.keeps_relative)
        pairs.relative[e].after_first = free.part(node, work.motion.relative_velocity(node, pairs.pair[e]));
    }
  };
  solve_nodes(pass, begin, finish);
}

template <int Dim>
void Corrections<Dim>::correct_second(State<Dim>& state, const FreeDirections<Dim>& free,
                                      const StepTimes& times, Interfaces<Dim>& interfaces,
                                      ContactList<Dim>& list) {
  const CorrectionPass<Dim> pass = make_pass(state, free, times.dt, second_rule(method_), true, list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    if (interfaces.active()) interfaces.apply(state, node, free, times.dt, list);
    work.motion.read(pass.fields(node));
    if (!method_.has_first) begin_active_set(pass, node, work.motion);
  };
  const bool include_as_force = method_.first_share > 0 || method_.one_set;
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    PairColumns<Dim>& pairs = list.pairs;
    remove_closing_part(pass, node, work);
    sum_impulses(node, pairs, include_as_force, work.motion);
    change_momenta(state, work.motion);
    change_forces(state, times.dt, work.motion);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      PairImpulses<Dim>& impulse = pairs.impulse[e];
      PairStatus& status = pairs.status[e];
      impulse.second = impulse.now + impulse.as_force;
      status.stuck = status.now == ContactStatus::stick;
      const Vec<Dim> relative = free.part(node, work.motion.relative_velocity(node, pair));
      if (!method_.third_ends_strain) pairs.relative[e].end = relative;
      if (!method_.one_set) {
        status.touching = !impulse.now.isZero(0);
        continue;
      }
      const Vec<Dim>& normal = pairs.geometry[e].normal;
      pairs.relative[e].after_second = relative;
      status.touching = still_touches(impulse, normal, status, work.motion[pair.a].mass, relative,
                                      state.grid.cell, times.dt);
      status.recovery_length =
          updated_recovery_length(impulse, normal, pairs.before[e],
                                  inverse_reduced_mass(node, pair, work.motion), times.crossing, times.dt);
    }
  };
  const Counts counts = solve_nodes(pass, begin, finish);
  list.counters.pair_nodes += counts.converged;
  list.counters.pair_fallbacks += counts.unconverged;
}

template <int Dim>
void Corrections<Dim>::correct_re_extrapolated(State<Dim>& state, const FreeDirections<Dim>& free,
                                               const StepTimes& times, ContactList<Dim>& list) {
  const CorrectionPass<Dim> pass =
      make_pass(state, free, times.dt, re_extrapolated_rule(method_), method_.strain_may_stick(), list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    work.motion.read(pass.fields(node));
  };
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    PairColumns<Dim>& pairs = list.pairs;
    sum_impulses(node, pairs, false, work.motion);
    change_momenta(state, work.motion);
    if (!method_.third_ends_strain) return;
    for (int e = node.pair_begin; e < node.pair_end; ++e)
      pairs.relative[e].end = free.part(node, work.motion.relative_velocity(node, pairs.pair[e]));
  };
  solve_nodes(pass, begin, finish);
}

/// With one active set, the tangential impulse of the second correction between surfaces that may part is a
/// force: it stays what it is in every order of FMPM. Friction found anew in each order makes energy, since
/// only normal impulses are a projection (theory, "XPIC and FMPM").
/// @return  on field a, N s; zero for pairs whose whole impulse each order finds
/// @pre impulse.second is the second correction's
template <int Dim>
Vec<Dim> Corrections<Dim>::force_of_friction(const PairColumns<Dim>& pairs, int e) const {
  if (!method_.one_set || !pairs.status[e].separable) return Vec<Dim>::Zero();
  return split(Vec<Dim>(pairs.impulse[e].second - pairs.impulse[e].as_force), pairs.geometry[e].normal)
      .tangential;
}

template <int Dim>
void Corrections<Dim>::take_out_impulses(State<Dim>& state, Nodal momenta,
                                         const ContactList<Dim>& list) const {
  using constants::threads::kFewNodes;
  const PairColumns<Dim>& pairs = list.pairs;
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), state.threads, kFewNodes, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    const auto take = [&](int field, const Vec<Dim>& impulse) {
      const int slot = list.fields[node.field_begin + field].slot;
      state.nodes.set(momenta, slot, state.nodes.vector(momenta, slot) - impulse);
    };
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      const Vec<Dim> found_anew = pairs.impulse[e].now - force_of_friction(pairs, e);
      take(pair.a, found_anew);
      if (!pair.is_lumped() && pair.b != node.rigid) take(pair.b, -found_anew);
    }
  });
}

template <int Dim>
void Corrections<Dim>::add_friction(const State<Dim>& state, ContactList<Dim>& list) const {
  for_each_pair(list, state.threads, [&](const ContactNode<Dim>&, int e) {
    list.pairs.impulse[e].now += force_of_friction(list.pairs, e);
  });
}

template <int Dim>
void Corrections<Dim>::correct_order(State<Dim>& state, const FreeDirections<Dim>& free,
                                     const StepTimes& times, ContactList<Dim>& list) {
  CorrectionRule rule = second_rule(method_);
  rule.friction = false;
  const CorrectionPass<Dim> pass = make_pass(state, free, times.dt, rule, method_.strain_may_stick(), list);
  const auto begin = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    work.motion.read(pass.fields(node));
  };
  const auto finish = [&](const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
    sum_impulses(node, list.pairs, false, work.motion);
    change_momenta(state, work.motion);
  };
  solve_nodes(pass, begin, finish);
}

/// Stores the relative velocities before any correction, and decides which pairs persist.
template <int Dim>
void Corrections<Dim>::begin_active_set(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                                        const NodeMotion<Dim>& motion) const {
  PairColumns<Dim>& pairs = pass.list.pairs;
  if (method_.keeps_relative)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      RelativeVelocities<Dim>& relative = pairs.relative[e];
      relative.start = relative.after_first =
          pass.free.part(node, motion.relative_velocity(node, pairs.pair[e]));
    }
  decide_persistence(method_, node, pass.cell(), pass.dt, pairs);
}

namespace {

/// One thread's share of the nodes of a correction. Nodes of three and four fields are queued until a batch
/// of lanes is full.
template <int Dim, class Begin, class Finish>
class NodeLoop {
 public:
  NodeLoop(const CorrectionPass<Dim>& pass, bool in_lanes, const Begin& begin, const Finish& finish,
           NodeWorkspace<Dim>& work)
      : pass_(pass), in_lanes_(in_lanes), begin_(begin), finish_(finish), work_(work) {}

  std::uint64_t converged() const { return converged_; }
  std::uint64_t unconverged() const { return unconverged_; }

  void solve(const ContactNode<Dim>& node) {
    const int fields = node.field_end - node.field_begin;
    begin_(node, work_);
    if (pass_.spec.fields == ManyFields::simultaneous && fields > 2)
      solve_many_fields(node, fields);
    else
      solve_pair_by_pair(node);
  }

  /// Solves the nodes that are still queued.
  void finish() {
    flush(work_.three_fields);
    flush(work_.four_fields);
  }

 private:
  void solve_many_fields(const ContactNode<Dim>& node, int fields) {
    prepare_simultaneous(pass_, node, work_);
    const bool queued = in_lanes_ && work_.responding.size() > 1;
    if (queued && fields == 3)
      add_to(node, work_.three_fields);
    else if (queued && fields == 4)
      add_to(node, work_.four_fields);
    else
      solve_alone(node);
  }

  void solve_pair_by_pair(const ContactNode<Dim>& node) {
    bool lumped = true;
    if (node.explicit_begin < node.pair_end) {
      const ExplicitOutcome outcome = solve_explicit_pairs(pass_, node, work_.motion);
      lumped = outcome == ExplicitOutcome::lumped;
      converged_ += outcome == ExplicitOutcome::solved;
      unconverged_ += lumped;
    }
    if (lumped) solve_each_pair(pass_, node, work_);
    finish_(node, work_);
  }

  void solve_alone(const ContactNode<Dim>& node) {
    const bool converged = solve_simultaneously(pass_, node, work_);
    converged_ += converged;
    unconverged_ += !converged;
    finish_(node, work_);
  }

  template <class Batch>
  void add_to(const ContactNode<Dim>& node, Batch& batch) {
    enqueue(pass_, node, work_, batch);
    if (batch.solver.is_full()) flush(batch);
  }

  /// Solves the nodes of a batch. The workspace holds the motion of another node by now, so it is read again;
  /// `begin` has acted already.
  template <class Batch>
  void flush(Batch& batch) {
    const int count = batch.solver.count();
    const unsigned solved = batch.solver.solve(pass_.may_stick);
    for (int lane = 0; lane < count; ++lane) {
      const ContactNode<Dim>& node = *batch.nodes[static_cast<std::size_t>(lane)];
      work_.motion.read(pass_.fields(node));
      if (!(solved >> lane & 1)) {
        prepare_simultaneous(pass_, node, work_);
        solve_alone(node);
        continue;
      }
      ++converged_;
      store_lane(node, batch.solver, lane, pass_.list.pairs);
      finish_(node, work_);
    }
  }

  const CorrectionPass<Dim>& pass_;
  bool in_lanes_;
  const Begin& begin_;
  const Finish& finish_;
  NodeWorkspace<Dim>& work_;
  std::uint64_t converged_ = 0, unconverged_ = 0;
};

}  // namespace

/// Solves all contact nodes of a correction, in parallel.
/// @param begin   begin(node, workspace): reads the motion of a node
/// @param finish  finish(node, workspace): adds the impulses of its pairs to its fields
template <int Dim>
template <class Begin, class Finish>
auto Corrections<Dim>::solve_nodes(const CorrectionPass<Dim>& pass, const Begin& begin, const Finish& finish)
    -> Counts {
  const ContactList<Dim>& list = pass.list;
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  const int threads = n <= constants::threads::kFewSolved ? 1 : pass.state.threads;
  std::atomic<std::uint64_t> converged{0}, unconverged{0};
  shares_.cut(threads, n, constants::threads::kSolvedAtOnce);
  on_threads(threads, [&](const TeamThread& me) {
    NodeLoop<Dim, Begin, Finish> loop(pass, solves_in_lanes_, begin, finish,
                                      workspaces_[static_cast<std::size_t>(me.thread)]);
    shares_.for_each(me.thread, [&](std::int64_t k) { loop.solve(list.nodes[k]); });
    loop.finish();
    converged += loop.converged();
    unconverged += loop.unconverged();
  });
  return {converged, unconverged};
}

template class Corrections<2>;
template class Corrections<3>;

}  // namespace mpmfast
