#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "scene_helpers.hpp"
#include "tests/source_folder.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// Every warning of a good scene, a line each.
std::string warnings(const std::string& text, const std::vector<Override>& overrides = {}) {
  std::vector<Diagnostic> found;
  parse_scene(text, "scene.yaml", overrides, &found);
  std::string out;
  for (const Diagnostic& one : found) out += one.warning() + "\n";
  return out;
}

}  // namespace

TEST_CASE("a plain scene raises no suspicion, and one that nobody asks about none either") {
  CHECK(warnings(plain_scene()).empty());
  CHECK(warnings(solid_scene()).empty());
}

TEST_CASE("a pressure on a place where its body does not lie is told: the load acts on nothing") {
  const auto at = [](const std::string& corner) {
    return warnings(plain_scene() +
                    "loads: {pressure: [{body: block, value: 1 kPa, where: {disk: {centre: [" + corner +
                    "], radius: 1 mm}}}]}\n");
  };
  const Bounds body = bounds(parse(plain_scene()).bodies[0].shape);
  const auto beside = [&](double gap) {
    return at(fmt::format("{} m, {} m", body.upper[0] + gap, body.upper[1]));
  };
  CHECK(beside(0.9e-3).empty());
  CHECK(holds(beside(1.1e-3),
              "loads.pressure.0.where: nothing of body 'block' lies here, and the load acts on "
              "nothing"));
}

TEST_CASE("a density that nothing has is told with what was likely meant") {
  CHECK(warnings(plain_scene(), {{"materials.steel.density", "7850 g/cm^3"}}) ==
        "--set materials.steel.density=7850 g/cm^3: warning: materials.steel.density: 7.85e+06 kg/m^3 is no "
        "density of a "
        "solid or a liquid. Did you mean 7850 kg/m^3, that is 7.85 g/cm^3?\n");
  CHECK(warnings(replaced(plain_scene(), "7.85 g/cm^3", "7.85 mg/m^3")) ==
        "scene.yaml:5:43: warning: materials.steel.density: 7.85e-06 kg/m^3 is no density of a solid or a "
        "liquid\n");
  CHECK(holds(warnings(replaced(plain_scene(), "7.85 g/cm^3", "30.1 g/cm^3")),
              "3.01e+04 kg/m^3 is no density"));
  CHECK(warnings(replaced(plain_scene(), "7.85 g/cm^3", "29.9 g/cm^3")).empty());
}

TEST_CASE("densities are usual from 0.1 to 30000 kg/m^3, and likely meant from 10 to 30000 kg/m^3") {
  const auto of = [](const std::string& density) {
    return warnings(replaced(plain_scene(), "7.85 g/cm^3", density));
  };
  const auto meant = [&](const std::string& density) {
    const std::string all = of(density), before = "Did you mean ";
    const std::size_t at = all.find(before);
    return at == std::string::npos ? ""
                                   : all.substr(at + before.size(), all.find(',', at) - at - before.size());
  };
  CHECK(of("30 g/cm^3").empty());
  CHECK(holds(of("30.001 g/cm^3"), "no density"));
  CHECK_FALSE(holds(of("0.1 kg/m^3"), "no density"));
  CHECK(holds(of("0.0999 kg/m^3"), "no density"));
  // A thousand times too much is told before a million times.
  CHECK(meant("30000 g/cm^3") == "3e+04 kg/m^3");
  CHECK(meant("30001 g/cm^3") == "30 kg/m^3");
  CHECK(meant("3e7 g/cm^3") == "3e+04 kg/m^3");
  CHECK(meant("3.001e7 g/cm^3") == "");
  CHECK(meant("0.01 kg/m^3") == "10 kg/m^3");
  CHECK(meant("0.00999 kg/m^3") == "9990 kg/m^3");
  CHECK(meant("1e-5 kg/m^3") == "10 kg/m^3");
  CHECK(meant("9.99e-6 kg/m^3") == "");
}

TEST_CASE("waves that run too fast or too slowly tell of a modulus in the wrong unit") {
  // c = sqrt(1.346 E / rho) at a Poisson's ratio of 0.3.
  CHECK(warnings(replaced(plain_scene(), "210 GPa", "21000 GPa")) ==
        "scene.yaml:5:10: warning: materials.steel: waves would run at 6e+04 m/s in it (usual: 1 to 20000). "
        "Is the density "
        "too small, or a modulus too large?\n");
  CHECK(holds(warnings(replaced(plain_scene(), "210 GPa", "210")), "waves would run at 0.19 m/s"));
  CHECK(holds(warnings(replaced(plain_scene(), "210 GPa", "210")),
              "Is a unit missing? young is read as 210 Pa"));
  CHECK(holds(warnings(replaced(plain_scene(), "210 GPa", "210 Pa")), "or a modulus too small?"));
}

