// Walls that act where bodies end (`at: surface`): presses of known stress, flights of known time, friction.

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr double kPressed = 0.9622 * 20.8e-3 / 0.1;  ///< the share that the piston takes off the column

/// A column of 20 cells that a piston closes to four fifths, in a space.
std::string column(const char* space, const char* size, const std::string& walls) {
  return fmt::format(R"(
space: {}
grid: {{size: {}, cell: 5 mm}}
time: {{end: 20.8 ms, cfl: 0.5}}
materials: {{rubber: {{model: neo_hookean, density: 1 g/cm^3, bulk: 2450 MPa, shear: 940 MPa}}}}
bodies: [{{name: column, box: {{from: {}, to: {}}}, material: rubber}}]
boundaries: {{{}, bottom: {{wall: sliding, at: surface}}, top: {{piston: 0.9622 m/s, at: surface}}}}
)",
                     space, size, std::string(space) == "3d" ? "[0 mm, 0 mm, 0 mm]" : "[0 mm, 0 mm]", size,
                     walls);
}

/// Mean σ_yy over the volume, relative to that of N20 Eq. 18 in uniaxial strain, less one.
template <int Dim>
double stress_error(const std::string& yaml, const std::vector<Override>& overrides) {
  const Scene scene = scene_from(yaml, overrides);
  Step<Dim> step(scene);
  while (step.state().time < scene.time.end)
    step.advance(std::min(step.stable_dt(), scene.time.end - step.state().time));
  const auto& particles = step.state().particles;
  double volume = 0, sum = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double initial = particles.column(Quantity::initial_volume)[p];
    volume += initial * particles.volume_ratio(p);
    sum += initial * particles.column(Quantity::kirchhoff_stress, 1)[p];
  }
  const double j = 1 - kPressed, growth = j * j - 1;
  const double exact = (2.0 / 3 * 940e6 * std::pow(j, -2.0 / 3) * growth + 0.5 * 2450e6 * growth) / j;
  return sum / volume / exact - 1;
}

const char* const kSides = "left: {wall: sliding, at: surface}, right: {wall: sliding, at: surface}";

TEST_CASE(
    "a column pressed between walls that know its surface has the stress of its stretch, in every basis") {
  const std::string plane = column("plane_strain", "[10 mm, 100 mm]", kSides);
  // Measured: 0.05 % with uGIMP and quadratic splines, 0.02 % with cubic ones, 0.002 % with the CPDI.
  for (const char* basis : {"ugimp", "lcpdi", "qcpdi", "bspline2", "bspline3"}) {
    CAPTURE(std::string(basis));
    CHECK(std::abs(stress_error<2>(plane, {{"method.basis", basis}})) < 0.001);
    CHECK(std::abs(stress_error<2>(plane, {{"method.basis", basis}, {"method.update", "xpic(5)"}})) < 0.001);
  }
  CHECK(std::abs(stress_error<2>(plane, {{"time.cfl", "0.9"}})) < 0.001);
}

TEST_CASE("the same about an axis and in three dimensions") {
  const std::string right = "right: {wall: sliding, at: surface}";
  CHECK(std::abs(stress_error<2>(column("axisymmetric", "[10 mm, 100 mm]", right), {})) < 0.001);
  const std::string sides =
      std::string(kSides) + ", back: {wall: sliding, at: surface}, front: {wall: sliding, at: surface}";
  CHECK(std::abs(stress_error<3>(column("3d", "[10 mm, 100 mm, 10 mm]", sides), {})) < 0.001);
}

/// A block flies down at 2 m/s; its lower face is at 20 mm. Cells of 2 mm.
const char* const kFlight = R"(
space: plane_strain
grid: {size: [60 mm, 60 mm], cell: 2 mm}
time: {end: 12 ms, cfl: 0.2}
materials: {rubber: {model: neo_hookean, density: 1 g/cm^3, bulk: 24.5 MPa, shear: 9.4 MPa}}
bodies: [{name: block, box: {from: [20 mm, 20 mm], to: [40 mm, 40 mm]}, material: rubber, velocity: [0 m/s, -2 m/s]}]
boundaries: {bottom: {wall: sliding, at: surface}}
)";

