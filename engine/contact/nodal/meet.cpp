/// What the pairs of a node bring to their laws: areas, the ways that walls leave, and which pairs last.
/// (Momenta that sticking needs and separations: correct.hpp.)

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/conditions/conditions.hpp"
#include "engine/contact/contact.hpp"
#include "engine/state/team.hpp"

namespace mpmfast {

template <int Dim>
Vec<Dim> Contact<Dim>::free_part(const ContactNode<Dim>& node, const Vec<Dim>& x) const {
  return conditions_->free_part({node.held_combination, node.held_axes}, x);
}

/// A wall and a contact that correct each other in turn are no projection, and hold different velocities in
/// the strain, the force and v′: that makes energy without end where grains jam at a wall. So on nodes where
/// conditions hold a direction, contact acts in the others alone: both are one projection then. A gap d along
/// n is closed by moving d/|n_free| along n_free.
template <int Dim>
void Contact<Dim>::leave_to(const Conditions<Dim>& conditions, int threads) {
  constexpr double kNone = 1e-3;  // a surface along the held plane: no way is left
  conditions_ = &conditions;
  if (conditions.empty() || !one_set_) return;
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), threads, 256, [&](std::int64_t k) {
    auto& node = list_.nodes[static_cast<std::size_t>(k)];
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const auto held = conditions.held(list_.fields[static_cast<std::size_t>(f)].slot);
      node.held_combination = std::max(node.held_combination, held.combination);
      node.held_axes |= held.axes;
      node.constrained |= held.any();
    }
    if (!node.constrained) return;
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      const Vec<Dim> free = free_part(node, entry.normal);
      const double length = free.norm();
      entry.normal = length > kNone ? Vec<Dim>(free / length) : Vec<Dim>::Zero();
      entry.separation = length > kNone ? entry.separation / length : std::numeric_limits<double>::infinity();
    }
  });
}

/// The other field of an entry; of a lump the one with the largest volume, whose law then holds for the whole
/// (N20 after Eq. 50).
template <int Dim>
int Contact<Dim>::partner(const State<Dim>& state, const ContactNode<Dim>& node,
                          const ListedEntry<Dim>& entry) const {
  if (entry.b >= 0) return entry.b;
  if (node.rigid >= 0) return node.rigid;
  const double* volume = state.nodes.column(Nodal::volume);
  int largest{};
  double most = -1;
  for (int k = 0; k < node.field_end - node.field_begin; ++k) {
    const double v = volume[list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot];
    if (k != entry.a && v > most) largest = k, most = v;
  }
  return largest;
}

/// Contact area of an entry, m² (of the scene's thickness in 2-D).
///
/// volume_gradient: g = Σ G_pi V_p = ∫ N_i n dS over the surface of a field, so that g_a·n and −g_b·n are
/// each the node's share of a surface; over a flat interface they add up to its area exactly, since Σ N_i
/// = 1. The smaller one leaves out what the other has beyond the edge of this one. nodal_volume: sqrt(2 Ω_min
/// Ω_tot)/h (theory §4), exact for linear functions and an interface along the grid.
template <int Dim>
double Contact<Dim>::area(const State<Dim>& state, const ContactNode<Dim>& node,
                          const ContactEntry<Dim>& entry) const {
  const bool by_volume = spec_.area == AreaKind::nodal_volume;
  double own = 0, rest = 0;
  for (int k = 0; k < node.field_end - node.field_begin; ++k) {
    if (entry.b >= 0 && k != entry.a && k != entry.b) continue;
    const int slot = list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
    const double sign = k == entry.a ? 1 : -1;
    (k == entry.a ? own : rest) +=
        by_volume ? state.nodes.column(Nodal::volume)[slot]
                  : sign * state.nodes.vector(Nodal::volume_gradient, slot).dot(entry.normal);
  }
  if (by_volume) return std::sqrt(2 * std::min(own, rest) * (own + rest)) / cell_;
  return std::max(0.0, std::min(own, rest));
}

/// Which pairs last, and what closes their gaps.
///
/// A pair stays in contact until a force pulls it apart. Held by its velocities, a surface drifts from
/// where the particles' extents say that it is; to close such a gap δ against N would lose N δ, time and
/// again. A gap that would not close if the pair were let go is none of this kind: that pair carries a load
/// where bodies do not touch (beside a round contact, at the ends of a sliding block).
template <int Dim>
void Contact<Dim>::judge(const ContactNode<Dim>& node) {
  constexpr double kLeast = 0.05, kMost = 0.3;  // cells
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    entry.lasts = one_set_ && entry.touched &&
                  entry.separation < std::clamp(entry.spring_before, kLeast * cell_, kMost * cell_);
    entry.closing = entry.lasts ? 0 : std::max(0.0, entry.separation) / dt_;
  }
}

/// Has the node surfaces that may part, which are not tied?
template <int Dim>
bool Contact<Dim>::may_part(const ContactNode<Dim>& node) const {
  const auto entry = list_.entries.begin();
  return std::any_of(entry + node.entry_begin, entry + node.entry_end, [](const auto& e) { return e.parts; });
}

/// Has it springs in place of ties?
template <int Dim>
bool Contact<Dim>::is_bridged(const ContactNode<Dim>& node) const {
  if (!bridges_) return false;
  const auto bridge = list_.bridges.begin();
  return std::any_of(bridge + node.entry_begin, bridge + node.entry_end,
                     [](const auto& b) { return b.acts; });
}

template <int Dim>
void Contact<Dim>::list_meeting_slots(int threads, std::vector<int>& slots) const {
  slots.assign(list_.fields.size(), -1);  // some fields belong to no listed node
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), threads, 256, [&](std::int64_t k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    const bool parts = may_part(node);
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const auto at = static_cast<std::size_t>(f);
      slots[at] = parts ? list_.fields[at].slot : -1;
    }
  });
}

template <int Dim>
void Contact<Dim>::share_pressed(State<Dim>& state) const {
  const double* mass = state.nodes.column(Nodal::mass);
  double* pressed = state.nodes.column(Nodal::pressed);
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), state.threads, 256, [&](std::int64_t k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    if (may_part(node) || is_bridged(node)) return;
    double all = 0, part = 0;
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const int slot = list_.fields[static_cast<std::size_t>(f)].slot;
      all += mass[slot], part += pressed[slot];
    }
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const int slot = list_.fields[static_cast<std::size_t>(f)].slot;
      pressed[slot] = part / all * mass[slot];
    }
  });
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
