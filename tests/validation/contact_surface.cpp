// Contact at points of the surface, where closed solutions exist: uniform strain under wide dies, momentum,
// energy.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// The least and the largest |Fᵀn| of a body's particles: their stretch along n where n is a principal axis.
struct Stretches {
  double least = 1e9, most = -1e9;
};

template <int Dim>
Stretches stretches_along(const State<Dim>& state, int body, const Vec<Dim>& n) {
  Stretches found;
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    if (state.particles.body()[p] != body) continue;
    Vec<Dim> image = Vec<Dim>::Zero();  // Fᵀ n
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        image[j] += state.particles.column(Quantity::deformation_gradient, Dim * i + j)[p] * n[i];
    found.least = std::min(found.least, image.norm());
    found.most = std::max(found.most, image.norm());
  }
  return found;
}

template <int Dim>
void finish(Step<Dim>& step, double end) {
  const double first = step.stable_dt();
  while (step.state().time < end) step.advance(step.dt_towards(end, first));
}

/// A confined column of twenty cells under a rigid die that is `above` cells away from a row of nodes.
std::string column(double above, const std::string& family) {
  return fmt::format(R"(
space: plane_strain
grid: {{size: [4 mm, 24 mm], cell: 1 mm}}
time: {{end: 2.5 ms}}
materials:
  rubber: {{model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.3}}
  die: {{model: rigid}}
bodies:
  - {{name: block, box: {{from: [0, 0], to: [4 mm, {0} mm]}}, material: rubber}}
  - {{name: die, box: {{from: [0, {0} mm], to: [4 mm, {1} mm]}}, material: die, velocity: [0, [[0 us, 0 m/s], [1000 us, -1 m/s]]]}}
boundaries: {{bottom: {{wall: sliding, at: surface}}, left: wall, right: wall}}
contact: {{family: {2}, law: frictionless}}
method: {{basis: lcpdi}}
output: {{frames: 0, history: 4}}
)",
                     20 + above, 22 + above, family);
}

TEST_CASE("a rigid die strains the row that it touches as much as all others, wherever it lies in a cell") {
  for (const double above : {0.0, 0.3, 0.71}) {
    CAPTURE(above);
    const Scene scene = scene_from(column(above, "surface"));
    Step<2> step(scene);
    finish(step, 2.5e-3);
    const double exact = 1 - 2e-3 / ((20 + above) * 1e-3);  // the die has gone 2 mm
    const Stretches found = stretches_along<2>(step.state(), 0, {0, 1});
    CHECK(found.least > 0.995 * exact);
    CHECK(found.most < 1.005 * exact);
  }
  const Scene nodes = scene_from(column(0.3, "nodes"));  // what the points are for
  Step<2> step(nodes);
  finish(step, 2.5e-3);
  CHECK(stretches_along<2>(step.state(), 0, {0, 1}).most > 1.02 * (1 - 2.0 / 20.3));
}

/// A block that a wide die presses by `share`, free to widen.
std::string wide_die(const std::string& basis, double share) {
  return fmt::format(R"(
space: plane_strain
grid: {{size: [24 mm, 12 mm], cell: 1 mm}}
time: {{end: {} ms}}
materials:
  rubber: {{model: neo_hookean, density: 7.83 g/cm^3, young: 200 MPa, poisson: 0.45}}
  die: {{model: rigid}}
bodies:
  - {{name: block, box: {{from: [0, 0], to: [10 mm, 10 mm]}}, material: rubber}}
  - {{name: die, box: {{from: [0, 10 mm], to: [22 mm, 12 mm]}}, material: die, velocity: [0, [[0 us, 0 m/s], [50 us, -2 m/s]]]}}
boundaries: {{bottom: {{wall: sliding, at: surface}}, left: wall}}
contact: {{family: surface, law: frictionless}}
method: {{basis: {}}}
output: {{frames: 0, history: 4}}
)",
                     0.025 + 5 * share, basis);
}

TEST_CASE("a block pressed by 45 % under a smooth die that overhangs it strains uniformly") {
  const Scene scene = scene_from(wide_die("lcpdi", 0.45));
  Step<2> step(scene);
  finish(step, scene.time.end);
  const Stretches found = stretches_along<2>(step.state(), 0, {0, 1});
  CHECK(found.least > 0.545);  // contact on nodes: some particles fold over
  CHECK(found.most < 0.555);
}

TEST_CASE("under a die that overhangs it a block of undeformed domains strains uniformly while these fit") {
  const Scene scene = scene_from(wide_die("ugimp", 0.1));
  Step<2> step(scene);
  finish(step, scene.time.end);
  const Stretches found = stretches_along<2>(step.state(), 0, {0, 1});
  CHECK(found.least > 0.88);  // exact 0.9
  CHECK(found.most < 0.93);
}

