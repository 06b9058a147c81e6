#include "engine/contact/surface/surface_contact.hpp"

#include <cmath>

#include "engine/constants.hpp"
#include "engine/contact/surface/point_solver.hpp"
#include "engine/contact/surface/record_points.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// Calls f(p) for all points, in parallel.
template <int Dim, class F>
void for_each_point(const SurfaceList<Dim>& points, int threads, const F& f) {
  for_each_of(static_cast<std::int64_t>(points.size()), threads, constants::threads::kFewNodes,
              [&](std::int64_t p) { f(static_cast<int>(p)); });
}

/// Subtracts from `as_force` the part of the second impulse that only closes the gap (force_part).
template <int Dim>
void remove_closing_part(const CorrectionMethod& method, const SurfaceList<Dim>& points, int p,
                         PairImpulses<Dim>& impulse) {
  const Vec<Dim>& normal = points.geometry[p].normal;
  const PointSolve<Dim>& solve = points.solve[p];
  const double normal_impulse = impulse.now.dot(normal);
  ContactPair alone{};
  alone.sole = true;
  const double as_force = force_part<Dim>(method, alone, points.status[p], points.relative[p], normal,
                                          {solve.trial, solve.reduced_mass}, normal_impulse);
  impulse.as_force -= (normal_impulse - as_force) * normal;
}

}  // namespace

template <int Dim>
SurfaceContact<Dim>::SurfaceContact(const Scene& scene, const Plan& plan, const PairLaws& laws)
    : laws_(laws), method_(scene, plan) {}

template <int Dim>
std::size_t SurfaceContact<Dim>::bytes() const {
  return bytes_in(samples_, points_.geometry, points_.stencil, points_.solve, points_.before, points_.status,
                  points_.impulse, points_.relative, points_.nodes, points_.responses) +
         finder_.bytes() + memory_.bytes();
}

template <int Dim>
void SurfaceContact<Dim>::find(const State<Dim>& state, const FreeDirections<Dim>& free,
                               const ContactList<Dim>& contacts) {
  conditions_ = free.conditions;
  memory_.sort(state.grid);
  finder_.find(state, laws_, free, contacts, samples_, memory_, points_);
}

/// Reads the velocities of the nodes, prescribed ones included.
template <int Dim>
void SurfaceContact<Dim>::start(const State<Dim>& state) {
  for_each_of(static_cast<std::int64_t>(points_.nodes.size()), state.threads, constants::threads::kFewNodes,
              [&](std::int64_t k) {
                SurfaceNode<Dim>& node = points_.nodes[k];
                points_.responses[k].velocity = conditions_->with_prescribed(
                    node.constraint, state.nodes.vector(Nodal::momentum, node.slot) / node.mass);
                node.impulse.setZero();
                node.as_force.setZero();
              });
}

/// Stores the relative velocities before any correction, and decides which points persist
/// (decide_persistence).
template <int Dim>
void SurfaceContact<Dim>::begin_active_set(double cell, double dt) {
  for (std::size_t p = 0; p < points_.size(); ++p) {
    decide_persistence(points_.before[p], points_.geometry[p].separation, cell, dt, points_.status[p]);
    RelativeVelocities<Dim>& relative = points_.relative[p];
    relative.start = relative.after_first = points_.relative_velocity(static_cast<int>(p));
  }
}

/// Adds the impulses to the nodal momenta, and to the forces what counts as one.
template <int Dim>
void SurfaceContact<Dim>::change_nodes(State<Dim>& state, double dt, bool forces) const {
  for_each_of(static_cast<std::int64_t>(points_.nodes.size()), state.threads, constants::threads::kFewNodes,
              [&](std::int64_t k) {
                const SurfaceNode<Dim>& node = points_.nodes[k];
                const auto add = [&](Nodal column, const Vec<Dim>& change) {
                  state.nodes.set(column, node.slot, state.nodes.vector(column, node.slot) + change);
                };
                add(Nodal::momentum, node.impulse);
                if (forces) add(Nodal::force, (node.impulse + node.as_force) / dt);
              });
}

template <int Dim>
void SurfaceContact<Dim>::correct_first(State<Dim>& state, const StepTimes& times) {
  start(state);
  begin_active_set(state.grid.cell, times.dt);
  solve_points<Dim>({laws_, first_rule(method_), state.threads}, points_, [&](int p) {
    points_.impulse[p].as_force = method_.first_share * points_.impulse[p].now;
  });
  change_nodes(state, times.dt, false);
  if (method_.keeps_velocity_change)
    for (std::size_t k = 0; k < points_.nodes.size(); ++k)
      for (int d = 0; d < Dim; ++d)
        state.nodes.column(Nodal::star, Dim + d)[points_.nodes[k].slot] +=
            points_.nodes[k].impulse[d] * points_.responses[k].inverse_mass[d];
  for_each_point(points_, state.threads, [&](int p) {
    PairImpulses<Dim>& impulse = points_.impulse[p];
    impulse.first = impulse.now;
    points_.status[p].active_in_first = !impulse.now.isZero(0);
    points_.relative[p].after_first = points_.relative_velocity(p);
  });
}

template <int Dim>
void SurfaceContact<Dim>::correct_second(State<Dim>& state, const StepTimes& times,
                                         const std::vector<Vec<Dim>>& pivots, ContactLedger<Dim>& ledger) {
  start(state);
  solve_points<Dim>({laws_, second_rule(method_), state.threads}, points_, [&](int p) {
    if (!method_.first_stays) remove_closing_part(method_, points_, p, points_.impulse[p]);
  });
  change_nodes(state, times.dt, true);
  const double cell = state.grid.cell;
  for_each_point(points_, state.threads, [&](int p) {
    const Vec<Dim>& normal = points_.geometry[p].normal;
    PairImpulses<Dim>& impulse = points_.impulse[p];
    PairStatus& status = points_.status[p];
    RelativeVelocities<Dim>& relative = points_.relative[p];
    const PointSolve<Dim>& solve = points_.solve[p];
    impulse.second = impulse.now + impulse.as_force;
    status.stuck = status.now == ContactStatus::stick;
    relative.after_second = relative.end = points_.relative_velocity(p);
    status.touching =
        still_touches(impulse, normal, status, solve.reduced_mass, relative.after_second, cell, times.dt);
    if (solve.reduced_mass > 0)
      status.recovery_length = updated_recovery_length(impulse, normal, points_.before[p],
                                                       1 / solve.reduced_mass, times.crossing, times.dt);
  });
  record_impulses(points_, pivots, ledger);
}

template <int Dim>
void SurfaceContact<Dim>::correct_re_extrapolated(State<Dim>& state, const StepTimes& times,
                                                  ContactLedger<Dim>& ledger) {
  start(state);
  solve_points<Dim>({laws_, re_extrapolated_rule(method_), state.threads}, points_, [](int) {});
  change_nodes(state, times.dt, false);
  if (method_.third_ends_strain)
    for_each_point(points_, state.threads,
                   [&](int p) { points_.relative[p].end = points_.relative_velocity(p); });
  record_friction(points_, method_, ledger);
  memory_.store(points_);
}

template class SurfaceContact<2>;
template class SurfaceContact<3>;

}  // namespace mpmfast
