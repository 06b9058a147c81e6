/// What contact did in a step: friction work, and the impulses, moments and work of rigid bodies and pairs.

#include <Eigen/Geometry>

#include "engine/step/contact.hpp"

namespace mpmfast {

template <int Dim>
void Contact<Dim>::open_books(const std::vector<Vec<Dim>>& pivots) {
  pivots_ = pivots;
  books_.friction_work = books_.rigid_work = 0;
  books_.rigid_impulse.assign(pivots.size(), Vec<Dim>::Zero());
  books_.rigid_moment.assign(pivots.size(), Vec<3>::Zero());
  books_.pair_impulse.assign(spec_.pairs.size(), Vec<Dim>::Zero());
  books_.pair_friction_work.assign(spec_.pairs.size(), 0);
}

/// Adds up, in a fixed order, what the particles will keep of a correction.
template <int Dim>
void Contact<Dim>::book(const State<Dim>& state) {
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      // In a lump, each touching pair is seen from both sides.
      const double share = entry.b >= 0 || node.rigid >= 0 ? 1.0 : 0.5;
      books_.friction_work += share * entry.friction_work;
      if (node.rigid >= 0) book_rigid(state, node, entry);
      if (!pairs_.empty()) book_pair(state, node, entry, share);
    }
}

template <int Dim>
void Contact<Dim>::book_rigid(const State<Dim>& state, const ContactNode<Dim>& node,
                              const ContactEntry<Dim>& entry) {
  const auto [field, slot] = list_.fields[static_cast<std::size_t>(node.field_begin + node.rigid)];
  const auto f = static_cast<std::size_t>(field);
  const Vec<Dim> kept = entry.impulse + entry.passed;
  books_.rigid_impulse[f] -= kept;
  books_.rigid_work +=
      kept.dot(state.nodes.vector(Nodal::momentum, slot)) / state.nodes.column(Nodal::mass)[slot];
  Vec<3> arm = Vec<3>::Zero(), impulse = Vec<3>::Zero();
  for (int d = 0; d < Dim; ++d) {
    arm[d] = state.grid.origin[d] + node.node[d] * state.grid.cell - pivots_[f][d];
    impulse[d] = kept[d];
  }
  books_.rigid_moment[f] -= arm.cross(impulse);
}

template <int Dim>
void Contact<Dim>::book_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                             const ContactEntry<Dim>& entry, double share) {
  const auto field_of = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  };
  const std::size_t at = pairs_.at(field_of(entry.a), field_of(partner(state, node, entry)));
  if (pairs_.pair[at] < 0) return;
  const auto k = static_cast<std::size_t>(pairs_.pair[at]);
  books_.pair_impulse[k] += (pairs_.forward[at] ? share : -share) * (entry.impulse + entry.passed);
  books_.pair_friction_work[k] += share * entry.friction_work;
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
