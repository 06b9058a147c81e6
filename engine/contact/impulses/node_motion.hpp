#pragma once

/// @file The velocity fields of one node while a correction acts on them.

#include <vector>

#include "engine/contact/pairs/node_fields.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// The masses and momenta of the fields of one node, and what a correction adds to them.
template <int Dim>
class NodeMotion {
 public:
  struct Field {
    int slot;
    double mass, inverse_mass;  ///< kg, 1/kg
    Vec<Dim> momentum;          ///< N s
    Vec<Dim> impulse;           ///< of the correction, N s
    Vec<Dim> as_force;          ///< what counts as a force beside it, N s
  };

  void clear() { fields_.clear(); }
  /// The fields of a node as they move at present.
  void read(const NodeFields<Dim>& fields) {
    clear();
    for (int k = 0; k < fields.count(); ++k)
      push(fields.slot(k), fields.mass(k), fields.vector(Nodal::momentum, k));
  }
  void push(int slot, double mass, const Vec<Dim>& momentum) {
    fields_.push_back({slot, mass, 1 / mass, momentum, Vec<Dim>::Zero(), Vec<Dim>::Zero()});
  }
  Field& operator[](int k) { return fields_[static_cast<std::size_t>(k)]; }
  const Field& operator[](int k) const { return fields_[static_cast<std::size_t>(k)]; }
  auto begin() { return fields_.begin(); }
  auto end() { return fields_.end(); }
  Vec<Dim> velocity(int k) const { return (*this)[k].inverse_mass * (*this)[k].momentum; }

  struct Total {
    double mass = 0;
    Vec<Dim> momentum = Vec<Dim>::Zero();
  };
  /// All fields, or the two of a pair.
  Total total(int a = -1, int b = -1) const {
    Total sum;
    for (int k = 0; k < static_cast<int>(fields_.size()); ++k) {
      if (b >= 0 && k != a && k != b) continue;
      sum.mass += (*this)[k].mass;
      sum.momentum += (*this)[k].momentum;
    }
    return sum;
  }
  /// All others of a lumped pair. (Summed, not subtracted from all: beside a heavy field, light ones would be
  /// round-off.)
  Total others_than(int a) const {
    Total sum;
    for (int k = 0; k < static_cast<int>(fields_.size()); ++k) {
      if (k == a) continue;
      sum.mass += (*this)[k].mass;
      sum.momentum += (*this)[k].momentum;
    }
    return sum;
  }
  /// v_b − v_a, m/s. @param b  −1: all others, lumped
  Vec<Dim> relative_velocity(int a, int b) const {
    if (b >= 0) return velocity(b) - velocity(a);
    const Total others = others_than(a);
    return others.momentum / others.mass - velocity(a);
  }
  /// v_b − v_a of a pair, m/s; b of a lumped one is the rigid body where the node has one.
  Vec<Dim> relative_velocity(const ContactNode<Dim>& node, const ContactPair& pair) const {
    return relative_velocity(pair.a, pair.is_lumped() ? node.rigid : pair.b);
  }
  /// Of b, or of all but a, 1/kg.
  double inverse_mass_of(int a, int b) const {
    return b >= 0 ? (*this)[b].inverse_mass : 1 / others_than(a).mass;
  }

 private:
  std::vector<Field> fields_;
};

}  // namespace mpmfast
