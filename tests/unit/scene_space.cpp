// What plane stress and axisymmetry refuse, and what they fill in.

#include <doctest/doctest.h>

#include "scene_helpers.hpp"

namespace mpmfast {
namespace {

using namespace test;

std::string turned() { return replaced(plain_scene(), "plane_strain", "axisymmetric"); }
std::string in_plane_stress() { return replaced(plain_scene(), "plane_strain", "plane_stress"); }

TEST_CASE("plane stress takes the elastic laws and refuses the others where they stand") {
  CHECK(parse(in_plane_stress()).space == Space::plane_stress);
  CHECK(parse(in_plane_stress() + "thickness: 2 mm\n").thickness == 0.002);
  for (const char* law : {"neo_hookean", "logarithmic_neo_hookean"})
    CHECK(faults(replaced(in_plane_stress(), "linear_elastic", law)).empty());
  CHECK(fault(replaced(replaced(in_plane_stress(), "linear_elastic", "j2_plasticity"), "poisson: 0.3",
                       "poisson: 0.3, yield: 1 GPa")) ==
        "scene.yaml:5:18: materials.steel.model: plane_stress takes elastic laws (neo_hookean, "
        "linear_elastic, logarithmic_neo_hookean), got 'j2_plasticity'");
}

TEST_CASE("axisymmetric scenes lie right of the axis and fall along it") {
  CHECK(faults(turned()).empty());
  CHECK(faults(replaced(turned(), "{size", "{origin: [3 mm, -5 mm], size")).size() ==
        1);  // the block's place
  CHECK(holds(fault(replaced(turned(), "{size", "{origin: [-1 mm, 0], size")),
              "scene.yaml:2:17: grid.origin.0: x is the radius in an axisymmetric scene: it must be zero or "
              "more, got '-1 mm'"));
  CHECK(holds(fault(turned() + "thickness: 1 mm\n"), "thickness: an axisymmetric scene has no thickness"));
  CHECK(holds(fault(turned() + "gravity: [9 m/s^2, 0]\n"),
              "scene.yaml:8:11: gravity.0: an axisymmetric scene falls along its axis, y, only"));
  CHECK(holds(fault(turned() + "gravity: {acceleration: [9 m/s^2, 0], ramp: 1 s}\n"),
              "gravity.acceleration.0: an axisymmetric scene falls"));
  CHECK(faults(turned() + "gravity: [0, -9.81 m/s^2]\n").empty());
  // A ball on the axis is the right half of a disk.
  const std::string box = "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}";
  CHECK(faults(replaced(turned(), box, "disk: {centre: [0, 5 mm], radius: 2 mm}")).empty());
  CHECK(holds(fault(replaced(turned(), box, "box: {from: [-1 mm, 1 mm], to: [4 mm, 3 mm]}")), "below in x"));
  CHECK(holds(fault(replaced(plain_scene(), box, "disk: {centre: [0, 5 mm], radius: 2 mm}")), "below in x"));
}

TEST_CASE("axisymmetric scenes have no contact areas and no turning bodies") {
  const std::string bond = "contact: {law: adhesion, normal_strength: 1 MPa, shear_strength: 1 MPa}\n";
  CHECK(faults(plain_scene() + bond).empty());
  CHECK(holds(fault(turned() + bond), "scene.yaml:8:16: contact.law: needs contact areas, which an"));
  CHECK(
      holds(fault(turned() + "contact: {pairs: [{materials: [steel, steel], law: viscous, viscosity: 1 Pa s, "
                             "film: 1 mm}]}\n"),
            "contact.pairs.0.law: needs contact areas"));
  const std::string tool = replaced(turned(),
                                    "{model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, "
                                    "poisson: 0.3}",
                                    "{model: rigid}");
  const std::string spinning =
      replaced(tool, "material: steel", "material: steel, rotation: {about: [2 mm, 2 mm], speed: 3 rad/s}") +
      "  - {box: {from: [5 mm, 1 mm], to: [6 mm, 3 mm]}, material: soft}\n";
  CHECK(holds(fault(replaced(spinning, "materials:\n",
                             "materials:\n  soft: {model: neo_hookean, density: 1, bulk: 1, shear: 1}\n")),
              "bodies.0.rotation: an axisymmetric body cannot turn"));
}

TEST_CASE("the axis is a wall: by default, and nothing else") {
  const auto left = [](const std::string& more) { return parse(turned() + more).boundaries; };
  for (const char* same : {"", "boundaries: {left: wall}\n", "boundaries: {left: symmetry}\n"}) {
    const std::vector<BoundarySpec> boundaries = left(same);
    REQUIRE(boundaries.size() == 1);
    const auto& wall = std::get<WallSpec>(boundaries[0].condition);
    CHECK(boundaries[0].name == "left");
    CHECK(wall.axis == 0);
    CHECK_FALSE(wall.upper);
    CHECK(wall.position == 0);
    CHECK_FALSE(wall.fixed);
  }
  CHECK(faults(turned() + "boundaries: {left: {piston: 1 m/s, position: 1 mm}}\n").empty());
  for (const char* wrong : {"free", "fixed", "{piston: 1 m/s}"})
    CHECK_MESSAGE(holds(fault(turned() + "boundaries: {left: " + wrong + "}\n"),
                        "boundaries.left: the left face is the axis here"),
                  wrong);
  // Away from the axis there is no wall unless the scene has one.
  CHECK(parse(replaced(turned(), "{size", "{origin: [1 mm, 0], size")).boundaries.empty());
}

TEST_CASE("what is resolved of both modes reads as the same scene again") {
  for (const std::string& text : {turned(), in_plane_stress(), turned() + "boundaries: {top: wall}\n"}) {
    const Scene scene = parse(text), again = parse(scene.resolved_yaml);
    CHECK(again.resolved_yaml == scene.resolved_yaml);
    CHECK(again.space == scene.space);
    CHECK(again.boundaries.size() == scene.boundaries.size());
  }
}

}  // namespace
}  // namespace mpmfast
