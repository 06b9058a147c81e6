#pragma once

/// @file Contact on nodes between velocity fields (theory §4): the phases of a step, in the order in which
/// the step calls them.

#include <memory>
#include <vector>

#include "engine/contact/contact_basis.hpp"
#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {

template <int Dim>
class Conditions;
template <int Dim>
class Cracks;

template <int Dim>
class Contact {
 public:
  /// All of these must outlive it.
  Contact(const Scene& scene, const Plan& plan, const Cracks<Dim>& cracks);
  ~Contact();

  /// Pairs: lists the nodes where two or more fields have mass, with the contact pairs there.
  void find_pairs(const State<Dim>& state);
  /// Geometry: normals and separations of all pairs, for all corrections of the step; jumps of interfaces.
  void find_geometry(State<Dim>& state, const ContactBasis<Dim>& basis);
  /// On nodes where conditions prescribe components of the velocities, contact acts along the others only.
  /// Contact at the surface lists its points then.
  void yield_to(const State<Dim>& state, const Conditions<Dim>& conditions);

  /// Begins the ledger of a step.
  /// @param pivots    points about which moments count, by field, m
  /// @param crossing  time in which the fastest wave or motion crosses a cell, s
  void begin_step(const std::vector<Vec<Dim>>& pivots, double dt, double crossing);
  /// Impulses before the strain update, after the momentum update, and of re-extrapolated momenta
  /// (Corrections).
  void correct_first(State<Dim>& state);
  void correct_second(State<Dim>& state);
  void correct_re_extrapolated(State<Dim>& state);
  /// FMPM meets contact in each of its orders (Step::filter_full_mass). First the normal impulses of the
  /// second correction are taken out of `momenta`; then the momenta of each order are corrected, each from
  /// the beginning; last the ledger has the impulses of the last order in place of the second correction's.
  void begin_orders(State<Dim>& state, Nodal momenta);
  void correct_order(State<Dim>& state);
  void end_orders(const State<Dim>& state);
  bool acts_on_nodes() const;  ///< contact family `nodes`, and some node has two fields in this step

  /// For the compression weights of re-extrapolated scenes: the slots of nodes with separable pairs, −1 for
  /// those of other contact nodes.
  void list_separable_slots(int threads, std::vector<int>& slots) const;
  /// Gives the fields of a tied node the mean compression weight: a tie moves as one field does.
  void average_compression(State<Dim>& state) const;

  /// Fitted normals that outlast a step: after a sort, after a loss of particles, and after particles have
  /// moved.
  void renumber_fits(const Tiling<Dim>& tiling);
  void invalidate_fits();
  void drift_fits(const State<Dim>& state, double dt);

  /// What a step leaves to the next, for a checkpoint.
  void visit(Archive& archive);

  const ContactList<Dim>& list() const { return list_; }
  const PairLaws& laws() const { return laws_; }
  const ConductanceSpec& conductance_of(const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                                        const ContactPair& pair) const;
  const ContactLedger<Dim>& ledger() const { return ledger_; }  ///< of the last step
  /// Memory that grows with the contact nodes and the clouds around them.
  std::size_t bytes() const;

 private:
  struct Phases;
  void end_step(State<Dim>& state);

  const Scene& scene_;
  const Cracks<Dim>& cracks_;
  int fields_;
  bool has_geometry_;  ///< some law asks for normals and separations
  PairLaws laws_;
  std::unique_ptr<Phases> phases_;
  ContactList<Dim> list_;
  ContactLedger<Dim> ledger_;
};

extern template class Contact<2>;
extern template class Contact<3>;

}  // namespace mpmfast