TEST_CASE("gravity towards a free face, where nothing is rigid, is told") {
  const std::string falls = plain_scene() + "gravity: [0, -9.81 m/s^2]\n";
  CHECK(
      warnings(falls) ==
      "scene.yaml:8:10: warning: gravity: it pulls towards the bottom face (lower y), which is free, and no "
      "body is rigid. boundaries: {bottom: wall}\n");
  CHECK(holds(warnings(falls + "boundaries: {top: wall}\n"), "bottom face (lower y)"));
  CHECK(warnings(falls + "boundaries: {bottom: wall}\n").empty());
  CHECK(warnings(falls + "boundaries: {left: {wall: held}}\n").empty());
  CHECK(holds(warnings(plain_scene() + "gravity: [9.81 m/s^2, 0]\n"), "right face (upper x)"));
}

TEST_CASE(
    "a material of which nothing is made, a blow faster than sound, a sheet and lone particles are told") {
  CHECK(warnings(replaced(plain_scene(), "bodies:", "  lead: {model: rigid}\nbodies:")) ==
        "scene.yaml:6:9: warning: materials.lead: no body is made of this material\n");
  CHECK(warnings(replaced(plain_scene(), "material: steel", "material: steel, velocity: [0, 7 km/s]")) ==
        "scene.yaml:7:91: warning: bodies.0.velocity: body 'block' flies at 7000 m/s, faster than waves in "
        "it (6001 m/s)\n");
  CHECK(holds(warnings(replaced(plain_scene(), "4 mm, 3 mm", "4 mm, 2.5 mm")),
              "scene.yaml:7:5: warning: bodies.0: body 'block' is only 1.5 cells thick"));
  CHECK(warnings(replaced(plain_scene(), "4 mm, 3 mm", "4 mm, 2.5 mm") +
                 "boundaries: {bottom: {wall: sliding, position: 1 mm}}\n")
            .empty());
  CHECK(holds(warnings(plain_scene(), {{"bodies.0.particles_per_cell", "[1, 2]"}}),
              "warning: bodies.0.particles_per_cell: body 'block' has one particle along a cell's side"));
  CHECK(warnings(solid_scene(), {{"bodies.0.particles_per_cell", "2"}}).empty());
}

TEST_CASE("a bare density among values with units, and degrees without their unit, are told") {
  CHECK(
      warnings(replaced(plain_scene(), "7.85 g/cm^3", "7.85")) ==
      "scene.yaml:5:43: warning: materials.steel.density: a bare density is in kg/m^3, and 7.85 is that of a "
      "gas or a foam. Did you mean 7.85 g/cm^3?\n");
  CHECK(warnings(replaced(plain_scene(), "7.85 g/cm^3", "7.85 kg/m^3")).find("bare") == std::string::npos);
  CHECK(warnings(replaced(plain_scene(), "7.85 g/cm^3, young: 210 GPa", "7.85, young: 100e6")).empty());
  const auto falls = [](const std::string& how) {
    return warnings(plain_scene() + "gravity: [" + how + "]\nboundaries: {left: {wall: held}}\n");
  };
  CHECK(falls("${9.81*sin(30)}, 0") ==
        "scene.yaml:8:11: warning: gravity.0: a bare number is in radians in sin(30). Did you mean sin(30 "
        "deg)?\n");
  CHECK(falls("${9.81*sin(30 deg)}, ${9.81*cos(6.2)}").empty());
  const std::string soft = replaced(plain_scene(), "linear_elastic", "neo_hookean");
  CHECK(holds(warnings(replaced(soft, "material: steel", "material: steel, seeding: {angle: 45}")),
              "seeding.angle: a bare number is in radians: 7.1"));
}

TEST_CASE("a grid that bodies cannot reach is told with the size that would do") {
  // The block lies at 1 to 4 mm, 1 to 3 mm; with cells of 0.02 mm and 1 us at rest it keeps to a margin of
  // two.
  const std::string fine = replaced(plain_scene(), "cell: 1 mm", "cell: 0.02 mm");
  CHECK(warnings(fine) ==
        "scene.yaml:2:14: warning: grid.size: bodies can reach 3.2 % of its 5e+05 cells. origin: [0.00096 m, "
        "0.00096 m], size: [0.00308 m, 0.00208 m] would do, with less memory and time\n");
  CHECK(warnings(fine + "gravity: [0, -1e9]\nboundaries: {bottom: wall}\n").empty());
  CHECK(warnings(replaced(fine, "material: steel", "material: steel, velocity: [0, 4 km/s]")).empty());
  CHECK(warnings(fine + "boundaries: {left: {piston: 3 km/s}}\n").empty());
  CHECK(warnings(replaced(plain_scene(), "cell: 1 mm", "cell: 0.1 mm")).empty());
}

