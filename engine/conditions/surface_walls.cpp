#include "engine/conditions/surface_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/conditions/wall_row.hpp"
#include "engine/constants.hpp"
#include "engine/quantities/time_table.hpp"

namespace mpmfast {

template <int Dim>
SurfaceWalls<Dim>::SurfaceWalls(const Scene& scene)
    : scene_(&scene),
      share_(scene.method.update == UpdateKind::flip ? constants::conditions::kFlipShare : 1),
      whole_(scene.method.strain == StrainKind::average_re_extrapolated ||
             scene.method.strain == StrainKind::last_re_extrapolated),
      holds_(scene.method.update == UpdateKind::flip) {
  for (std::size_t b = 0; b < scene.boundaries.size(); ++b) {
    const auto* wall = std::get_if<WallSpec>(&scene.boundaries[b].condition);
    if (!wall || wall->enforcement != WallEnforcement::surface) continue;
    const double friction = wall->fixed ? std::numeric_limits<double>::infinity() : wall->friction;
    walls_.push_back(
        {static_cast<int>(b), wall->axis, wall->upper ? 1 : -1, friction, largest(wall->speed) > 0});
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
    using constants::conditions::kThinLayer;
    const WallRow at = wall_row(wall.plane, spec.upper);
    stale_ |= at.row != wall.row || (at.cut < kThinLayer) != (wall.cut < kThinLayer);
    wall.row = at.row;
    wall.cut = at.cut;
  }
  if (stale_) list(state, prescribed);
  stale_ = false;
  find_gaps(state);
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
double SurfaceWalls<Dim>::target_approach(const Column& column) const {
  using constants::conditions::kDepthShare, constants::conditions::kKeptDepth;
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  return wall.speed + wall.out *
                          (column.gap > 0
                               ? column.gap
                               : kDepthShare * std::min(0.0, column.gap + kKeptDepth * scene_->grid.cell)) /
                          dt_;
}

/// A column touches where it would otherwise end the step beyond the plane. One that is at the plane and
/// parts is held too: contact ends where the forces pull, not where noise does (react).
template <int Dim>
void SurfaceWalls<Dim>::decide(const State<Dim>& state) {
  if (walls_.empty()) return;
  constrained_.assign(static_cast<std::size_t>(state.tiling.slots()), 0);
  const double near = constants::conditions::kTouchingGap * state.grid.cell;
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    column.pushed = 0;
    column.touches = false;
    if (!(column.gap < constants::conditions::kFarGap * state.grid.cell)) {
      column.stuck = false;
      continue;
    }
    column.target = target_approach(column);
    column.touches = -wall.out * of_momentum(state, column, column.target, wall.axis).sum > 0;
    if (!column.touches && column.gap < near) {
      column.touches = wall.out * of_momentum(state, column, wall.speed, wall.axis).sum > 0;
      if (column.touches) column.target = column.gap < 0 ? target_approach(column) : wall.speed;
    }
    column.stuck = column.stuck && column.touches;
    if (!column.touches) continue;
    for (const int slot : column.slot)
      if (slot >= 0)
        constrained_[static_cast<std::size_t>(slot)] |= static_cast<std::uint8_t>(1u << wall.axis);
  }
}

template <int Dim>
void SurfaceWalls<Dim>::straighten_velocity(State<Dim>& state, Nodal velocities, const Column& column,
                                            double target, int axis) const {
  const double* mass = state.nodes.column(Nodal::mass);
  double* v = state.nodes.column(velocities, axis);
  const Change change = straighten(state, column, target, [&](int slot, double) { return v[slot]; });
  for (std::size_t k = 0; k < kRows; ++k)
    if (change.row[k] != 0) v[column.slot[k]] += change.row[k] / mass[column.slot[k]];
}

template <int Dim>
void SurfaceWalls<Dim>::impose_velocity(State<Dim>& state, Nodal velocities, BoundaryLedger<Dim>& ledger) {
  for (const Column& column : columns_) {
    if (!column.touches) continue;
    straighten_velocity(state, velocities, column, column.target,
                        walls_[static_cast<std::size_t>(column.wall)].axis);
    for_each_sideways(column, [&](int d, Friction& friction) {
      if (velocities == Nodal::re_extrapolated)
        ledger.friction_work += friction_work(state, column, d, friction);
      if (column.stuck) straighten_velocity(state, velocities, column, 0, d);
    });
  }
}

/// What particles lose by sliding, J, with the impulse J along the wall: −J·½(v^c + v'^c) + ½(J₁ + J₃)·(v⁺ −
/// v^c); v^c and v'^c are what the strains see, J₁ and J₃ what holds put into them, v⁺ the velocity after J.
template <int Dim>
double SurfaceWalls<Dim>::friction_work(const State<Dim>& state, const Column& column, int axis,
                                        const Friction& friction) const {
  const double *mass = state.nodes.column(Nodal::mass), *end = state.nodes.column(Nodal::velocity, axis),
               *back = state.nodes.column(Nodal::re_extrapolated, axis);
  const Change third =
      column.stuck ? straighten(state, column, 0, [&](int slot, double) { return back[slot]; }) : Change{};
  double gain = 0;
  for (std::size_t k = 0; k < kRows; ++k) {
    const int slot = column.slot[k];
    if (slot < 0 || !(mass[slot] > 0)) continue;
    gain += 0.5 * friction.impulse[k] * (friction.held[k] + back[slot] + third.row[k] / mass[slot]) -
            0.5 * (friction.first[k] + third.row[k]) * (end[slot] - friction.held[k]);
  }
  return -gain;
}

/// Impulses that the particles take too.
template <int Dim>
void SurfaceWalls<Dim>::push(State<Dim>& state, double dt, Column& column, const Change& change,
                             double factor, BoundaryLedger<Dim>& ledger) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  add(state, Nodal::force, column, wall.axis, change, factor / dt);
  const double impulse = factor * change.sum;
  column.pushed -= wall.out * impulse;
  ledger.force[static_cast<std::size_t>(wall.boundary)][wall.axis] += impulse / dt;
  ledger.work += impulse * wall.speed;
}

