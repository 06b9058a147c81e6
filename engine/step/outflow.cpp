/// Particles that come a cell beyond the grid (grid.leaving).

#include <cmath>

#include "engine/plan/seed.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// Only what is sound flows out: a finite particle that did not come there through the axis of symmetry.
template <int Dim>
void Step<Dim>::remove_outflow() {
  if (!lost_) return;
  const auto timed = clock_.enter(Task::leave);
  lost_ = false;
  constexpr const char* kLost = "a particle left the grid or is not a number";
  if (scene_->grid.outflow != OutflowKind::outflow) fail(kLost);
  auto& particles = state_.particles;
  const bool has_axis = plan_.plane_kind == PlaneKind::axisymmetric;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<Dim> x = particles.vector(Quantity::position, p), v = particles.vector(Quantity::velocity, p);
    const double fastest = v.norm() + particles.column(Quantity::wave_speed)[p];
    if (!x.allFinite() || !std::isfinite(fastest) || (has_axis && x[0] <= 0)) fail(kLost);
  }
  Outflow& out = sums_.outflow;
  state_.tiling.take_out(particles, [&](std::size_t p) {
    const Vec<Dim> x = particles.vector(Quantity::position, p);
    if ((x.array() > lower_.array()).all() && (x.array() < upper_.array()).all()) return false;
    ++out.particles;
    if (state_.bodies[particles.body()[p]].rigid) return true;
    const Vec<Dim> v = particles.vector(Quantity::velocity, p);
    const double mass = particles.column(Quantity::mass)[p];
    out.mass += mass;
    out.energy += 0.5 * mass * v.squaredNorm() + inner_energy(state_, p);
    for (int d = 0; d < Dim; ++d) out.momentum[static_cast<std::size_t>(d)] += mass * v[d];
    return true;
  });
  contact_.invalidate_fits();
  sort_due_ = true;
}

template void Step<2>::remove_outflow();
template void Step<3>::remove_outflow();

}  // namespace mpmfast