TEST_CASE("a gap to a wall closes on time, wherever the plane is in a cell") {
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"})
    for (const double position : {10e-3, 9e-3, 9.7e-3, 8.1e-3}) {
      CAPTURE(std::string(basis));
      CAPTURE(position);
      const Scene scene = scene_from(
          kFlight,
          {{"boundaries.bottom.position", fmt::format("{} mm", 1e3 * position)}, {"method.basis", basis}});
      Step<2> step(scene);
      while (step.sums().boundary_impulse[0][1] == 0 && step.state().time < scene.time.end)
        step.advance(step.stable_dt());
      CHECK(step.state().time == doctest::Approx((20e-3 - position) / 2).epsilon(0.001));  // at most 0.04 %
    }
}

TEST_CASE("a wall pushes and does not pull: a bar that comes flying leaves as it came") {
  const char* const bar = R"(
space: plane_strain
grid: {size: [140 mm, 4 mm], cell: 1 mm}
time: {end: 4 ms, cfl: 0.4}
materials: {rubber: {model: linear_elastic, density: 1 g/cm^3, young: 10 MPa, poisson: 0.3}}
bodies: [{name: bar, box: {from: [5 mm, 0 mm], to: [105 mm, 4 mm]}, material: rubber, velocity: [-0.1 m/s, 0 m/s]}]
boundaries: {left: {wall: sliding, at: surface, position: 4.9 mm}, bottom: symmetry, top: symmetry}
method: {strain: first}
)";
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"}) {
    CAPTURE(std::string(basis));
    const Scene scene = scene_from(bar, {{"method.basis", basis}});
    Step<2> step(scene);
    const double brought = kinetic_energy(step.state().particles), mass = 1000 * 0.1 * 0.004;
    double last = 0, least = 0, before = 0;
    while (step.state().time < scene.time.end) {
      step.advance(step.stable_dt());
      const double impulse = step.sums().boundary_impulse[0][0];
      least = std::min(least, impulse - before);
      if (impulse != before) last = step.state().time;
      before = impulse;
    }
    CHECK(least == 0);
    // A wave goes up and down the bar, at 116.0239 m/s.
    CHECK(last == doctest::Approx(1e-3 + 2 * 0.1 / 116.0239).epsilon(0.02));  // +0.7 %: it trails off
    CHECK(before == doctest::Approx(2 * mass * 0.1).epsilon(0.02));           // -1.1 %
    const double kept = kinetic_energy(step.state().particles) + step.stored_energy();
    CHECK(kept == doctest::Approx(brought).epsilon(0.005));  // -0.25 to +0.2 %
  }
  // What flies away from a wall that it touches is not held.
  const Scene away =
      scene_from(bar, {{"bodies.0.velocity", "[0.1 m/s, 0 m/s]"}, {"boundaries.left.position", "5 mm"}});
  Step<2> step(away);
  advance(step, 100);
  CHECK(step.sums().boundary_impulse[0][0] == 0);
}

/// A block lies on the floor at 9.7 mm and slides at 1 m/s; its weight comes at once, so it swings.
const char* const kSlide = R"(
space: plane_strain
grid: {size: [60 mm, 40 mm], cell: 2 mm}
time: {end: 8 ms, cfl: 0.4}
materials: {rubber: {model: neo_hookean, density: 1 g/cm^3, bulk: 24.5 MPa, shear: 9.4 MPa}}
bodies: [{name: block, box: {from: [10 mm, 9.7 mm], to: [30 mm, 19.7 mm]}, material: rubber, velocity: [1 m/s, 0 m/s]}]
gravity: [0 m/s^2, -200 m/s^2]
boundaries: {bottom: {wall: sliding, at: surface, position: 9.7 mm, friction: 0.3}}
)";

TEST_CASE("a block slides on a wall with its friction, and the books have all of it") {
  const Scene scene = scene_from(kSlide);
  Step<2> step(scene);
  const Vec<2> before = momentum(step.state().particles);
  while (step.state().time < scene.time.end) step.advance(step.stable_dt());
  const double t = step.state().time, mass = 1000 * 0.02 * 0.01;
  const Vec<2> after = momentum(step.state().particles), impulse = step.sums().boundary_impulse[0];
  const Vec<2> weight(0, -200 * mass * t);
  CHECK((after - before - impulse - weight).norm() < 1e-10 * impulse.norm());
  CHECK(-impulse[0] == doctest::Approx(0.3 * impulse[1]).epsilon(5e-4));  // it swings: now and then it lifts
  CHECK(after[0] / mass == doctest::Approx(1 - 0.3 * 200 * t).epsilon(0.05));
  const double speed = after[0] / mass;
  CHECK(step.sums().friction_work == doctest::Approx(0.5 * mass * (1 - speed * speed)).epsilon(0.05));
}

