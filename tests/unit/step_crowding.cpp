// How many bodies lie at one place, and where that is too many.

#include "engine/step/crowding.hpp"

#include <fmt/format.h>

#include <string>

#include "engine/plan/seed.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// 36 bodies of one cell at one place, and four at another, farther along each axis.
Scene crowd() {
  std::string yaml = R"(
space: plane_strain
grid: {size: [10 mm, 8 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {law: coulomb}
bodies:
)";
  for (int k = 0; k < 40; ++k)
    yaml += fmt::format("  - {{name: b{}, box: {{from: [{} mm, 3 mm], to: [{} mm, 4 mm]}}, material: m}}\n",
                        k, k < 36 ? 2 : 6, k < 36 ? 3 : 7);
  return scene_from(yaml);
}

TEST_CASE("of bodies that lie in one cell all pairs are counted, and the fullest cell is told") {
  const Scene scene = crowd();
  State<2> state;
  seed(scene, make_plan(scene), state);
  const Crowding found = crowding(state, 40);
  CHECK(found.pairs == 36 * 35 / 2 + 4 * 3 / 2);
  CHECK(found.fields == 36);
  CHECK(found.one == 0);
  CHECK(found.other == 35);
  // The fullest cell may be the last.
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    state.particles.column(Quantity::position, 0)[p] =
        9e-3 - state.particles.column(Quantity::position, 0)[p];
  CHECK(crowding(state, 40).fields == 36);
  CHECK(crowding(state, 40).pairs == found.pairs);
  // Bodies of one field are one.
  state.body_field[1] = state.body_field[0];
  CHECK(crowding(state, 39).fields == 35);
  CHECK(crowding(state, 39).pairs == 35 * 34 / 2 + 4 * 3 / 2);
  // So few fields crowd no cell.
  CHECK(crowding(state, 33).fields == 35);
  CHECK(crowding(state, 32).fields == 0);
  CHECK(crowding(state, 32).pairs == 0);
}

TEST_CASE("bodies that lie apart crowd no cell, and a state without particles none either") {
  const Scene scene = crowd();
  State<2> state;
  seed(scene, make_plan(scene), state);
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    state.particles.column(Quantity::position, 0)[p] = 1e-3 * (0.5 + state.particles.body()[p] % 10);
    state.particles.column(Quantity::position, 1)[p] = 1e-3 * (0.5 + state.particles.body()[p] / 10);
  }
  CHECK(crowding(state, 40).pairs == 0);
  CHECK(crowding(state, 40).fields == 1);
  State<2> empty;
  CHECK(crowding(empty, 40).pairs == 0);
  CHECK(crowding(empty, 40).fields == 0);
}

TEST_CASE("pairs of crowded bodies that would not fit into memory are refused, where contact lists them") {
  Scene scene = crowd();
  State<2> state;
  seed(scene, make_plan(scene), state);
  CHECK_NOTHROW(check_crowding(scene, state, 40, {std::uint64_t{1} << 30, ""}));
  CHECK_NOTHROW(check_crowding(scene, state, 40, {}));  // no limit is known
  try {
    check_crowding(scene, state, 40, {1000, "of the machine"});
    FAIL("it was taken");
  } catch (const SceneError& error) {
    const std::string what = error.what();
    CHECK(what.find("36") != std::string::npos);
    CHECK(what.find("b0") != std::string::npos);
    CHECK(what.find("b35") != std::string::npos);
  }
  scene.contact.fields = ManyFields::lump;
  CHECK_NOTHROW(check_crowding(scene, state, 40, {1000, ""}));
  scene.contact.fields = ManyFields::pairs;
  scene.contact.active = false;
  CHECK_NOTHROW(check_crowding(scene, state, 40, {1000, ""}));
}

}  // namespace
}  // namespace mpmfast
