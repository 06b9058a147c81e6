#pragma once

/// @file The motion of rigid bodies: translation and rotation as the scene prescribes them.

#include <vector>

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Of the rigid particles in a step.
struct RigidReport {
  double fastest{};   ///< m/s
  bool lost = false;  ///< one is outside the allowed box
};

/// A rigid body moves with v(t) and turns with ω(t) about a pivot that moves with it: its particles are at
/// x = c(t) + R(θ(t)) (X − c(0)) with c = c(0) + ∫v and θ = ∫ω. Positions of a turning body come from those
/// of time 0, so that no particle leaves its orbit however many steps there are.
template <int Dim>
class RigidBodies {
 public:
  /// @param seeded  the state at time 0
  RigidBodies(const Scene& scene, const Plan& plan, const State<Dim>& seeded);

  bool empty() const { return bodies_.empty(); }
  /// Largest speed that a rigid particle ever has, m/s.
  double fastest() const { return fastest_; }

  /// Before a step from t to t + dt: particles carry the mean velocity of the step.
  void begin(State<Dim>& state, double dt);
  /// After the projection: the nodes of turning bodies get v + ω × (x_i − c), exact at the node itself (the
  /// projected velocity is that of the particles' mean place, which lies inside the body).
  void set_nodes(State<Dim>& state) const;
  /// After a step: new positions.
  RigidReport end(State<Dim>& state, double dt, const Vec<Dim>& lower, const Vec<Dim>& upper);

  /// Points that moments count about, m, at the start of the step; by velocity field.
  const std::vector<Vec<Dim>>& pivots() const { return pivots_; }

 private:
  struct Body {
    std::size_t index, field;      ///< in Scene::bodies; of its velocity field
    std::uint32_t first_id;        ///< of its particles, which are numbered in a row
    std::vector<Vec<Dim>> arm;     ///< X − c(0), m; only of a turning body
    Vec<Dim> pivot, velocity;      ///< c(0); v of this step
    Vec<3> spin = Vec<3>::Zero();  ///< ω of this step, rad/s
    bool turns = false, travels = false;
  };
  Vec<Dim> travelled(const Body& body, double t) const;
  static Vec<Dim> cross(const Vec<3>& spin, const Vec<Dim>& arm);

  const Scene* scene_;
  std::vector<Body> bodies_;
  std::vector<int> body_at_;  ///< by index in Scene::bodies: into bodies_, or −1
  std::vector<Vec<Dim>> pivots_;
  double fastest_ = 0;
};

extern template class RigidBodies<2>;
extern template class RigidBodies<3>;

}  // namespace mpmfast
