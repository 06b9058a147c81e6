/// Laws, pairs and rotations as a scene writes them.

#include <doctest/doctest.h>

#include <map>
#include <string>

#include "engine/plan/contact_law.hpp"
#include "engine/scene/catalogue.hpp"
#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// Two materials, a rigid tool, three bodies of which two share a velocity field.
std::string three_bodies(const std::string& more, const std::string& tool = "") {
  return "space: plane_strain\ngrid: {size: [30 mm, 20 mm], cell: 1 mm}\ntime: {end: 1 ms}\nmaterials:\n"
         "  steel: {model: linear_elastic, density: 7800 kg/m^3, young: 210 GPa, poisson: 0.3}\n"
         "  wood: {model: linear_elastic, density: 600 kg/m^3, young: 10 GPa, poisson: 0.3}\n"
         "  rigid: {model: rigid}\nbodies:\n"
         "  - {name: a, box: {from: [1 mm, 1 mm], to: [4 mm, 4 mm]}, material: steel}\n"
         "  - {name: b, box: {from: [6 mm, 1 mm], to: [9 mm, 4 mm]}, material: wood, field: pair}\n"
         "  - {name: c, box: {from: [11 mm, 1 mm], to: [14 mm, 4 mm]}, material: wood, field: pair}\n"
         "  - {name: tool, box: {from: [1 mm, 10 mm], to: [9 mm, 12 mm]}, material: rigid" +
         tool + "}\n" + more;
}

}  // namespace

TEST_CASE("a pair of bodies or materials has its law, and what it leaves out from the default") {
  const Scene scene = parse(three_bodies(
      "contact:\n  law: adhesion\n  friction: 0.3\n  normal_strength: 2 MPa\n  shear_strength: 3 MPa\n"
      "  corrections: 1\n  fields: pairs\n  area: nodal_volume\n"
      "  pairs:\n    - {between: [tool, pair], friction: 0.1}\n    - {materials: [wood, steel], law: "
      "viscous, "
      "viscosity: 1.5 Pa*s, film: 0.1 mm}\n    - {between: [a, tool], law: velocity_friction, "
      "static_friction: 0.5, decay_speed: 2 m/s}\n"));
  const auto& pairs = scene.contact.pairs;
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0].between == std::array<int, 2>{3, 1});
  const auto& bond = std::get<Adhesion>(pairs[0].law.acts);
  CHECK(bond.friction == 0.1);
  CHECK(bond.normal_strength == 2e6);
  CHECK(pairs[1].materials);
  CHECK(std::get<Viscous>(pairs[1].law.acts).film == 1e-4);
  CHECK(std::get<VelocityFriction>(pairs[2].law.acts).friction == 0.3);
  CHECK(std::get<VelocityFriction>(pairs[2].law.acts).decay_speed == 2);
  CHECK(scene.contact.corrections == 1);
  CHECK(scene.contact.fields == ManyFields::pairs);
  CHECK(scene.contact.area == AreaKind::nodal_volume);
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
}

TEST_CASE("a cohesive law has its keys, and its initial stiffness from the cells where there is none") {
  const Scene scene =
      parse(three_bodies("contact: {law: cohesive, shape: trapezoidal, plateau: 0.25, normal_strength: 2 "
                         "MPa, shear_strength: 3 MPa, "
                         "normal_toughness: 0.2 N/mm, shear_toughness: 300 J/m^2, mode_exponent: 1.5, "
                         "compression: contact, friction: 0.2, "
                         "crack: {from: [0 mm, 0 mm], to: [3 mm, 4 mm]}}\n"));
  const auto& law = std::get<Cohesive>(scene.contact.law.acts);
  CHECK(law.shape == Softening::trapezoidal);
  CHECK(law.plateau == 0.25);
  CHECK(law.normal_toughness == doctest::Approx(200));
  CHECK(law.mode_exponent == 1.5);
  CHECK(law.compression == CompressionModel::contact);
  CHECK(scene.contact.law.friction == 0.2);
  CHECK(scene.contact.crack_upper[0] == doctest::Approx(3e-3));
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  const AnyLaw on_grid = law_on(scene.contact.law, scene);
  CHECK(std::get<Cohesive>(on_grid).initial_stiffness ==
        doctest::Approx(constants::plan::kBondStiffness * stiffest_modulus(scene) / scene.grid.cell));
  CHECK(std::get<Cohesive>(on_grid).compression_stiffness == 0);
}

