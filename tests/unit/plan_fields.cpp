// Velocity fields of a scene: of bodies, of what belongs together, and of the sides of cracks.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Three bars along x, one over the other, with what else is said of them and of the scene.
Plan plan_of(const std::string& of_a, const std::string& of_b, const std::string& of_c,
             const std::string& more) {
  return make_plan(scene_from(fmt::format(R"(
space: plane_strain
grid: {{size: [12 mm, 12 mm], cell: 0.5 mm}}
time: {{end: 1 ms}}
materials:
  soft: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
  tool: {{model: rigid}}
bodies:
  - {{name: a, box: {{from: [2 mm, 2 mm], to: [10 mm, 4 mm]}}, {}}}
  - {{name: b, box: {{from: [2 mm, 4 mm], to: [10 mm, 6 mm]}}, {}}}
  - {{name: c, box: {{from: [2 mm, 6 mm], to: [10 mm, 8 mm]}}, {}}}
{}
)",
                                          of_a, of_b, of_c, more)));
}
using Names = std::vector<std::string>;
const std::string kSoft = "material: soft", kTool = "material: tool";

TEST_CASE(
    "each body has a velocity field, but what belongs together shares one, and all do without contact") {
  const Plan each = plan_of(kSoft, kSoft, kTool, "contact: {friction: 0.1}");
  CHECK(each.fields == Names{"a", "b", "c"});
  CHECK(each.body_field == std::vector<int>{0, 1, 2});
  CHECK(each.field_rigid == std::vector<bool>{false, false, true});
  const Plan together =
      plan_of(kSoft + ", field: pair", kSoft, kSoft + ", field: pair", "contact: {friction: 0.1}");
  CHECK(together.fields == Names{"pair", "b"});
  CHECK(together.body_field == std::vector<int>{0, 1, 0});
  const Plan shared = plan_of(kSoft, kSoft, kSoft, "contact: none");
  CHECK(shared.fields == Names{"all"});
  CHECK(shared.body_field == std::vector<int>{0, 0, 0});
}

TEST_CASE(
    "a crack gives its body one field more, two and more cracks of a body give it three, behind all others") {
  const std::string contact = "contact: {friction: 0.1, pairs: [{between: [a, b], law: stick}]}\ncracks:\n";
  const auto crack = [](const std::string& body, const std::string& x, double low) {
    return "  - {body: " + body + ", line: [[" + x + " mm, " + std::to_string(low) + " mm], [" + x + " mm, " +
           std::to_string(low + 1) + " mm]]}\n";
  };
  const auto check_sides = [](const Plan& plan, const std::vector<int>& first, const std::vector<int>& sides,
                              const Names& fields) {
    CHECK(plan.first_side == first);
    CHECK(plan.sides == sides);
    CHECK(plan.fields == fields);
    // A side is a field of its body: it falls as that does, and meets others by the same laws.
    REQUIRE(plan.field_rigid.size() == fields.size());
    REQUIRE(plan.field_acceleration.size() == fields.size());
    REQUIRE(plan.pairs.group.size() == fields.size());
    for (std::size_t f = 3; f < fields.size(); ++f) {
      const std::size_t body = fields[f] == "a" ? 0 : 1;
      CHECK_FALSE(plan.field_rigid[f]);
      CHECK(plan.field_acceleration[f] == plan.field_acceleration[body]);
      CHECK(plan.pairs.group[f] == plan.pairs.group[body]);
    }
  };
  const auto cracked = [&](const std::string& cracks) {
    return plan_of(kSoft + ", acceleration: [1 m/s^2, 0]", kSoft + ", acceleration: [2 m/s^2, 0]", kTool,
                   contact + cracks);
  };
  check_sides(cracked(crack("a", "3", 2.5)), {3, -1, -1}, {1, 0, 0}, {"a", "b", "c", "a"});
  check_sides(cracked(crack("b", "3", 4.5)), {-1, 3, -1}, {0, 1, 0}, {"a", "b", "c", "b"});
  check_sides(cracked(crack("a", "3", 2.5) + crack("b", "4", 4.5)), {3, 4, -1}, {1, 1, 0},
              {"a", "b", "c", "a", "b"});
  check_sides(cracked(crack("a", "3", 2.5) + crack("a", "6", 2.5) + crack("b", "4", 4.5)), {3, 6, -1},
              {3, 1, 0}, {"a", "b", "c", "a", "a", "a", "b"});
  check_sides(cracked(crack("a", "3", 2.5) + crack("a", "6", 2.5) + crack("a", "8", 2.5)), {3, -1, -1},
              {3, 0, 0}, {"a", "b", "c", "a", "a", "a"});
}

}  // namespace
}  // namespace mpmfast
