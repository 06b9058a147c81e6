#include "engine/step/surface_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/time_table.hpp"
#include "engine/step/wall_row.hpp"

namespace mpmfast {

namespace {

constexpr double kFar = 1;  ///< cells: what is further away cannot reach a plane in a step

/// Cells: so near to the plane, what touches is held until the forces pull. Any more makes no difference.
constexpr double kTouch = 1e-3;

/// Domains of particles on rings leave gaps: each counts as so much wider.
constexpr double kOver = 1.25;

/// Cells that a particle may come through between two columns. With 0, Hertz's cylinders are 37 % too stiff
/// at first and not 12; with 0.1, particles stay beyond a piston.
constexpr double kSlack = 0.02;

/// What has come further through than kDeep cells is brought back by this part of it in a step. All of it is
/// to be brought back slowly: pushed hard, a column makes energy out of the noise of its particles' extents.
constexpr double kDeep = 0.05, kBack = 0.02;

/// Share of −P v_s that FLIP's particles take. The energy of a bar that rebounds (strain first; uGIMP, lCPDI,
/// quadratic splines) changes by 0.8, 1.1 and 0.2 % with 0, by 0.2, 0.3 and 0.2 % with 0.03, by 0.0, 0.2 and
/// −0.2 % with 0.1 and by 0.5, 0.1 and −0.3 % with 1, where the first force is a seventh too low.
constexpr double kShare = 0.1;

/// Cells from the last row inside to the plane: with less, the next row inside shares the line. A thin sliver
/// of a cell by itself would need a small time step.
constexpr double kThin = 0.5;

constexpr double kReach = 2;  ///< cells: the widest basis function reaches so far

}  // namespace

template <int Dim>
SurfaceWalls<Dim>::SurfaceWalls(const Scene& scene)
    : scene_(&scene), share_(scene.method.update == UpdateKind::flip ? kShare : 1) {
  for (std::size_t b = 0; b < scene.boundaries.size(); ++b) {
    const auto* wall = std::get_if<WallSpec>(&scene.boundaries[b].condition);
    if (!wall || wall->place != WallPlace::surface) continue;
    const double friction = wall->held ? std::numeric_limits<double>::infinity() : wall->friction;
    walls_.push_back({static_cast<int>(b), wall->axis, wall->upper ? 1 : -1, friction});
  }
}

template <int Dim>
void SurfaceWalls<Dim>::prepare(const State<Dim>& state, double t, double dt, const Prescribed& prescribed) {
  if (walls_.empty()) return;
  dt_ = dt;
  for (Wall& wall : walls_) {
    const auto& spec =
        std::get<WallSpec>(scene_->boundaries[static_cast<std::size_t>(wall.boundary)].condition);
    wall.speed = mean_over(spec.speed, t, dt);
    wall.plane = (spec.position + integral_to(spec.speed, t) -
                  scene_->grid.origin[static_cast<std::size_t>(wall.axis)]) /
                 scene_->grid.cell;
    const WallRow at = wall_row(wall.plane, spec.upper);
    stale_ |= at.row != wall.row || (at.cut < kThin) != (wall.cut < kThin);
    wall.row = at.row;
    wall.cut = at.cut;
  }
  if (stale_) list(state, prescribed);
  stale_ = false;
  find_gaps(state);
}

template <int Dim>
void SurfaceWalls<Dim>::list(const State<Dim>& state, const Prescribed& prescribed) {
  columns_.clear();
  at_.clear();
  first_.clear();
  const auto& tiling = state.tiling;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    first_.push_back(static_cast<int>(at_.size()));
    for (const auto& stack : tiling.stacks) {
      const int layer = wall.row - stack.first_node[wall.axis];
      if (layer < 0 || layer >= kTileSide) continue;
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const NodeIndex<Dim> node = tiling.node(stack, local);
        if (node[wall.axis] != wall.row) continue;
        for (int n = stack.begin; n < stack.end; ++n) {
          const int field = tiling.node_tiles[static_cast<std::size_t>(n)].field;
          if (state.field_rigid[static_cast<std::size_t>(field)]) continue;
          at_.emplace_back(n * kTileNodes<Dim> + local, static_cast<int>(columns_.size()));
          list_column(state, static_cast<int>(w), node, field, prescribed);
        }
      }
    }
    std::sort(at_.begin() + first_.back(), at_.end());
  }
  first_.push_back(static_cast<int>(at_.size()));
  list_near(state);
}

