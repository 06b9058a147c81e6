/// Heat from faces of the grid and at given nodes.

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/conditions/wall_row.hpp"
#include "engine/constants.hpp"
#include "engine/heat/heat.hpp"

namespace mpmfast {

namespace {

/// Rows of nodes on either side of a face that its heat may reach.
constexpr int kRowsAround = 2;

/// Where the face of a condition is at a time, m: that of its wall, or of the grid.
double position_of(const Scene& scene, const HeatConditionSpec& condition, double t) {
  for (const BoundarySpec& boundary : scene.boundaries) {
    const auto* wall = std::get_if<WallSpec>(&boundary.condition);
    if (wall && wall->axis == condition.axis && wall->upper == condition.upper)
      return wall->position + integral_to(wall->speed, t);
  }
  const auto axis = static_cast<std::size_t>(condition.axis);
  return scene.grid.origin[axis] + (condition.upper ? scene.grid.size[axis] : 0);
}

}  // namespace

/// The nodes of conditions: at and beyond a face where they hold, with those before it that its heat comes
/// to; around it where they feed; or in a box.
template <int Dim>
void Heat<Dim>::list_nodes(const State<Dim>& state) {
  fed_.clear();
  const auto& conditions = scene_->heat.conditions;
  const auto& grid = scene_->grid;
  for (const auto& block : state.tiling.node_blocks)
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const NodeIndex<Dim> node = state.tiling.node(block, local);
      for (std::size_t c = 0; c < conditions.size(); ++c) {
        const HeatConditionSpec& condition = conditions[c];
        bool in = true, inside = false;
        if (condition.face) {
          const int beyond = (condition.upper ? 1 : -1) * (node[condition.axis] - row_[c]);
          inside = holds(static_cast<int>(c)) && beyond < 0;
          in = holds(static_cast<int>(c)) ? beyond >= -kRowsAround : std::abs(beyond) <= kRowsAround;
        } else {
          for (std::size_t d = 0; d < Dim; ++d) {
            const double x = grid.origin[d] + node[static_cast<int>(d)] * grid.cell,
                         slack = constants::conditions::kRowTolerance * grid.cell;
            in &= x >= condition.lower[d] - slack && x <= condition.corner[d] + slack;
          }
        }
        if (!in) continue;
        for (int t = block.begin; t < block.end; ++t) {
          const int field = state.tiling.node_tiles[static_cast<std::size_t>(t)].field;
          if (state.field_rigid[static_cast<std::size_t>(field)]) continue;
          NodeIndex<Dim> row = node;
          if (inside) row[condition.axis] = row_[c];
          const int across = inside ? state.tiling.slot(row, field) : -1;
          if (inside && across < 0) continue;
          Fed& fed = fed_.emplace_back();
          fed.across = across;
          fed.slot = t * kTileNodes<Dim> + local;
          fed.condition = static_cast<int>(c);
          fed.node = node;
          fed.field = field;
        }
        if (holds(static_cast<int>(c)) && !inside) break;  // the first that holds a node counts
      }
    }
}

/// Where a node beyond a face takes its temperature from: as far inside on the other side, between two rows,
/// where the field has them. (At the temperature of the face, rows of a spline beyond it hold a slab of 20
/// cells 2 % off, and a face that cuts a cell is taken to lie on its next row.)
template <int Dim>
void Heat<Dim>::mirror(const State<Dim>& state, Fed& fed) const {
  const auto c = static_cast<std::size_t>(fed.condition);
  const int axis = scene_->heat.conditions[c].axis;
  fed.by_face = 1;
  fed.by_inner = {};
  const double at = 2 * plane_[c] - fed.node[axis];
  if (std::abs(at - fed.node[axis]) < 2 * constants::conditions::kRowTolerance) return;  // on the face
  NodeIndex<Dim> row = fed.node;
  row[axis] = static_cast<int>(std::floor(at + constants::conditions::kRowTolerance));
  const double second = std::max(0.0, at - row[axis]);
  std::array<double, 2> share{1 - second, second > constants::conditions::kRowTolerance ? second : 0};
  std::array<int, 2> slot{};
  double own = 0;  // what of it is the node itself
  for (std::size_t k = 0; k < 2; ++k, ++row[axis]) {
    if (share[k] == 0) continue;
    slot[k] = state.tiling.slot(row, fed.field);
    if (slot[k] < 0 || !(state.nodes.column(Nodal::heat_capacity)[slot[k]] > 0)) return;
    if (slot[k] == fed.slot) own = std::exchange(share[k], 0);
  }
  fed.inner = slot;
  fed.by_face = 2 / (1 + own);
  for (std::size_t k = 0; k < 2; ++k) fed.by_inner[k] = -share[k] / (1 + own);
}