/// What sticks keeps its slip in its particles, as pairs do: no force, but the grid does not see it.
template <int Dim>
void SurfaceWalls<Dim>::hold_slip(State<Dim>& state, const Column& column) {
  for_each_sideways(column, [&](int d, Friction& friction) {
    const Change change = of_momentum(state, column, 0, d);
    add(state, Nodal::momentum, column, d, change, 1);
    std::copy(change.row, change.row + kRows, friction.first.begin());
  });
}

template <int Dim>
void SurfaceWalls<Dim>::react(State<Dim>& state, double dt, BoundaryLedger<Dim>& ledger) {
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    if (!(column.gap < constants::conditions::kFarGap * state.grid.cell)) continue;
    const double *force = state.nodes.column(Nodal::force, wall.axis),
                 *momentum = state.nodes.column(Nodal::momentum, wall.axis);
    if (!column.touches) {
      const Change both = straighten(state, column, column.target, [&](int slot, double mass) {
        return (momentum[slot] + dt * force[slot]) / mass;
      });
      if (!(-wall.out * both.sum > 0)) continue;
      column.touches = true;
      if (wall.moves) take_touch(state, column, both, ledger);
      push(state, dt, column, both, 1, ledger);
      continue;
    }
    if (column.stuck) hold_slip(state, column);
    const Change start = of_momentum(state, column, column.target, wall.axis);
    const Change forced =
        straighten(state, column, 0, [&](int slot, double mass) { return dt * force[slot] / mass; });
    const double by_force = -wall.out * forced.sum, by_start = -wall.out * start.sum;
    if (by_force + share_ * by_start > 0) {
      push(state, dt, column, forced, 1, ledger);
      take(state, column, start, ledger);
      if (wall.moves) ledger.work += forced.sum * (column.target - wall.speed);
      push(state, dt, column, start, share_, ledger);
      add(state, Nodal::momentum, column, wall.axis, start, 1 - share_);
    } else if (by_force + by_start > 0) {  // it comes in while the forces pull: the grid alone is held
      add(state, Nodal::momentum, column, wall.axis, start, 1);
      add(state, Nodal::momentum, column, wall.axis, forced, 1);
    } else {
      column.touches = false;
      column.target = target_approach(column);
    }
  }
}

