// method.split: what a scene may say of it.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

std::string scene_with(const std::string& method, const std::string& rest = "") {
  return R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1 g/cm^3, bulk: 2 GPa, shear: 1 GPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm], to: [5 mm, 5 mm]}, material: m}
  - {name: b, box: {from: [5 mm, 1 mm], to: [9 mm, 5 mm]}, material: m}
method: )" +
         method + "\n" + rest;
}

std::string refusal(const std::string& yaml) {
  try {
    scene_from(yaml);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("particles are split where the scene says so, at 1.5 cells unless it says when") {
  CHECK(!scene_from(scene_with("{basis: lcpdi}")).method.split);
  for (const char* off : {"none", "false"})
    CHECK(!scene_from(scene_with(std::string("{basis: ugimp, split: ") + off + "}")).method.split);
  for (const char* on : {"true", "{}", "{edge: 1.5}"}) {
    const MethodSpec method = scene_from(scene_with(std::string("{basis: qcpdi, split: ") + on + "}")).method;
    CHECK(method.split);
    CHECK(method.split_edge == 1.5);
  }
  CHECK(scene_from(scene_with("{basis: lcpdi, split: {edge: 1.2}}")).method.split_edge == 1.2);
}

TEST_CASE("the resolved scene says whether particles are split, and is read as it was written") {
  const Scene scene = scene_from(scene_with("{basis: lcpdi, split: {edge: 1.25}}"));
  const Scene again = scene_from(scene.resolved_yaml);
  CHECK(again.method.split);
  CHECK(again.method.split_edge == 1.25);
  CHECK(again.resolved_yaml == scene.resolved_yaml);
  CHECK(scene_from(scene_with("{basis: lcpdi}")).resolved_yaml.find("split: none") != std::string::npos);
}

TEST_CASE("a scene hears why its particles cannot be split") {
  const auto says = [](const std::string& yaml, const char* text) {
    const std::string told = refusal(yaml);
    CHECK_MESSAGE(told.find(text) != std::string::npos, told);
    CHECK_MESSAGE(told.find("method.split") != std::string::npos, told);
  };
  says(scene_with("{basis: ugimp, split: true}"), "(basis: lcpdi or qcpdi)");
  says(scene_with("{basis: lcpdi, split: 1.5}"), "Write {edge: 1.5}");
  says(scene_with("{basis: lcpdi, split: {edge: 0.9}}"), "from 1 to 2 cells");
  says(scene_with("{basis: lcpdi, split: {edge: 2.5}}"), "from 1 to 2 cells");
  says(scene_with("{basis: lcpdi, split: true}", "contact: {family: penalty}\n"), "surfaces are followed");
  says(scene_with("{basis: lcpdi, split: true}", "cracks: [{body: a, line: [[0 mm, 3 mm], [3 mm, 3 mm]]}]\n"),
       "cracks");
}

}  // namespace
}  // namespace mpmfast