TEST_CASE("a block sticks to a wall that holds, and slides freely without friction") {
  /// Mean speed over the second half, in units of the one at the start. (At 1 m/s a block that sticks hops.)
  const auto speed = [](const char* wall) {
    const Scene scene =
        scene_from(kSlide, {{"boundaries.bottom", wall}, {"bodies.0.velocity", "[0.05 m/s, 0 m/s]"}});
    Step<2> step(scene);
    double path = 0, time = 0;
    while (step.state().time < scene.time.end) {
      const double dt = step.stable_dt();
      step.advance(dt);
      if (step.state().time < 0.5 * scene.time.end) continue;
      path += dt * momentum(step.state().particles)[0] / (1000 * 0.02 * 0.01);
      time += dt;
    }
    return path / time / 0.05;
  };
  CHECK(speed("{wall: sliding, at: surface, position: 9.7 mm}") == doctest::Approx(1).epsilon(1e-12));
  CHECK(std::abs(speed("{wall: held, at: surface, position: 9.7 mm}")) < 0.05);
}

TEST_CASE("walls that rub what is at rest on them make no energy") {
  for (const char* strain : {"average+", "first"}) {
    const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 14 mm], cell: 1 mm}
time: {end: 10 ms, cfl: 0.5}
materials: {rubber: {model: neo_hookean, density: 1 g/cm^3, bulk: 24.5 MPa, shear: 9.4 MPa}}
bodies: [{name: block, box: {from: [10 mm, 1.7 mm], to: [30 mm, 11.7 mm]}, material: rubber}]
boundaries:
  bottom: {wall: sliding, at: surface, position: 1.7 mm, friction: 1}
  top: {piston: 0.2 m/s, at: surface, position: 11.7 mm, friction: 1}
)",
                                   {{"method.strain", strain}});
    CAPTURE(std::string(strain));
    const Outcome out = run(scene);
    CHECK(out.failure == "");
    // Measured −4e-5, 3e-4; without holding what sticks 18 and 6 %.
    CHECK(std::abs(out.summary.energy_error) < 1e-3);
  }
}

TEST_CASE("what rests exactly on a wall that rubs, and presses nothing, is no division by zero") {
  // Loose sand has no stress: momenta along the wall are zeros where it lies, and nothing presses where it
  // parts.
  const Scene scene =
      scene_file("sand_column.yaml", {{"boundaries.bottom", "{wall: sliding, at: surface, friction: 0.5}"},
                                      {"time.end", "0.26 s"},
                                      {"output.frames", "0"}});
  CHECK(run(scene).failure == "");
}

TEST_CASE("walls at the surface give the same bits on one, two and three threads") {
  const std::vector<Override> fine{{"grid.cell", "0.5 mm"}, {"time.end", "0.2 ms"}, {"output.frames", "0"}};
  const Outcome one = run(scene_from(kSlide, fine), 1);
  REQUIRE(one.failure == "");
  for (const int threads : {2, 3}) CHECK(run(scene_from(kSlide, fine), threads).history == one.history);
}

/// Shortening of two cylinders between planes at the force P per metre: hertz.cpp.
double hertz_force(double path) {
  const double radius = 0.01, compliance = (1 - 0.07 * 0.07) / (std::numbers::pi * 94.53e9);
  double low = 1, high = 1e9;
  while (high - low > 1e-6 * low) {
    const double force = 0.5 * (low + high), half_width = std::sqrt(4 * force * radius * compliance);
    const double shortening = 4 * force * compliance * (2 * std::log(4 * radius / half_width) - 1);
    (shortening < path ? low : high) = force;
  }
  return low;
}