/// Rows that another condition prescribes are left to it. The last row inside may belong to one column only:
/// where another wall is as near as two cells, the rows beyond the plane are held as they are.
template <int Dim>
void SurfaceWalls<Dim>::list_column(const State<Dim>& state, int w, const NodeIndex<Dim>& node, int field,
                                    const Prescribed& prescribed) {
  const Wall& wall = walls_[static_cast<std::size_t>(w)];
  const auto at_other = [&](const NodeIndex<Dim>& n, int axis, int margin) {
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& other) {
      return &other != &wall && other.axis == axis && other.out * (n[axis] - other.row) >= -margin;
    });
  };
  Column& column = columns_.emplace_back();
  column.wall = w;
  column.gap = std::numeric_limits<double>::infinity();
  column.sideways = 0;
  column.touches = false;
  NodeIndex<Dim> row = node;
  for (int k = 0; k < kRows; ++k) {
    row[wall.axis] = wall.row + wall.out * (k - kInside);
    const bool free = k >= kInside - (wall.cut < kThin ? 2 : 1) && !prescribed(row, wall.axis) &&
                      !(k < kInside && at_other(row, wall.axis, 1));
    column.slot[static_cast<std::size_t>(k)] = free ? state.tiling.slot(row, field) : -1;
  }
  if (!(wall.friction > 0)) return;
  for (int d = 0; d < Dim; ++d)
    if (d != wall.axis && !prescribed(node, d) && !at_other(node, d, 1)) column.sideways |= 1u << d;
}

template <int Dim>
void SurfaceWalls<Dim>::list_near(const State<Dim>& state) {
  near_.clear();
  const auto& tiles = state.tiling.tiles;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    const auto begin = at_.begin() + first_[w], end = at_.begin() + first_[w + 1];
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      const ParticleTile<Dim>& tile = tiles[t];
      const int layer = wall.row - tile.window[wall.axis];
      if (layer < 0 || layer >= kWindowSide || state.field_rigid[static_cast<std::size_t>(tile.field)])
        continue;
      Near near{static_cast<int>(t), static_cast<int>(w), {}, {}};
      for (int k = 0; k < kAcross; ++k) {
        int corner = 0, local = 0, rest = k;
        for (int d = 0, bit = 1, stride = 1; d < Dim; ++d, bit *= 2, stride *= kTileSide) {
          const int offset = d == wall.axis ? layer : rest % kWindowSide;
          if (d != wall.axis) rest /= kWindowSide;
          corner += offset >= kTileSide ? bit : 0;
          local += offset % kTileSide * stride;
        }
        const int slot = tile.slot[corner] + local;
        const auto found = std::lower_bound(begin, end, std::pair(slot, 0));
        near.column[static_cast<std::size_t>(k)] = found != end && found->first == slot ? found->second : -1;
      }
      near_.push_back(near);
    }
  }
}

