#include "engine/conditions/rigid_bodies.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "engine/geometry/shapes.hpp"
#include "engine/quantities/time_table.hpp"

namespace mpmfast {

namespace {

template <int Dim>
Vec<Dim> vector_of(const Vec3& v) {
  Vec<Dim> out;
  for (int d = 0; d < Dim; ++d) out[d] = v[static_cast<std::size_t>(d)];
  return out;
}

Vec<3> axis_of(const RotationSpec& rotation) { return vector_of<3>(rotation.axis); }

}  // namespace

template <int Dim>
RigidBodies<Dim>::RigidBodies(const Scene& scene, const Plan& plan, const State<Dim>& seeded)
    : scene_(&scene) {
  body_at_.assign(scene.bodies.size(), -1);
  pivots_.assign(plan.fields.size(), Vec<Dim>::Zero());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& spec = scene.bodies[b];
    if (!is_rigid(scene, spec)) continue;
    Body body;
    body.index = b;
    body.field = static_cast<std::size_t>(plan.body_field[b]);
    body.first_id = ~std::uint32_t{0};
    body.velocity = vector_of<Dim>(spec.velocity);
    body.travels = std::any_of(spec.rigid_velocity.begin(), spec.rigid_velocity.end(),
                               [](const auto& table) { return table.has_value(); });
    body.turns = spec.rotation && largest(spec.rotation->speed) > 0;
    const Bounds box = bounds(spec.shape);
    for (std::size_t d = 0; d < Dim; ++d)
      body.pivot[static_cast<int>(d)] =
          spec.rotation ? spec.rotation->about[d] : 0.5 * (box.lower[d] + box.upper[d]);
    pivots_[body.field] = body.pivot;
    body_at_[b] = static_cast<int>(bodies_.size());
    bodies_.push_back(std::move(body));
  }
  const auto& particles = seeded.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const int k = body_at_[particles.body()[p]];
    if (k < 0) continue;
    Body& body = bodies_[static_cast<std::size_t>(k)];
    body.first_id = std::min(body.first_id, particles.id()[p]);
    if (body.turns)
      body.arm.push_back(particles.vector(Quantity::position, p) - body.pivot);  // in order of ids
  }
  for (const Body& body : bodies_) {
    const BodySpec& spec = scene.bodies[body.index];
    double squared = 0, radius = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const double v = spec.rigid_velocity[d] ? largest(*spec.rigid_velocity[d]) : spec.velocity[d];
      squared += v * v;
    }
    for (const Vec<Dim>& arm : body.arm) radius = std::max(radius, arm.norm());
    const double turning = body.turns ? radius * largest(spec.rotation->speed) : 0;
    fastest_ = std::max(fastest_, std::sqrt(squared) + turning);
  }
}

template <int Dim>
Vec<Dim> RigidBodies<Dim>::cross(const Vec<3>& spin, const Vec<Dim>& arm) {
  if constexpr (Dim == 2)
    return Vec<2>(-spin[2] * arm[1], spin[2] * arm[0]);
  else
    return spin.cross(arm);
}

template <int Dim>
Vec<Dim> RigidBodies<Dim>::travelled(const Body& body, double t) const {
  const BodySpec& spec = scene_->bodies[body.index];
  Vec<Dim> path;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    path[d] = spec.rigid_velocity[k] ? integral_to(*spec.rigid_velocity[k], t) : spec.velocity[k] * t;
  }
  return path;
}

template <int Dim>
void RigidBodies<Dim>::begin(State<Dim>& state, double dt) {
  bool changes = false;
  for (Body& body : bodies_) {
    const BodySpec& spec = scene_->bodies[body.index];
    for (int d = 0; d < Dim; ++d)
      if (const auto& table = spec.rigid_velocity[static_cast<std::size_t>(d)])
        body.velocity[d] = mean_over(*table, state.time, dt);
    if (body.turns) body.spin = mean_over(spec.rotation->speed, state.time, dt) * axis_of(*spec.rotation);
    pivots_[body.field] = body.pivot + travelled(body, state.time);
    changes |= body.turns || body.travels;
  }
  if (!changes) return;
  auto& particles = state.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const int k = body_at_[particles.body()[p]];
    if (k < 0) continue;
    const Body& body = bodies_[static_cast<std::size_t>(k)];
    Vec<Dim> v = body.velocity;
    if (body.turns) v += cross(body.spin, particles.vector(Quantity::position, p) - pivots_[body.field]);
    for (int d = 0; d < Dim; ++d) particles.column(Quantity::velocity, d)[p] = v[d];
  }
}

template <int Dim>
void RigidBodies<Dim>::set_nodes(State<Dim>& state) const {
  if (std::none_of(bodies_.begin(), bodies_.end(), [](const Body& b) { return b.turns; })) return;
  std::vector<const Body*> turning(pivots_.size(), nullptr);
  for (const Body& body : bodies_)
    if (body.turns) turning[body.field] = &body;
  const double* mass = state.nodes.column(Nodal::mass);
  for (const auto& block : state.tiling.node_blocks)
    for (int t = block.begin; t < block.end; ++t) {
      const auto field = static_cast<std::size_t>(state.tiling.node_tiles[static_cast<std::size_t>(t)].field);
      if (!turning[field]) continue;
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const int slot = t * kTileNodes<Dim> + local;
        const NodeIndex<Dim> node = state.tiling.node(block, local);
        Vec<Dim> arm;
        for (int d = 0; d < Dim; ++d)
          arm[d] = state.grid.origin[d] + node[d] * state.grid.cell - pivots_[field][d];
        const Body& body = *turning[field];
        state.nodes.set(Nodal::momentum, slot, mass[slot] * (body.velocity + cross(body.spin, arm)));
      }
    }
}

template <int Dim>
RigidReport RigidBodies<Dim>::end(State<Dim>& state, double dt, const Vec<Dim>& lower,
                                  const Vec<Dim>& upper) {
  std::vector<Mat<Dim>> turn(bodies_.size(), Mat<Dim>::Identity());
  std::vector<Vec<Dim>> pivot(bodies_.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Body& body = bodies_[k];
    if (!body.turns) continue;
    const RotationSpec& rotation = *scene_->bodies[body.index].rotation;
    pivot[k] = body.pivot + travelled(body, state.time + dt);
    const double angle = integral_to(rotation.speed, state.time + dt);
    const Mat<3> full = Eigen::AngleAxisd(angle, axis_of(rotation)).toRotationMatrix();
    turn[k] = full.topLeftCorner<Dim, Dim>();
  }
  RigidReport report;
  auto& particles = state.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const int at = body_at_[particles.body()[p]];
    if (at < 0) continue;
    const auto k = static_cast<std::size_t>(at);
    const Vec<Dim> v = particles.vector(Quantity::velocity, p);
    report.fastest = std::max(report.fastest, v.norm());
    Vec<Dim> x = particles.vector(Quantity::position, p) + dt * v;
    if (bodies_[k].turns) x = pivot[k] + turn[k] * bodies_[k].arm[particles.id()[p] - bodies_[k].first_id];
    for (int d = 0; d < Dim; ++d) {
      particles.column(Quantity::position, d)[p] = x[d];
      report.lost |= !(x[d] > lower[d] && x[d] < upper[d]);
    }
  }
  return report;
}

template class RigidBodies<2>;
template class RigidBodies<3>;

}  // namespace mpmfast