/// Inside of a face that holds, what conducts ends within the supports of nodes that are free: conduction
/// alone would keep their share of what comes through the face, ∫ k ∂T/∂n N_i dS, as if they were insulated.
/// With it, a straight line of temperatures stays, wherever the face cuts the cells.
template <int Dim>
void Heat<Dim>::apply_boundary_flow(State<Dim>& state, const Fed& fed, double dt) {
  auto& nodes = state.nodes;
  const double* capacity = nodes.column(Nodal::heat_capacity);
  if (!(capacity[fed.slot] > 0) || !(capacity[fed.across] > 0)) return;
  const HeatConditionSpec& condition = scene_->heat.conditions[static_cast<std::size_t>(fed.condition)];
  const double out = nodes.column(Nodal::conducting_surface, condition.axis)[fed.slot];
  if (!(condition.upper ? out > 0 : out < 0)) return;
  const double flow = out * nodes.column(Nodal::heat_slope, condition.axis)[fed.slot] / capacity[fed.slot];
  nodes.column(Nodal::heat_flow)[fed.slot] += flow;
  sums_.conditions[static_cast<std::size_t>(fed.condition)] += flow * dt;
}

/// Heat through faces, ∫ q N_i dS: Σ G_pi V_p is ∫ N_i n dS over the surface of a body.
template <int Dim>
void Heat<Dim>::feed(State<Dim>& state, double t, double dt) {
  const auto& conditions = scene_->heat.conditions;
  if (conditions.empty()) return;
  const auto& grid = scene_->grid;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    if (!conditions[c].face) continue;
    const double plane = position_of(*scene_, conditions[c], t);
    const double cells = (plane - grid.origin[static_cast<std::size_t>(conditions[c].axis)]) / grid.cell;
    const int row = wall_row(cells, conditions[c].upper).row;
    stale_ |= row != row_[c];
    plane_[c] = cells;
    row_[c] = row;
  }
  if (stale_) list_nodes(state);
  stale_ = false;
  auto& nodes = state.nodes;
  const double* capacity = nodes.column(Nodal::heat_capacity);
  for (Fed& fed : fed_) {
    const HeatConditionSpec& condition = conditions[static_cast<std::size_t>(fed.condition)];
    if (fed.across >= 0) {
      apply_boundary_flow(state, fed, dt);
      continue;
    }
    if (holds(fed)) {
      if (condition.face) mirror(state, fed);
      continue;
    }
    if (!(capacity[fed.slot] > 0)) continue;
    const double out = nodes.column(Nodal::volume_gradient, condition.axis)[fed.slot];
    const double area = around(state, fed.node) * std::max(0.0, condition.upper ? out : -out);
    double flow = mean_over(condition.value, t, dt) * area;
    if (condition.kind == HeatConditionSpec::Kind::ambient) {
      // As across a surface whose other side keeps its temperature (Heat::cross).
      const double colder = flow / std::max(area, constants::heat::kLeastArea) - scale_.reference -
                            nodes.column(Nodal::temperature)[fed.slot];
      flow =
          capacity[fed.slot] / dt * shared(condition.coefficient * area / capacity[fed.slot] * dt) * colder;
    }
    nodes.column(Nodal::heat_flow)[fed.slot] += flow;
    sums_.conditions[static_cast<std::size_t>(fed.condition)] += flow * dt;
  }
}

template void Heat<2>::list_nodes(const State<2>&);
template void Heat<3>::list_nodes(const State<3>&);
template void Heat<2>::apply_boundary_flow(State<2>&, const Fed&, double);
template void Heat<3>::apply_boundary_flow(State<3>&, const Fed&, double);
template void Heat<2>::feed(State<2>&, double, double);
template void Heat<3>::feed(State<3>&, double, double);

}  // namespace mpmfast
