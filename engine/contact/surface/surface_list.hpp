#pragma once

/// @file The points where surfaces meet, and the nodes whose velocities they read and change: columns, one
/// element a point or a node.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/conditions/conditions.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "kernels/contact/active_set_rule.hpp"

namespace mpmfast {

/// Where a point lies, and which surfaces meet there.
template <int Dim>
struct PointGeometry {
  Vec<Dim> position;  ///< m
  Vec<Dim> normal;    ///< unit, from field a to field b
  double separation;  ///< m, negative: overlap
  int field_a, field_b;
  int law;           ///< PairLaws number
  bool meets_rigid;  ///< field b is a rigid body
  bool forward;      ///< field a is the first of the two that the scene names for this law
};

/// The nodes of the cell around a point, of fields a and b, with the weights that multilinear functions have
/// there. The weights of each field have the sum 1. In place of a node without mass or weight stands another
/// one of the field, with the weight 0.
template <int Dim>
struct PointStencil {
  static constexpr int kNodes = 1 << Dim;

  std::array<int, kNodes> node[2];  ///< into SurfaceList::nodes
  std::array<double, kNodes> weight[2];
};

/// A point while impulses are found: all that a sweep reads and writes of it, beside its stencil.
template <int Dim>
struct PointSolve {
  double reduced_mass;  ///< m_red = 1/Σ w² Σ_d n_d²/m_d over the nodes of both fields, kg; 0: none moves
  Vec<Dim> trial;       ///< impulse that sticking would need while the others stay, N s
  Vec<Dim> normal;      ///< as PointGeometry
  Vec<Dim> impulse;     ///< so far, N s
  double target_approach;   ///< as PairStatus, m/s
  int law;                  ///< as PointGeometry
  ActiveSetRule<Dim> rule;  ///< of the correction
  ContactStatus status;     ///< so far
};

/// A velocity field on a node that points reach.
template <int Dim>
struct SurfaceNode {
  int slot;
  double mass;  ///< kg
  typename Conditions<Dim>::Constraint constraint;
  Vec<Dim> impulse;   ///< of the correction, N s
  Vec<Dim> as_force;  ///< what counts as a force beside it, N s
};

/// How impulses move a node: all that a sweep reads and writes of it.
template <int Dim>
struct NodeResponse {
  Vec<Dim> velocity;      ///< m/s, with the impulses so far
  Vec<Dim> inverse_mass;  ///< by axis; 0: rigid, or prescribed by conditions, 1/kg
};

template <int Dim>
struct SurfaceList {
  Indexed<PointGeometry<Dim>> geometry;
  Indexed<PointStencil<Dim>> stencil;
  Indexed<PointSolve<Dim>> solve;
  Indexed<PairHistory> before;
  Indexed<PairStatus> status;
  Indexed<PairImpulses<Dim>> impulse;
  Indexed<RelativeVelocities<Dim>> relative;
  Indexed<SurfaceNode<Dim>> nodes;
  Indexed<NodeResponse<Dim>> responses;  ///< of the nodes
  /// By colour: the first point of each block of nodes, and the one after its last. Blocks of one colour
  /// never share a node.
  std::array<std::vector<std::array<int, 2>>, kCorners<Dim>> blocks;

  std::size_t size() const { return geometry.size(); }
  void resize(std::size_t points) {
    geometry.resize(points);
    stencil.resize(points);
    solve.resize(points);
    before.resize(points);
    status.resize(points);
    impulse.resize(points);
    relative.resize(points);
  }

  /// v_b − v_a at a point, m/s.
  Vec<Dim> relative_velocity(int p) const { return velocity_of(p, 1) - velocity_of(p, 0); }
  /// The velocity of field a (0) or b (1) at a point, m/s.
  Vec<Dim> velocity_of(int p, int side) const {
    Vec<Dim> v = Vec<Dim>::Zero();
    for (std::size_t c = 0; c < PointStencil<Dim>::kNodes; ++c)
      v += stencil[p].weight[side][c] * responses[stencil[p].node[side][c]].velocity;
    return v;
  }
  /// Calls f(node, share) with the number of each node of a point, where the share of an impulse on field a
  /// is positive.
  template <class F>
  void for_each_node(int p, const F& f) const {
    for (int side = 0; side < 2; ++side)
      for (std::size_t c = 0; c < PointStencil<Dim>::kNodes; ++c)
        f(stencil[p].node[side][c], side == 0 ? stencil[p].weight[side][c] : -stencil[p].weight[side][c]);
  }
};

}  // namespace mpmfast
