#include <doctest/doctest.h>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

TEST_CASE("an override replaces a scalar, an entry of a list, or a whole value") {
  const Scene scene = parse(plain_scene(), {{"time.end", "2 us"},
                                            {"bodies.0.box.to.1", "5 mm"},
                                            {"grid.size", "[12 mm, 24 mm]"},
                                            {"bodies.0.velocity", "[3 m/s, -4]"}});
  CHECK(scene.time.end == 2e-6);
  CHECK(std::get<BoxShape>(scene.bodies[0].shape).upper == Vec3{0.004, 0.005, 0});
  CHECK(scene.grid.size == Vec3{0.012, 0.024, 0});
  CHECK(scene.bodies[0].velocity == Vec3{3, -4, 0});
}

TEST_CASE("an override may give a known key that the file leaves out, and the last one wins") {
  const Scene scene =
      parse(plain_scene(), {{"output.frames", "7"}, {"output.frames", "0"}, {"time.cfl", "0.3"}});
  CHECK(scene.output.frames == 0);
  CHECK(scene.time.cfl == 0.3);
}

TEST_CASE("an override that names nothing is an error that names the override") {
  CHECK(fault(plain_scene(), {{"time.clf", "0.3"}}) ==
        "--set time.clf=0.3: time.clf: unknown key. Did you mean 'cfl'?");
  CHECK(holds(
      fault(plain_scene(), {{"bodies.1.material", "steel"}}),
      "--set bodies.1.material=steel: bodies.1: no such entry (bodies is a list, its entries are 0 to 0)"));
  CHECK(holds(fault(plain_scene(), {{"bodies.first.material", "steel"}}), "bodies.first: no such entry"));
  CHECK(holds(fault(plain_scene(), {{"space.kind", "x"}}),
              "space.kind: no such key (space is 'plane_strain')"));
  CHECK(holds(fault(plain_scene(), {{"time..cfl", "1"}}), "not a path"));
}

TEST_CASE("a bad value is reported at the override, faults of the file at their lines") {
  const auto all =
      faults(replaced(plain_scene(), "0.3}", "0.7}"), {{"time.cfl", "3"}, {"grid.cell", "1 kg"}});
  REQUIRE(all.size() == 3);
  CHECK(all[0].rfind("scene.yaml:5:81: materials.steel.poisson: must be", 0) == 0);
  CHECK(all[1] == "--set time.cfl=3: time.cfl: must be in (0, 1] (a number), got '3'");
  CHECK(all[2].rfind("--set grid.cell=1 kg: grid.cell: 'kg' is a mass", 0) == 0);
}

TEST_CASE("an override that is no YAML, or nothing, is an error") {
  CHECK(holds(fault(plain_scene(), {{"grid.origin", "[0, "}}), "--set grid.origin=[0, : not valid YAML"));
  CHECK(holds(fault(plain_scene(), {{"time.cfl", ""}}), "no value after '='"));
}
