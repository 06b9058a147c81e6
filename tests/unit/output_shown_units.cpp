// Which units people are shown.

#include <doctest/doctest.h>

#include "engine/output/shown_units.hpp"

namespace mpmfast {
namespace {

Scene in_space(Space space, double thickness = 1) {
  Scene scene;
  scene.space = space;
  scene.thickness = thickness;
  return scene;
}

TEST_CASE("masses, forces and energies of a plane are those of a metre unless it states another thickness") {
  for (const Space space : {Space::plane_strain, Space::plane_stress}) {
    CHECK(shown_unit(in_space(space), "J") == "J/m");
    CHECK(shown_unit(in_space(space, 0.02), "J") == "J");
  }
  CHECK(shown_unit(in_space(Space::axisymmetric), "J") == "J");
  CHECK(shown_unit(in_space(Space::three_dimensional), "J") == "J");
}

TEST_CASE("units that grow with the thickness have a metre below them, others stay") {
  CHECK(unit_per_metre("N") == "N/m");
  CHECK(unit_per_metre("kg") == "kg/m");
  CHECK(unit_per_metre("N m") == "N m/m");
  CHECK(unit_per_metre("kg m/s") == "kg m/s per m");
  for (const char* unit : {"", "s", "m", "m²", "m/s", "Pa", "J/m^3"}) CHECK(unit_per_metre(unit) == unit);
}

TEST_CASE("runs of a metre beside runs of a body have no common unit of what grows with the thickness") {
  CHECK(shown_unit(std::vector{true, true}, "J") == "J/m");
  CHECK(shown_unit(std::vector{false, false}, "J") == "J");
  for (const std::vector<bool>& mixed : {std::vector{true, false}, std::vector{false, true}}) {
    CHECK(shown_unit(mixed, "J").empty());
    CHECK(shown_unit(mixed, "Pa") == "Pa");
  }
}

}  // namespace
}  // namespace mpmfast
