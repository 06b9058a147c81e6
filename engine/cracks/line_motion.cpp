#include "engine/cracks/line_motion.hpp"

#include <cmath>
#include <cstddef>

#include "engine/constants.hpp"
#include "engine/cracks/element.hpp"
#include "engine/state/nodes.hpp"

namespace mpmfast {

namespace {

/// The bit of a node's crack sides that belongs to this crack; 0: the node has no side of it.
template <int Dim>
int side_bit(const CrackedNode<Dim>* node, int crack) {
  int bit = 0;
  for (int k = 0; node && k < CrackedNode<Dim>::kMost; ++k)
    if (element(node->crack, k) == crack) bit = 1 << k;
  return bit;
}

/// Mass and momentum of one side of a crack at a node.
template <int Dim>
struct SideMotion {
  double mass = 0;                       ///< kg
  Vec<Dim> momentum = Vec<Dim>::Zero();  ///< kg m/s
};

template <int Dim>
SideMotion<Dim> motion_at(const State<Dim>& state, const SideFields& fields, int body, int bit, int side,
                          const NodeIndex<Dim>& node) {
  const double* mass = state.nodes.column(Nodal::mass);
  SideMotion<Dim> sum;
  fields.for_each(state.field_base, body, [&](int field) {
    if (bit != 0 && ((fields.side(state.field_base, field) & bit) != 0) != (side == 1)) return;
    const int slot = state.tiling.slot(node, field);
    if (slot < 0 || !(mass[slot] > 0)) return;
    sum.mass += mass[slot];
    sum.momentum += mass[slot] * state.nodes.vector(Nodal::velocity, slot);
  });
  return sum;
}

}  // namespace

template <int Dim>
std::optional<Vec<Dim>> side_velocity(const State<Dim>& state, const CrackedNodes<Dim>& nodes,
                                      const SideFields& fields, const CrackLine<Dim>& line, int crack,
                                      int side, const Vec<Dim>& x) {
  NodeIndex<Dim> low;
  Vec<Dim> share;
  for (int d = 0; d < Dim; ++d) {
    const double cells = (x[d] - state.grid.origin[d]) * state.grid.inverse_cell;
    low[d] = node_at(std::floor(cells));
    share[d] = cells - low[d];
  }
  double weight = 0;
  Vec<Dim> velocity = Vec<Dim>::Zero();
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    NodeIndex<Dim> node = low;
    double w = 1;
    for (int d = 0; d < Dim; ++d) {
      node[d] += corner >> d & 1;
      w *= corner >> d & 1 ? share[d] : 1 - share[d];
    }
    const int bit = side_bit(nodes.find(line.field, node), crack);
    const SideMotion<Dim> motion = motion_at(state, fields, line.field, bit, side, node);
    if (!(motion.mass > crack_constants::kLeastNodeMass * line.node_mass)) continue;
    velocity += w / motion.mass * motion.momentum;
    weight += w;
  }
  if (!(weight > 0)) return std::nullopt;
  velocity /= weight;
  return velocity;
}

template <int Dim>
void extend_velocities(SideVelocities<Dim>& side) {
  const auto n = static_cast<std::ptrdiff_t>(side.velocity.size());
  const auto spread = [&](std::ptrdiff_t begin, std::ptrdiff_t end, std::ptrdiff_t step) {
    for (std::ptrdiff_t k = begin + step; k != end; k += step) {
      if (element(side.known, k) || !element(side.known, k - step)) continue;
      element(side.velocity, k) = element(side.velocity, k - step);
      element(side.known, k) = true;
    }
  };
  spread(0, n, 1);
  spread(n - 1, -1, -1);
}

template <int Dim>
void move_line(const State<Dim>& state, const CrackedNodes<Dim>& nodes, const SideFields& fields, int crack,
               double dt, CrackLine<Dim>& line, std::array<SideVelocities<Dim>, 2>& workspace) {
  const std::size_t points = line.points.size();
  for (std::size_t side = 0; side < 2; ++side) {
    SideVelocities<Dim>& of_side = workspace[side];
    of_side.velocity.assign(points, Vec<Dim>::Zero());
    of_side.known.assign(points, false);
    for (std::size_t k = 0; k < points; ++k) {
      const std::optional<Vec<Dim>> found =
          side_velocity(state, nodes, fields, line, crack, static_cast<int>(side), line.sides[side][k]);
      if (!found) continue;
      of_side.velocity[k] = *found;
      of_side.known[k] = true;
    }
    extend_velocities(of_side);
  }
  for (std::size_t k = 0; k < points; ++k)
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec<Dim>& velocity = workspace[workspace[side].known[k] ? side : 1 - side].velocity[k];
      line.sides[side][k] += dt * velocity;
      line.points[k] += 0.5 * dt * velocity;
    }
}

template std::optional<Vec<2>> side_velocity(const State<2>&, const CrackedNodes<2>&, const SideFields&,
                                             const CrackLine<2>&, int, int, const Vec<2>&);
template void extend_velocities(SideVelocities<2>&);
template void move_line(const State<2>&, const CrackedNodes<2>&, const SideFields&, int, double,
                        CrackLine<2>&, std::array<SideVelocities<2>, 2>&);
template std::optional<Vec<3>> side_velocity(const State<3>&, const CrackedNodes<3>&, const SideFields&,
                                             const CrackLine<3>&, int, int, const Vec<3>&);
template void extend_velocities(SideVelocities<3>&);
template void move_line(const State<3>&, const CrackedNodes<3>&, const SideFields&, int, double,
                        CrackLine<3>&, std::array<SideVelocities<3>, 2>&);

}  // namespace mpmfast
