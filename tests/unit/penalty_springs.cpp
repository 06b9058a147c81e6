// Springs of penalty contact: stiffness, stored energy, reach and memory.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/contact/penalty/penalty.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Force on the surface of a body in the last step, N.
Vec<2> force_on(const Step<2>& step, std::size_t body) {
  const auto& surface = step.state().surfaces.bodies[body];
  Vec<2> sum = Vec<2>::Zero();
  for (int p = surface.first; p < surface.first + surface.count; ++p)
    sum += step.penalty().forces()[static_cast<std::size_t>(p)];
  return sum;
}

TEST_CASE("the spring between two materials has the stiffness of the softer, whichever is named first") {
  const std::string low = "box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                    high = "box: {from: [11.13 mm, 19.99 mm], to: [17.13 mm, 26 mm]}";
  // K + 4G/3 is 120 MPa of the soft one, 1200 MPa of the hard one.
  for (const bool hard_first : {true, false}) {
    CAPTURE(hard_first);
    const char *first = hard_first ? "hard" : "soft", *second = hard_first ? "soft" : "hard";
    const Scene scene = scene_from(fmt::format(R"(
space: plane_strain
grid: {{size: [40 mm, 40 mm], cell: 1 mm}}
time: {{end: 1 s}}
materials:
  soft: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
  hard: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 800 MPa, shear: 300 MPa}}
bodies:
  - {{name: a, {}, material: {}}}
  - {{name: b, {}, material: {}}}
method: {{basis: bspline2}}
contact: {{family: penalty, points_per_cell: 4, law: frictionless}}
)",
                                               low, first, high, second));
    Step<2> step(scene);
    advance(step, 1);
    CHECK(force_on(step, 1)[1] == doctest::Approx(120e6 / 1e-3 * 1e-5 * 6e-3).epsilon(1e-3));
  }
}

TEST_CASE("a small step in a surface does not hide contacts beside it, at any scale") {
  // A block lies along facets of a quarter of a cell, right beside a step of a hundredth.
  for (const double cell : {1e-3, 1.0, 100.0}) {
    CAPTURE(cell);
    const auto at = [&](double x, double y) {
      return fmt::format("[{:.9g} m, {:.9g} m]", x * cell, y * cell);
    };
    const Scene scene = scene_from(fmt::format(
        R"(
space: plane_strain
grid: {{size: {}, cell: {:.9g} m}}
time: {{end: 1 s}}
materials: {{m: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
bodies:
  - {{name: a, polygon: [{}, {}, {}, {}, {}, {}], material: m}}
  - {{name: b, box: {{from: {}, to: {}}}, material: m}}
method: {{basis: bspline2}}
contact: {{family: penalty, points_per_cell: 4, law: frictionless}}
)",
        at(12, 8), cell, at(1, 1), at(10, 1), at(10, 3), at(5, 3), at(5, 3.01), at(1, 3.01),
        at(5.002, 2.9975), at(7.002, 5)));
    Step<2> step(scene);
    advance(step, 1);
    CHECK(force_on(step, 1)[1] == doctest::Approx(120e6 / cell * 0.0025 * cell * 2 * cell).epsilon(1e-3));
  }
}

TEST_CASE("springs store half of stiffness times depth squared, and of stiffness times slip squared") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 40 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}, material: m}
  - {name: b, box: {from: [11.13 mm, 19.99 mm], to: [17.13 mm, 26 mm]}, material: m}
method: {basis: bspline2}
contact: {family: penalty, points_per_cell: 4, law: stick}
)");
  Step<2> step(scene);
  const auto passes = make_passes<2>(scene.method.basis);
  Penalty<2> penalty(scene, step.plan(), step.state());
  auto& state = step.state();
  passes->sort(state);
  const auto stored = [&] {
    penalty.invalidate_tiles();
    REQUIRE(!penalty.find_contacts(state));
    penalty.compute_forces(state, std::vector<Vec<2>>(2, Vec<2>::Zero()), 1e-6);
    ++state.step;
    state.time += 1e-6;
    return penalty.stored_energy(state);
  };
  const double stiffness = 120e6 / 1e-3 * 6e-3, depth = 1e-5;
  CHECK(stored() == doctest::Approx(0.5 * stiffness * depth * depth).epsilon(2e-3).scale(0));
  for (const double slip : {0.4e-5, 0.8e-5}) {
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      if (state.particles.body()[p] == 1) state.particles.column(Quantity::position, 0)[p] += 0.4e-5;
    CHECK(stored() ==
          doctest::Approx(0.5 * stiffness * (depth * depth + slip * slip)).epsilon(2e-3).scale(0));
  }
}

/// Memory of penalty contact of two bars that touch along all of their length, bytes.
double bytes_of_bars(double length) {
  const Scene scene = scene_from(fmt::format(R"(
space: plane_strain
grid: {{size: [90 mm, 16 mm], cell: 1 mm}}
time: {{end: 1 s}}
materials: {{m: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
bodies:
  - {{name: a, box: {{from: [5 mm, 5 mm], to: [{0} mm, 8 mm]}}, material: m}}
  - {{name: b, box: {{from: [5 mm, 8 mm], to: [{0} mm, 11 mm]}}, material: m}}
method: {{basis: bspline2}}
contact: {{family: penalty, points_per_cell: 4, law: frictionless}}
)",
                                             5 + length));
  Step<2> step(scene);
  const auto passes = make_passes<2>(scene.method.basis);
  Penalty<2> penalty(scene, step.plan(), step.state());
  passes->sort(step.state());
  REQUIRE(!penalty.find_contacts(step.state()));
  return static_cast<double>(penalty.bytes());
}

TEST_CASE("surfaces twice as long take twice the memory, as only near facets are candidates") {
  const double ratio = bytes_of_bars(80) / bytes_of_bars(40);
  CHECK(ratio > 1.5);  // vectors reserve more than they hold
  CHECK(ratio < 2.6);
}

TEST_CASE("no patch belongs to two bodies, and a body has as many as its shape") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 40 mm], cell: 1 mm}
time: {end: 1 s}
materials: {soft: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: disk, disk: {centre: [8 mm, 8 mm], radius: 4 mm}, material: soft}
  - {name: ring, ring: {centre: [20 mm, 8 mm], inner: 2 mm, outer: 4 mm}, material: soft}
  - {name: box, box: {from: [4 mm, 20 mm], to: [12 mm, 24 mm]}, material: soft}
  - {name: other, disk: {centre: [20 mm, 24 mm], radius: 4 mm}, material: soft}
method: {basis: bspline2}
contact: {family: penalty, law: frictionless}
)");
  const Step<2> step(scene);
  std::map<int, int> body_of;
  for (const auto& facet : step.state().surfaces.facets) {
    const auto known = body_of.emplace(facet.patch, facet.body).first;
    CHECK(known->second == facet.body);
  }
  std::vector<int> patches(4, 0);
  for (const auto& [patch, body] : body_of) ++patches[static_cast<std::size_t>(body)];
  CHECK(patches == std::vector<int>{1, 2, 4, 1});
}

}  // namespace
}  // namespace mpmfast
