#include "engine/contact/solver/solve_nodes.hpp"

namespace mpmfast {

namespace {

/// Calls f with the acting law of pair e.
template <int Dim, class Laws, class F>
void with_law(const CorrectionPass<Dim>& pass, const Laws& laws, const NodeFields<Dim>& fields,
              const ContactNode<Dim>& node, int e, const F& f) {
  const ContactPair& pair = pass.list.pairs.pair[e];
  const int number = Laws::by_pair ? pass.laws.number_between(fields, pair, partner(fields, node, pair)) : -1;
  laws.with(number, [&](const auto& law) { with_acting_law(law, pass.list.pairs.is_broken(e), f); });
}

template <int Dim, class Laws>
void solve_pairs_with(const CorrectionPass<Dim>& pass, const Laws& laws, const ContactNode<Dim>& node,
                      NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  const auto all = work.motion.total();
  work.trials.clear();
  for (int e = node.pair_begin; e < node.explicit_begin; ++e) {
    const Trial<Dim>& trial =
        work.trials.emplace_back(trial_of(pass.free, node, work.motion, pairs.pair[e].a, all));
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
  open_pairs(pairs, node.explicit_begin, node.pair_end);
}

template <int Dim, class Laws>
void find_responding_with(const CorrectionPass<Dim>& pass, const Laws& laws, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  auto& velocities = work.velocities;
  velocities.clear();
  for (int k = 0; k < fields.count(); ++k) velocities.push_back(pass.free(node, work.motion.velocity(k)));
  work.responding.clear();
  open_pairs(pairs, node.pair_begin, node.pair_end);
  const auto inverse_mass = [&](int k) { return fields.is_rigid(k) ? 0.0 : work.motion[k].inverse_mass; };
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    PairStatus& status = pairs.status[e];
    const double reduced = 1 / (inverse_mass(pair.a) + inverse_mass(pair.b));
    const Trial<Dim> trial{reduced * (velocities[static_cast<std::size_t>(pair.b)] -
                                      velocities[static_cast<std::size_t>(pair.a)]),
                           reduced};
    const double gap = status.predicted_gap =
        predicted_gap(pass.method, pairs.geometry[e], pairs.before[e], trial, pass.dt);
    with_law(pass, laws, fields, node, e, [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      const bool known =
          pass.method.one_set && (status.persistent || status.active_in_first || status.touching);
      if (Law::scope == LawScope::nowhere || Law::scope == LawScope::interface) return;
      if (Law::scope == LawScope::contact && !(gap < 0) && !known) return;
      RespondingPair<Dim>& responding = work.responding.emplace_back();
      responding.pair = e;
      responding.reduced = reduced;
      responding.area_time = area_time_of<Law>(pass, fields, e);
      responding.in_set = uses_set<Law>(pass.method);
      responding.rule = rule_for(pass, law, e, gap);
      if constexpr (std::is_same_v<Law, Coulomb>) responding.friction = law;
    });
  }
}

/// Hands the fields and the responding pairs of a node to its solver.
template <int Dim>
void pose(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
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
    contact.reduced = responding.reduced;
    if (!pass.method.one_set) continue;
    contact.target_approach = pairs.status[e].target_approach;
    contact.bilateral = responding.rule.set.bilateral;
  }
}

template <int Dim, class Laws>
bool solve_together_with(const CorrectionPass<Dim>& pass, const Laws& laws, const ContactNode<Dim>& node,
                         NodeWorkspace<Dim>& work) {
  const NodeFields<Dim> fields = pass.fields(node);
  PairColumns<Dim>& pairs = pass.list.pairs;
  pose(pass, node, work);
  const bool converged = work.solver.solve([&](std::size_t k, const Vec<Dim>& trial) {
    const RespondingPair<Dim>& responding = work.responding[k];
    const FieldContact<Dim>& contact = work.solver.contacts[k];
    Response<Dim> response;
    with_law(pass, laws, fields, node, responding.pair, [&](const auto& law) {
      response = responding.in_set
                     ? responding.rule.set.response(contact.normal, contact.target_approach, trial,
                                                    contact.reduced, law, responding.area_time,
                                                    [](double normal_impulse) { return normal_impulse; })
                     : own_response(responding.rule, contact.normal, {trial, contact.reduced},
                                    pairs.status[responding.pair].predicted_gap, law, responding.area_time);
    });
    return response;
  });
  for (std::size_t k = 0; k < work.responding.size(); ++k) {
    const int e = work.responding[k].pair;
    pairs.impulse[e].now = work.solver.contacts[k].impulse;
    pairs.status[e].now = work.solver.contacts[k].status;
    with_law(pass, laws, fields, node, e,
             [&](const auto& law) { pairs.status[e].separable = law.scope == LawScope::contact; });
  }
  return converged;
}

}  // namespace

template <int Dim>
void solve_pairs(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
  pass.laws.dispatch([&](const auto& laws) { solve_pairs_with(pass, laws, node, work); });
}

template <int Dim>
void find_responding(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                     NodeWorkspace<Dim>& work) {
  pass.laws.dispatch([&](const auto& laws) { find_responding_with(pass, laws, node, work); });
}

template <int Dim>
bool solve_together(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work) {
  bool converged = false;
  pass.laws.dispatch([&](const auto& laws) { converged = solve_together_with(pass, laws, node, work); });
  return converged;
}

template void solve_pairs(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template void solve_pairs(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);
template void find_responding(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template void find_responding(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);
template bool solve_together(const CorrectionPass<2>&, const ContactNode<2>&, NodeWorkspace<2>&);
template bool solve_together(const CorrectionPass<3>&, const ContactNode<3>&, NodeWorkspace<3>&);

}  // namespace mpmfast
