// The same scene gives the same bits on any number of threads.

#include "tests/overlapping.hpp"
#include "tests/scattered.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kGrains2 = R"(
space: plane_strain
grid: {size: [24 mm, 24 mm], cell: 0.4 mm}
time: {end: 50 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [6 mm, 6 mm], radius: 4 mm}, material: m, velocity: [20 m/s, 20 m/s]}
  - {name: b, disk: {centre: [13 mm, 13 mm], radius: 5 mm}, material: m, velocity: [-20 m/s, -20 m/s]}
  - {name: c, ellipse: {centre: [15 mm, 6 mm], radii: [5 mm, 2 mm], angle: 0.4 rad}, material: m, velocity: [-30 m/s, 10 m/s]}
boundaries: {left: wall, bottom: wall, top: {piston: 30 m/s, direction: down, position: 18 mm}}
contact: {law: coulomb, friction: 0.3}
method: {basis: lcpdi, update: xpic(3)}
output: {frames: 0, history: 4}
)";

const char* const kGrains3 = R"(
space: 3d
grid: {size: [16 mm, 16 mm, 16 mm], cell: 0.8 mm}
time: {end: 30 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, sphere: {centre: [5 mm, 5 mm, 5 mm], radius: 3 mm}, material: m, velocity: [30 m/s, 30 m/s, 30 m/s]}
  - {name: b, sphere: {centre: [8.6 mm, 8.6 mm, 8.6 mm], radius: 3 mm}, material: m, velocity: [-30 m/s, -30 m/s, -30 m/s]}
contact: {law: coulomb, friction: 0.3, normal: smoothed_logistic_regression}
method: {update: flip}
output: {frames: 0, history: 4}
)";

TEST_CASE("the checksum is the same on one thread, on two, on three and again") {
  for (const char* yaml : {kGrains2, kGrains3}) {
    const Scene scene = scene_from(yaml);
    const Outcome one = run(scene, 1), two = run(scene, 2), three = run(scene, 3), again = run(scene, 2);
    REQUIRE(one.failure.empty());
    CHECK(one.summary.threads == 1);
    CHECK(two.summary.threads == 2);
    CHECK(three.summary.threads == 3);
    CHECK(one.summary.contact.regressions > 1000);
    CHECK(one.summary.checksum == two.summary.checksum);
    CHECK(one.summary.checksum == three.summary.checksum);
    CHECK(two.summary.checksum == again.summary.checksum);
    CHECK(one.summary.energy_error == two.summary.energy_error);
  }
}

TEST_CASE("contact of surfaces that are followed gives the same bits on any number of threads") {
  for (const char* yaml : {kGrains2, kGrains3}) {
    const Scene scene =
        scene_from(yaml, {{"contact", "{family: penalty, friction: 0.3}"},
                          {"method", "{basis: bspline2, extension: {occupation: 0.75}, update: flip}"}});
    const Outcome one = run(scene, 1), two = run(scene, 2), three = run(scene, 3);
    REQUIRE(one.failure.empty());
    CHECK(one.history.at("friction_J").back() > 0);
    CHECK(one.summary.checksum == two.summary.checksum);
    CHECK(one.summary.checksum == three.summary.checksum);
    CHECK(one.summary.energy_error == three.summary.energy_error);
  }
}

TEST_CASE(
    "contact at points of the surface gives the same bits on any number of threads, and after a resume") {
  for (const char* yaml : {kGrains2, kGrains3}) {
    const Scene scene = scene_from(yaml, {{"contact", "{family: surface, friction: 0.3}"}});
    const Outcome one = run(scene, 1), two = run(scene, 2), three = run(scene, 3);
    REQUIRE(one.failure.empty());
    CHECK(one.history.at("friction_J").back() > 0);
    CHECK(one.summary.checksum == two.summary.checksum);
    CHECK(one.summary.checksum == three.summary.checksum);
    CHECK(one.summary.energy_error == three.summary.energy_error);
  }
}

TEST_CASE("any number of threads counts the same normals as fallbacks, touching and doubtful") {
  for (const char* normal : {"smoothed_max_margin", "max_margin"}) {
    CAPTURE(std::string(normal));
    // Cells so small that threads share the nodes.
    const Scene scene = scene_from(kOverlapping, {{"contact.normal", normal}, {"grid.cell", "0.25 mm"}});
    const auto one = run(scene, 1).summary.contact, three = run(scene, 3).summary.contact;
    CHECK(one.doubtful > 0);
    CHECK(one.fallbacks == three.fallbacks);
    CHECK(one.touching == three.touching);
    CHECK(one.doubtful == three.doubtful);
  }
}

TEST_CASE("the checksum is the same on any number of threads with every other basis and update") {
  for (const auto& method : std::map<std::string, std::string>{{"linear", "flip"},
                                                               {"ugimp", "fmpm(3)"},
                                                               {"qcpdi", "xpic(2)"},
                                                               {"bspline2", "apic"},
                                                               {"bspline3", "apic"}}) {
    CAPTURE(method.first);
    const Scene scene = scene_from(kGrains2, {{"method.basis", method.first},
                                              {"method.update", method.second},
                                              {"method.deformation_terms", "exponential"},
                                              {"time.end", "25 us"}});
    const Outcome one = run(scene, 1), three = run(scene, 3);
    REQUIRE(one.failure.empty());
    CHECK(one.summary.contact.regressions > 100);
    CHECK(one.summary.checksum == three.summary.checksum);
  }
}

TEST_CASE("a run that particles leave is the same to the bit on any number of threads") {
  const Scene scene = scene_from(kScattered);
  const Outcome one = run(scene, 1), two = run(scene, 2), three = run(scene, 3);
  REQUIRE(one.failure.empty());
  CHECK(three.summary.threads == 3);
  CHECK(one.summary.checksum == two.summary.checksum);
  CHECK(one.summary.checksum == three.summary.checksum);
  CHECK(one.history == three.history);
  CHECK(one.summary.outflow->energy == three.summary.outflow->energy);
}

TEST_CASE("running the resolved scene gives the same bits") {
  const Scene scene = scene_from(kGrains2);
  const Scene resolved = parse_scene(scene.resolved_yaml, "resolved.yaml");
  CHECK(run(scene).summary.checksum == run(resolved).summary.checksum);
}

}  // namespace
}  // namespace mpmfast
