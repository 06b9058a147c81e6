#include "engine/contact/published/grid_geometry.hpp"

#include "engine/constants.hpp"
#include "engine/contact/pairs/node_fields.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

namespace {

/// Into the rigid body, else from the lower velocity field to the higher.
template <int Dim>
Vec<Dim> specified_normal(const ContactSpec& spec, const NodeFields<Dim>& fields,
                          const ContactNode<Dim>& node, const ContactPair& pair) {
  const int other = !pair.is_lumped() ? pair.b : pair.a == 0 ? 1 : 0;
  const bool forward = meets_rigid(node, pair) || fields.field(pair.a) < fields.field(other);
  Vec<Dim> normal;
  for (int d = 0; d < Dim; ++d)
    normal[d] = (forward ? 1.0 : -1.0) * spec.specified_normal[static_cast<std::size_t>(d)];
  return normal;
}

/// Volumes and their gradients of the two sides of a pair. Of several fields, the other side is the sum.
template <int Dim>
struct SideVolumes {
  Vec<Dim> own = Vec<Dim>::Zero(), others = Vec<Dim>::Zero();  ///< gradients, m^(Dim−1)
  double own_volume = 0, others_volume = 0;

  SideVolumes(const State<Dim>& state, const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
              const ContactPair& pair) {
    const bool volumes = state.nodes.has(Nodal::volume);
    const int other = pair.is_lumped() ? node.rigid : pair.b;
    for (int k = 0; k < fields.count(); ++k) {
      if (other >= 0 && k != pair.a && k != other) continue;
      (k == pair.a ? own : others) += fields.vector(Nodal::volume_gradient, k);
      if (volumes) (k == pair.a ? own_volume : others_volume) += fields.volume(k);
    }
  }
};

/// A volume gradient points out of its own material, so from a to b point g_a and −g_b (N20 Eq. 13; NN §3.2).
template <int Dim>
void find_gradient_normal(const State<Dim>& state, const ContactSpec& spec, const NodeFields<Dim>& fields,
                          const ContactNode<Dim>& node, const ContactPair& pair,
                          PairGeometry<Dim>& geometry) {
  const SideVolumes<Dim> sides(state, fields, node, pair);
  Vec<Dim> normal = sides.own - sides.others;
  bool gradients = true;
  switch (spec.normal) {
    case NormalKind::max_gradient:
      normal = sides.own.squaredNorm() >= sides.others.squaredNorm() ? sides.own : Vec<Dim>(-sides.others);
      break;
    case NormalKind::max_volume:
      normal = sides.own_volume >= sides.others_volume ? sides.own : Vec<Dim>(-sides.others);
      break;
    case NormalKind::own_gradient:
      normal = sides.own;
      break;
    case NormalKind::average_gradient:
      break;
    default:
      gradients = false;
  }
  // NN §3.5: a rigid body keeps its shape, and so does its gradient.
  if (meets_rigid(node, pair) && spec.rigid_bias > 0 &&
      (gradients || spec.rigid_bias >= constants::contact::kCertainRigidBias) &&
      sides.others.norm() * spec.rigid_bias >= sides.own.norm()) {
    normal = -sides.others;
    geometry.prescribed = true;
  }
  const double length = normal.norm();
  if ((gradients || geometry.prescribed) && length > 0) geometry.normal = normal / length;
  geometry.prescribed &= length > 0;
}

/// The gap from the distances e of the mean positions of both sides ahead of the node, cells.
double gap_of_positions(const ContactSpec& spec, double e_a, double e_b) {
  switch (spec.separation) {
    case SeparationKind::position_offset:
      return position_offset(e_a, e_b, spec.position_offset);
    case SeparationKind::position_power:
      return position_power(e_a, e_b);
    default:
      return position_piecewise(e_a, e_b, spec.piecewise_particles);
  }
}

}  // namespace

template <int Dim>
void find_grid_normals(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& list) {
  const bool specified = spec.normal == NormalKind::specified;
  if (!specified && !state.nodes.has(Nodal::volume_gradient)) return;
  for_each_pair(list, state.threads, [&](const ContactNode<Dim>& node, int e) {
    const ContactPair& pair = list.pairs.pair[e];
    PairGeometry<Dim>& geometry = list.pairs.geometry[e];
    if (pair.crack >= 0) return;
    const NodeFields<Dim> fields(state, list, node);
    if (specified)
      geometry.normal = specified_normal(spec, fields, node, pair);
    else
      find_gradient_normal(state, spec, fields, node, pair, geometry);
  });
}

template <int Dim>
void find_grid_separations(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& list) {
  const bool displaced = state.nodes.has(Nodal::mass_displacement);
  if (!displaced && !state.nodes.has(Nodal::mass_position)) return;
  const Nodal moment = displaced ? Nodal::mass_displacement : Nodal::mass_position;
  for_each_pair(list, state.threads, [&](const ContactNode<Dim>& node, int e) {
    const ContactPair& pair = list.pairs.pair[e];
    PairGeometry<Dim>& geometry = list.pairs.geometry[e];
    const NodeFields<Dim> fields(state, list, node);
    double mass_own = 0, mass_others = 0;
    Vec<Dim> own = Vec<Dim>::Zero(), others = Vec<Dim>::Zero();
    for (int k = 0; k < fields.count(); ++k) {
      if (!pair.is_lumped() && k != pair.a && k != pair.b) continue;
      (k == pair.a ? mass_own : mass_others) += fields.mass(k);
      (k == pair.a ? own : others) += fields.vector(moment, k);
    }
    own /= mass_own;
    others /= mass_others;
    if (displaced) {  // NN Eq. 3.45, 3.46
      geometry.separation = (others - own).dot(geometry.normal);
      return;
    }
    const auto ahead = [&](const Vec<Dim>& x) {  // e = (x − x_i)·n in cells
      return (x / state.grid.cell - node.index.template cast<double>()).dot(geometry.normal);
    };
    geometry.separation = state.grid.cell * gap_of_positions(spec, ahead(own), ahead(others));
  });
}

template void find_grid_normals(const State<2>&, const ContactSpec&, ContactList<2>&);
template void find_grid_normals(const State<3>&, const ContactSpec&, ContactList<3>&);
template void find_grid_separations(const State<2>&, const ContactSpec&, ContactList<2>&);
template void find_grid_separations(const State<3>&, const ContactSpec&, ContactList<3>&);

}  // namespace mpmfast
