#pragma once

/// @file The impulses of the contact pairs of one node: pair by pair, or all together.

#include <cstdint>

#include "engine/contact/impulses/correction_pass.hpp"
#include "engine/contact/impulses/node_workspace.hpp"

namespace mpmfast {

/// Finds the impulse of each pair by itself, but of the explicit ones, from the momenta before any of them
/// changes. The trial states are left in the workspace.
template <int Dim>
void solve_each_pair(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, NodeWorkspace<Dim>& work);

/// Prepares a simultaneous solve of a node. Projects the velocities of its fields onto the free directions,
/// opens all pairs, predicts their gaps, and lists in `responding` those that may have an impulse.
template <int Dim>
void prepare_simultaneous(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work);

/// Finds the impulses of all responding pairs together. @return whether they converged
template <int Dim>
bool solve_simultaneously(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                          NodeWorkspace<Dim>& work);

/// Adds a prepared node to a batch of lanes.
template <int Dim, int kFields>
void enqueue(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node, const NodeWorkspace<Dim>& work,
             LaneBatch<Dim, kFields>& batch) {
  const int lane = batch.solver.begin_node();
  const NodeFields<Dim> fields = pass.fields(node);
  const PairColumns<Dim>& pairs = pass.list.pairs;
  batch.nodes[static_cast<std::size_t>(lane)] = &node;
  for (int k = 0; k < kFields; ++k)
    batch.solver.set_field(lane, k, work.velocities[static_cast<std::size_t>(k)],
                           fields.is_rigid(k) ? 0.0 : work.motion[k].inverse_mass);
  for (const RespondingPair<Dim>& responding : work.responding) {
    const int e = responding.pair;
    batch.solver.add_contact(lane, pairs.pair[e].a, pairs.pair[e].b, pairs.geometry[e].normal,
                             responding.reduced_mass, pairs.status[e].target_approach, responding.rule.set,
                             responding.friction);
  }
}

/// Stores the impulses of a node that was solved in a lane.
template <int Dim, int kFields>
void store_lane(const ContactNode<Dim>& node, const LaneSolver<Dim, kFields>& solver, int lane,
                PairColumns<Dim>& pairs) {
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = pairs.pair[e];
    if (!solver.has(lane, pair.a, pair.b)) continue;
    pairs.impulse[e].now = solver.impulse(lane, pair.a, pair.b);
    pairs.status[e].now = solver.status(lane, pair.a, pair.b);
    pairs.status[e].separable = true;
  }
}

}  // namespace mpmfast
