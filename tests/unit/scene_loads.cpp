/// `loads`: read, refused and written.

#include <doctest/doctest.h>

#include "scene_helpers.hpp"

namespace mpmfast {
namespace {

using namespace test;

const PressureSpec& only_pressure(const Scene& scene) {
  REQUIRE(scene.loads.size() == 1);
  return std::get<PressureSpec>(scene.loads[0]);
}

TEST_CASE("a pressure is read with its body, its value in time, its place and its direction") {
  const PressureSpec plain =
      only_pressure(parse(plain_scene() + "loads: {pressure: [{body: block, value: 2 kPa}]}\n"));
  CHECK(plain.body == 0);
  CHECK(value_at(plain.value, 1) == 2e3);
  CHECK_FALSE(plain.where);
  CHECK_FALSE(plain.along);
  const PressureSpec whole = only_pressure(
      parse(plain_scene() +
            "loads:\n  pressure:\n    - body: block\n      value: [[0 s, 0 Pa], [2 s, -4 MPa]]\n"
            "      where: {disk: {centre: [1 mm, 2 mm], radius: 3 mm}}\n      along: [3, 4]\n"));
  CHECK(value_at(whole.value, 1) == -2e6);
  REQUIRE(whole.where);
  CHECK(contains(*whole.where, {3.9e-3, 2e-3, 0}));
  CHECK_FALSE(contains(*whole.where, {4.1e-3, 2e-3, 0}));
  REQUIRE(whole.along);
  CHECK((*whole.along)[0] == doctest::Approx(0.6));
  CHECK((*whole.along)[1] == doctest::Approx(0.8));
}

TEST_CASE("a scene with pressures comes back from its resolved text") {
  const Scene scene = parse(
      plain_scene() +
      "loads: {pressure: [{body: block, value: 2 kPa}, {body: block, value: [[0, 0], [1 s, 3 kPa]], where: "
      "{box: {from: [0, 0], to: [1 mm, 2 mm]}}, along: up}]}\n");
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  CHECK(parse(scene.resolved_yaml).loads.size() == 2);
  CHECK_FALSE(holds(parse(plain_scene()).resolved_yaml, "loads"));
  const Scene solid = parse(solid_scene() +
                            "loads: {pressure: [{body: block, value: 1, where: {tube: {centre: [0, 0, 0], "
                            "inner: 0, outer: 1 mm, length: "
                            "2 mm}}, along: z}]}\n");
  CHECK(parse(solid.resolved_yaml).resolved_yaml == solid.resolved_yaml);
}

TEST_CASE("what is wrong with a load is said at its place") {
  const auto refused = [](const char* loads) { return fault(plain_scene() + "loads: " + loads + "\n"); };
  CHECK(holds(refused("{pressure: [{value: 1 Pa}]}"), "loads.pressure.0.body: missing"));
  CHECK(holds(refused("{pressure: [{body: block}]}"), "loads.pressure.0.value: missing"));
  CHECK(holds(refused("{pressure: [{body: blok, value: 1 Pa}]}"), "Did you mean 'block'?"));
  CHECK(holds(refused("{pressure: [{body: block, value: 1 m}]}"), "loads.pressure.0.value: "));
  CHECK(
      holds(refused("{pressure: [{body: block, value: 1, where: {}}]}"), "needs a shape (one of box, disk"));
  CHECK(holds(refused("{pressure: [{body: block, value: 1, where: {sphere: {centre: [0, 0], radius: 1}}}]}"),
              "sphere"));
  CHECK(holds(refused("{pressure: [{body: block, value: 1, along: [0, 0]}]}"), "has no direction"));
  CHECK(holds(refused("{pressure: []}"), "loads.pressure: "));
  CHECK(holds(refused("{presure: [{body: block, value: 1}]}"), "Did you mean 'pressure'?"));
}

TEST_CASE("rigid bodies, cracks and extended splines have no loads on their surfaces") {
  const std::string load = "loads: {pressure: [{body: block, value: 1 kPa}]}\n";
  CHECK(holds(fault(replaced(plain_scene(),
                             "{model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: "
                             "0.3}",
                             "{model: rigid}") +
                    load),
              "loads.pressure.0.body: a rigid body"));
  CHECK(holds(fault(plain_scene() + load + "cracks: [{body: block, line: [[2 mm, 2 mm], [3 mm, 2 mm]]}]\n"),
              "loads: loads on surfaces do not know cracks"));
  CHECK(holds(fault(plain_scene() + load + "method: {basis: bspline2, extension: {}}\n"),
              "loads: loads on surfaces do not know extended splines"));
}

}  // namespace
}  // namespace mpmfast