TEST_CASE("times, friction and frames far from the usual are told") {
  // The block is 2 mm high, waves run at 6001 m/s: 0.333 us.
  CHECK(warnings(plain_scene(), {{"time.end", "0.34 us"}}).empty());
  CHECK(warnings(plain_scene(), {{"time.end", "0.33 us"}}) ==
        "--set time.end=0.33 us: warning: time.end: 3.3e-07 s is over before a wave has crossed any body "
        "(3.33e-07 s)\n");
  CHECK(holds(warnings(plain_scene(), {{"time.end", "10 s"}}),
              "warning: time.end: about 1.2e+08 steps of 8.3e-08 s"));
  CHECK(holds(warnings(plain_scene(), {{"contact.family", "penalty"}}),
              "warning: contact.family: penalty forces throw nodes at surfaces that have hardly any mass"));
  CHECK(warnings(plain_scene(), {{"contact.friction", "2"}}).empty());
  CHECK(holds(warnings(plain_scene(), {{"contact.friction", "30"}}),
              "warning: contact.friction: 30 is a lot of friction"));
  CHECK(holds(warnings(plain_scene(), {{"output.frames", "1001"}}),
              "warning: output.frames: 1001 particle files"));
  CHECK(warnings(plain_scene(), {{"output.frames", "1000"}}).empty());
}

TEST_CASE(
    "the scenes that come with the program raise no suspicion, but for those that are meant to be hard") {
  const std::set<std::string> meant{
      "clouds.yaml",             // bodies of one and a few particles
      "grains_box.yaml",         // a striker of a hundred times the disks' density
      "grains_line.yaml",        // the same
      "ratio.yaml",              // a density of a thousand times the other
      "rest.yaml",               // a block of four particles
      "sheet.yaml",              // a sheet of one row of particles
      "sheet_over_corner.yaml",  // the same
      "twenty_fields.yaml",      // slivers that meet at a node
  };
  std::set<std::string> found;
  for (const char* folder : {"configs", "configs/hard", "configs/bench", "configs/starters"})
    for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      std::vector<Diagnostic> all;
      read_scene(entry.path(), {}, &all);
      if (!all.empty()) found.insert(entry.path().filename().string());
    }
  CHECK(found == meant);
}

TEST_CASE("a curve of springs that goes on to where surfaces let go is told at its key") {
  const auto scene = [](const std::string& normal, const std::string& shear) {
    return plain_scene() + "contact: {law: nonlinear_interface, normal_curve: " + normal +
           ", shear_curve: " + shear + "}\n";
  };
  // Cells of 1 mm; springs too soft for waves to matter.
  const std::string within = "[[0, 0], [0.9 mm, 1 Pa]]", beyond = "[[0, 0], [2 mm, 1 Pa]]";
  const std::string says =
      ": goes on to 0.002 m, and surfaces that are a cell apart (0.001 m) let go before. Larger cells, or "
      "another unit\n";
  CHECK(warnings(scene(within, within)).empty());
  CHECK(warnings(scene(beyond, within)) == "scene.yaml:8:51: warning: contact.normal_curve" + says);
  CHECK(warnings(scene(within, beyond)) == "scene.yaml:8:90: warning: contact.shear_curve" + says);
}

TEST_CASE("springs as stiff as steps can follow are not told, stiffer ones are") {
  // NN Eq. 5.36 with powers of two, exact in any order: rho c^2 = 2^30 Pa as Poisson's ratio is 0, cfl = 1/2
  // and h = 1/4 m allow 2^30 / (2 / 4 / 4) = 2^33 Pa/m.
  const auto told = [](const std::string& stiffness) {
    return warnings(
        "space: plane_strain\n"
        "grid: {size: [4, 4], cell: 0.25}\n"
        "time: {end: 1 s, cfl: 0.5}\n"
        "materials: {a: {model: linear_elastic, density: 4096, young: 1073741824, poisson: 0}}\n"
        "bodies: [{box: {from: [1, 1], to: [3, 3]}, material: a}]\n"
        "contact: {law: interface, normal_stiffness: " +
        stiffness + ", shear_stiffness: 1}\n");
  };
  CHECK(told("8589934592").empty());
  CHECK(holds(told("8589934593"), "contact.normal_stiffness: 8.59e+09 Pa/m swings faster than steps follow"));
}
