#include "engine/contact/surface/record_points.hpp"

#include <Eigen/Geometry>

#include "kernels/contact/friction_cone.hpp"

namespace mpmfast {

template <int Dim>
void record_impulses(const SurfaceList<Dim>& points, const std::vector<Vec<Dim>>& pivots,
                     ContactLedger<Dim>& ledger) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PointGeometry<Dim>& geometry = points.geometry[p];
    const Vec<Dim> kept = points.impulse[p].now + points.impulse[p].as_force;
    if (geometry.law >= 0)
      ledger.pair_impulse[static_cast<std::size_t>(geometry.law)] += (geometry.forward ? 1.0 : -1.0) * kept;
    if (!geometry.meets_rigid) continue;
    const auto f = static_cast<std::size_t>(geometry.field_b);
    ledger.rigid_impulse[f] -= kept;
    ledger.rigid_work += kept.dot(points.velocity_of(static_cast<int>(p), 1));
    Vec<3> arm = Vec<3>::Zero(), impulse = Vec<3>::Zero();
    arm.head<Dim>() = geometry.position - pivots[f];
    impulse.head<Dim>() = kept;
    ledger.rigid_moment[f] -= arm.cross(impulse);
  }
}

template <int Dim>
void record_friction(const SurfaceList<Dim>& points, const CorrectionMethod& method,
                     ContactLedger<Dim>& ledger) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PairImpulses<Dim>& impulse = points.impulse[p];
    if (impulse.first.isZero(0) && impulse.second.isZero(0)) continue;
    const PointGeometry<Dim>& geometry = points.geometry[p];
    const RelativeVelocities<Dim>& relative = points.relative[p];
    const auto sliding_part = [&](const Vec<Dim>& x) { return split(x, geometry.normal).tangential; };
    double lost = 0.5 * sliding_part(impulse.second).dot(relative.after_first + relative.end);
    if (method.first_stays) {
      lost += 0.5 * sliding_part(impulse.first).dot(relative.start + relative.after_first);
    } else if (method.holds_sticking) {
      const Vec<Dim> unseen = relative.after_second - relative.after_first;
      if (points.before[p].stuck) lost -= 0.5 * sliding_part(impulse.first).dot(unseen);
      if (points.status[p].stuck) lost -= 0.5 * sliding_part(impulse.now).dot(unseen);
    }
    ledger.friction_work += lost;
    if (geometry.law >= 0) ledger.pair_friction_work[static_cast<std::size_t>(geometry.law)] += lost;
  }
}

template void record_impulses(const SurfaceList<2>&, const std::vector<Vec<2>>&, ContactLedger<2>&);
template void record_impulses(const SurfaceList<3>&, const std::vector<Vec<3>>&, ContactLedger<3>&);
template void record_friction(const SurfaceList<2>&, const CorrectionMethod&, ContactLedger<2>&);
template void record_friction(const SurfaceList<3>&, const CorrectionMethod&, ContactLedger<3>&);

}  // namespace mpmfast