/// The gaps of the columns that the particles of one tile are near to.
template <int Dim>
void SurfaceWalls<Dim>::measure(const State<Dim>& state, Near& near) const {
  const Wall& wall = walls_[static_cast<std::size_t>(near.wall)];
  const ParticleTile<Dim>& tile = state.tiling.tiles[static_cast<std::size_t>(near.tile)];
  const auto& particles = state.particles;
  const double inverse = state.grid.inverse_cell;
  const double* position[Dim];
  const double* deformation[Dim * Dim];
  for (int d = 0; d < Dim; ++d) {
    position[d] = particles.column(Quantity::position, d);
  }
  for (int e = 0; e < Dim * Dim; ++e) deformation[e] = particles.column(Quantity::deformation_gradient, e);
  near.gap.fill({});
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const ParticleRun<Dim>& run = state.tiling.runs[static_cast<std::size_t>(r)];
    const BodyView<Dim>& body = state.bodies[static_cast<std::size_t>(run.body)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      const double inside =
          wall.out * (wall.plane - (position[wall.axis][p] - state.grid.origin[wall.axis]) * inverse);
      if (inside > 2 * kFar || inside < -kRowsBeyond) continue;
      const auto extent = [&](int axis) {
        double sum = 0;
        for (int d = 0; d < Dim; ++d) sum += std::abs(deformation[axis * Dim + d][p]) * body.half_size[d];
        return sum * inverse;
      };
      const double gap = inside - extent(wall.axis);
      if (!(gap < kFar)) continue;
      int low[Dim], high[Dim];
      double xi[Dim], width[Dim];
      for (int d = 0; d < Dim; ++d) {
        if (d == wall.axis) continue;
        xi[d] = (position[d][p] - state.grid.origin[d]) * inverse - tile.window[d];
        width[d] = kOver * extent(d);
        low[d] = std::max(0, static_cast<int>(std::floor(xi[d] - kReach)) + 1);
        high[d] = std::min(kWindowSide - 1, static_cast<int>(std::ceil(xi[d] + kReach)) - 1);
      }
      const int first = wall.axis == 0 ? 1 : 0, second = wall.axis == 2 ? 1 : 2;
      if constexpr (Dim == 2) {
        for (int i = low[first]; i <= high[first]; ++i) {
          const double t = std::abs(i - xi[first]);
          auto& least = near.gap[static_cast<std::size_t>(i)].of(t < width[first], t < 1);
          least = std::min(least, gap);
        }
      } else {
        for (int j = low[second]; j <= high[second]; ++j)
          for (int i = low[first]; i <= high[first]; ++i) {
            const double s = std::abs(i - xi[first]), t = std::abs(j - xi[second]);
            const bool over = s < width[first] && t < width[second];
            auto& least = near.gap[static_cast<std::size_t>(j * kWindowSide + i)].of(over, s < 1 && t < 1);
            least = std::min(least, gap);
          }
      }
    }
  }
}

template <int Dim>
void SurfaceWalls<Dim>::find_gaps(const State<Dim>& state) {
  const auto n = static_cast<std::int64_t>(near_.size());
#pragma omp parallel for num_threads(state.threads) schedule(static) if (n > 16)
  for (std::int64_t k = 0; k < n; ++k) measure(state, near_[static_cast<std::size_t>(k)]);
  for (Column& column : columns_) column.gaps = {};
  for (const Near& near : near_)
    for (std::size_t k = 0; k < kAcross; ++k) {
      if (near.column[k] < 0) continue;
      Column& column = columns_[static_cast<std::size_t>(near.column[k])];
      column.gaps.take(near.gap[k]);
    }
  for (Column& column : columns_) column.gap = state.grid.cell * column.gaps.least(kSlack);
}

/// On row k, at s_k = k − ξ cells from the plane, the velocity becomes u + g s_k with the slope of the least
/// Σ m (u + g s − v)², g = Σ m s (v − u) / Σ m s²; without a row inside, g = 0.
template <int Dim>
template <class Velocity>
auto SurfaceWalls<Dim>::straighten(const State<Dim>& state, const Column& column, double target,
                                   Velocity velocity) const -> Change {
  const double* mass = state.nodes.column(Nodal::mass);
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  double moment = 0, inertia = 0, m[kRows], s[kRows], v[kRows]{};
  for (std::size_t k = 0; k < kRows; ++k) {
    m[k] = column.slot[k] < 0 ? 0 : mass[column.slot[k]];
    s[k] = static_cast<double>(k) - (kInside - 1) - wall.cut;
    if (!(m[k] > 0)) continue;
    v[k] = velocity(column.slot[k], m[k]);
    moment += m[k] * s[k] * (v[k] - target);
    inertia += m[k] * s[k] * s[k];
  }
  const double slope = m[kInside - 1] > 0 ? moment / inertia : 0;
  Change change;
  for (std::size_t k = 0; k < kRows; ++k) {
    if (!(m[k] > 0)) continue;
    change.row[k] = m[k] * (target + slope * s[k] - v[k]);
    change.sum += change.row[k];
  }
  return change;
}