TEST_CASE("curves of tractions are read, written and handed down to pairs") {
  const Scene scene = parse(
      three_bodies("contact: {law: nonlinear_interface, normal_curve: [[0, 0], [1 mm, 2 MPa], [3 mm, 0]], "
                   "shear_curve: [[0, 0], [2 um, 1 kPa]], pairs: [{between: [a, b], normal_curve: "
                   "[[-1 mm, -5 MPa], [0, 0]]}]}\n"));
  const auto& all = std::get<NonlinearInterface>(scene.contact.law.acts);
  CHECK(all.normal_curve.jump == std::vector<double>{0, 1e-3, 3e-3});
  CHECK(all.normal_curve.traction == std::vector<double>{0, 2e6, 0});
  const auto& pair = std::get<NonlinearInterface>(scene.contact.pairs[0].law.acts);
  CHECK(pair.normal_curve.traction == std::vector<double>{-5e6, 0});
  CHECK(pair.shear_curve.jump == std::vector<double>{0, 2e-6});
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  // What holds surfaces apart that press: by the first slope, by a stiffness of its own, or contact.
  CHECK(all.curve_with_overlap(0.5e-3).at(-1e-4) == doctest::Approx(-0.2e6));
  auto other = all;
  other.compression_stiffness = 7e9;
  CHECK(other.curve_with_overlap(0.5e-3).at(-1e-4) == doctest::Approx(-0.7e6));
  other.compression = CompressionModel::contact;
  CHECK(other.curve_with_overlap(0.5e-3).at(-1e-4) == 0);
  CHECK(pair.curve_with_overlap(0.5e-3).at(-2e-3) == doctest::Approx(-10e6));
}

TEST_CASE("faults of laws and pairs are found where they stand") {
  const auto contact = [](const std::string& text) { return fault(three_bodies("contact: " + text + "\n")); };
  CHECK(holds(contact("{law: stick, viscosity: 1 Pa*s}"),
              "contact.viscosity: the law 'stick' has no viscosity"));
  CHECK(holds(contact("{law: viscous, film: 1 mm}"), "contact.viscosity: missing (a viscosity: Pa*s)"));
  CHECK(holds(contact("{law: viscous, film: 1 mm, viscosity: 1 Pa}"), "'Pa' is a pressure"));
  CHECK(holds(contact("{friction: 0.4, static_friction: 0.3}"), "static friction 0.3 is less than"));
  CHECK(holds(contact("{law: adhesion, normal_strength: 0 Pa, shear_strength: 1 Pa}"), "must be positive"));
  CHECK(holds(contact("{law: interface, normal_stiffness: 1 MPa/mm}"),
              "contact.shear_stiffness: missing (a stiffness of an interface: Pa/m, MPa/mm, GPa/m)"));
  CHECK(
      holds(contact("{law: interface, normal_stiffness: 1 MPa, shear_stiffness: 0}"), "'MPa' is a pressure"));
  CHECK(holds(contact("{law: interface, normal_stiffness: 1, shear_stiffness: 1, fields: lump}"),
              "interfaces join bodies in pairs"));
  CHECK(holds(contact("{family: penalty, law: interface, normal_stiffness: 1, shear_stiffness: 1}"),
              "penalty contact only pushes"));
  const std::string glue =
      "{law: cohesive, normal_strength: 2 MPa, shear_strength: 1 MPa, shear_toughness: 9 N/m";
  CHECK(holds(contact(glue + "}"),
              "contact.normal_toughness: missing (an energy of a surface: J/m^2, N/m, N/mm)"));
  CHECK(holds(contact(glue + ", normal_toughness: 3 Pa}"), "'Pa' is a pressure"));
  CHECK(holds(
      contact(glue + ", normal_toughness: 8 N/m, initial_stiffness: 249 MPa/mm}"),
      "too soft: with these strengths it has more energy than breaks it; at least 2.5e+11 Pa/m was expected, "
      "got '249 MPa/mm'"));
  CHECK(holds(contact(glue + ", normal_toughness: 8 N/m, shape: round}"),
              "not known here (one of triangular, exponential, trapezoidal), got 'round'"));
  CHECK(holds(contact(glue + ", normal_toughness: 8 N/m, mode_exponent: 0.5}"), "must be 1 or more"));
  CHECK(holds(contact(glue + ", normal_toughness: 8 N/m, plateau: 1}"), "must be in [0, 1)"));
  CHECK(holds(contact(glue + ", normal_toughness: 8 N/m, compression: glue}"),
              "not known here (one of spring, contact), got 'glue'"));
  CHECK(holds(contact("{law: nonlinear_interface, shear_curve: [[0, 0]]}"),
              "contact.normal_curve: missing (a list of points [length, pressure])"));
  const auto curve = [&](const std::string& points, const std::string& more = "") {
    return contact("{law: nonlinear_interface, shear_curve: [[0, 0]], normal_curve: " + points + more + "}");
  };
  CHECK(holds(curve("3 MPa"), "not a curve (one or more pairs [length, pressure]), got '3 MPa'"));
  CHECK(holds(curve("[]"), "not a curve"));
  CHECK(holds(curve("[[0, 0], [1 mm, 2 MPa, 3]]"), "contact.normal_curve.1: not a pair [length, pressure]"));
  CHECK(holds(curve("[[0, 0], [1 mm, 2 mm]]"), "'mm' is a length"));
  CHECK(holds(curve("[[0, 0], [1 mm, 2 MPa], [1 mm, 3 MPa]]"),
              "lengths must increase, but 0.001 m follows 0.001 m"));
  CHECK(holds(curve("[[0, 1 MPa], [1 mm, 2 MPa]]"), "a point [0, 0] was expected"));
  CHECK(holds(curve("[[1 mm, 2 MPa]]"), "a point [0, 0] was expected"));
  CHECK(holds(curve("[[-1 mm, 2 MPa], [0, 0]]"), "contact.normal_curve.0: a traction against the jump"));
  CHECK(holds(curve("[[-1 mm, -2 MPa], [0, 0]]", ", compression: contact"),
              "contact.compression: normal_curve says already what overlap does"));
  CHECK(holds(
      contact("{law: nonlinear_interface, normal_curve: [[0, 0]], shear_curve: [[-1 mm, -1 Pa], [0, 0]]}"),
      "contact.shear_curve: the first point must be [0, 0]"));
  CHECK(holds(contact("{corrections: 3}"), "not a whole number from 1 to 2"));
  CHECK(holds(contact("{fields: pairs, normal: average_gradient}"), "explicit pairs are found from"));
  const auto pair = [&](const std::string& text) { return contact("{pairs: [" + text + "]}"); };
  CHECK(holds(pair("{between: [a, x]}"),
              "contact.pairs.0.between.1: not known here (one of a, b, c, tool, pair)"));
  CHECK(holds(pair("{between: [b, c]}"), "the velocity field 'pair' does not meet itself"));
  CHECK(holds(pair("{between: [a]}"), "not a list of two bodies"));
  CHECK(holds(pair("{law: stick}"), "either between two bodies or of two materials"));
  CHECK(holds(pair("{between: [a, b]}, {between: [c, a]}"),
              "contact.pairs.1.between: this pair has a law already"));
  CHECK(holds(pair("{materials: [wood, oak]}"), "one of steel, wood, rigid"));
  CHECK(holds(pair("{between: [a, b], normal: own}"), "unknown key"));
  CHECK(holds(contact("{pairs: {between: [a, b]}}"), "not a list of maps"));
}

