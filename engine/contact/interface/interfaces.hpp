#pragma once

/// @file Interfaces (NN chapter 5): springs on the displacement jump of two fields at a node.

#include <vector>

#include "engine/contact/geometry/free_directions.hpp"
#include "engine/contact/impulses/node_motion.hpp"
#include "engine/contact/interface/bonds.hpp"
#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/pairs/pair_laws.hpp"

namespace mpmfast {

/// Sums over an interface on the nodes around one: areas, m², and the mean of the extrapolated jumps, m.
template <int Dim>
struct InterfaceAround {
  Vec<Dim> jump = Vec<Dim>::Zero();
  double own_area{}, mean_area{};
  bool integrated = false;  ///< the mean is that of known jumps
};

/// Do springs or bonds join surfaces of the node?
template <int Dim>
bool has_springs(const ContactList<Dim>& list, const ContactNode<Dim>& node) {
  if (list.pairs.spring.empty()) return false;
  const auto begin = list.pairs.spring.begin();
  return std::any_of(begin + node.pair_begin, begin + node.pair_end, [](const auto& s) { return s.acts; });
}

template <int Dim>
class Interfaces {
 public:
  /// All of these must outlive it.
  Interfaces(const Scene& scene, const Plan& plan, const PairLaws& laws, const Cracks<Dim>& cracks);

  /// Does the scene have any?
  bool active() const { return active_; }
  /// Jumps, areas and bonds of all pairs at the start of a step; separations of pairs with springs.
  void find(const State<Dim>& state, ContactList<Dim>& list) const;
  /// The impulses of the springs of a node in one step, as forces on its fields.
  void apply(State<Dim>& state, const ContactNode<Dim>& node, const FreeDirections<Dim>& free, double dt,
             ContactList<Dim>& list);
  /// Jumps and damage at the end of the step, and the energies of the ledger.
  void end(const State<Dim>& state, const FreeDirections<Dim>& free, double dt, ContactList<Dim>& list,
           ContactLedger<Dim>& ledger);

 private:
  void find_pair(const State<Dim>& state, const ContactNode<Dim>& node, int e, ContactList<Dim>& list) const;
  bool start(const State<Dim>& state, const ContactNode<Dim>& node, int e, const FreeDirections<Dim>& free,
             double dt, ContactList<Dim>& list) const;
  InterfaceAround<Dim> sum_around(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                                  const ContactList<Dim>& list) const;
  void solve_node(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, int acting,
                  const FreeDirections<Dim>& free, double dt, ContactList<Dim>& list,
                  std::vector<Vec<Dim>>& impulses) const;
  Vec<Dim> impulse_of(const AnyLaw& law, const Bond<Dim>* bond, const Vec<Dim>& external, double dt,
                      bool alone, InterfaceSpring<Dim>& spring) const;
  void end_jumps(const State<Dim>& state, const FreeDirections<Dim>& free, double dt, ContactList<Dim>& list);

  const ContactSpec& spec_;
  const PairLaws& laws_;
  const Cracks<Dim>& cracks_;
  bool active_, bonds_active_;
  Bonds<Dim> bonds_;
  NodeMotion<Dim> motion_;
  std::vector<std::vector<Vec<Dim>>> impulses_;  ///< by thread: on the fields of a node, N s
};

extern template class Interfaces<2>;
extern template class Interfaces<3>;

}  // namespace mpmfast
