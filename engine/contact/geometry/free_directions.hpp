#pragma once

/// @file The directions of a contact node that velocity conditions leave free.

#include <cstdint>
#include <limits>

#include "engine/conditions/conditions.hpp"
#include "engine/constants.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// Projects vectors onto the directions in which velocity conditions leave a node free.
template <int Dim>
struct FreeDirections {
  const Conditions<Dim>* conditions = nullptr;

  Vec<Dim> part(const ContactNode<Dim>& node, const Vec<Dim>& x) const {
    return node.constrained ? conditions->free_part({node.constrained_combination, node.constrained_axes}, x)
                            : x;
  }
};

/// Yields the prescribed directions of each node to the velocity conditions; contact acts in the others.
///
/// Conditions and contact together are then one projection. If each corrected the other in turn, the
/// velocities in the strain, the force and v′ would differ, and grains that jam at a wall would gain energy
/// without bound. A gap d along n is closed by moving d/|n_free| along n_free.
template <int Dim>
void yield_constrained_directions(const FreeDirections<Dim>& free, int threads, ContactList<Dim>& list) {
  using constants::contact::kLeastFreeNormal, constants::threads::kFewNodes;
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), threads, kFewNodes, [&](std::int64_t k) {
    ContactNode<Dim>& node = list.nodes[k];
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const auto constraint = free.conditions->constraint(list.fields[f].slot);
      node.constrained_combination = std::max(node.constrained_combination, constraint.combination);
      node.constrained_axes |= constraint.axes;
      node.constrained |= constraint.any();
    }
    if (!node.constrained) return;
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      PairGeometry<Dim>& geometry = list.pairs.geometry[e];
      const Vec<Dim> along = free.part(node, geometry.normal);
      const double length = along.norm();
      geometry.normal = length > kLeastFreeNormal ? Vec<Dim>(along / length) : Vec<Dim>::Zero();
      geometry.separation =
          length > kLeastFreeNormal ? geometry.separation / length : std::numeric_limits<double>::infinity();
    }
  });
}

}  // namespace mpmfast
