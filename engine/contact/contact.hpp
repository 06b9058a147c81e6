#pragma once

/// @file Contact between velocity fields: which nodes, and the two corrections of a step (theory §4).

#include <omp.h>

#include <array>
#include <memory>
#include <vector>

#include "engine/contact/books.hpp"
#include "engine/contact/contact_basis.hpp"
#include "engine/contact/cracks/cracks.hpp"
#include "engine/contact/nodal/list.hpp"
#include "engine/contact/nodal/motion.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "kernels/contact/lane_solver.hpp"
#include "kernels/contact/resolve_pair.hpp"
#include "kernels/contact/set_rule.hpp"
#include "kernels/contact/node_solver.hpp"

namespace mpmfast {

template <int Dim>
class Conditions;
template <int Dim>
class ContactFit;

/// N20 §3.2: before the strain update (momenta only) and after the momentum update (also a force); and of
/// re-extrapolated momenta (for the strain alone).
enum class Correction { initial, final, strain };

/// Of a node with explicit pairs: none touches or they are solved, or the lump must do (N20 §3.4).
enum class PairOutcome { none, solved, lump };

template <int Dim>
class Contact {
 public:
  Contact(const Scene& scene, const Plan& plan, const Cracks<Dim>& cracks);
  ~Contact();

  /// Lists the nodes where two or more fields have mass, without the pairs that the mass screen drops.
  void find_nodes(const State<Dim>& state);

  /// Normals and separations of all entries: they hold for both corrections.
  void find_geometry(State<Dim>& state, ContactBasis<Dim>& basis);
  /// The particles have been sorted: those that fits have kept have other numbers.
  void follow(const Tiling<Dim>& tiling);
  /// Particles have left: what fits have kept of them is void.
  void forget_fits() { list_.fits.assign(list_.fits.size(), {}); }
  /// Particles have moved with the velocities of the nodes.
  void drift(const State<Dim>& state, double dt);

  /// On nodes where conditions prescribe components of the velocities contact acts along the others only.
  void leave_to(const Conditions<Dim>& conditions, int threads);

  /// A new step: the books are empty, and moments count about these points, by field.
  void open_books(const std::vector<Vec<Dim>>& pivots);
  /// The time in which the fastest of all waves and motions crosses a cell, s.
  void set_crossing(double seconds) { crossing_ = seconds; }

  /// The slots of nodes where surfaces meet that may part (not bonds); −1 for those of other contact nodes.
  void list_meeting_slots(int threads, std::vector<int>& slots) const;

  /// Gives the fields of a node that are tied the share of pressed mass that all of them have: a tie moves as
  /// one field does.
  void share_pressed(State<Dim>& state) const;

  /// Momentum changes of all entries. initial: Δv is kept in the second half of `star` where XPIC wants it;
  /// final: forces change too. Friction work and the impulses on rigid bodies and of pairs are summed.
  void resolve(State<Dim>& state, Correction correction, double dt);

  /// What a step leaves to the next.
  void visit(Archive& archive);

  const ContactList<Dim>& list() const { return list_; }
  /// Which of the node's fields an entry meets: the other one, of a lump the rigid or the largest one.
  int partner(const State<Dim>& state, const ContactNode<Dim>& node, const ListedEntry<Dim>& entry) const;
  /// By what corrections act on an entry, and how its surfaces conduct heat.
  LawScope scope_of(const State<Dim>& state, const ContactNode<Dim>& node,
                    const ContactEntry<Dim>& entry) const {
    return scope_of(law_of(state, node, entry), entry);
  }
  const ConductanceSpec& conductance_of(const State<Dim>& state, const ContactNode<Dim>& node,
                                        const ContactEntry<Dim>& entry) const;
  /// Do springs join the surfaces of this entry?
  bool joined(int entry) const { return bridges_ && list_.bridges[static_cast<std::size_t>(entry)].acts; }
  /// Of the last step.
  const ContactBooks<Dim>& books() const { return books_; }
  /// Of all that grows with the contact nodes, and of the clouds of particles around them.
  std::size_t bytes() const;

