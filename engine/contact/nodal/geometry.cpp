/// Normals and separations that come from the grid (theory §4, NN §3.2 to 3.6).

#include <algorithm>
#include <limits>

#include "engine/contact/contact.hpp"
#include "engine/contact/nodal/fit.hpp"
#include "engine/state/team.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

namespace {

/// f(node, entry), node after node, in parallel.
template <int Dim, class F>
void for_each_entry(ContactList<Dim>& list, int threads, const F& f) {
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), threads, 256, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[static_cast<std::size_t>(k)];
    for (int e = node.entry_begin; e < node.entry_end; ++e)
      f(node, list.entries[static_cast<std::size_t>(e)]);
  });
}

}  // namespace

template <int Dim>
void Contact<Dim>::find_geometry(State<Dim>& state, ContactBasis<Dim>& basis) {
  if (list_.nodes.empty() || !geometry_) return;
  const auto is_crack = [](const auto& entry) { return entry.crack >= 0; };
  if (!std::all_of(list_.entries.begin(), list_.entries.end(), is_crack)) {
    grid_normals(state);
    fit_->run(state, spec_, basis, list_);
    grid_separations(state);
  }
  if (cracks_.active()) crack_separations(state);
  find_bonds(state);
  find_bridges(state);
  weigh_bonds(state);
  if (spec_.detection == DetectionKind::velocity || spec_.separation == SeparationKind::none)
    for_each_entry(list_, state.threads, [](const ContactNode<Dim>&, ContactEntry<Dim>& entry) {
      entry.separation = -std::numeric_limits<double>::infinity();
    });
}

/// How far the sides of cracks are apart: u_b − u_a along the normal, led to the node along their slopes.
template <int Dim>
void Contact<Dim>::crack_separations(const State<Dim>& state) {
  for_each_entry(list_, state.threads, [&](const ContactNode<Dim>& node, ContactEntry<Dim>& entry) {
    if (entry.crack < 0) return;
    const auto slot = [&](int k) {
      return list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
    };
    entry.separation = told_jump(state, node, slot(entry.a), slot(entry.b)).dot(entry.normal);
  });
}

template <int Dim>
void Contact<Dim>::grid_normals(const State<Dim>& state) {
  const bool specified = spec_.normal == NormalKind::specified;
  if (!specified && !state.nodes.has(Nodal::volume_gradient)) return;
  for_each_entry(list_, state.threads, [&](const ContactNode<Dim>& node, ContactEntry<Dim>& entry) {
    if (entry.crack >= 0) return;
    if (!specified) {
      gradient_normal(state, node, entry);
      return;
    }
    // Into the rigid body, else from the lower field to the higher.
    const int other = entry.b >= 0 ? entry.b : entry.a == 0 ? 1 : 0;
    const auto field = [&](int k) {
      return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
    };
    const bool into_rigid = node.rigid >= 0 && (entry.b < 0 || entry.b == node.rigid);
    const double sign = into_rigid || field(entry.a) < field(other) ? 1.0 : -1.0;
    for (int d = 0; d < Dim; ++d)
      entry.normal[d] = sign * spec_.specified_normal[static_cast<std::size_t>(d)];
  });
}

/// A volume gradient points out of its own material, so from a to the rest point g_a and −g_b (N20 Eq. 13;
/// NN §3.2). Of several fields, b is the sum.
template <int Dim>
void Contact<Dim>::gradient_normal(const State<Dim>& state, const ContactNode<Dim>& node,
                                   ContactEntry<Dim>& entry) const {
  Vec<Dim> own = Vec<Dim>::Zero(), rest = Vec<Dim>::Zero();
  double own_volume = 0, rest_volume = 0;
  const bool volumes = state.nodes.has(Nodal::volume);
  for (int k = 0; k < node.field_end - node.field_begin; ++k) {
    const int slot = list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
    const int other = entry.b >= 0 ? entry.b : node.rigid;
    if (other >= 0 && k != entry.a && k != other) continue;
    (k == entry.a ? own : rest) += state.nodes.vector(Nodal::volume_gradient, slot);
    if (volumes) (k == entry.a ? own_volume : rest_volume) += state.nodes.column(Nodal::volume)[slot];
  }
  Vec<Dim> normal = own - rest;
  bool gradients = true;
  switch (spec_.normal) {
    case NormalKind::max_gradient:
      normal = own.squaredNorm() >= rest.squaredNorm() ? own : Vec<Dim>(-rest);
      break;
    case NormalKind::max_volume:
      normal = own_volume >= rest_volume ? own : Vec<Dim>(-rest);
      break;
    case NormalKind::own_gradient:
      normal = own;
      break;
    case NormalKind::average_gradient:
      break;
    default:
      gradients = false;
  }
  // NN §3.5: a rigid body keeps its shape, and so does its gradient.
  const bool against_rigid = node.rigid >= 0 && (entry.b < 0 || entry.b == node.rigid);
  if (against_rigid && spec_.rigid_bias > 0 && (gradients || spec_.rigid_bias >= 10) &&
      rest.norm() * spec_.rigid_bias >= own.norm()) {
    normal = -rest;
    entry.settled = true;
  }
  const double length = normal.norm();
  if ((gradients || entry.settled) && length > 0) entry.normal = normal / length;
  entry.settled &= length > 0;
}

template <int Dim>
void Contact<Dim>::grid_separations(const State<Dim>& state) {
  const bool displaced = state.nodes.has(Nodal::mass_displacement);
  if (!displaced && !state.nodes.has(Nodal::mass_position)) return;
  const Nodal moment = displaced ? Nodal::mass_displacement : Nodal::mass_position;
  const double* mass = state.nodes.column(Nodal::mass);
  for_each_entry(list_, state.threads, [&](const ContactNode<Dim>& node, ContactEntry<Dim>& entry) {
    double mass_own = 0, mass_rest = 0;
    Vec<Dim> own = Vec<Dim>::Zero(), rest = Vec<Dim>::Zero();
    for (int k = 0; k < node.field_end - node.field_begin; ++k) {
      if (entry.b >= 0 && k != entry.a && k != entry.b) continue;
      const int slot = list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
      (k == entry.a ? mass_own : mass_rest) += mass[slot];
      (k == entry.a ? own : rest) += state.nodes.vector(moment, slot);
    }
    own /= mass_own;
    rest /= mass_rest;
    if (displaced) {  // NN Eq. 3.45, 3.46
      entry.separation = (rest - own).dot(entry.normal);
      return;
    }
    const auto ahead = [&](const Vec<Dim>& x) {  // e = (x − x_i)·n in cells
      return (x / state.grid.cell - node.node.template cast<double>()).dot(entry.normal);
    };
    const double e_a = ahead(own), e_b = ahead(rest);
    const double cells = spec_.separation == SeparationKind::position_offset
                             ? position_offset(e_a, e_b, spec_.position_offset)
                         : spec_.separation == SeparationKind::position_power
                             ? position_power(e_a, e_b)
                             : position_piecewise(e_a, e_b, spec_.piecewise_particles);
    entry.separation = state.grid.cell * cells;
  });
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
