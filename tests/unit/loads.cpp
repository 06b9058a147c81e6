/// Loads: forces on nodes against closed sums, what they need of the plan, and their work.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/random.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr double kBarDensity = 1000;

/// One block of 6 mm by 4 mm off the lines of the grid, or that cube, under what `loads` says.
Scene block(const char* space, const char* loads, const char* method = "{strain: last}") {
  const bool solid = std::string(space) == "3d";
  return scene_from(
      fmt::format("space: {}\ngrid: {{size: [{}], cell: 1 mm}}\ntime: {{end: 1 s}}\n"
                  "materials: {{m: {{model: neo_hookean, density: {}, young: 1 MPa, poisson: 0.3}}}}\n"
                  "bodies: [{{name: block, material: m, box: {{from: [{}], to: [{}]}}}}]\n"
                  "loads: {}\nmethod: {}\n",
                  space, solid ? "30 mm, 10 mm, 10 mm" : "30 mm, 10 mm", kBarDensity,
                  solid ? "3.3 mm, 3.4 mm, 3.2 mm" : "3.3 mm, 3.4 mm",
                  solid ? "9.3 mm, 7.4 mm, 6.2 mm" : "9.3 mm, 7.4 mm", loads, method));
}

/// The force on the block in the next step, N.
template <int Dim>
Vec<Dim> next_force(Step<Dim>& step) {
  constexpr double dt = 1e-7;
  const Vec<Dim> before = momentum(step.state().particles);
  step.advance(dt);
  return (momentum(step.state().particles) - before) / dt;
}

TEST_CASE("a pressure on a part of the surface has the resultant of that part") {
  struct Case {
    const char* loads;
    double x, y;  ///< N a metre of depth
  };
  for (const Case& one : {
           Case{"{pressure: [{body: block, value: 1 kPa}]}", 0, 0},
           Case{"{pressure: [{body: block, value: 1 kPa, where: {box: {from: [6 mm, 0], to: [20 mm, 10 "
                "mm]}}}]}",
                -4, 0},
           Case{"{pressure: [{body: block, value: -1 kPa, where: {box: {from: [0, 0], to: [6 mm, 10 mm]}}}]}",
                -4, 0},
           Case{
               "{pressure: [{body: block, value: 1 kPa, along: y, where: {box: {from: [0, 5 mm], to: [20 mm, "
               "10 mm]}}}]}",
               0, -6},
           // A part of the upper face: along straight edges the shares of the cells add up to it.
           Case{"{pressure: [{body: block, value: 1 kPa, where: {box: {from: [5.1 mm, 5 mm], to: [7.6 mm, 20 "
                "mm]}}}]}",
                0, -2.5},
           Case{"{pressure: [{body: block, value: [[0, 1 kPa], [1, 1 kPa]], along: [3, 4], where: {box: "
                "{from: "
                "[6 mm, 0], to: [20 mm, 10 mm]}}}]}",
                -4 * 0.36, -4 * 0.48},
       }) {
    CAPTURE(one.loads);
    const Scene scene = block("plane_strain", one.loads);
    Step<2> step(scene);
    const Vec<2> force = next_force(step);
    CHECK(force[0] == doctest::Approx(one.x).epsilon(1e-9).scale(1));
    CHECK(force[1] == doctest::Approx(one.y).epsilon(1e-9).scale(1));
  }
}

TEST_CASE("a pressure in three dimensions has the resultant of its face") {
  const Scene scene =
      block("3d",
            "{pressure: [{body: block, value: 1 kPa, where: {box: {from: [6 mm, 0, 0], to: [20 "
            "mm, 10 mm, 10 mm]}}}]}");
  Step<3> step(scene);
  const Vec<3> force = next_force(step);
  CHECK(force[0] == doctest::Approx(-1e3 * 4e-3 * 3e-3).epsilon(1e-9));
  CHECK(std::abs(force[1]) < 1e-12);
  CHECK(std::abs(force[2]) < 1e-12);
}

TEST_CASE("about an axis a pressure acts on the whole turn") {
  const double pi = std::acos(-1.0);
  {
    const Scene scene =
        block("axisymmetric",
              "{pressure: [{body: block, value: 1 kPa, along: y, where: {box: {from: [0, 5 mm], "
              "to: [20 mm, 20 mm]}}}]}",
              "{}");
    Step<2> step(scene);
    CHECK(next_force(step)[1] == doctest::Approx(-1e3 * pi * (9.3 * 9.3 - 3.3 * 3.3) * 1e-6).epsilon(1e-9));
  }
  const Scene scene = block("axisymmetric",
                            "{pressure: [{body: block, value: 1 kPa, where: {box: {from: [-5 mm, -5 mm], to: "
                            "[6 mm, 20 mm]}}, along: x}]}",
                            "{}");
  Step<2> step(scene);
  CHECK(next_force(step)[0] == doctest::Approx(1e3 * 2 * pi * 3.3e-3 * 4e-3).epsilon(1e-9));
}

