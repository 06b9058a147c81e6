#include <doctest/doctest.h>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

TEST_CASE(
    "a fault says file, line, column, path, what is wrong, what was expected, what it got, and a hint") {
  CHECK(fault(replaced(plain_scene(), "210 GPa", "210 GPA")) ==
        "scene.yaml:5:63: materials.steel.young: unknown unit 'GPA' (a pressure: Pa, kPa, MPa, GPa), got "
        "'210 GPA'. "
        "Did you mean 'GPa'?");
}

TEST_CASE("a misspelt key, word or material name suggests the right one") {
  CHECK(holds(fault(replaced(plain_scene(), "poisson", "poison")), "unknown key. Did you mean 'poisson'?"));
  CHECK(fault(plain_scene() + "outptu: {frames: 3}\n") ==
        "scene.yaml:8:1: outptu: unknown key. Did you mean 'output'?");
  CHECK(fault(plain_scene() + "contact: {law: columb}\n") ==
        "scene.yaml:8:16: contact.law: not known here (one of coulomb, frictionless, stick, perfect, "
        "ignore, adhesion, velocity_friction, viscous, interface, "
        "nonlinear_interface, "
        "cohesive), got 'columb'. "
        "Did you mean 'coulomb'?");
  CHECK(fault(replaced(plain_scene(), "material: steel", "material: stele")) ==
        "scene.yaml:7:74: bodies.0.material: not known here (one of steel), got 'stele'. Did you mean "
        "'steel'?");
  CHECK(fault(plain_scene() + "boundaries: {lfet: wall}\n") ==
        "scene.yaml:8:20: boundaries.lfet: not a face of the grid, and not a map {box | node, direction, "
        "speed}, "
        "got 'wall'. "
        "Did you mean 'left'?");
  CHECK(holds(fault(plain_scene() + "method: {update: flpi}\n"), "Did you mean 'flip'?"));
}

TEST_CASE("all faults come at once, in the order of the text") {
  const std::string text =
      "title: broken\n"
      "space: plane_stres\n"
      "grid:\n"
      "  size: [10 mm, 20 GPa]\n"
      "  cell: -1 mm\n"
      "time: {end: soon, cfl: 2}\n"
      "materials:\n"
      "  steel: {model: linear_elastic, density: 0, young: 1, poisson: 0.5}\n"
      "bodies:\n"
      "  - {box: {from: [0, 0], to: [1 mm, 1 mm]}, material: steel, colour: red}\n";
  const std::vector<std::string> expected{
      "scene.yaml:2:8: space: not known here (one of plane_strain, plane_stress, axisymmetric, 3d), got "
      "'plane_stres'. Did you mean 'plane_stress'?",
      "scene.yaml:4:17: grid.size.1: 'GPa' is a pressure",
      "scene.yaml:5:9: grid.cell: must be positive",
      "scene.yaml:6:13: time.end: not a number",
      "scene.yaml:6:24: time.cfl: must be in (0, 1]",
      "scene.yaml:8:43: materials.steel.density: must be positive",
      "scene.yaml:8:65: materials.steel.poisson: must be in (-1, 0.5)",
      "scene.yaml:10:62: bodies.0.colour: unknown key"};
  const std::vector<std::string> got = faults(text);
  REQUIRE(got.size() == expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) CHECK_MESSAGE(got[k].rfind(expected[k], 0) == 0, got[k]);
}

TEST_CASE("a missing key is named where its map begins") {
  CHECK(fault(replaced(plain_scene(), ", cell: 1 mm", "")) ==
        "scene.yaml:2:7: grid.cell: missing (a length: m, cm, mm, um)");
  CHECK(holds(fault(replaced(plain_scene(), "time: {end: 1 us}\n", "")), "scene.yaml:1:1: time: missing"));
  CHECK(holds(fault(replaced(plain_scene(), ", material: steel", "")),
              "scene.yaml:7:5: bodies.0.material: missing"));
}

TEST_CASE("a missing key whose value is a word is told with all the words that it may be") {
  CHECK(fault(replaced(plain_scene(), "space: plane_strain\n", "")) ==
        "scene.yaml:1:1: space: missing (plane_strain, plane_stress, axisymmetric or 3d)");
}

TEST_CASE("the text must be one plain YAML document") {
  CHECK(fault("") == "scene.yaml: empty (a scene was expected)");
  CHECK(fault("# nothing but a comment\n") == "scene.yaml: empty (a scene was expected)");
  CHECK(holds(fault(plain_scene() + "---\ntitle: another\n"), "a second document begins here"));
  CHECK(holds(fault(plain_scene() + "title: [\n"), "not valid YAML"));
  CHECK(holds(fault("just words\n"), "not a map"));
  CHECK(holds(fault(plain_scene() + "title: !!str x\n"), "tags are not supported"));
  CHECK(fault("title: caf\xE9\n") == "scene.yaml:1:11: not UTF-8 text, got the byte 0xE9");
  CHECK(fault(std::string("title: a\nspa\0ce: 3d\n", 20)) ==
        "scene.yaml:2:4: not UTF-8 text, got the byte 0x00");
  CHECK(faults(plain_scene() + "title: \"Grüße, 目\"\n").empty());
}

TEST_CASE("a key given twice is an error that names the first") {
  CHECK(fault(plain_scene() + "time: {end: 2 us}\n") == "scene.yaml:8:1: time: already given on line 3");
  CHECK(holds(fault(replaced(plain_scene(), "poisson: 0.3", "poisson: 0.3, young: 1 GPa")),
              "materials.steel.young: already given on line 5"));
}

TEST_CASE("anchors on whole values work, merge keys are refused by name") {
  const std::string text =
      replaced(plain_scene(), "box: {from: [1 mm, 1 mm]", "velocity: &rest [0, 0], box: {from: [1 mm, 1 mm]");
  CHECK(faults(text + "gravity: *rest\n").empty());
  CHECK(
      holds(fault(plain_scene() + "output: {<<: {frames: 3}}\n"), "output.<<: merge keys are not supported"));
}

TEST_CASE("aliases that multiply or contain themselves, and deep nesting, end in a message") {
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 9; ++k) {
    const std::string last = "*a" + std::to_string(k - 1);
    bomb += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [";
    for (int i = 0; i < 9; ++i) bomb += last + ", ";
    bomb += last + "]\n";
  }
  CHECK(holds(fault(bomb), "too many values"));
  CHECK(holds(fault("a: &a [1, *a]\n"), "inside its own anchor"));
  CHECK(holds(fault("a: " + std::string(100, '[') + std::string(100, ']') + "\n"), "nested too deeply"));
  CHECK(faults("a: " + std::string(100000, '[') + "\n").size() == 1);
}

TEST_CASE("yes and on are words, true and false are truths") {
  CHECK(holds(fault(plain_scene() + "contact: {advance_separation: yes}\n"), "not true or false, got 'yes'"));
  CHECK(parse(plain_scene() + "contact: {advance_separation: true}\n").contact.advance_separation);
}

TEST_CASE("whole numbers are decimal and whole") {
  for (const char* text : {"010", "2.0", "2 mm", "0x2", "-1", "1e3", "+2", "''"}) {
    CHECK_MESSAGE(holds(fault(plain_scene() + "output: {frames: " + text + "}\n"), "not a whole number"),
                  text);
  }
}

TEST_CASE("words behind a text in quotes that ends on the next line are told where they stand") {
  CHECK(fault(plain_scene() + "title: \"one\n: two\" three\n").starts_with("scene.yaml:9:8: not valid YAML"));
}
