/// What `mpmfast check` says of a scene: its bodies first, long lists folded, columns and passes on demand.

#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "engine/run/describe_bodies.hpp"
#include "tests/support.hpp"
#include "tests/text.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

Scene grains(int count, const std::string& thickness = "") {
  std::string text =
      "space: plane_strain\n" + thickness +
      "grid: {size: [40 mm, 10 mm], cell: 1 mm}\ntime: {end: 1 us}\n"
      "materials:\n  rubber: {model: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}\n"
      "  tool: {model: rigid}\nbodies:\n";
  for (int k = 0; k < count; ++k)
    text +=
        fmt::format("  - {{name: g{0}, box: {{from: [{1} mm, 2 mm], to: [{2} mm, 4 mm]}}, material: {3}}}\n",
                    k, 2 * k, 2 * k + 2, k == 1 ? "tool" : "rubber");
  text += "contact: {friction: 0.1, pairs: [{between: [g0, g1], law: stick}]}\noutput: {checkpoint: none}\n";
  return parse_scene(text, "grains.yaml");
}

/// Cubes of two cells that rest, side by side along x.
Scene cubes(int count, bool contact, const std::string& space = "plane_strain") {
  const bool solid = space == "3d";
  const auto point = [&](int x, int yz) {
    return fmt::format("[{} mm, {} mm{}]", x, yz, solid ? fmt::format(", {} mm", yz) : "");
  };
  std::string text = fmt::format(
      "space: {}\ngrid: {{size: [12 mm, 8 mm{}], cell: 0.5 mm}}\ntime: {{end: 1 us}}\n"
      "materials: {{rubber: {{model: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}}}}\n"
      "contact: {}\nmethod: {{update: flip, strain: first}}\noutput: {{checkpoint: none}}\nbodies:\n",
      space, solid ? ", 4 mm" : "", contact ? "{friction: 0.1, normal: average_gradient}" : "none");
  for (int k = 0; k < count; ++k)
    text += fmt::format("  - {{name: g{}, box: {{from: {}, to: {}}}, material: rubber}}\n", k,
                        point(1 + 2 * k, 1), point(2 + 2 * k, 2));
  return parse_scene(text, "cubes.yaml");
}

/// What follows a name at the beginning of a line; nothing where no line begins with it.
std::string line_of(const std::string& text, const std::string& name) {
  const std::string begin = fmt::format("\n  {:<16}", name);
  const auto at = text.find(begin);
  if (at == std::string::npos) return "";
  const auto from = at + begin.size();
  return text.substr(from, text.find('\n', from) - from);
}

}  // namespace

TEST_CASE("check begins with the bodies: material, particles, mass, extents") {
  const std::string text = describe_plan(grains(2));
  CHECK(holds(text,
              "\n  bodies          2\n    g0  rubber (neo_hookean): 16 particles, 0.004 kg/m; "
              "x 0 to 2, y 2 to 4 mm\n    g1  tool (rigid): 16 particles; x 2 to 4"));
  const std::string deep = describe_plan(grains(2, "thickness: 20 mm\n"));
  CHECK(holds(deep, "\n    g0  rubber (neo_hookean): 16 particles, 8e-05 kg; x 0"));
  CHECK(holds(text, "\n    g0 and g1: stick\n"));
  CHECK(holds(text, " a step, over "));
  CHECK_FALSE(holds(text, "deformation_gradient"));
  const std::string all = describe_plan(grains(2), true);
  CHECK(holds(all, "particle columns"));
  CHECK(holds(all, "deformation_gradient"));
  CHECK(holds(all, "particle update"));
}

TEST_CASE("of many bodies and fields check names the first, and all when it is asked") {
  const Scene scene = grains(20);
  const std::string text = describe_plan(scene), all = describe_plan(scene, true);
  CHECK(holds(text, "\n  bodies          20\n"));
  CHECK(holds(text, "    … and 12 more (all with --verbose)\n"));
  CHECK_FALSE(holds(text, "\n    g8 "));
  CHECK(holds(text, "20: g0, g1, g2, g3, g4, g5, …\n"));
  CHECK(holds(all, "\n    g19  rubber"));
  CHECK(holds(all, ", g18, g19\n"));
  CHECK(folded(std::vector<std::string>(12), false).size() == 12);
}

TEST_CASE("check states the cells along each axis that a scene has, and no more") {
  CHECK(line_of(describe_plan(cubes(1, false)), "grid") == "24 x 16 cells of 0.5 mm");
  CHECK(line_of(describe_plan(cubes(1, false, "axisymmetric")), "grid") == "24 x 16 cells of 0.5 mm");
  CHECK(line_of(describe_plan(cubes(1, false, "3d")), "grid") == "24 x 16 x 8 cells of 0.5 mm");
}

TEST_CASE("check counts the particles of a body: one is one particle, others are particles") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 10 mm], cell: 1 mm}
time: {end: 1 us}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}}
output: {checkpoint: none}
bodies:
  - {name: lone, box: {from: [2 mm, 2 mm], to: [3 mm, 3 mm]}, material: m, particles_per_cell: 1}
  - {name: two, box: {from: [5 mm, 2 mm], to: [7 mm, 3 mm]}, material: m, particles_per_cell: 1}
)");
  const std::string text = describe_plan(scene);
  CHECK(holds(text, "\n    lone  m (neo_hookean): 1 particle, 0.001 kg/m; x 2 to 3"));
  CHECK(holds(text, "\n    two   m (neo_hookean): 2 particles, 0.002 kg/m; x 5 to 7"));
}

TEST_CASE("check says how bodies meet where several may, that all share a field, or nothing of one alone") {
  CHECK(line_of(describe_plan(cubes(1, true)), "contact") == "");
  CHECK(line_of(describe_plan(cubes(2, true)), "contact") ==
        "coulomb, friction 0.1; normals by average_gradient");
  for (const int count : {1, 2})
    CHECK(line_of(describe_plan(cubes(count, false)), "contact") ==
          "none: all bodies share one velocity field");
}

TEST_CASE("check takes five steps or more, and a hundred at most, to know what one costs") {
  const std::string text = line_of(describe_plan(cubes(1, false)), "estimated time");
  const std::string before = "the median of the first ";
  REQUIRE(holds(text, before));
  const int steps = std::atoi(text.c_str() + text.find(before) + before.size());
  CHECK(steps >= 5);
  CHECK(steps <= 100);
}

TEST_CASE("check names what particles and nodes carry, each with what asks for it") {
  const std::string text = describe_plan(cubes(2, true), true);
  CHECK(holds(text, R"(
  particle columns
    position              2 x m (every scene)
    velocity              2 x m/s (every scene)
    deformation_gradient  4 x - (strain (row-major F in the plane or in space))
    kirchhoff_stress      4 x Pa (internal force, output (xx yy zz xy yz xz))
    mass                  1 x kg (every scene)
    initial_volume        1 x m^3 (internal force)
    wave_speed            1 x m/s (time step)
)"));
  CHECK(holds(text, R"(
    mass                  (every scene)
    momentum              (every scene)
    force                 (every scene)
    velocity              (every scene)
    volume_gradient       (surfaces: normals, areas, loads)
)"));
}