/// Particles with a stress -p I of their own, and any deformation: nothing moves, not even by round-off times
/// what the pressure alone would move.
template <int Dim>
double moved(const char* space, const char* basis) {
  const Scene scene = block(space, "{pressure: [{body: block, value: 1 kPa}]}",
                            fmt::format("{{basis: {}, strain: last}}", basis).c_str());
  Step<Dim> step(scene);
  auto& particles = step.state().particles;
  Random random(7);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int e = 0; e < Dim * Dim; ++e)
      particles.column(Quantity::deformation_gradient, e)[p] += random.in(-0.1, 0.1);
    const double j = particles.volume_ratio(p);
    for (int e = 0; e < (Dim == 2 ? 4 : 6); ++e)
      particles.column(Quantity::kirchhoff_stress, e)[p] = e < 3 ? -1e3 * j : 0;
  }
  constexpr double dt = 1e-7;
  step.advance(dt);
  double most = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    most = std::max(most, particles.vector(Quantity::velocity, p).norm());
  return most / (1e3 * dt / (kBarDensity * 1e-3));  // p dt/(rho h)
}

TEST_CASE("a body with the stress -p I rests under the pressure p, whatever its basis and deformation") {
  for (const char* basis : bases()) {
    CAPTURE(basis);
    CHECK(moved<2>("plane_strain", basis) < 1e-11);
  }
  CHECK(moved<3>("3d", "ugimp") < 1e-11);
  CHECK(moved<3>("3d", "lcpdi") < 1e-11);
}

TEST_CASE("a pressure stays on the material that it was given to") {
  const Scene scene = block("plane_strain",
                            "{pressure: [{body: block, value: [[0 s, 0 Pa], [1 ms, 0 Pa], [1.01 ms, 1 kPa]], "
                            "where: {box: {from: [6 mm, "
                            "0], to: [12 mm, 10 mm]}}}]}");
  Step<2> step(scene);
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) particles.column(Quantity::velocity, 0)[p] = 12;
  while (step.state().time < 1.02e-3) step.advance(std::min(step.stable_dt(), 1.02e-3 - step.state().time));
  CHECK(particles.column(Quantity::position, 0)[0] > 12e-3);  // beyond the box
  CHECK(next_force(step)[0] == doctest::Approx(-4).epsilon(0.01));
}

TEST_CASE("the work of a pressure in a step from rest is the energy of the nodes") {
  const Scene scene =
      block("plane_strain",
            "{pressure: [{body: block, value: 1 kPa, where: {box: {from: [6 mm, 0], to: [20 mm, 10 "
            "mm]}}}]}");
  Step<2> step(scene);
  advance(step, 1);
  const auto& nodes = step.state().nodes;
  double energy = 0;
  for (int slot = 0; slot < step.state().tiling.slots(); ++slot)
    energy += 0.5 * nodes.column(Nodal::mass)[slot] * nodes.vector(Nodal::force, slot).squaredNorm();
  CHECK(energy > 0);
  CHECK(step.sums().body_force_work == doctest::Approx(energy).epsilon(1e-12));
}

TEST_CASE("the work of a pressure is the energy of the block that it moves") {
  const Scene scene =
      block("plane_strain",
            "{pressure: [{body: block, value: 1 kPa, where: {box: {from: [6 mm, 0], to: [20 mm, 10 "
            "mm]}}}]}",
            "{}");
  Step<2> step(scene);
  while (step.state().time < 1e-3) step.advance(step.stable_dt());
  const double energy = kinetic_energy(step.state().particles) + step.stored_energy();
  CHECK(step.sums().body_force_work > 0);
  CHECK(energy == doctest::Approx(step.sums().body_force_work).epsilon(0.005));
}

TEST_CASE("only a load on a surface has columns, and displacements only a part of one") {
  const auto has = [](const Plan& plan, Nodal q) {
    return std::find(plan.nodal_columns.begin(), plan.nodal_columns.end(), q) != plan.nodal_columns.end();
  };
  const auto follows = [](const Plan& plan) {
    return std::count(plan.particle_columns.begin(), plan.particle_columns.end(),
                      Quantity::reference_position);
  };
  const Plan none = make_plan(block("plane_strain", "{}"));
  CHECK_FALSE(has(none, Nodal::volume_gradient));
  const Plan whole = make_plan(block("plane_strain", "{pressure: [{body: block, value: 1 Pa}]}"));
  CHECK(has(whole, Nodal::volume_gradient));
  CHECK_FALSE(has(whole, Nodal::mass_displacement));
  CHECK(follows(whole) == 0);
  CHECK(whole.passes.size() == none.passes.size() + 2);  // the projection of the gradients, and the loads
  const Plan part = make_plan(
      block("plane_strain",
            "{pressure: [{body: block, value: 1 Pa, where: {disk: {centre: [0, 0], radius: 1}}}]}"));
  CHECK(has(part, Nodal::mass_displacement));
  CHECK(follows(part) == 1);
}

}  // namespace
}  // namespace mpmfast
