// What a run tells of itself while it goes on.

#include <vector>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("a run that goes on tells how far it is, and how long the rest takes at the pace so far") {
  // Nothing moves, so all steps are as long: the rest of the time takes as much of the clock as what is over.
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [4 mm, 4 mm], cell: 1 mm}
time: {end: 10 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [1 mm, 1 mm], to: [3 mm, 3 mm]}, material: m}]
output: {frames: 0, picture: none, checkpoint: none}
)");
  const Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  options.threads = 1;
  std::vector<Progress> told;
  options.progress = [&](const Progress& p) { told.push_back(p); };
  options.stop = [&] { return !told.empty(); };
  const RunSummary summary = run_scene(scene, options);
  REQUIRE(!told.empty());
  const Progress& p = told.front();
  CHECK(p.step > 0);
  CHECK(p.step <= summary.steps);
  CHECK(p.end == 10);
  CHECK(p.time == doctest::Approx(static_cast<double>(p.step) * summary.dt_max).epsilon(1e-9).scale(0));
  CHECK(p.seconds_left == doctest::Approx(p.wall * (p.end - p.time) / p.time).epsilon(1e-9).scale(0));
  CHECK(p.energy_error == 0);
}

TEST_CASE("the seconds of a run by pass and of its output are no more than all that it took") {
  const Outcome outcome = run(scene_from(R"(
space: plane_strain
grid: {size: [8 mm, 8 mm], cell: 1 mm}
time: {end: 50 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [2 mm, 2 mm], to: [6 mm, 6 mm]}, material: m, velocity: [3 m/s, -2 m/s]}]
output: {frames: 2, checkpoint: none}
)"));
  REQUIRE(outcome.failure.empty());
  double sum = 0, output = -1;
  for (const auto& [pass, seconds] : outcome.summary.seconds) {
    CAPTURE(pass);
    CHECK(seconds >= 0);
    sum += seconds;
    if (pass == "output") output = seconds;
  }
  CHECK(output > 0);
  CHECK(sum > output);
  CHECK(sum <= outcome.summary.wall);
}

}  // namespace
}  // namespace mpmfast