template <int Dim>
auto SurfaceWalls<Dim>::of_momentum(const State<Dim>& state, const Column& column, double target,
                                    int axis) const -> Change {
  const double* momentum = state.nodes.column(Nodal::momentum, axis);
  return straighten(state, column, target, [&](int slot, double mass) { return momentum[slot] / mass; });
}

template <int Dim>
void SurfaceWalls<Dim>::add(State<Dim>& state, Nodal q, const Column& column, int axis, const Change& change,
                            double factor) const {
  double* values = state.nodes.column(q, axis);
  for (std::size_t k = 0; k < kRows; ++k)
    if (column.slot[k] >= 0) values[column.slot[k]] += factor * change.row[k];
}

/// The velocity that closes the gap by the end of the step, and the wall's where it is closed.
template <int Dim>
double SurfaceWalls<Dim>::closing(const Column& column) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  return wall.speed +
         wall.out *
             (column.gap > 0 ? column.gap : kBack * std::min(0.0, column.gap + kDeep * scene_->grid.cell)) /
             dt_;
}

/// A column touches where it would otherwise end the step beyond the plane. One that is at the plane and
/// parts is held too: contact ends where the forces pull, not where noise does (react).
template <int Dim>
void SurfaceWalls<Dim>::decide(const State<Dim>& state) {
  if (walls_.empty()) return;
  held_.assign(static_cast<std::size_t>(state.tiling.slots()), 0);
  const double near = kTouch * state.grid.cell;
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    column.pushed = 0;
    column.touches = false;
    if (!(column.gap < kFar * state.grid.cell)) continue;
    column.target = closing(column);
    column.touches = -wall.out * of_momentum(state, column, column.target, wall.axis).sum > 0;
    if (!column.touches && column.gap < near) {
      column.touches = wall.out * of_momentum(state, column, wall.speed, wall.axis).sum > 0;
      if (column.touches) column.target = column.gap < 0 ? closing(column) : wall.speed;
    }
    if (!column.touches) continue;
    for (const int slot : column.slot)
      if (slot >= 0) held_[static_cast<std::size_t>(slot)] |= static_cast<std::uint8_t>(1u << wall.axis);
  }
}

template <int Dim>
void SurfaceWalls<Dim>::impose_velocity(State<Dim>& state, Nodal velocities) {
  const double* mass = state.nodes.column(Nodal::mass);
  for (const Column& column : columns_) {
    if (!column.touches) continue;
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    double* v = state.nodes.column(velocities, wall.axis);
    const Change change = straighten(state, column, column.target, [&](int slot, double) { return v[slot]; });
    for (std::size_t k = 0; k < kRows; ++k)
      if (change.row[k] != 0) v[column.slot[k]] += change.row[k] / mass[column.slot[k]];
  }
}

/// Impulses that the particles take too.
template <int Dim>
void SurfaceWalls<Dim>::push(State<Dim>& state, double dt, Column& column, const Change& change,
                             double factor, BoundaryBooks<Dim>& books) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  add(state, Nodal::force, column, wall.axis, change, factor / dt);
  const double impulse = factor * change.sum;
  column.pushed -= wall.out * impulse;
  books.force[static_cast<std::size_t>(wall.boundary)][wall.axis] += impulse / dt;
  books.work += impulse * wall.speed;
}