 private:
  int fields_on(const State<Dim>& state, std::size_t stack) const;
  void list_stack(const State<Dim>& state, std::size_t stack, NodeListing<Dim>& out);
  void add_entries(const State<Dim>& state, ContactNode<Dim>& node, NodeListing<Dim>& out) const;
  double screen_of(const ContactNode<Dim>& node, const ListedEntry<Dim>& entry, int other) const;
  void add_pairs(const ContactNode<Dim>& node, std::vector<ListedEntry<Dim>>& entries) const;
  void make_room(std::size_t threads);
  void take_listed(const State<Dim>& state, const NodeListing<Dim>& listing);
  void book(const State<Dim>& state);
  bool is_screened(const State<Dim>& state, const ContactNode<Dim>& node) const;
  void visit_fits(Archive& archive);
  void remember(const State<Dim>& state);
  void book_rigid(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry);
  void book_pair(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                 double share);
  void grid_normals(const State<Dim>& state);
  void gradient_normal(const State<Dim>& state, const ContactNode<Dim>& node, ContactEntry<Dim>& entry) const;
  void grid_separations(const State<Dim>& state);
  void crack_separations(const State<Dim>& state);
  bool parts(const State<Dim>& state, const ContactNode<Dim>& node, ListedEntry<Dim>& entry) const;
  template <class Laws>
  void resolve_all(State<Dim>& state, const Laws& laws, Correction correction, double dt);
  template <class Laws>
  void resolve_each(const State<Dim>& state, const Laws& laws, Correction correction, double dt,
                    const ContactNode<Dim>& node, const NodeMotion<Dim>& motion);
  /// What is kept of an entry until the next step.
  struct Memory {
    std::uint64_t key;
    std::uint32_t entry;  ///< which of the last step's entries
    bool touching, stuck;
    double spring;
    double plane[Dim + 1];
  };
  void recall(const Memory& memory, std::size_t entry);

