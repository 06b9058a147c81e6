#pragma once

/// @file Crack sides and their velocity fields. A crack has a left and a right side. A node near one or two
/// cracks has up to four sides: 0 is left of both cracks, 1 right of the first, 2 right of the second, 3
/// right of both. Sides belong to the material, not to the node: a node that a crack passes keeps its fields.
/// (NN section 1.1 numbers the sides from the node.) All other nodes have side 0 only.

#include <utility>
#include <vector>

#include "engine/cracks/cracked_nodes.hpp"
#include "engine/cracks/element.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// The velocity fields of crack sides. Side 0 has the field of the body; sides 1, 2 and 3 follow each other.
class SideFields {
 public:
  /// @param first  by field: the field of its side 1; −1: no crack lies in its body (Plan::first_side)
  explicit SideFields(std::vector<int> first) : first_(std::move(first)) {}

  /// Does a crack lie in the body of this field?
  bool cracked(int field) const { return element(first_, field) >= 0; }
  /// @param body_field  by field: the field of the body (State::field_base)
  int side(const std::vector<int>& body_field, int field) const {
    const int body = element(body_field, field);
    return field == body ? 0 : field - element(first_, body) + 1;
  }
  /// Calls f(field) for the fields of all sides of a body, from side 0 on.
  template <class F>
  void for_each(const std::vector<int>& body_field, int body, const F& f) const {
    f(body);
    const auto fields = static_cast<int>(body_field.size());
    for (int field = element(first_, body); field < fields && element(body_field, field) == body; ++field)
      f(field);
  }

 private:
  std::vector<int> first_;
};

/// The crack between two fields of a node, which are sides of one body.
template <int Dim>
struct CrackContact {
  int crack = -1;                      ///< −1: none
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, from the first field to the second
  bool beyond = false;                 ///< both fields lie on the right of the other crack of the node
};

/// Which crack of a node lies between two sides: 0 or 1; −1: none, or both. Sides that two cracks separate
/// meet in a point only and have no contact.
/// @param alone  the node has these two sides only: two cracks between them coincide, and the first counts
constexpr int crack_between(int side_a, int side_b, bool alone) {
  const int differ = side_a ^ side_b;
  if (differ == 3) return alone ? 0 : -1;
  return differ - 1;
}

/// @param node  null: the node is not cracked
/// @param k     crack_between of the sides, 0 or 1
template <int Dim>
CrackContact<Dim> contact_at(const CrackedNode<Dim>* node, int k, int side_a, int side_b);

}  // namespace mpmfast
