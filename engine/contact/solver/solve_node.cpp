#include "engine/contact/solver/solve_node.hpp"

namespace mpmfast {

namespace {

/// Calls f(law) with the acting law of pair e, in its own type.
template <int Dim, class Laws, class F>
void with_law(const CorrectionPass<Dim>& pass, const Laws& laws, const NodeFields<Dim>& fields,
              const ContactNode<Dim>& node, int e, const F& f) {
  const ContactPair& pair = pass.list.pairs.pair[e];
  const int number = Laws::by_pair ? pass.laws.number_between(fields, pair, partner(fields, node, pair))
                                   : PairLaws::kDefault;
  laws.with(number, [&](const auto& law) { with_acting_law(law, pass.list.pairs.is_broken(e), f); });
}

template <int Dim, class Laws>
void solve_each_pair_with(const CorrectionPass<Dim>& pass, const Laws& laws, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  const auto total = work.motion.total();
  work.trials.clear();
  for (int e = node.pair_begin; e < node.explicit_begin; ++e) {
    const Trial<Dim>& trial =
        work.trials.emplace_back(trial_of(pass.free, node, work.motion, pairs.pair[e].a, total));
    const double gap = predicted_gap(pass.method, pairs.geometry[e], pairs.before[e], trial, pass.dt);
    with_law(pass, laws, fields, node, e, [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      const Response<Dim> response =
          pair_response(pass, e, trial, gap, law, area_time_of<Law>(pass, fields, e));
      pairs.impulse[e].now = response.impulse;
      pairs.status[e].now = response.status;
      pairs.status[e].separable = Law::scope == LawScope::contact;
    });
  }
  open_pairs(pairs, node.explicit_begin, node.pair_end);  // solve_explicit_pairs acts on these
}

/// May a pair with this law have an impulse? The predicted gap of a pair without history must be negative.
template <class Law>
bool may_respond(double gap, bool in_active_set) {
  if (Law::scope == LawScope::nowhere || Law::scope == LawScope::interface) return false;
  return Law::scope != LawScope::contact || gap < 0 || in_active_set;
}

template <int Dim, class Laws>
void prepare_simultaneous_with(const CorrectionPass<Dim>& pass, const Laws& laws,
                               const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  auto& velocities = work.velocities;
  velocities.clear();
  for (int k = 0; k < fields.count(); ++k)
    velocities.push_back(pass.free.part(node, work.motion.velocity(k)));
  work.responding.clear();
  open_pairs(pairs, node.pair_begin, node.pair_end);
  const auto inverse_mass = [&](int k) { return fields.is_rigid(k) ? 0.0 : work.motion[k].inverse_mass; };
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    PairStatus& status = pairs.status[e];
    const double reduced_mass = 1 / (inverse_mass(pair.a) + inverse_mass(pair.b));  // one may be rigid
    const Vec<Dim> relative =
        velocities[static_cast<std::size_t>(pair.b)] - velocities[static_cast<std::size_t>(pair.a)];
    const Trial<Dim> trial{reduced_mass * relative, reduced_mass};
    status.predicted_gap = predicted_gap(pass.method, pairs.geometry[e], pairs.before[e], trial, pass.dt);
    const bool in_active_set =
        pass.method.one_set && (status.persistent || status.active_in_first || status.touching);
    with_law(pass, laws, fields, node, e, [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      if (!may_respond<Law>(status.predicted_gap, in_active_set)) return;
      RespondingPair<Dim>& responding = work.responding.emplace_back();
      responding.pair = e;
      responding.reduced_mass = reduced_mass;
      responding.area_time = area_time_of<Law>(pass, fields, e);
      responding.by_active_set = uses_active_set<Law>(pass.method);
      responding.separable = Law::scope == LawScope::contact;
      responding.rule = rule_for(pass, law, e, status.predicted_gap);
      if constexpr (std::is_same_v<Law, Coulomb>) responding.friction = law;
    });
  }
}

/// Copies the fields of a node and its responding pairs into the solver of the workspace.
template <int Dim>
void load_solver(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  const PairColumns<Dim>& pairs = pass.list.pairs;
  NodeSolver<Dim>& solver = work.solver;
  solver.fields.clear();
  solver.contacts.clear();
  for (int k = 0; k < fields.count(); ++k)
    solver.fields.push_back({work.velocities[static_cast<std::size_t>(k)],
                             fields.is_rigid(k) ? 0.0 : work.motion[k].inverse_mass});
  for (const RespondingPair<Dim>& responding : work.responding) {
    const int e = responding.pair;
    FieldContact<Dim>& contact = solver.contacts.emplace_back();
    contact.a = pairs.pair[e].a, contact.b = pairs.pair[e].b;
    contact.normal = pairs.geometry[e].normal;
    contact.reduced_mass = responding.reduced_mass;
    if (!pass.method.one_set) continue;
    contact.target_approach = pairs.status[e].target_approach;
    contact.bilateral = responding.rule.set.bilateral;
  }
}

/// The response of one pair while the others stay. @param trial  impulse that sticking would need, N s
template <int Dim, class Law>
Response<Dim> response_in_node(const RespondingPair<Dim>& responding, const FieldContact<Dim>& contact,
                               const PairStatus& status, const Law& law, const Vec<Dim>& trial) {
  if (!responding.by_active_set)
    return own_response(responding.rule, contact.normal, {trial, contact.reduced_mass}, status.predicted_gap,
                        law, responding.area_time);
  const auto all_of_it = [](double normal_impulse) { return normal_impulse; };  // see force_part
  return responding.rule.set.response(contact.normal, contact.target_approach, trial, contact.reduced_mass,
                                      law, responding.area_time, all_of_it);
}

template <int Dim, class Laws>
bool solve_simultaneously_with(const CorrectionPass<Dim>& pass, const Laws& laws,
                               const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  load_solver(pass, node, work);
  const bool converged = work.solver.solve([&](std::size_t k, const Vec<Dim>& trial) {
    const RespondingPair<Dim>& responding = work.responding[k];
    Response<Dim> response;
    with_law(pass, laws, fields, node, responding.pair, [&](const auto& law) {
      response =
          response_in_node(responding, work.solver.contacts[k], pairs.status[responding.pair], law, trial);
    });
    return response;
  });
  for (std::size_t k = 0; k < work.responding.size(); ++k) {
    const int e = work.responding[k].pair;
    pairs.impulse[e].now = work.solver.contacts[k].impulse;
    pairs.status[e].now = work.solver.contacts[k].status;
    pairs.status[e].separable = work.responding[k].separable;
  }
  return converged;
}

}  // namespace

template <int Dim>
void solve_each_pair(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                     NodeWorkspace<Dim>& work) {
  pass.laws.dispatch([&](const auto& laws) { solve_each_pair_with(pass, laws, node, work); });
}

template <int Dim>
void prepare_simultaneous(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work) {
  pass.laws.dispatch([&](const auto& laws) { prepare_simultaneous_with(pass, laws, node, work); });
}

template <int Dim>
bool solve_simultaneously(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work) {
  bool converged = false;
  pass.laws.dispatch(
      [&](const auto& laws) { converged = solve_simultaneously_with(pass, laws, node, work); });
  return converged;
}

template void solve_each_pair(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template void solve_each_pair(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);
template void prepare_simultaneous(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template void prepare_simultaneous(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);
template bool solve_simultaneously(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template bool solve_simultaneously(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);

}  // namespace mpmfast
