// What contact will take is foretold from a few nodes as from many, where what each takes is known; how many
// nodes may come to meet, and what the places of tiles take.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "engine/run/contact_memory.hpp"
#include "engine/run/threads.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("the memory of a few contact nodes is foretold, with clouds that have places, shapes or none") {
  const ThreadCount one(1);  // each has clouds under way, which with so few nodes are much of it
  for (const std::string contact :
       {"{normal: smoothed_max_margin}", "{normal: smoothed_max_margin, separation: position_power}",
        "{normal: average_gradient, separation: position_power}"}) {
    CAPTURE(contact);
    // Along a face of 80 cells: 166 nodes, fewer than tell what one takes.
    const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [44 mm, 24 mm], cell: 0.5 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [2 mm, 9 mm], to: [42 mm, 12 mm]}, material: m}
  - {name: b, box: {from: [2 mm, 12 mm], to: [42 mm, 15 mm]}, material: m, velocity: [0, -1 m/s]}
)",
                                   {{"contact", contact}});
    Step<2> step(scene);
    advance(step, 3);
    const auto now = static_cast<double>(step.contact_list().nodes.size());
    REQUIRE(now > 100);
    REQUIRE(now < 200);
    const double of_nodes = 4.0 * static_cast<double>(step.state().tiling.block_nodes());
    const double taken = static_cast<double>(step.contact_bytes()) - of_nodes;
    const ContactNeed need = contact_need(step, scene);
    const double ratio = (need.bytes - of_nodes) / need.nodes / (taken / now);
    CHECK(ratio > 0.8);  // measured 0.92, 0.94, 1.01
    CHECK(ratio < 1.25);
  }
}

/// Two boxes that rest, the first of 4 x 4 cells from (4, 4) on; linear functions give nodes in them all of a
/// cell's mass and those on their boundaries half of it or less.
Scene boxes(const std::string& from, const std::string& to, const std::string& material,
            const std::string& contact) {
  return scene_from(fmt::format(R"(
space: plane_strain
grid: {{size: [32 mm, 24 mm], cell: 1 mm}}
time: {{end: 1 s}}
method: {{basis: linear, update: flip}}
materials:
  soft: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
  tool: {{model: rigid}}
contact: {}
bodies:
  - {{name: a, box: {{from: [4 mm, 4 mm], to: [8 mm, 8 mm]}}, material: soft}}
  - {{name: b, box: {{from: [{}], to: [{}]}}, material: {}}}
)",
                                contact, from, to, material));
}

ContactNeed need_of(const Scene& scene) {
  Step<2> step(scene);
  advance(step, 1);
  return contact_need(step, scene);
}

TEST_CASE("contact nodes are foretold as two fifths of the pairs that surface nodes can make") {
  const std::string contact = "{normal: average_gradient}", from = "16 mm, 4 mm", to = "20 mm, 8 mm";
  // Boundaries of 16 nodes each: 16 pairs, two nodes a pair, one of them deformable.
  CHECK(need_of(boxes(from, to, "soft", contact)).nodes == doctest::Approx(0.4 * 16).epsilon(1e-12));
  CHECK(need_of(boxes(from, to, "tool", contact)).nodes == doctest::Approx(0.4 * 16).epsilon(1e-12));
  // Of a rigid one with 24: all 16 can meet it.
  CHECK(need_of(boxes(from, "24 mm, 8 mm", "tool", contact)).nodes ==
        doctest::Approx(0.4 * 16).epsilon(1e-12));
  // Of another deformable one with 24 also those that meet in pairs of its own.
  CHECK(need_of(boxes(from, "24 mm, 8 mm", "soft", contact)).nodes ==
        doctest::Approx(0.4 * 20).epsilon(1e-12));
  const ContactNeed none = need_of(boxes(from, to, "soft", "none"));
  CHECK(none.nodes == 0);
  CHECK(none.bytes == 0);
}

TEST_CASE("beside four bytes for each place of the tiles, each node that is foretold takes as much") {
  const auto of_a_node = [](const std::string& to) {
    const Scene scene = boxes("12 mm, 4 mm", to, "soft", "{normal: average_gradient}");
    Step<2> step(scene);
    advance(step, 1);
    const ContactNeed need = contact_need(step, scene);
    const double of_nodes = 4.0 * static_cast<double>(step.state().tiling.block_nodes());
    REQUIRE(need.bytes > of_nodes);
    return std::pair{(need.bytes - of_nodes) / need.nodes, of_nodes / need.nodes};
  };
  const auto [small, around_small] = of_a_node("16 mm, 8 mm");
  const auto [large, around_large] = of_a_node("28 mm, 20 mm");  // more of it is inside
  REQUIRE(around_large > 1.1 * around_small);
  CHECK(large == doctest::Approx(small).epsilon(1e-12).scale(0));
}

}  // namespace
}  // namespace mpmfast
