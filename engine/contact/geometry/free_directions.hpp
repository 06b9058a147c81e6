#pragma once

/// @file What velocity conditions leave of a node to contact.

#include <cstdint>
#include <limits>

#include "engine/conditions/conditions.hpp"
#include "engine/constants.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// The part of a vector along the directions in which conditions leave a node free.
template <int Dim>
struct FreeDirections {
  const Conditions<Dim>* conditions = nullptr;

  Vec<Dim> operator()(const ContactNode<Dim>& node, const Vec<Dim>& x) const {
    return node.constrained ? conditions->free_part({node.constrained_combination, node.constrained_axes}, x)
                            : x;
  }
};

/// Yields the directions that conditions prescribe on a node to them; contact acts in the others.
///
/// A wall and a contact that correct each other in turn are no projection. They hold different velocities in
/// the strain, the force and v′, which makes energy without end where grains jam at a wall. With this, both
/// are one projection. A gap d along n is closed by moving d/|n_free| along n_free.
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
      const Vec<Dim> along = free(node, geometry.normal);
      const double length = along.norm();
      geometry.normal = length > kLeastFreeNormal ? Vec<Dim>(along / length) : Vec<Dim>::Zero();
      geometry.separation =
          length > kLeastFreeNormal ? geometry.separation / length : std::numeric_limits<double>::infinity();
    }
  });
}

}  // namespace mpmfast