TEST_CASE("a rotation is about a point; only that of a rigid body may change in time") {
  const std::string turning =
      ", velocity: [1 m/s, 0], rotation: {about: [5 mm, 11 mm], speed: [[0 s, 0 "
      "rad/s], [1 ms, 180 deg/s]]}";
  const Scene scene = parse(three_bodies("", turning));
  REQUIRE(scene.bodies[3].rotation);
  CHECK(scene.bodies[3].rotation->about[1] == 0.011);
  CHECK(scene.bodies[3].rotation->speed.value[1] == doctest::Approx(3.14159265358979));
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  CHECK(holds(
      fault(replaced(three_bodies(""), "material: steel}",
                     "material: steel, rotation: {about: [0, 0], speed: [[0 s, 0 rad/s], [1 s, 1 rad/s]]}}")),
      "bodies.0.rotation: a table of rotations is for rigid bodies only"));
  CHECK(holds(fault(three_bodies("", ", rotation: {speed: 1 rad/s}")), "bodies.3.rotation.about: missing"));
  CHECK(holds(fault(three_bodies("", ", rotation: 1 rad/s")),
              "bodies.3.rotation: not a map {about, speed}, got '1 rad/s'"));
  CHECK(holds(fault(replaced(solid_scene(), "material: steel", "material: steel, rotation: 1 rad/s")),
              "bodies.0.rotation: not a map {about, axis, speed}, got '1 rad/s'"));
  CHECK(holds(fault(three_bodies("", ", rotation: {about: [0, 0], speed: 1 m/s}")), "'m/s' is a velocity"));
}

TEST_CASE("a condition on a node stands at the nearest node of the grid") {
  const Scene scene =
      parse(three_bodies("boundaries: {pin: {node: [2.4 mm, 3.6 mm], direction: x, speed: 1 m/s}}\n"));
  const auto& box = std::get<VelocityBoxSpec>(scene.boundaries[0].condition);
  CHECK(box.lower[0] == doctest::Approx(2e-3));
  CHECK(box.upper[1] == doctest::Approx(4e-3));
  CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  CHECK(holds(fault(three_bodies("boundaries: {pin: {node: [2 mm, 33 mm], direction: x, speed: 1 m/s}}\n")),
              "no node of the grid lies there in y"));
}

TEST_CASE("every law and choice of contact is listed with its keys") {
  const auto laws = catalogue("laws");
  REQUIRE(laws.size() == 11);
  CHECK(laws[0].keys == "friction = 0, static_friction = 0");
  CHECK(laws[7].keys == "viscosity, film");
  CHECK(catalogue("areas").size() == 2);
  CHECK(catalogue("fields").size() == 3);
}

TEST_CASE("a key of the output is listed with its default, a map with those of its keys") {
  std::map<std::string, std::string> keys;
  for (const CatalogueEntry& entry : catalogue("output")) keys[entry.name] = entry.keys;
  CHECK(keys.at("frames") == "= 20");
  CHECK(keys.at("history") == "= 200");
  CHECK(keys.at("grid") == "= false");
  CHECK(keys.at("overlap") == "= false");
  CHECK(keys.at("picture") == "= pressure");
  CHECK(keys.at("checkpoint") == "{every = 600 s, steps = none}");
}