template <int Dim>
void SurfaceWalls<Dim>::enforce(State<Dim>& state, double dt, BoundaryLedger<Dim>& ledger) {
  for (Column& column : columns_) {
    const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
    if (!(column.gap < constants::conditions::kFarGap * state.grid.cell)) continue;
    const Change change = of_momentum(state, column, column.target, wall.axis);
    const double inwards = -wall.out * change.sum;
    if (!column.touches && !(inwards > 0)) continue;
    // The step as a whole pushes, at most until nothing is left of what it pushed.
    const double factor = column.pushed + inwards >= 0 ? 1 : -column.pushed / inwards;
    column.touches = factor == 1;
    push(state, dt, column, change, factor, ledger);
    add(state, Nodal::momentum, column, wall.axis, change, factor);
  }
  for (Column& column : columns_)
    if (column.touches)
      apply_friction(state, dt, column, ledger);
    else
      release(state, dt, column, ledger);
}

/// What has stuck and parts: the grid was held before the forces, and what those do since is not strained.
template <int Dim>
void SurfaceWalls<Dim>::release(const State<Dim>& state, double dt, Column& column,
                                BoundaryLedger<Dim>& ledger) {
  const double* mass = state.nodes.column(Nodal::mass);
  if (column.stuck && whole_)
    for_each_sideways(column, [&](int d, const Friction& friction) {
      const double* force = state.nodes.column(Nodal::force, d);
      for (std::size_t k = 0; k < kRows; ++k)
        if (const int slot = column.slot[k]; slot >= 0 && mass[slot] > 0)
          ledger.friction_work += 0.5 * friction.first[k] * dt * force[slot] / mass[slot];
    });
  column.stuck = false;
}

/// Coulomb: the impulse that stops the slip at the plane, at most μ times the one along the normal.
template <int Dim>
void SurfaceWalls<Dim>::apply_friction(State<Dim>& state, double dt, Column& column,
                                       BoundaryLedger<Dim>& ledger) {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  Change stick[Dim];
  double squared = 0;
  for_each_sideways(column, [&](int d, Friction&) {
    stick[d] = of_momentum(state, column, 0, d);
    squared += stick[d].sum * stick[d].sum;
  });
  const double needed = std::sqrt(squared);
  const bool sticks =
      std::isinf(wall.friction) || (needed <= wall.friction * column.pushed && column.pushed > 0);
  // What rests exactly, as loose sand does, needs nothing.
  const double factor = sticks ? 1 : needed > 0 ? wall.friction * std::max(0.0, column.pushed) / needed : 0;
  const double* mass = state.nodes.column(Nodal::mass);
  for_each_sideways(column, [&](int d, Friction& friction) {
    const double *momentum = state.nodes.column(Nodal::momentum, d),
                 *force = state.nodes.column(Nodal::force, d);
    if (!column.stuck) friction.first = {};
    for (std::size_t k = 0; k < kRows; ++k) {
      const int slot = column.slot[k];
      if (slot < 0 || !(mass[slot] > 0)) continue;
      friction.impulse[k] = factor * stick[d].row[k];
      friction.held[k] = (momentum[slot] - dt * force[slot]) / mass[slot];
    }
    add(state, Nodal::momentum, column, d, stick[d], factor);
    add(state, Nodal::force, column, d, stick[d], factor / dt);
    ledger.force[static_cast<std::size_t>(wall.boundary)][d] += factor * stick[d].sum / dt;
    for (std::size_t k = 0; !whole_ && k < kRows; ++k)
      if (stick[d].row[k] != 0)
        ledger.friction_work -= friction.impulse[k] * momentum[column.slot[k]] / mass[column.slot[k]];
  });
  column.stuck = sticks && holds_ && column.sideways != 0;
}

template <int Dim>
void SurfaceWalls<Dim>::keep_stuck() {
  if (columns_.empty()) return;
  stuck_.clear();
  for (const Column& column : columns_)
    if (column.stuck) stuck_.push_back(column.key);
  std::sort(stuck_.begin(), stuck_.end());
}

template <int Dim>
void SurfaceWalls<Dim>::visit(Archive& archive) {
  if (!holds_ || walls_.empty()) return;
  if (archive.reading())
    columns_.clear();
  else
    keep_stuck();
  archive.list("walls/stuck", stuck_);
  stale_ = true;
}

template class SurfaceWalls<2>;
template class SurfaceWalls<3>;

}  // namespace mpmfast