template <int Dim>
void SurfaceWalls<Dim>::react(State<Dim>& state, double dt, BoundaryBooks<Dim>& books) {
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    if (!(column.gap < kFar * state.grid.cell)) continue;
    const double *force = state.nodes.column(Nodal::force, wall.axis),
                 *momentum = state.nodes.column(Nodal::momentum, wall.axis);
    if (!column.touches) {
      const Change both = straighten(state, column, column.target, [&](int slot, double mass) {
        return (momentum[slot] + dt * force[slot]) / mass;
      });
      if (!(-wall.out * both.sum > 0)) continue;
      column.touches = true;
      push(state, dt, column, both, 1, books);
      continue;
    }
    const Change start = of_momentum(state, column, column.target, wall.axis);
    const Change forced =
        straighten(state, column, 0, [&](int slot, double mass) { return dt * force[slot] / mass; });
    const double by_force = -wall.out * forced.sum, by_start = -wall.out * start.sum;
    if (by_force + share_ * by_start > 0) {
      push(state, dt, column, forced, 1, books);
      push(state, dt, column, start, share_, books);
      add(state, Nodal::momentum, column, wall.axis, start, 1 - share_);
    } else if (by_force + by_start > 0) {  // it comes in while the forces pull: the grid alone is held
      add(state, Nodal::momentum, column, wall.axis, start, 1);
      add(state, Nodal::momentum, column, wall.axis, forced, 1);
    } else {
      column.touches = false;
      column.target = closing(column);
    }
  }
}

template <int Dim>
void SurfaceWalls<Dim>::enforce(State<Dim>& state, double dt, BoundaryBooks<Dim>& books) {
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    if (!(column.gap < kFar * state.grid.cell)) continue;
    const Change change = of_momentum(state, column, column.target, wall.axis);
    const double inwards = -wall.out * change.sum;
    if (!column.touches && !(inwards > 0)) continue;
    // The step as a whole pushes, at most until nothing is left of what it pushed.
    const double factor = column.pushed + inwards >= 0 ? 1 : -column.pushed / inwards;
    column.touches = factor == 1;
    push(state, dt, column, change, factor, books);
    add(state, Nodal::momentum, column, wall.axis, change, factor);
  }
  for (const Column& column : columns_)
    if (column.sideways && column.touches) rub(state, dt, column, books);
}

/// Coulomb: the impulse that stops the slip at the plane, at most μ times the one along the normal.
template <int Dim>
void SurfaceWalls<Dim>::rub(State<Dim>& state, double dt, const Column& column,
                            BoundaryBooks<Dim>& books) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  Change stick[Dim];
  double squared = 0;
  for (int d = 0; d < Dim; ++d) {
    if (!(column.sideways >> d & 1)) continue;
    stick[d] = of_momentum(state, column, 0, d);
    squared += stick[d].sum * stick[d].sum;
  }
  const double needed = std::sqrt(squared);
  const bool sticks = std::isinf(wall.friction) || needed <= wall.friction * column.pushed;
  const double factor = sticks ? 1 : wall.friction * std::max(0.0, column.pushed) / needed;
  for (int d = 0; d < Dim; ++d) {
    if (!(column.sideways >> d & 1)) continue;
    add(state, Nodal::momentum, column, d, stick[d], factor);
    add(state, Nodal::force, column, d, stick[d], factor / dt);
    books.force[static_cast<std::size_t>(wall.boundary)][d] += factor * stick[d].sum / dt;
    const double *mass = state.nodes.column(Nodal::mass), *momentum = state.nodes.column(Nodal::momentum, d);
    for (std::size_t k = 0; k < kRows; ++k)
      if (stick[d].row[k] != 0)
        books.friction_work -= factor * stick[d].row[k] * momentum[column.slot[k]] / mass[column.slot[k]];
  }
}

template class SurfaceWalls<2>;
template class SurfaceWalls<3>;

}  // namespace mpmfast
