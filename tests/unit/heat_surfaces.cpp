// What crosses surfaces in a step, where it is so little that temperatures stay as they are.

#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Σ M c (T − 300 K) of a body, J.
double content(const Step<2>& step, std::size_t body) {
  const auto& state = step.state();
  double sum = 0;
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    if (state.particles.body()[p] == body)
      sum += state.particles.column(Quantity::mass)[p] * state.bodies[body].heat.capacity *
             (state.particles.column(Quantity::temperature)[p] - 300);
  return sum;
}

/// What body 0 at 300 K gets in a step through x = 6 mm, of h A ΔT Δt.
double crossed(const std::string& others, const std::string& contact,
               const std::string& conductance = "10 W/m^2/K") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials:
  m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 0 W/m/K}
  hard: {model: rigid}
heat: {temperature: 300 K}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [6 mm, 10 mm]}, material: m}
)" + others +
                                 "contact: {conductance: " + conductance + ", " + contact + "}\n");
  Step<2> step(scene);
  const double dt = step.stable_dt();
  step.advance(dt);
  return content(step, 0) / (10 * 8e-3 * 100 * dt);
}

const std::string kWarm = "  - {name: b, box: {from: [6 mm, 2 mm], to: [10 mm, 10 mm]}, temperature: 400 K, ";
const std::string kHalves =
    "  - {name: b, box: {from: [6 mm, 2 mm], to: [10 mm, 6.2 mm]}, temperature: 400 K, material: m}\n"
    "  - {name: c, box: {from: [6 mm, 6.2 mm], to: [10 mm, 10 mm]}, temperature: 400 K, material: m}\n";

TEST_CASE("a conductance lets through what its area and the jump of the temperatures say") {
  for (const char* contact : {"normal: average_gradient", "normal: logistic_regression",
                              "normal: logistic_regression, fields: pairs"}) {
    CAPTURE(std::string(contact));
    // One exponential decay, of which a step takes a millionth.
    CHECK(crossed(kWarm + "material: m}\n", contact) == doctest::Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("a rigid body without a heat capacity is as warm as it is told") {
  for (const char* contact : {"normal: average_gradient", "normal: logistic_regression"}) {
    CAPTURE(std::string(contact));
    CHECK(crossed(kWarm + "material: hard}\n", contact) == doctest::Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("what fills a gap and the surfaces on it resist in series") {
  const std::string apart =
      "  - {name: b, box: {from: [6.5 mm, 2 mm], to: [10 mm, 10 mm]}, temperature: 400 K, material: m}\n";
  const auto through = [&](const std::string& conductance, const std::string& filling) {
    return crossed(apart, "normal: logistic_regression, gap_conductivity: " + filling, conductance);
  };
  // Half a millimetre of 5 mW/m/K: 10 W/m^2/K by itself, in multiples of which both are.
  const double gap = through("perfect", "0.005 W/m/K");
  CHECK(gap == doctest::Approx(1).epsilon(0.05));
  for (const double surface : {0.5, 1.0, 4.0}) {
    CAPTURE(surface);
    CHECK(through(std::to_string(10 * surface) + " W/m^2/K", "0.005 W/m/K") ==
          doctest::Approx(gap * surface / (1 + surface)).epsilon(1e-4));
  }
  CHECK(through("10 W/m^2/K", "0 W/m/K") == 0);
  CHECK(through("none", "0.005 W/m/K") == 0);
}

TEST_CASE("a surface that is shared by two bodies lets through as much as that of one") {
  // On the nodes where three meet, areas are those of their pairs, and normals turn: 2 and 4 % by
  // measurement.
  for (const char* contact : {"normal: average_gradient", "normal: logistic_regression",
                              "normal: logistic_regression, fields: pairs"}) {
    CAPTURE(std::string(contact));
    CHECK(crossed(kHalves, contact) == doctest::Approx(1).epsilon(0.1));
  }
}

TEST_CASE("the history has the heat of bodies, from the temperature of the scene, and what came in") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [10 mm, 4 mm], cell: 1 mm}
time: {end: 20 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 20 W/m/K}}
heat: {temperature: 300 K, boundaries: {left: {flux: 2 MW/m^2}}}
bodies: [{name: a, box: {from: [0, 0], to: [8 mm, 4 mm]}, material: m, temperature: 310 K}]
output: {frames: 0, picture: none}
)");
  const Outcome out = run(scene);
  REQUIRE(out.failure == "");
  // M c ΔT and q A t, with 32 mm² and 4 mm a metre of thickness.
  const auto& heat = out.history.at("heat_J");
  CHECK(heat.front() == doctest::Approx(1200 * 32e-6 * 50 * 10).epsilon(1e-9));
  CHECK(heat.back() - heat.front() == doctest::Approx(2e6 * 4e-3 * 20e-6).epsilon(1e-6));
  CHECK(out.history.at("heat_in_J").back() == doctest::Approx(2e6 * 4e-3 * 20e-6).epsilon(1e-9));
}

}  // namespace
}  // namespace mpmfast
