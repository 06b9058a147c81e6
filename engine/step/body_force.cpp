/// Gravity and the accelerations of single bodies.

#include <algorithm>

#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// f += m g(t), g ramped from zero; rigid bodies move as they are told.
template <int Dim>
void Step<Dim>::add_body_force(double dt) {
  if (!plan_.gravity) return;
  const auto timed = clock_.enter(Task::body_force);
  const double ramp = scene_->gravity.ramp, middle = state_.time + 0.5 * dt;
  ramped_ = ramp > 0 ? std::min(1.0, middle / ramp) : 1.0;
  const double* mass = state_.nodes.column(Nodal::mass);
  for (std::size_t d = 0; d < Dim; ++d) {
    double* f = state_.nodes.column(Nodal::force, static_cast<int>(d));
    for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t tile = begin; tile < end; tile += kTileNodes<Dim>) {
        const double g = ramped_ * plan_.field_acceleration[field_of_slot(tile)][d];
        if (g == 0) continue;
        for (std::int64_t i = tile; i < tile + kTileNodes<Dim>; ++i) f[i] += mass[i] * g;
      }
    });
  }
}

/// The work of the body force on what moves with v⁺ − ½ a Δt.
template <int Dim>
void Step<Dim>::weigh_body_force(double dt) {
  if (!plan_.gravity) return;
  body_force_work_ = 0;
  const double* mass = state_.nodes.column(Nodal::mass);
  for (std::size_t d = 0; d < Dim; ++d) {
    const double *v = state_.nodes.column(Nodal::velocity, static_cast<int>(d)),
                 *jump = state_.nodes.column(Nodal::force, static_cast<int>(d));
    double power = 0;
    for (std::int64_t tile = 0; tile < state_.tiling.slots(); tile += kTileNodes<Dim>) {
      const double g = plan_.field_acceleration[field_of_slot(tile)][d];
      if (g == 0) continue;
      double momentum = 0;
      for (std::int64_t i = tile; i < tile + kTileNodes<Dim>; ++i)
        momentum += mass[i] * (v[i] - 0.5 * jump[i]);
      power += g * momentum;
    }
    body_force_work_ += ramped_ * power * dt;
  }
}

// Here: the members that this file defines.
template void Step<2>::add_body_force(double);
template void Step<3>::add_body_force(double);
template void Step<2>::weigh_body_force(double);
template void Step<3>::weigh_body_force(double);

}  // namespace mpmfast
