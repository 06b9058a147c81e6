// Two equal disks meet off-centre: momentum, energy, and the same scene turned in its grid.

#include "tests/turned.hpp"

namespace mpmfast {
namespace {

using namespace test;

using Overrides = std::vector<Override>;
// Published normals with the particles of their time, on a lattice.
const Overrides kPlain{{"contact.normal", "logistic_regression"},
                       {"method.basis", "lcpdi"},
                       {"bodies.0.seeding", "lattice"},
                       {"bodies.1.seeding", "lattice"}};
const Overrides kSmoothed{{"contact.normal", "smoothed_logistic_regression"},
                          {"method.basis", "lcpdi"},
                          {"bodies.0.seeding", "lattice"},
                          {"bodies.1.seeding", "lattice"}};
const Overrides kDefault{{"contact.normal", "smoothed_max_margin"}, {"method.basis", "lcpdi"}};

struct Impact {
  Vec<2> velocity;         ///< of the left disk after the impact, turned back, m/s
  double rim_speed;        ///< of its spin, m/s
  double energy_change;    ///< relative, friction counted as energy
  double momentum_change;  ///< relative to the momentum of one disk
};

Impact impact(const Overrides& normal, double turned, const Overrides& more = {}) {
  Overrides overrides = normal;
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Scene scene = scene_file("oblique_impact.yaml", overrides);
  Step<2> step(scene);
  auto& particles = step.state().particles;
  if (turned != 0) turn(step, turned * kDegree, Vec<2>(0.015, 0.01));
  const double energy = kinetic_energy(particles);
  const Vec<2> momentum_before = momentum(particles);
  while (step.state().time < scene.time.end)
    step.advance(std::min(step.stable_dt(), scene.time.end - step.state().time));
  const BodyMotion left = body_motion(particles, 0);
  const double radius = 3e-3, inertia = 0.5 * left.mass * radius * radius;
  return {Eigen::Rotation2Dd(-turned * kDegree) * left.velocity, radius * left.spin / inertia,
          (kinetic_energy(particles) + step.stored_energy() + step.sums().friction_work) / energy - 1,
          (momentum(particles) - momentum_before).norm() / (10 * left.mass)};
}

/// How far the velocities of the turned scene are from the turned velocities, relative to the speed of 10
/// m/s.
double turning_error(const Impact& a, const Impact& b) {
  return std::max((a.velocity - b.velocity).norm(), std::abs(a.rim_speed - b.rim_speed)) / 10;
}

TEST_CASE("oblique impact: momentum stays to round-off under every normal and update, turned and not") {
  for (const auto& normal : {kPlain, kSmoothed, Overrides{{"contact.normal", "average_gradient"}}})
    for (const char* update : {"flip", "xpic(5)"})
      for (const double turned : {0.0, 30.0}) {
        CAPTURE(normal.front().second);
        CAPTURE(std::string(update));
        CAPTURE(turned);
        const Impact result = impact(normal, turned, {{"method.update", update}});
        CHECK(result.momentum_change < 1e-12);  // of some 400 particles over 1000 steps: measured 4e-15
        CHECK(result.velocity[0] < 0);          // they did meet
      }
}

TEST_CASE("oblique impact: turned by 30 degrees with its particles it gives nearly the same velocities") {
  // At 6 cells a radius, where one contact node more or less is seen: turned by 15 degrees the default
  // differs by 11 %, plain LR by 45 degrees by 9 %. Both figures fall with the cell size (the next cases).
  struct Reached {
    const Overrides& normal;
    double turning, gain, loss;
  };
  // N20's contact comes with strain: average.
  for (const Reached& reached : {Reached{kPlain, 0.025, 0.005, 0.09},       // measured 1.7 %; -6.8, -7.8 %
                                 Reached{kSmoothed, 0.02, 0.002, 0.002},    // 1.8 %
                                 Reached{kDefault, 0.06, 0.002, 0.003}}) {  // 5.3 %; −0.21, −0.03 %
    CAPTURE(reached.normal.front().second);
    const Impact along = impact(reached.normal, 0), turned = impact(reached.normal, 30);
    CHECK(turning_error(along, turned) < reached.turning);
    for (const Impact& result : {along, turned}) {
      CHECK(result.energy_change < reached.gain);
      CHECK(result.energy_change > -reached.loss);
    }
  }
}

TEST_CASE("slow: oblique impact: at half the cell size the turned scene and the energy stay near") {
  // Strain first, which keeps the energy of a body that vibrates; the lattice's rough outline adds 0.8 to 2.2
  // % (1.0 to 1.7 where particles take nothing of the first correction), rings do not (the next case).
  // Turning: measured 0.70 % (smoothed LR), 0.76 % (default).
  for (const auto& normal : {kSmoothed, kDefault}) {
    const Overrides fine{{"grid.cell", "0.25 mm"}, {"method.strain", "first"}};
    const Impact along = impact(normal, 0, fine), turned = impact(normal, 30, fine);
    CHECK(turning_error(along, turned) < 0.013);
    CHECK(std::abs(along.energy_change) < 0.025);
    CHECK(std::abs(turned.energy_change) < 0.025);
  }
}

TEST_CASE("oblique impact: on rings, with splines and strain first, the energy balance is met within 0.6 %") {
  const Overrides rings{{"bodies.0.seeding", "rings"}, {"bodies.1.seeding", "rings"},
                        {"grid.cell", "0.25 mm"},      {"method.strain", "first"},
                        {"method.basis", "bspline2"},  {"contact.normal", "smoothed_max_margin"}};
  const Impact along = impact(rings, 0),
               published = impact(rings, 0, {{"contact.first_correction_share", "0"}});
  CHECK(std::abs(published.energy_change) < 0.005);  // measured -0.26 %
  CHECK(std::abs(along.energy_change) < 0.006);      // -0.56 %: what particles take of the first correction
  for (const double angle : {15.0, 30.0, 45.0}) {
    const Impact turned = impact(rings, angle);
    CHECK(std::abs(turned.energy_change) < (angle < 45 ? 0.005 : 0.01));  // -0.1, -0.4, -0.8 %
    CHECK(turning_error(along, turned) < 0.01);                           // 0.7, 0.9, 0.4 %
  }
  CHECK(along.momentum_change < 1e-12);
}

TEST_CASE("oblique impact without friction keeps its energy within 1.5 % when the strain comes first") {
  // The averaged strain loses 8.2 %: a disk of this size that vibrates alone loses as much (-12 % in
  // 0.1 ms), so most of the loss is not of the contact.
  for (const double turned : {0.0, 30.0}) {
    CAPTURE(turned);
    const Impact first =
        impact(kPlain, turned, {{"contact.law", "frictionless"}, {"method.strain", "first"}});
    CHECK(std::abs(first.energy_change) < 0.015);  // goal 0.5 %; measured 0.03 and 1.05 %
  }
}

}  // namespace
}  // namespace mpmfast
