#pragma once

/// @file Contact between velocity fields: which nodes, and the two corrections of a step (theory §4).

#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"
#include "engine/step/contact_list.hpp"
#include "engine/step/passes.hpp"

namespace mpmfast {

/// N20 §3.2: before the strain update (momenta only) and after the momentum update (also a force).
enum class Correction { initial, final };

template <int Dim>
class Contact {
 public:
  /// @param keep_velocity_change  XPIC wants Δv of the first correction
  /// @param first_correction_stays  particles keep the impulse of the first correction: it is booked too
  /// @param cell_volume  m³
  Contact(const ContactSpec& spec, bool keep_velocity_change, bool first_correction_stays, double cell_volume)
      : spec_(spec),
        keep_velocity_change_(keep_velocity_change),
        first_correction_stays_(first_correction_stays),
        cell_volume_(cell_volume) {}

  /// Lists the nodes where two or more fields have mass, without the pairs that the mass screen drops.
  void find_nodes(const State<Dim>& state);

  /// Normals and separations of all entries: they hold for both corrections.
  void find_geometry(State<Dim>& state, Passes<Dim>& passes);

  /// Momentum changes of all entries. initial: Δv is kept in the second half of `star` where XPIC wants it;
  /// final: forces change too, friction work and the impulses on rigid bodies are summed.
  void resolve(State<Dim>& state, Correction correction, double dt);

  const ContactList<Dim>& list() const { return list_; }
  double friction_work() const { return friction_work_; }  ///< J, of the last step
  /// Work that rigid bodies did on the others in the last step, J.
  double rigid_work() const { return rigid_work_; }
  const std::vector<Vec<Dim>>& rigid_impulse() const {
    return rigid_impulse_;
  }  ///< N s, by field, of the last step

 private:
  void list_stack(const State<Dim>& state, int stack);
  void add_entries(const State<Dim>& state, ContactNode<Dim>& node);
  void book(const State<Dim>& state);
  bool is_screened(const State<Dim>& state, const ContactNode<Dim>& node) const;
  void remember();
  void recall(const State<Dim>& state);
  void grid_normals(const State<Dim>& state);
  void gradient_normal(const State<Dim>& state, const ContactNode<Dim>& node, ContactEntry<Dim>& entry) const;
  void grid_separations(const State<Dim>& state);
  template <class Law>
  void resolve_law(State<Dim>& state, const Law& law, Correction correction, double dt);
  template <class Law>
  void resolve_node(State<Dim>& state, const Law& law, Correction correction, double dt,
                    const ContactNode<Dim>& node);
  /// What is kept of an entry until the next step.
  struct Memory {
    std::uint64_t key;
    bool touching, sticking;
    double plane[Dim + 1];
  };

  ContactSpec spec_;
  bool keep_velocity_change_, first_correction_stays_;
  double cell_volume_;
  ContactList<Dim> list_;
  std::vector<std::uint64_t> keys_;  ///< of the entries, ascending
  std::vector<Memory> memory_;       ///< of the last step, in order of the keys
  double friction_work_ = 0, rigid_work_ = 0;
  std::vector<Vec<Dim>> rigid_impulse_;
};

extern template class Contact<2>;
extern template class Contact<3>;

}  // namespace mpmfast
