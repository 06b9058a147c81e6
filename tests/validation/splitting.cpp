// Bodies that are drawn out until the domains of their particles would no longer bridge the cells.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// An elastic strip between rigid grips, drawn to six times its length within 2.7 ms, slowly for its waves.
const char* const kStrip = R"(
title: A strip is drawn out between two rigid grips
space: plane_strain
grid: {size: [84 mm, 10 mm], cell: 1 mm}
time: {end: 2.7 ms}
materials:
  rubber: {model: logarithmic_neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
  grip: {model: rigid}
bodies:
  - {name: strip, box: {from: [37 mm, 3 mm], to: [47 mm, 7 mm]}, material: rubber}
  - {name: l, box: {from: [33 mm, 2 mm], to: [37 mm, 8 mm]}, material: grip, velocity: [[[0 ms, 0 m/s], [0.4 ms, -10 m/s]], 0]}
  - {name: r, box: {from: [47 mm, 2 mm], to: [51 mm, 8 mm]}, material: grip, velocity: [[[0 ms, 0 m/s], [0.4 ms, 10 m/s]], 0]}
contact: {law: perfect}
method: {basis: lcpdi}
output: {frames: 0, history: 200, picture: none}
)";

TEST_CASE(
    "a strip drawn to six times its length stays whole with two particles a side, and as stiff as with "
    "four") {
  for (const char* basis : {"lcpdi", "qcpdi"}) {
    CAPTURE(std::string(basis));
    const Outcome four = run(
                      scene_from(kStrip, {{"method.basis", basis}, {"bodies.0.particles_per_cell", "4"}})),
                  split = run(scene_from(kStrip, {{"method.basis", basis}, {"method.split", "{edge: 1.5}"}}));
    REQUIRE(four.failure.empty());
    REQUIRE(split.failure.empty());
    REQUIRE(split.summary.splits);
    CHECK(split.summary.splits->splits > 160);
    const double there = four.history.at("strip.mean_stress_xx_Pa").back();
    CHECK(split.history.at("strip.mean_stress_xx_Pa").back() == doctest::Approx(there).epsilon(0.02));
    CHECK(std::abs(split.summary.energy_error) < 0.02);
  }
}

}  // namespace
}  // namespace mpmfast
