/// Bonds on nodes (kernels/contact/bond.hpp): which there are, what a step leaves of them, and how that moves
/// with the bodies from node to node.

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/contact/contact.hpp"
#include "engine/contact/nodal/smooth_normals.hpp"

namespace mpmfast {

/// Surfaces are bonded that touch at the start of the run. Later a pair on a node has what the node had of
/// it, or the nodes around; what meets where nobody knows of a bond is broken.
template <int Dim>
void Contact<Dim>::find_bonds(const State<Dim>& state) {
  if (!bonds_) return;
  constexpr double kTouch = 0.25;  // cells
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
#pragma omp parallel for num_threads(state.threads) schedule(static) if (n > 64)
  for (std::int64_t k = 0; k < n; ++k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      if (!std::holds_alternative<Cohesive>(law_of(state, node, entry))) continue;
      Bond& bond = bond_of(entry);
      if (bond.before >= 0)
        bond.way = bond.before;
      else if (state.step == 0)
        bond.way = entry.separation < kTouch * cell_ && !is_cracked(state, node) ? 0 : 1;
      else
        bond.way = way_around(state, node, entry);
    }
  }
}

/// Does the scene have a crack there at the start?
template <int Dim>
bool Contact<Dim>::is_cracked(const State<Dim>& state, const ContactNode<Dim>& node) const {
  if (!spec_.cracked) return false;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const double x = state.grid.origin[d] + node.node[d] * cell_;
    if (x < spec_.crack_lower[k] || x > spec_.crack_upper[k]) return false;
  }
  return true;
}

/// The mean of the nodes around that know of the bond, near ones twice for every axis that others are off.
template <int Dim>
double Contact<Dim>::way_around(const State<Dim>& state, const ContactNode<Dim>& node,
                                const ContactEntry<Dim>& entry) const {
  double weights = 0, sum = 0;
  for (int m = 0; m < power(3, Dim); ++m) {
    const auto* beside = same_pair(state, node, entry, m);
    if (!beside || bond_of(*beside).before < 0) continue;
    double weight = 1;
    for (int d = 0, rest = m; d < Dim; ++d, rest /= 3) weight *= rest % 3 == 1 ? 2 : 1;
    weights += weight;
    sum += weight * bond_of(*beside).before;
  }
  return weights > 0 ? sum / weights : 1;
}

/// Bonds move with the mean velocity of their two fields: by |v| Δt/h a step a node takes what the nodes have
/// from which they come. No new extremes, so that what is broken or whole all around stays so.
template <int Dim>
void Contact<Dim>::carry_bonds(const State<Dim>& state, double dt) {
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
  for (Bond& bond : list_.bonds) bond.before = bond.way;
#pragma omp parallel for num_threads(state.threads) schedule(static) if (n > 64)
  for (std::int64_t k = 0; k < n; ++k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      if (!std::holds_alternative<Cohesive>(law_of(state, node, entry))) continue;
      const auto slot = [&](int field) {
        return list_.fields[static_cast<std::size_t>(node.field_begin + field)].slot;
      };
      const int a = slot(entry.a), b = slot(partner(state, node, entry));
      const double* mass = state.nodes.column(Nodal::mass);
      const Vec<Dim> velocity =
          (state.nodes.vector(Nodal::momentum, a) + state.nodes.vector(Nodal::momentum, b)) /
          (mass[a] + mass[b]);
      Bond& bond = bond_of(entry);
      const int middle = power(3, Dim) / 2;
      for (int d = 0; d < Dim; ++d) {
        const auto* upstream =
            same_pair(state, node, entry, middle + (velocity[d] > 0 ? -1 : 1) * power(3, d));
        if (upstream)
          bond.way += std::abs(velocity[d]) * dt / cell_ * (bond_of(*upstream).before - bond.before);
      }
    }
  }
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
