#pragma once

/// @file The nodes where velocity fields meet, and what is known of the contact there.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/state.hpp"
#include "kernels/contact/interface.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// A velocity field with mass at a contact node.
struct ContactField {
  int field, slot;
};

/// One field against another or against the rest of a node, as it is listed.
template <int Dim>
struct ListedEntry {
  int a;                    ///< which of the node's fields
  int b;                    ///< the other field of the pair; −1: the lump of all the others (N20 Eq. 50)
  std::int16_t crack = -1;  ///< whose sides they are
  bool beyond = false;      ///< both are on the right of another crack of the node
  bool settled = false;     ///< the normal is found: no regression
  bool alone = false;       ///< its node has these two fields only
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, from a to the rest; zero: unknown, no contact
};

/// All that a step knows of it.
template <int Dim>
struct ContactEntry : ListedEntry<Dim> {
  double separation{};        ///< m, negative: overlap
  double advanced{};          ///< the separation that a correction judges by, m
  double closing{};           ///< the approach that closes its gap by the end of the step, m/s
  double plane[Dim + 1]{};    ///< of the regression, cells; zero: none
  bool touched = false;       ///< in contact at the end of the last step
  bool lasts = false;         ///< it stays in contact until a force pulls it apart
  bool held = false;          ///< by the first correction
  bool touching = false;      ///< in contact at the second correction
  bool stuck = false;         ///< the second correction leaves no slip
  double spring{};            ///< m: how far the surfaces would come together if nothing pressed them apart
  double spring_before{};     ///< at the end of the last step
  bool parts = false;         ///< its law knows no tie
  bool stuck_before = false;  ///< the second correction of the last step left no slip
  double friction_work{};     ///< J, of this step
  Vec<Dim> impulse = Vec<Dim>::Zero();  ///< Δp_a of the last correction
  Vec<Dim> first = Vec<Dim>::Zero();    ///< Δp_a of the first correction
  Vec<Dim> second = Vec<Dim>::Zero();   ///< Δp_a of the second, with what that passes on of the first
  /// v_a − v_b, m/s: as the particles give it to the grid, and as the corrections leave it
  Vec<Dim> slip_start = Vec<Dim>::Zero(), slip_held = Vec<Dim>::Zero(), slip_pulled = Vec<Dim>::Zero(),
           slip_end = Vec<Dim>::Zero();
  Vec<Dim> passed = Vec<Dim>::Zero();  ///< Δp_a that the second counts as a force, beside its own
};

/// What a fit leaves to the steps after it, while hardly anything near has moved (ContactSpec::refit).
template <int Dim>
struct KeptFit {
  Vec<Dim> raw = Vec<Dim>::Zero();               ///< normal of the node's own cloud
  Vec<Dim> normal = Vec<Dim>::Zero();            ///< the mean over the nodes around, where that is asked for
  std::array<std::int32_t, 2> foremost{-1, -1};  ///< particles: of a furthest along the normal, of b back
  double drift{};                                ///< what the fields have moved since, slides times 30, m
  bool known = false;
  bool touches = false, doubted = false;  ///< as RawNormal
};

/// What springs do at an entry whose law joins surfaces by them.
template <int Dim>
struct Bridge {
  Vec<Dim> jump = Vec<Dim>::Zero();  ///< u_b − u_a at the start of the step, at its end when that is done, m
  bool known = false;                ///< the jump is that of the last step's end
  Vec<Dim> jump_normal = Vec<Dim>::Zero();  ///< of the surface that a known jump was last seen on
  Vec<Dim> told = Vec<Dim>::Zero();         ///< what else says of it at the start, m
  bool recalls = false;                     ///< that is the jump that the node has had
  Vec<Dim> normal = Vec<Dim>::Zero();       ///< as ContactEntry::normal, also where walls hold a part of it
  bool acts = false;                        ///< springs join the two here
  Vec<Dim> rate = Vec<Dim>::Zero();         ///< v_b − v_a at the start, m/s
  Vec<Dim> pulls = Vec<Dim>::Zero();        ///< what forces change of it, m/s²
  int a = -1, b = -1;                       ///< which of the node's fields
  double inverse_a{}, inverse_b{};          ///< of their masses, 1/kg; a rigid one has none
  double own_area{}, mean_area{};           ///< of the surface at the node: the lighter side's, the mean, m²
  double area{};                            ///< that the springs have, m²
  Springs springs{};                        ///< there, where they are straight or a bond unharmed, N/m
  Vec<Dim> impulse = Vec<Dim>::Zero();      ///< Δp_a, N s
  Vec<Dim> friction = Vec<Dim>::Zero();     ///< of it: of friction where springs press
  double friction_work{};                   ///< J, of this step
};

