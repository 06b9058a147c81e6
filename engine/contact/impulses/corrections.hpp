#pragma once

/// @file The three contact corrections of a step: of momenta before the strain update, of momenta and forces
/// after the momentum update, and of re-extrapolated momenta (N20 §3.2; theory, "The energy of a contact").

#include <vector>

#include "engine/contact/impulses/correction_pass.hpp"
#include "engine/contact/impulses/node_workspace.hpp"
#include "engine/contact/interface/interfaces.hpp"
#include "engine/state/shares.hpp"

namespace mpmfast {

/// The time scales of a step, s.
struct StepTimes {
  double dt;
  double crossing;  ///< in which the fastest wave or motion crosses a cell
};

template <int Dim>
class Corrections {
 public:
  /// Both must outlive it.
  Corrections(const Scene& scene, const Plan& plan, const PairLaws& laws);

  const CorrectionMethod& method() const { return method_; }

  /// Decides the active set, and corrects momenta before the strain update (N20 Eq. 26). Contact-aware XPIC
  /// finds the velocity changes in the second half of Nodal::star.
  void correct_first(State<Dim>& state, const FreeDirections<Dim>& free, const StepTimes& times,
                     ContactList<Dim>& list);
  /// Corrects momenta and forces after the momentum update (N20 Eq. 31, 33). The springs of interfaces act
  /// first.
  void correct_second(State<Dim>& state, const FreeDirections<Dim>& free, const StepTimes& times,
                      Interfaces<Dim>& interfaces, ContactList<Dim>& list);
  /// Corrects re-extrapolated momenta, for the strain alone (NN §2.8).
  void correct_re_extrapolated(State<Dim>& state, const FreeDirections<Dim>& free, const StepTimes& times,
                               ContactList<Dim>& list);

  /// The orders of FMPM. What they find anew is taken out of nodal momenta: the impulses of the second
  /// correction without friction (force_of_friction).
  void take_out_impulses(State<Dim>& state, Nodal momenta, const ContactList<Dim>& list) const;
  /// Corrects the momenta of an order as the second correction does, without friction. What pairs remember of
  /// the step stays the second correction's.
  void correct_order(State<Dim>& state, const FreeDirections<Dim>& free, const StepTimes& times,
                     ContactList<Dim>& list);
  /// Adds the friction of the second correction to the impulses of the last order.
  void add_friction(const State<Dim>& state, ContactList<Dim>& list) const;

 private:
  struct Counts {
    std::uint64_t converged{}, unconverged{};  ///< nodes of simultaneous or explicit pairs
  };
  CorrectionPass<Dim> make_pass(State<Dim>& state, const FreeDirections<Dim>& free, double dt,
                                const CorrectionRule& rule, bool may_stick, ContactList<Dim>& list) const;
  template <class Begin, class Finish>
  Counts solve_nodes(const CorrectionPass<Dim>& pass, const Begin& begin, const Finish& finish);
  Vec<Dim> force_of_friction(const PairColumns<Dim>& pairs, int e) const;
  void begin_active_set(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                        const NodeMotion<Dim>& motion) const;

  const ContactSpec& spec_;
  const PairLaws& laws_;
  CorrectionMethod method_;
  bool solves_in_lanes_;                        ///< nodes of three and four fields, many at once
  std::vector<NodeWorkspace<Dim>> workspaces_;  ///< by thread
  Shares shares_{omp_get_max_threads()};        ///< of the nodes
};

extern template class Corrections<2>;
extern template class Corrections<3>;

}  // namespace mpmfast
