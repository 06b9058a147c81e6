/// Bonds on nodes (kernels/contact/bond.hpp): which there are, what a step leaves of them, and how that moves
/// with the bodies from node to node.

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/contact/contact.hpp"
#include "engine/contact/nodal/bonds.hpp"
#include "engine/contact/nodal/smooth_normals.hpp"
#include "engine/state/team.hpp"

namespace mpmfast {

template <int Dim>
template <class F>
void Contact<Dim>::for_each_bond(const State<Dim>& state, const F& f) {
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
  for_each_of(n, state.threads, 64, [&](std::int64_t k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      if (const auto* law = std::get_if<Cohesive>(&law_of(state, node, entry)))
        f(node, entry, *law, bond_of(entry));
    }
  });
}

/// Surfaces are bonded that touch at the start of the run. Later a pair on a node has what the node had of
/// it, or the nodes around; what meets where nobody knows of a bond is broken.
template <int Dim>
void Contact<Dim>::find_bonds(const State<Dim>& state) {
  if (!bonds_) return;
  constexpr double kTouch = 0.25;  // cells
  for_each_bond(state, [&](const auto& node, const auto& entry, const Cohesive&, Bond<Dim>& bond) {
    bond.way = bond.before, bond.offset = bond.offset_before;
    // Ahead of where a crack ended sides have hardly any mass, and what they tell of a jump is noise.
    if (entry.crack >= 0 && state.step > 0 && cracks_.is_fresh(state, entry.crack, node.node)) {
      bond.way = 0;
      bond.offset.setZero();
      auto& bridge = list_.bridges[static_cast<std::size_t>(&entry - list_.entries.data())];
      bridge.known = true;  // they were one: what displacements tell about a tip is no jump
      bridge.jump.setZero();
      bridge.jump_normal = entry.normal;
      return;
    }
    if (bond.before >= 0) return;
    if (state.step == 0)
      bond.way = entry.separation < kTouch * cell_ && !is_cracked(state, node, entry) ? 0 : 1;
    else
      take_nearest(state, node, entry, bond);
  });
}

/// Does the scene have a crack there at the start?
template <int Dim>
bool Contact<Dim>::is_cracked(const State<Dim>& state, const ContactNode<Dim>& node,
                              const ContactEntry<Dim>& entry) const {
  if (entry.crack >= 0 && cracks_.grows(entry.crack)) return true;
  if (!spec_.cracked) return false;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const double x = state.grid.origin[d] + node.node[d] * cell_;
    if (x < spec_.crack_lower[k] || x > spec_.crack_upper[k]) return false;
  }
  return true;
}

/// What the nodes around know of the bond, itself among them, that have some of the surface: of the material
/// that is nearest along it. Broken where none does.
template <int Dim>
void Contact<Dim>::take_nearest(const State<Dim>& state, const ContactNode<Dim>& node,
                                const ContactEntry<Dim>& entry, Bond<Dim>& bond) const {
  constexpr double kAcross = 0.01;  // what a distance across the surface counts
  double nearest = std::numeric_limits<double>::infinity();
  bond.way = 1;
  bond.offset.setZero();
  for (int m = 0; m < power(3, Dim); ++m) {
    const auto* beside = same_pair(state, node, entry, m);
    if (!beside || bond_of(*beside).before < 0 || bond_of(*beside).area < bond.least_area) continue;
    Vec<Dim> offset = bond_of(*beside).offset_before;
    for (int d = 0, rest = m; d < Dim; ++d, rest /= 3) offset[d] += rest % 3 - 1;
    const double across = offset.dot(entry.normal);
    const double distance = offset.squaredNorm() - (1 - kAcross) * across * across;
    if (!(distance < nearest)) continue;
    nearest = distance;
    bond.way = bond_of(*beside).before;
    bond.offset = offset;
  }
}

/// Nodes with hardly any of the surface, whose jumps are noise, follow those around them: by themselves they
/// break too early or too late, and tell the next node so when the surface has come to it.
template <int Dim>
void Contact<Dim>::weigh_bonds(const State<Dim>& state) {
  if (!bonds_) return;
  constexpr double kHardly = 0.05;
  for_each_bond(state, [&](const auto& node, const auto& entry, const Cohesive&, Bond<Dim>& bond) {
    for (int m = 0; m < power(3, Dim); ++m)
      if (const auto* beside = same_pair(state, node, entry, m))
        bond.least_area = std::max(bond.least_area, kHardly * bond_of(*beside).area);
  });
}

/// What is worn moves with the mean velocity of its two fields, off the node that keeps it; from half a cell
/// on along the surface the next node keeps it. (A node that took |v| Δt/h a step of what the last one has
/// would mend what is broken beside what is whole by every vibration.)
template <int Dim>
void Contact<Dim>::carry_bonds(const State<Dim>& state, double dt) {
  constexpr double kHalf = 0.5;
  for_each_bond(state, [&](const auto& node, const auto& entry, const Cohesive&, Bond<Dim>& bond) {
    const auto slot = [&](int field) {
      return list_.fields[static_cast<std::size_t>(node.field_begin + field)].slot;
    };
    const int a = slot(entry.a), b = slot(partner(state, node, entry));
    const double* mass = state.nodes.column(Nodal::mass);
    bond.offset += dt / cell_ *
                   (state.nodes.vector(Nodal::momentum, a) + state.nodes.vector(Nodal::momentum, b)) /
                   (mass[a] + mass[b]);
    bond.before = bond.way;
    bond.offset_before = bond.offset;
  });
  for_each_bond(state, [&](const auto& node, const auto& entry, const Cohesive& law, Bond<Dim>& bond) {
    const Vec<Dim> along = bond.offset - bond.offset.dot(entry.normal) * entry.normal;
    if (!bond.follows() && !(along.template lpNorm<Eigen::Infinity>() > kHalf)) return;
    const double before = law.integrity_of(bond.way);
    take_nearest(state, node, entry, bond);
    auto& bridge = list_.bridges[static_cast<std::size_t>(&entry - list_.entries.data())];
    if (bond.follows() && bridge.acts) wear(law, before, bridge, bond);
    if (bond.broken()) bridge.acts = false;
  });
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
