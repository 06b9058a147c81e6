// How long steps are, and what a push between two of them does.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kBlock = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: block, box: {from: [2 mm, 4 mm], to: [6 mm, 6 mm]}, material: m, velocity: [4 m/s, -3 m/s]}]
)";

TEST_CASE("what is left of the time is one step, or two that are alike, or more than two") {
  const Scene scene = scene_from(kBlock);
  const Step<2> step(scene);
  const double stable = step.stable_dt();
  CHECK(step.dt_towards(0.7 * stable, stable) == 0.7 * stable);
  CHECK(step.dt_towards(stable, stable) == stable);
  CHECK(step.dt_towards(1.5 * stable, stable) == 0.75 * stable);
  CHECK(step.dt_towards(1.99 * stable, stable) == doctest::Approx(0.995 * stable).epsilon(1e-12));
  CHECK(step.dt_towards(2.1 * stable, stable) == stable);
}

TEST_CASE("a push between two steps does the work that the particles gain") {
  const Scene scene = scene_from(kBlock);
  Step<2> step(scene);
  advance(step, 2);
  auto& particles = step.state().particles;
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < particles.size(); ++p)
      sum +=
          0.5 * particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p).squaredNorm();
    return sum;
  };
  std::vector<double> change(particles.size());
  for (std::size_t p = 0; p < change.size(); ++p) change[p] = 0.1 * static_cast<double>(p % 7) - 0.2;
  for (const int axis : {0, 1}) {
    const double before = kinetic(), work = step.sums().body_force_work;
    step.add_velocity(axis, change);
    CHECK(step.sums().body_force_work - work == doctest::Approx(kinetic() - before).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace mpmfast
