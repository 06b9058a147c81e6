// What a run tells of itself when it is over: of few steps and of none, and of the settings that count.

#include <functional>
#include <utility>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kBlock = R"(
space: plane_strain
grid: {size: [8 mm, 8 mm], cell: 1 mm}
time: {end: 50 us}
materials:
  m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  sand: {model: drucker_prager, density: 1600 kg/m^3, young: 1 MPa, poisson: 0.3, friction_angle: 31 deg}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [4 mm, 6 mm]}, material: m, velocity: [3 m/s, 0]}
  - {name: b, box: {from: [4 mm, 2 mm], to: [6 mm, 6 mm]}, material: m}
contact: {friction: 0.1}
output: {frames: 0, picture: none, checkpoint: none}
)";

RunSummary summary_of(const Scene& scene, const std::function<void(RunOptions&)>& set) {
  const Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  set(options);
  return run_scene(scene, options);
}

TEST_CASE("a run without a step has no time steps, and one of a step has the one that it took") {
  const Scene scene = scene_from(kBlock);
  const RunSummary none = summary_of(scene, [](RunOptions& options) { options.max_steps = 0; });
  CHECK(none.steps == 0);
  CHECK(none.time == 0);
  CHECK(none.dt_min == 0);
  CHECK(none.dt_max == 0);
  const RunSummary one = summary_of(scene, [](RunOptions& options) { options.max_steps = 1; });
  CHECK(one.steps == 1);
  CHECK(one.time > 0);
  CHECK(one.dt_min == one.time);
  CHECK(one.dt_max == one.time);
  const RunSummary two = summary_of(scene, [](RunOptions& options) { options.max_steps = 2; });
  CHECK(two.dt_min <= two.dt_max);
  CHECK(two.dt_min + two.dt_max == doctest::Approx(two.time).epsilon(1e-12).scale(0));
}

TEST_CASE(
    "a run is over at the time it goes to, which round-off may miss, and takes no step to where it is") {
  CHECK(has_ended(0, 0));
  CHECK(has_ended(1e-6, 0));
  CHECK_FALSE(has_ended(0, 1e-6));
  for (const double end : {1e-6, 1.0, 3600.0}) {
    CHECK(has_ended(end, end));
    CHECK(has_ended(end * (1 - 1e-15), end));
    CHECK(has_ended(end * (1 + 1e-15), end));
    CHECK_FALSE(has_ended(end * (1 - 1e-9), end));
  }
  const RunSummary none = summary_of(scene_from(kBlock), [](RunOptions& options) {
    options.until = 0;
    options.max_steps = 3;
  });
  CHECK(none.steps == 0);
  CHECK(none.status == "finished");
  CHECK(none.reason == "");
}

TEST_CASE("a run tells the settings that its warnings go by") {
  const auto settings = [](const std::vector<Override>& overrides) {
    return summary_of(scene_from(kBlock, overrides), [](RunOptions& options) { options.max_steps = 0; })
        .settings;
  };
  for (const auto& [share, drops] : {std::pair{"0", false}, {"0.01", true}, {"0.9", true}, {"1.5", true}}) {
    CAPTURE(share);
    CHECK(settings({{"contact.volume_screen", share}}).volume_screen == drops);
  }
  for (const auto& [update, filters] : {std::pair{"flip", false}, {"pic", true}, {"xpic(2)", true}})
    CHECK(settings({{"method.update", update}}).filtered == filters);
  for (const auto& [strain, averages] : {std::pair{"first", false}, {"average", true}, {"last", false}})
    CHECK(settings({{"method.strain", strain}}).averaged_strain == averages);
  for (const auto& [position, ends] : {std::pair{"grid_end", true}, {"grid", false}})
    CHECK(settings({{"method.position", position}}).grid_end == ends);
  for (const auto& [split, splits] : {std::pair{"none", false}, {"true", true}})
    CHECK(settings({{"method.basis", "lcpdi"}, {"method.split", split}}).splits == splits);
  CHECK(settings({{"time.cfl", "0.125"}}).cfl == 0.125);
  for (const auto& [basis, follows] : {std::pair{"linear", false}, {"bspline2", false}, {"lcpdi", true}})
    CHECK(settings({{"method.basis", basis}}).follows_shape == follows);
  CHECK(settings({}).flowing_body == "");
  CHECK(settings({{"bodies.1.material", "sand"}}).flowing_body == "b");
  CHECK(settings({{"bodies.0.material", "sand"}, {"bodies.1.material", "sand"}}).flowing_body == "a");
}

}  // namespace
}  // namespace mpmfast
