#pragma once

/// @file The workspace in which one thread solves the contact pairs of a node.

#include <array>
#include <vector>

#include "engine/contact/active_set/active_set.hpp"
#include "engine/contact/impulses/node_motion.hpp"
#include "kernels/contact/lane_solver.hpp"
#include "kernels/contact/node_solver.hpp"

namespace mpmfast {

/// A pair that may have an impulse in a simultaneous solve of its node.
template <int Dim>
struct RespondingPair {
  int pair;                    ///< into ContactList::pairs
  double reduced_mass;         ///< m_red, kg
  double area_time{};          ///< A_c Δt, m² s, for laws that use the area
  bool by_active_set = false;  ///< the active set of the step decides, else the law alone (own_response)
  bool separable = false;      ///< as PairStatus::separable
  PairRule<Dim> rule;
  Coulomb friction;  ///< where that is its law
};

/// Nodes of kFields fields that are solved at once, one in each lane.
template <int Dim, int kFields>
struct LaneBatch {
  LaneSolver<Dim, kFields> solver;
  std::array<const ContactNode<Dim>*, kLanes> nodes;
};

template <int Dim>
struct alignas(64) NodeWorkspace {
  NodeMotion<Dim> motion;
  std::vector<Trial<Dim>> trials;    ///< by pair of the node, where pairs are solved one by one
  std::vector<Vec<Dim>> velocities;  ///< of its fields, in the free directions, m/s
  std::vector<RespondingPair<Dim>> responding;
  NodeSolver<Dim> solver;  ///< its contacts are `responding`
  LaneBatch<Dim, 3> three_fields;
  LaneBatch<Dim, 4> four_fields;
};

}  // namespace mpmfast
