// What grid files say of surfaces that springs or bonds join.

#include <cmath>

#include "engine/output/read_vtu.hpp"
#include "engine/run/write_grid.hpp"
#include "tests/support.hpp"
#include "tests/unit/output_fixture.hpp"

namespace mpmfast {
namespace {

using namespace test;
using output_test::TemporaryFolder;

/// Two blocks of which the upper one is drawn off; along half of their face there is a crack.
Scene drawn(const std::string& law) {
  return scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: low, box: {from: [2 mm, 2 mm], to: [10 mm, 6 mm]}, material: soft}
  - {name: high, box: {from: [2 mm, 6 mm], to: [10 mm, 10 mm]}, material: soft, velocity: [0, 1 m/s]}
)",
                    {{"contact", law}});
}

TEST_CASE("grid files have the jump of surfaces that springs join, seen from either side, and no more") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "grid.vtu";
  const Scene scene = drawn("{law: interface, normal_stiffness: 1 GPa/m, shear_stiffness: 0}");
  Step<2> step(scene);
  advance(step, 5);
  write_grid(file, step, scene);
  const VtuReader reader(file);
  CHECK(reader.find("damage") == nullptr);
  REQUIRE(reader.find("jump") != nullptr);
  const auto jump = reader.values(*reader.find("jump")), field = reader.values(*reader.find("field")),
             points = reader.points();
  const double opened = step.state().time * 1;  // the springs are soft: it has hardly slowed down
  int seen = 0;
  for (std::size_t k = 0; k < reader.size(); ++k) {
    if (std::abs(points[3 * k + 1] - 6e-3) > 1e-9 || std::abs(points[3 * k] - 6e-3) > 1e-9) continue;
    CHECK(jump[3 * k + 1] == doctest::Approx(field[k] == 0 ? opened : -opened).epsilon(0.02).scale(0));
    ++seen;
  }
  CHECK(seen == 2);
  const Scene plain = drawn("{friction: 0.2}");
  Step<2> other(plain);
  advance(other, 2);
  write_grid(file, other, plain);
  CHECK(VtuReader(file).find("jump") == nullptr);
}

TEST_CASE("where a body is joined to two, grid files have the jump to the one that is farther apart") {
  for (const bool left_first : {true, false}) {
    CAPTURE(left_first);
    const TemporaryFolder folder;
    const auto file = folder.path() / "grid.vtu";
    const std::string slow = ", velocity: [0, 0.25 m/s]}\n", fast = ", velocity: [0, 1 m/s]}\n";
    const Scene scene =
        scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {law: interface, normal_stiffness: 1 GPa/m, shear_stiffness: 0}
bodies:
  - {name: low, box: {from: [2 mm, 2 mm], to: [10 mm, 6 mm]}, material: soft}
  - {name: left, box: {from: [2 mm, 6 mm], to: [6 mm, 10 mm]}, material: soft)" +
                   (left_first ? fast : slow) +
                   "  - {name: right, box: {from: [6 mm, 6 mm], to: [10 mm, 10 mm]}, material: soft" +
                   (left_first ? slow : fast));
    Step<2> step(scene);
    advance(step, 5);
    write_grid(file, step, scene);
    const VtuReader reader(file);
    const auto jump = reader.values(*reader.find("jump")), field = reader.values(*reader.find("field")),
               points = reader.points();
    int seen = 0;
    for (std::size_t k = 0; k < reader.size(); ++k) {
      if (field[k] != 0 || std::abs(points[3 * k + 1] - 6e-3) > 1e-9 || std::abs(points[3 * k] - 6e-3) > 1e-9)
        continue;
      CHECK(jump[3 * k + 1] ==
            doctest::Approx(step.state().time * 1).epsilon(0.05).scale(0));  // soft springs
      ++seen;
    }
    CHECK(seen == 1);
  }
}

TEST_CASE("grid files have the damage of bonds: a crack is broken, what is drawn apart is worn") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "grid.vtu";
  const Scene scene = drawn(
      "{law: cohesive, normal_strength: 100 kPa, shear_strength: 100 kPa, normal_toughness: 10 J/m^2, "
      "shear_toughness: 10 J/m^2, crack: {from: [0, 5 mm], to: [5 mm, 7 mm]}}");
  Step<2> step(scene);
  advance(step, 20);
  write_grid(file, step, scene);
  const VtuReader reader(file);
  REQUIRE(reader.find("damage") != nullptr);
  const auto damage = reader.values(*reader.find("damage")), points = reader.points();
  int broken = 0, worn = 0;
  for (std::size_t k = 0; k < reader.size(); ++k) {
    const double x = points[3 * k], y = points[3 * k + 1];
    if (std::abs(y - 6e-3) < 1e-9 && x > 2.5e-3 && x < 4.5e-3) broken += damage[k] == 1;
    if (std::abs(y - 6e-3) < 1e-9 && x > 6.5e-3 && x < 9.5e-3) worn += damage[k] > 0 && damage[k] < 1;
    if (y < 4e-3) CHECK(std::isnan(damage[k]));
  }
  CHECK(broken == 2 * 2);
  CHECK(worn == 2 * 3);
}

}  // namespace
}  // namespace mpmfast
