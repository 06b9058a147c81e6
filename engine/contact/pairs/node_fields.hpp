#pragma once

/// @file The velocity fields of one contact node, as the grid has them.

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

template <int Dim>
class NodeFields {
 public:
  NodeFields(const State<Dim>& state, const Indexed<ContactField>& fields, const ContactNode<Dim>& node)
      : state_(&state),
        fields_(fields.data() + node.field_begin),
        count_(node.field_end - node.field_begin) {}
  NodeFields(const State<Dim>& state, const ContactList<Dim>& list, const ContactNode<Dim>& node)
      : NodeFields(state, list.fields, node) {}

  int count() const { return count_; }
  int field(int k) const { return fields_[k].field; }
  int slot(int k) const { return fields_[k].slot; }
  bool is_rigid(int k) const { return state_->field_rigid[static_cast<std::size_t>(field(k))]; }
  double mass(int k) const { return value(Nodal::mass, k); }
  double volume(int k) const { return value(Nodal::volume, k); }
  double value(Nodal quantity, int k) const { return state_->nodes.column(quantity)[slot(k)]; }
  Vec<Dim> vector(Nodal quantity, int k) const { return state_->nodes.vector(quantity, slot(k)); }

 private:
  const State<Dim>* state_;
  const ContactField* fields_;
  int count_;
};

/// The field that field a of a pair meets. For a lumped pair it is the rigid one, or the one of the largest
/// volume, whose law then holds for all others (N20 after Eq. 50).
template <int Dim>
int partner(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, const ContactPair& pair) {
  if (!pair.is_lumped()) return pair.b;
  if (node.rigid >= 0) return node.rigid;
  int largest{};
  double most = -1;
  for (int k = 0; k < fields.count(); ++k)
    if (const double volume = fields.volume(k); k != pair.a && volume > most) largest = k, most = volume;
  return largest;
}

/// Does field a meet the rigid body of the node?
template <int Dim>
bool meets_rigid(const ContactNode<Dim>& node, const ContactPair& pair) {
  return node.rigid >= 0 && (pair.is_lumped() || pair.b == node.rigid);
}

}  // namespace mpmfast