/// What lasts of a bond at an entry whose law breaks (kernels/contact/cohesive.hpp): how much of it is worn,
/// and where the material is that this was found at.
template <int Dim>
struct Bond {
  double way = 1;                      ///< to broken, of [0, 1]
  Vec<Dim> offset = Vec<Dim>::Zero();  ///< of that material from the node, cells
  double before = -1;                  ///< the way at the end of the last step; negative: none was here
  Vec<Dim> offset_before = Vec<Dim>::Zero();
  double area{};        ///< of the surface at the node, also where it is broken, m²
  double least_area{};  ///< with less, it has hardly any of the surface, and does as the nodes around, m²
  double lost{};        ///< J, in this step
  bool broken() const { return way >= 1; }
  bool follows() const { return area < least_area; }
};

/// Of an interface on the nodes around one: sums of the areas, m², and the mean of `told`, m.
template <int Dim>
struct BridgesAround {
  Vec<Dim> told = Vec<Dim>::Zero();
  double own_area{}, mean_area{};
  bool recalls = false;  ///< of jumps that the nodes have had
};

template <int Dim>
struct ContactNode {
  int stack, local;
  NodeIndex<Dim> node;         ///< coordinates
  int field_begin, field_end;  ///< into ContactList::fields
  int entry_begin, entry_end;  ///< into ContactList::entries
  int pair_begin;  ///< entries from here on are the explicit pairs of a node of three or more fields
  int rigid;       ///< which of its fields is the rigid one; −1: none
  int held_combination = -1;  ///< of its fields, see Conditions::Held
  unsigned held_axes{};
  bool constrained = false;  ///< by either: contact acts along what is left free
};

/// What one thread lists: the contact nodes of its share of the stacks, their entries from 0 on.
template <int Dim>
struct alignas(64) NodeListing {
  std::vector<ContactNode<Dim>> nodes;
  std::vector<ListedEntry<Dim>> entries;
  std::vector<std::size_t> stack_begin;               ///< of `nodes`: the first of each stack
  std::uint64_t meetings, screened;                   ///< as ContactCounters
  std::size_t node_begin, entry_begin, stacks_begin;  ///< where its own go in the list of all
};

struct ContactCounters {
  std::uint64_t nodes_peak = 0, regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
  /// Fitted normals of surfaces that overlap at the start of the step or were in contact at the end of the
  /// last (all, where separations come from the grid); of these, those that fell back and that the normals
  /// around do not bear out.
  std::uint64_t touching = 0, doubtful = 0;
  std::uint64_t pair_nodes = 0, pair_fallbacks = 0;  ///< explicit pairs solved, and left to the lump
  std::uint64_t meetings = 0;  ///< nodes of two and more fields that might touch, over all steps
  std::uint64_t screened = 0;  ///< of these: without contact by mass_screen or volume_screen
};

template <int Dim>
struct ContactList {
  std::vector<ContactNode<Dim>> nodes;
  std::vector<ContactField> fields;
  std::vector<ContactEntry<Dim>> entries;
  std::vector<Bridge<Dim>> bridges;      ///< as `entries`; none where no law has springs
  std::vector<Bond<Dim>> bonds;          ///< as `entries`; none where no law breaks
  std::vector<KeptFit<Dim>> fits;        ///< as `entries`; none where each step fits anew
  std::vector<std::size_t> stack_begin;  ///< first node of each stack that has some, and the end
  std::vector<int> node_at;              ///< [stack · kTileNodes + local] → contact node or −1
  ContactCounters counters;
};

/// Names an entry from step to step: its node, then its field a, then b (first of all the lump); of sides of
/// a crack that crack, since the fields that it parts depend on what else is near.
template <int Dim>
std::uint64_t entry_key(const State<Dim>& state, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                        const ContactEntry<Dim>& entry) {
  constexpr std::uint64_t kCrack = std::uint64_t{1} << 63;
  const auto& stack = state.tiling.stacks[static_cast<std::size_t>(node.stack)];
  const auto place =
      static_cast<std::uint64_t>(state.tiling.node_tiles[static_cast<std::size_t>(stack.begin)].place);
  const auto field = [&](int k) {
    return static_cast<std::uint64_t>(list.fields[static_cast<std::size_t>(node.field_begin + k)].field);
  };
  const auto fields = static_cast<std::uint64_t>(state.fields());
  const std::uint64_t at = place * kTileNodes<Dim> + static_cast<std::uint64_t>(node.local);
  if (entry.crack >= 0)
    return kCrack | (at << 16 | static_cast<std::uint64_t>(2 * entry.crack + (entry.beyond ? 1 : 0)));
  const std::uint64_t other = entry.b >= 0 ? field(entry.b) + 1 : 0;
  return (at * fields + field(entry.a)) * (fields + 1) + other;
}

}  // namespace mpmfast