  PairOutcome resolve_pairs(const State<Dim>& state, Correction correction, double dt,
                            const ContactNode<Dim>& node, const NodeMotion<Dim>& motion);
  struct Touching;
  bool find_touching(const State<Dim>& state, double dt, const ContactNode<Dim>& node,
                     const NodeMotion<Dim>& motion, Touching& out);
  void rest(int begin, int end);
  Vec<Dim> kept_of(const ContactEntry<Dim>& entry) const;
  const Bridge<Dim>& bridge_of(const ContactEntry<Dim>& entry) const {
    return list_.bridges[static_cast<std::size_t>(&entry - list_.entries.data())];
  }
  LawScope scope_of(const AnyLaw& law, const ContactEntry<Dim>& entry) const;
  const AnyLaw& law_of(const State<Dim>& state, const ContactNode<Dim>& node,
                       const ContactEntry<Dim>& entry) const;
  /// An entry by itself: `bonds` has it.
  Bond<Dim>& bond_of(const ContactEntry<Dim>& entry) {
    return list_.bonds[static_cast<std::size_t>(&entry - list_.entries.data())];
  }
  const Bond<Dim>& bond_of(const ContactEntry<Dim>& entry) const {
    return list_.bonds[static_cast<std::size_t>(&entry - list_.entries.data())];
  }
  void find_bonds(const State<Dim>& state);
  void weigh_bonds(const State<Dim>& state);
  template <class F>
  void for_each_bond(const State<Dim>& state, const F& f);
  bool is_cracked(const State<Dim>& state, const ContactNode<Dim>& node,
                  const ContactEntry<Dim>& entry) const;
  void take_nearest(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                    Bond<Dim>& bond) const;
  const ContactEntry<Dim>* same_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                                     const ContactEntry<Dim>& entry, int place) const;
  void carry_bonds(const State<Dim>& state, double dt);
  bool is_joined(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry) const;
  /// f(law), or f(the contact) of surfaces whose bond is broken or that contact holds apart.
  template <class Law, class F>
  void as_it_is(const ContactEntry<Dim>& entry, const Law& law, F f) const {
    if constexpr (requires { law.contact(); }) {
      const bool broken = std::is_same_v<Law, Cohesive> && is_broken(entry);
      if (broken || law.compression == CompressionModel::contact) return f(law.contact());
    }
    f(law);
  }
  bool is_broken(const ContactEntry<Dim>& entry) const { return bonds_ && bond_of(entry).broken(); }
  void find_bridges(const State<Dim>& state);
  BridgesAround<Dim> bridges_around(const State<Dim>& state, const ContactNode<Dim>& node,
                                    const ContactEntry<Dim>& entry) const;
  void end_bridges(const State<Dim>& state, double dt);
  void bridge(State<Dim>& state, double dt, const ContactNode<Dim>& node);
  bool start_bridge(const State<Dim>& state, double dt, const ContactNode<Dim>& node, int e);
  Vec<Dim> pull_of(const AnyLaw& law, const ContactEntry<Dim>& entry, Bridge<Dim>& bridge,
                   const ContactNode<Dim>& node, double dt, const Vec<Dim>& pulls, bool alone) const;
  void apply_pressed_friction(const AnyLaw& law, Bridge<Dim>& bridge, const PairStart<Dim>& joint, double dt,
                              bool alone, Vec<Dim>& end) const;
  double stored_of(const AnyLaw& law, const ContactEntry<Dim>& entry) const;
  Vec<Dim> told_jump(const State<Dim>& state, const ContactNode<Dim>& node, int slot_a, int slot_b) const;
  void apply(State<Dim>& state, Correction correction, double dt, const ContactNode<Dim>& node,
             NodeMotion<Dim>& motion) const;
  /// What field a needs to stick to the others: Δp_a(0), N s, and m_red, kg.
  struct Meeting {
    Vec<Dim> stick;
    double reduced;
  };
  /// A pair of a node that may have an impulse while all of them are solved together.
  struct Acting {
    ContactEntry<Dim>* entry;
    double reduced;      ///< kg
    double area_time{};  ///< A_c Δt, m² s, for laws that use the area
    bool in_set;         ///< the step's one set: by its rule
    SetRule<Dim> rule;
    Coulomb friction;  ///< where that is its law
  };
  /// Nodes of so many fields that wait to be solved together, in lanes.
  template <int kFields>
  struct Waiting {
    LaneSolver<Dim, kFields> solver;
    std::array<const ContactNode<Dim>*, kLanes> nodes;
  };
  /// What one thread solves the pairs of a node in.
  struct alignas(64) Together {
    NodeMotion<Dim> motion;
    std::vector<Vec<Dim>> velocities;  ///< of its fields, along what conditions leave free, m/s
    NodeSolver<Dim> solver;
    std::vector<Acting> acting;  ///< as the solver's contacts
    Waiting<3> of_three;
    Waiting<4> of_four;
    std::vector<Vec<Dim>> pulled;  ///< impulses of springs on the node's fields, N s
  };
  template <class Laws>
  void find_acting(const State<Dim>& state, const Laws& laws, Correction correction, double dt,
                   const ContactNode<Dim>& node, Together& together);
  bool is_rigid(const State<Dim>& state, const ContactNode<Dim>& node, int k) const {
    const int field = list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
    return state.field_rigid[static_cast<std::size_t>(field)];
  }
  void pose(const State<Dim>& state, Correction correction, const ContactNode<Dim>& node,
            Together& together) const;
  template <class Laws>
  void finish(const Laws& laws, Correction correction, const ContactNode<Dim>& node,
              const Together& together) const;
  template <class Laws, class F>
  void with_law(const Laws& laws, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry, F f) const;
  int law_between(const ListedEntry<Dim>& entry, const ContactNode<Dim>& node, int other) const;
  template <class Laws>
  bool resolve_together(const Laws& laws, Correction correction, const ContactNode<Dim>& node,
                        Together& together) const;
  template <int kFields>
  void put_in_lane(const State<Dim>& state, const Together& together, const ContactNode<Dim>& node,
                   Waiting<kFields>& waiting) const;
  template <int kFields>
  void finish_lane(Correction correction, const ContactNode<Dim>& node,
                   const LaneSolver<Dim, kFields>& solver, int lane);
  template <class Law>
  Response<Dim> impulse_of(const ContactEntry<Dim>& entry, const Meeting& meeting, double separation,
                         Correction correction, const Law& law, double area_time) const;
  template <class Law>
  Response<Dim> impulse_of_set(const ContactEntry<Dim>& entry, const Meeting& meeting, double separation,
                             Correction correction, const Law& law, double area_time) const;
  template <class Law>
  SetRule<Dim> rule_of(const ContactEntry<Dim>& entry, double separation, Correction correction,
                       const Law& law) const;
  bool may_part(const ContactNode<Dim>& node) const;
  bool is_bridged(const ContactNode<Dim>& node) const;
  void judge(const ContactNode<Dim>& node);
  bool both_ways(const ContactEntry<Dim>& entry, Correction correction) const;
  bool holds_slip(const ContactEntry<Dim>& entry, Correction correction) const;
  Vec<Dim> free_part(const ContactNode<Dim>& node, const Vec<Dim>& x) const;
  void read_motion(const State<Dim>& state, const ContactNode<Dim>& node, NodeMotion<Dim>& motion) const;
  Vec<Dim> slip_of(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                   const NodeMotion<Dim>& motion) const;
  void see_slips(const ContactNode<Dim>& node, const NodeMotion<Dim>& motion);
  bool touches_on(const ContactEntry<Dim>& entry, double mass, const Vec<Dim>& slip) const;
  double spring_of(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                   const NodeMotion<Dim>& motion) const;
  double force_of(const ContactEntry<Dim>& entry, const Meeting& meeting, double normal) const;
  void settle(Correction correction, const ContactNode<Dim>& node, const NodeMotion<Dim>& motion);
  double friction_work_of(const ContactEntry<Dim>& entry, bool tangential) const;
  void book_friction(const State<Dim>& state);
  std::size_t place_of_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                            const ContactEntry<Dim>& entry) const;
  int pair_of(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry) const;
  Meeting meet(const ContactNode<Dim>& node, const NodeMotion<Dim>& motion, int a,
               const typename NodeMotion<Dim>::Total& all) const;
  void pass_on(ContactEntry<Dim>& entry, Correction correction, LawScope scope) const;
  double separation_of(const ContactEntry<Dim>& entry, const Meeting& meeting, double dt) const;
  double area(const State<Dim>& state, const ContactNode<Dim>& node, const ContactEntry<Dim>& entry) const;

  ContactSpec spec_;
  const Cracks<Dim>& cracks_;
  PairTable pairs_;
  std::vector<AnyLaw> laws_;  ///< the default, then those of ContactSpec::pairs, then those of cracks
  const Conditions<Dim>* conditions_ = nullptr;
  double cell_, cell_volume_;
  double dt_{};        ///< of the step, s
  double crossing_{};  ///< s
  bool first_correction_;
  bool one_set_;                 ///< the touching pairs are decided once a step
  bool keep_velocity_change_;    ///< XPIC wants Δv of the first correction
  bool holds_sticking_;          ///< pairs that stick are held along the surface in every correction
  bool first_correction_stays_;  ///< particles keep the impulse of the first correction: it is booked too
  double first_share_;           ///< of the first correction's impulse: a force of the second too
  bool geometry_;                ///< some law asks for normals and separations
  bool bridges_;                 ///< some law joins surfaces by springs
  bool bonds_;                   ///< some law joins them by bonds that break
  bool keeps_fits_;              ///< normals outlast a step
  bool solves_in_lanes_;         ///< nodes of three and four fields, many at once
  std::unique_ptr<ContactFit<Dim>> fit_;
  ContactList<Dim> list_;
  std::vector<std::uint64_t> keys_;         ///< of the entries
  std::vector<int> field_begin_;            ///< by stack, into the list's fields
  std::vector<NodeListing<Dim>> listings_;  ///< of each thread
  std::vector<Together> together_;          ///< of each thread
  std::vector<Memory> memory_;              ///< of the last step, in order of the keys
  std::vector<Bridge<Dim>> last_bridges_;   ///< likewise
  std::vector<Bond<Dim>> last_bonds_;       ///< likewise
  std::vector<KeptFit<Dim>> last_fits_;     ///< likewise
  ContactBooks<Dim> books_;
  Shares shares_{omp_get_max_threads()};  ///< of the nodes
  std::vector<double> friction_sums_;     ///< of nodes that follow each other, J

  std::vector<Vec<Dim>> pivots_;  ///< m, by field
};

extern template class Contact<2>;
extern template class Contact<3>;

}  // namespace mpmfast
