#pragma once

/// @file The bonds of a contact list (kernels/contact/bond.hpp): which there are, and how their damage moves
/// with the bodies from node to node.

#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/cracks/cracks.hpp"

namespace mpmfast {

template <int Dim>
class Bonds {
 public:
  /// All of these must outlive it.
  Bonds(const Scene& scene, const PairLaws& laws, const Cracks<Dim>& cracks)
      : spec_(scene.contact), laws_(laws), cracks_(cracks) {}

  /// The damage of all bonds at the start of a step.
  void find(const State<Dim>& state, ContactList<Dim>& list) const;
  /// Which bonds follow those around them, by the areas that nodes have of the surface.
  void find_followers(const State<Dim>& state, ContactList<Dim>& list) const;
  /// Moves damage with the bodies over a step.
  void carry(const State<Dim>& state, double dt, ContactList<Dim>& list) const;

 private:
  template <class F>
  void for_each(const State<Dim>& state, const ContactList<Dim>& list, const F& f) const;
  bool is_cracked(const State<Dim>& state, const ContactNode<Dim>& node, const ContactPair& pair) const;
  void take_nearest(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                    ContactList<Dim>& list) const;

  const ContactSpec& spec_;
  const PairLaws& laws_;
  const Cracks<Dim>& cracks_;
};

extern template class Bonds<2>;
extern template class Bonds<3>;

}  // namespace mpmfast
