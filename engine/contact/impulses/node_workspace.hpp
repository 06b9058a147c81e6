#pragma once

/// @file What one thread solves the contact pairs of a node in.

#include <array>
#include <vector>

#include "engine/contact/active_set/active_set.hpp"
#include "engine/contact/impulses/node_motion.hpp"
#include "kernels/contact/lane_solver.hpp"
#include "kernels/contact/node_solver.hpp"

namespace mpmfast {

/// A pair of a node that may have an impulse while all pairs are solved together.
template <int Dim>
struct RespondingPair {
  int pair;             ///< into ContactList::pairs
  double reduced;       ///< m_red, kg
  double area_time{};   ///< A_c Δt, m² s, for laws that use the area
  bool in_set = false;  ///< the rule of the active set holds
  PairRule<Dim> rule;
  Coulomb friction;  ///< where that is its law
};

/// Nodes of so many fields that wait to be solved in lanes.
template <int Dim, int kFields>
struct WaitingNodes {
  LaneSolver<Dim, kFields> solver;
  std::array<const ContactNode<Dim>*, kLanes> nodes;
};

template <int Dim>
struct alignas(64) NodeWorkspace {
  NodeMotion<Dim> motion;
  std::vector<Trial<Dim>> trials;    ///< by pair of the node, where pairs are solved one by one
  std::vector<Vec<Dim>> velocities;  ///< of its fields, along what conditions leave free, m/s
  std::vector<RespondingPair<Dim>> responding;
  NodeSolver<Dim> solver;  ///< its contacts are `responding`
  WaitingNodes<Dim, 3> of_three;
  WaitingNodes<Dim, 4> of_four;
};

}  // namespace mpmfast
