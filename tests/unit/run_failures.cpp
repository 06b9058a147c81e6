// A run that fails says when, where and why, and keeps what was written.

#include <nlohmann/json.hpp>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kThrown = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: missile, box: {from: [2 mm, 4 mm], to: [4 mm, 6 mm]}, material: m, velocity: [40 m/s, 0 m/s]}]
output: {frames: 2, history: 10}
)";

struct Failed {
  std::string message;
  nlohmann::json summary;
  History history;
  bool pictures = false;
};

Failed run_to_failure(const Scene& scene) {
  Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  Failed failed;
  try {
    run_scene(scene, options);
  } catch (const RunFailure& failure) {
    failed.message = failure.what();
  }
  std::ifstream file(options.folder / "run.json");
  failed.summary = nlohmann::json::parse(file);
  failed.history = read_history(options.folder / "history.csv");
  failed.pictures = std::filesystem::exists(options.folder / "picture_last_body.png");
  return failed;
}

TEST_CASE("a particle that leaves the grid ends the run with step, time, particle, body, field and place") {
  const Failed failed = run_to_failure(scene_from(kThrown));
  for (const char* part :
       {"step ", "time ", "particle ", "'missile'", "velocity field", "(0.011", "left the grid"}) {
    CAPTURE(std::string(part));
    CHECK(failed.message.find(part) != std::string::npos);
  }
  CHECK(failed.summary["status"] == "failed");
  CHECK(failed.summary["reason"] == failed.message);
  CHECK(failed.history.at("time_s").size() >= 2);
  // 6 mm and a cell to go at 40 m/s; the last whole row lies before that.
  CHECK(failed.history.at("time_s").back() == doctest::Approx(1e-4).epsilon(0.05));
  CHECK(failed.summary["time_s"].get<double>() == doctest::Approx(7e-3 / 40).epsilon(0.1));
  CHECK(failed.summary["energy_error"].is_number());
  CHECK(failed.summary.contains("scene_hash"));
  CHECK(failed.pictures);
}

TEST_CASE("a particle that is turned inside out is named") {
  const Scene scene =
      scene_from(kThrown, {{"boundaries", "{right: {piston: 4000 m/s, direction: left, position: 6 mm}}"},
                           {"time.cfl", "1"},
                           {"method.deformation_terms", "1"}});
  const Failed failed = run_to_failure(scene);
  CHECK(failed.message.find("particle ") != std::string::npos);
  CHECK(failed.summary["status"] == "failed");
}

TEST_CASE("a body without particles, or one outside the grid, is a scene error before anything is written") {
  const auto dust = [](const std::string& centre) {
    return scene_from(kThrown, {{"bodies.0", "{name: dust, disk: {centre: " + centre +
                                                 ", radius: 0.001 mm}, material: m}"}});
  };
  const Scene empty = dust("[5.01 mm, 5.01 mm]");
  CHECK_THROWS_AS(Step<2>{empty}, SceneError);
  CHECK_THROWS_AS(dust("[15 mm, 5 mm]"), SceneError);
}

}  // namespace
}  // namespace mpmfast
