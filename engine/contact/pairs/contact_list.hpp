#pragma once

/// @file The nodes where velocity fields meet, and the contact pairs there: one column for each phase of
/// contact, one element a pair.

#include <cstdint>

#include "engine/constants.hpp"
#include "engine/contact/geometry/kept_fit.hpp"
#include "engine/contact/interface/interface_spring.hpp"
#include "engine/state/indexed.hpp"
#include "engine/state/state.hpp"
#include "engine/state/thread_team.hpp"
#include "kernels/contact/contact_status.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// A velocity field with mass at a contact node.
struct ContactField {
  int field, slot;
};

/// Which two velocity fields of a node meet.
struct ContactPair {
  int a;                    ///< one of the node's fields, by its number there
  int b;                    ///< the other; −1: lumped, field a against all others (N20 Eq. 50)
  std::int16_t crack = -1;  ///< the crack whose sides they are; −1: none
  bool beyond = false;      ///< both lie on the right side of another crack of the node
  bool sole = false;        ///< the node has these two fields only

  bool is_lumped() const { return b < 0; }
};

template <int Dim>
struct PairGeometry {
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, from a to b; zero: unknown, no contact
  double separation{};                 ///< m, negative: overlap
  double plane[Dim + 1]{};             ///< of the regression, from the last step on, cells; zero: none
  bool prescribed = false;             ///< the normal is given, by a crack or a rigid body: no regression
};

/// What the last step left of a pair.
struct PairHistory {
  bool touched = false, stuck = false;  ///< after its second correction
  double recovery_length{};             ///< m, see PairStatus
};

/// The active set: what a pair does in this step.
struct PairStatus {
  ContactStatus now = ContactStatus::open;  ///< in the correction at hand
  bool persistent = false;                  ///< it stays in contact until a force pulls it apart
  bool active_in_first = false;             ///< the first correction gave it an impulse
  bool touching = false;                    ///< in contact after the second correction
  bool stuck = false;                       ///< the second correction left no slip rate
  bool separable = false;                   ///< its law is a contact law: no bond, no spring
  double target_approach{};  ///< approach velocity that closes the gap by the end of the step, m/s
  double predicted_gap{};    ///< gap by which a simultaneous solve decides, m (active_set.hpp)
  /// m: how far the surfaces would approach each other elastically without the contact force (active_set.hpp)
  double recovery_length{};
};

/// Changes of the momentum of field a, N s; b takes the opposite.
template <int Dim>
struct PairImpulses {
  Vec<Dim> now = Vec<Dim>::Zero();       ///< of the correction at hand
  Vec<Dim> first = Vec<Dim>::Zero();     ///< of the first correction
  Vec<Dim> second = Vec<Dim>::Zero();    ///< of the second, with `as_force`
  Vec<Dim> as_force = Vec<Dim>::Zero();  ///< what counts as a force beside the impulse of the second
  double friction_work{};                ///< J, of this step
};

/// v_b − v_a, m/s, in the directions that boundary conditions leave free. (Its normal part is the opening
/// rate, its tangential part the slip rate.)
/// The corrections of a method set what is read of it; the rest keeps values of an earlier step.
template <int Dim>
struct RelativeVelocities {
  Vec<Dim> start = Vec<Dim>::Zero();         ///< as extrapolated from the particles
  Vec<Dim> after_first = Vec<Dim>::Zero();   ///< after the first correction
  Vec<Dim> after_second = Vec<Dim>::Zero();  ///< after the second
  Vec<Dim> end = Vec<Dim>::Zero();           ///< with which the strains of the step end
};

template <int Dim>
struct PairColumns {
  Indexed<ContactPair> pair;
  Indexed<PairGeometry<Dim>> geometry;
  Indexed<PairHistory> before;
  Indexed<PairStatus> status;
  Indexed<PairImpulses<Dim>> impulse;
  Indexed<RelativeVelocities<Dim>> relative;
  Indexed<InterfaceSpring<Dim>> spring;  ///< empty where no law has springs
  Indexed<Bond<Dim>> bond;               ///< empty where no law has bonds that break
  Indexed<KeptFit<Dim>> fit;             ///< empty where every step fits its normals anew

  std::size_t size() const { return pair.size(); }
  bool is_broken(int e) const { return !bond.empty() && bond[e].is_broken(); }
};

/// Memory of a pair in the columns that every scene has.
template <int Dim>
constexpr std::size_t kPairBytes = sizeof(ContactPair) + sizeof(PairGeometry<Dim>) + sizeof(PairHistory) +
                                   sizeof(PairStatus) + sizeof(PairImpulses<Dim>) +
                                   sizeof(RelativeVelocities<Dim>);

template <int Dim>
struct ContactNode {
  int block, local;            ///< the block of node tiles, and the node in it
  NodeIndex<Dim> index;        ///< coordinates, cells
  int field_begin, field_end;  ///< into ContactList::fields
  int pair_begin, pair_end;    ///< into ContactList::pairs
  int explicit_begin;  ///< pairs from here on are the explicit pairs of a node of three or more fields
  int rigid;           ///< which of its fields is the rigid one; −1: none
  int constrained_combination = -1;  ///< what conditions hold of its fields (Conditions::Constraint)
  unsigned constrained_axes{};
  bool constrained = false;  ///< by either: contact acts in the remaining directions
};

struct ContactCounters {
  std::uint64_t nodes_peak = 0, regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
  /// Fitted normals of surfaces that overlap at the start of the step or were in contact at the end of the
  /// last (all, where separations come from the grid); and how many of these fell back to a simpler method
  /// while the normals around do not confirm them.
  std::uint64_t touching = 0, doubtful = 0;
  std::uint64_t pair_nodes = 0, pair_fallbacks = 0;  ///< nodes solved by pairs or together, and not converged
  std::uint64_t meetings = 0;  ///< nodes of two and more fields that might touch, over all steps
  std::uint64_t screened = 0;  ///< how many of these lost contact by mass_screen or volume_screen
};

template <int Dim>
struct ContactList {
  Indexed<ContactNode<Dim>> nodes;
  Indexed<ContactField> fields;
  PairColumns<Dim> pairs;
  Indexed<std::size_t> block_begin;  ///< first node of each block that has some, and the end
  Indexed<int> node_at;              ///< [block · kTileNodes + local] → contact node or −1
  ContactCounters counters;
};

/// f(node, e) for every pair e, node after node, in parallel.
template <int Dim, class F>
void for_each_pair(const ContactList<Dim>& list, int threads, const F& f) {
  using constants::threads::kFewNodes;
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), threads, kFewNodes, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    for (int e = node.pair_begin; e < node.pair_end; ++e) f(node, e);
  });
}

}  // namespace mpmfast