/// Force over Hertz's, less one, at the end, where `cylinders` of R = 20 cells stand between a floor and a
/// piston and are pressed to 3 % of their height. It shall come there without a kink.
double hertz_error(int cylinders, double floor, double friction, const std::vector<Override>& method) {
  const auto disk = [&](int k) {
    return fmt::format(
        "  - {{name: cylinder{}, disk: {{centre: [12 mm, {} mm], radius: 10 mm}}, material: ceramic, "
        "seeding: rings}}\n",
        k, floor + 10 + 20 * k);
  };
  std::string text = R"(
space: plane_strain
time: {end: 800 us, cfl: 0.5}
materials: {ceramic: {model: neo_hookean, density: 2.5 g/cm^3, young: 94.53 GPa, poisson: 0.07}}
contact: {law: coulomb, friction: 0.2}
output: {frames: 0, history: 100}
bodies:
)";
  for (int k = 0; k < cylinders; ++k) text += disk(k);
  text +=
      fmt::format(R"(
grid: {{size: [24 mm, {} mm], cell: 0.5 mm}}
boundaries:
  bottom: {{wall: sliding, position: {} mm, at: surface, friction: {}}}
  top: {{piston: {} m/s, position: {} mm, at: surface, friction: {}}}
)",
                  6 + 20 * cylinders, floor, friction, 0.375 * cylinders, floor + 20 * cylinders, friction);
  const Outcome out = run(scene_from(text.c_str(), method));
  REQUIRE(out.failure == "");
  const auto &time = out.history.at("time_s"), &above = out.history.at("top.force_y_N"),
             &below = out.history.at("bottom.force_y_N");
  const auto error = [&](std::size_t k) {
    return 0.5 * (below[k] - above[k]) / hertz_force(0.75 * time[k]) - 1;
  };
  for (std::size_t k = time.size() / 2; k < time.size(); ++k) CHECK(std::abs(error(k) - error(k - 1)) < 0.02);
  return error(time.size() - 1);
}

TEST_CASE(
    "slow: a cylinder between walls comes to Hertz's force, without a kink where a piston passes a row") {
  // Hertz knows no friction. Measured −0.4, 0.8, 1.0 %; with the floor between two rows 1.3, 2.3
  for (const char* basis : {"ugimp", "bspline2", "lcpdi"})
    CHECK(std::abs(hertz_error(1, 3, 0, {{"method.basis", basis}})) < 0.03);
  for (const double floor : {3.1, 3.25}) CHECK(std::abs(hertz_error(1, floor, 0, {})) < 0.03);
  CHECK(std::abs(hertz_error(1, 3, 0, {{"method.strain", "average"}})) < 0.03);  // 1.5 %
}

TEST_CASE("slow: two cylinders between walls with friction come to Hertz's force") {
  // Measured 2.0 to 2.7 %; friction at the walls makes 2 to 3 of it.
  for (const double floor : {3.0, 3.125, 3.25}) CHECK(std::abs(hertz_error(2, floor, 0.2, {})) < 0.03);
  CHECK(std::abs(hertz_error(2, 3, 0.2, {{"method.strain", "average"}})) < 0.03);  // 2.2 %
}

TEST_CASE("slow: hardly a particle of the pressed grains stands beyond a wall") {
  const std::string walls =
      "{left: {wall: sliding, at: surface}, right: {wall: sliding, at: surface}, bottom: {wall: sliding, at: "
      "surface}, top: {piston: 100 m/s, at: surface}}";
  const Scene scene = scene_file(
      "ellipses.yaml", {{"grid.cell", "1/20 mm"}, {"method.update", "xpic(5)"}, {"boundaries", walls}});
  Step<2> step(scene);
  while (step.state().time < scene.time.end)
    step.advance(std::min(step.stable_dt(), scene.time.end - step.state().time));
  const auto& particles = step.state().particles;
  // With the nodes held: 236. Grains that jam are chaotic: of 32 runs whose time steps differ (16 of c9a7844,
  // where particles lay otherwise, 16 of f37b92a) 24 left none beyond, seven one and one two, by 7 % of a
  // cell at most.
  int beyond = 0;
  double deepest = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<2> x = particles.vector(Quantity::position, p);
    const double depth = std::max({-x[0], x[0] - 1e-3, -x[1], x[1] - 0.5e-3}) / scene.grid.cell;
    beyond += depth > 0;
    deepest = std::max(deepest, depth);
  }
  CHECK(beyond <= 2);
  CHECK(deepest < 0.15);
}

}  // namespace
}  // namespace mpmfast