/// A block between two wide dies that close by a tenth, all turned through the grid. Its faces lie between
/// particles of the turned lattice, half a cell apart.
std::string turned_dies(double degrees) {
  const double q = degrees * std::numbers::pi / 180, speed = 0.5;
  const auto on_lattice = [](double x) { return std::round(2 * x) / 2; };
  const double middle[2] = {on_lattice(20 * std::cos(q) + 20 * std::sin(q)),
                            on_lattice(20 * std::cos(q) - 20 * std::sin(q))};  // turned back, mm
  const auto corner = [&](double x, double y) {                                // from the middle, mm
    const double at[2] = {middle[0] + x, middle[1] + y};
    return fmt::format("[{:.9f} mm, {:.9f} mm]", at[0] * std::cos(q) - at[1] * std::sin(q),
                       at[0] * std::sin(q) + at[1] * std::cos(q));
  };
  const auto box = [&](double x, double low, double high) {
    return fmt::format("polygon: [{}, {}, {}, {}], seeding: {{angle: {} deg}}", corner(-x, low),
                       corner(x, low), corner(x, high), corner(-x, high), degrees);
  };
  const auto velocity = [&](double along) {
    const auto table = [&](double v) { return fmt::format("[[0 us, 0 m/s], [200 us, {:.9f} m/s]]", v); };
    return fmt::format("[{}, {}]", table(-along * std::sin(q)), table(along * std::cos(q)));
  };
  return fmt::format(R"(
space: plane_strain
grid: {{size: [40 mm, 40 mm], cell: 1 mm}}
time: {{end: 1.1 ms}}
materials:
  rubber: {{model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.3}}
  die: {{model: rigid}}
bodies:
  - {{name: block, {}, material: rubber}}
  - {{name: upper, {}, material: die, velocity: {}}}
  - {{name: lower, {}, material: die, velocity: {}}}
contact: {{family: surface, law: frictionless}}
output: {{frames: 0, history: 4}}
)",
                     box(5, -5, 5), box(9, 5, 8), velocity(-speed), box(9, -8, -5), velocity(speed));
}

TEST_CASE("a block between smooth dies across the grid strains uniformly") {
  for (const double degrees : {0.0, 23.0, 45.0}) {
    CAPTURE(degrees);
    const Scene scene = scene_from(turned_dies(degrees));
    Step<2> step(scene);
    finish(step, scene.time.end);
    const double q = degrees * std::numbers::pi / 180;
    const Stretches found = stretches_along<2>(step.state(), 0, {-std::sin(q), std::cos(q)});
    CHECK(found.least > 0.88);  // exact 0.9
    CHECK(found.most < (degrees == 45 ? 0.935 : 0.92));
  }
}

TEST_CASE("two bodies of different stiffness share a press as springs in series do") {
  // Confined columns of ten cells each; small strains: the softer one takes three quarters of the way.
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [3 mm, 24 mm], cell: 1 mm}
time: {end: 2 ms}
materials:
  soft: {model: linear_elastic, density: 1.2 g/cm^3, young: 30 MPa, poisson: 0}
  hard: {model: linear_elastic, density: 1.2 g/cm^3, young: 90 MPa, poisson: 0}
  die: {model: rigid}
bodies:
  - {name: lower, box: {from: [0, 0], to: [3 mm, 10.4 mm]}, material: soft}
  - {name: upper, box: {from: [0, 10.4 mm], to: [3 mm, 20.8 mm]}, material: hard}
  - {name: die, box: {from: [0, 20.8 mm], to: [3 mm, 22.8 mm]}, material: die, velocity: [0, [[0 us, 0 m/s], [1500 us, -0.2 m/s]]]}
boundaries: {bottom: {wall: sliding, at: surface}, left: wall, right: wall}
contact: {family: surface, law: frictionless}
output: {frames: 0, history: 4}
)");
  Step<2> step(scene);
  finish(step, scene.time.end);
  const double way = 0.25e-3;  // of the die
  const double soft = 1 - 0.75 * way / 10.4e-3, hard = 1 - 0.25 * way / 10.4e-3;
  const Stretches lower = stretches_along<2>(step.state(), 0, {0, 1}),
                  upper = stretches_along<2>(step.state(), 1, {0, 1});
  CHECK(std::abs(lower.least - soft) < 0.1 * (1 - soft));
  CHECK(std::abs(lower.most - soft) < 0.1 * (1 - soft));
  CHECK(std::abs(upper.least - hard) < 0.2 * (1 - hard));
  CHECK(std::abs(upper.most - hard) < 0.2 * (1 - hard));
}

TEST_CASE(
    "bodies that meet at points keep their momentum and angular momentum to round-off, and their energy") {
  const Scene scene =
      scene_file("oblique_impact.yaml", {{"contact.family", "surface"}, {"output.frames", "0"}});
  Step<2> step(scene);
  const auto angular = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < step.state().particles.size(); ++p) {
      const Vec<2> x = step.state().particles.vector(Quantity::position, p),
                   v = step.state().particles.vector(Quantity::velocity, p);
      sum += step.state().particles.column(Quantity::mass)[p] * (x[0] * v[1] - x[1] * v[0]);
    }
    return sum;
  };
  double scale = 0;
  for (std::size_t p = 0; p < step.state().particles.size(); ++p)
    scale += 10 * step.state().particles.column(Quantity::mass)[p];
  const double before = angular();
  finish(step, scene.time.end);
  CHECK(momentum(step.state().particles).norm() < 1e-12 * scale);
  CHECK(std::abs(angular() / before - 1) < 0.02);  // the particles' own transfers, not contact, change it
  const Outcome out = run(scene);
  CHECK(std::abs(out.summary.energy_error) < 0.003);  // measured 0.0 %
  CHECK(out.history.at("friction_J").back() > 0);
}

TEST_CASE("squares and cubes that meet face to face at points keep their energy") {
  for (const char* name : {"squares.yaml", "cubes.yaml"}) {
    CAPTURE(std::string(name));
    const Outcome out = run(scene_file(name, {{"contact.family", "surface"}, {"output.frames", "0"}}));
    REQUIRE(out.failure == "");
    CHECK(std::abs(out.summary.energy_error) < 0.005);  // measured -0.22, -0.32 %
  }
}

}  // namespace
}  // namespace mpmfast
