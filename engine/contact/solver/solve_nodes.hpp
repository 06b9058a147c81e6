#pragma once

/// @file The impulses of the contact pairs of one node: pair by pair, or all together.

#include <cstdint>

#include "engine/contact/impulses/correction_pass.hpp"
#include "engine/contact/impulses/node_workspace.hpp"

namespace mpmfast {

/// Impulses of the pairs of a node but the explicit ones, each by itself, from the momenta before any of them
/// changes. Each pair's trial state is left in the workspace.
template <int Dim>
void solve_pairs(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work);

/// The pairs of a node that may have an impulse, in `responding`, with their predicted gaps. A law of
/// touching surfaces asks nothing of surfaces that stay apart.
template <int Dim>
void find_responding(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work);

/// Impulses of all pairs that find_responding found, together. @return whether they converged
template <int Dim>
bool solve_together(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work);

/// Adds a node that find_responding was called for to those that wait.
template <int Dim, int kFields>
void wait_in_lane(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                  const NodeWorkspace<Dim>& work, WaitingNodes<Dim, kFields>& waiting) {
  const int lane = waiting.solver.begin_node();
  const NodeFields<Dim> fields = pass.fields(node);
  const PairColumns<Dim>& pairs = pass.list.pairs;
  waiting.nodes[static_cast<std::size_t>(lane)] = &node;
  for (int k = 0; k < kFields; ++k)
    waiting.solver.set_field(lane, k, work.velocities[static_cast<std::size_t>(k)],
                             fields.is_rigid(k) ? 0.0 : work.motion[k].inverse_mass);
  for (const RespondingPair<Dim>& responding : work.responding) {
    const int e = responding.pair;
    waiting.solver.add_contact(lane, pairs.pair[e].a, pairs.pair[e].b, pairs.geometry[e].normal,
                               responding.reduced, pairs.status[e].target_approach, responding.rule.set,
                               responding.friction);
  }
}

/// Takes the impulses of a node that was solved in a lane.
template <int Dim, int kFields>
void take_from_lane(const ContactNode<Dim>& node, const LaneSolver<Dim, kFields>& solver, int lane,
                    PairColumns<Dim>& pairs) {
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    if (!solver.has(lane, pair.a, pair.b)) continue;
    pairs.impulse[e].now = solver.impulse(lane, pair.a, pair.b);
    pairs.status[e].now = solver.sticks(lane, pair.a, pair.b) ? ContactStatus::stick : ContactStatus::slip;
    pairs.status[e].separable = true;
  }
}

}  // namespace mpmfast
