/// What `mpmfast check` says of a scene: its bodies first, long lists folded, columns and passes on demand.

#include <fmt/format.h>

#include "engine/run/describe_bodies.hpp"
#include "tests/support.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

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
