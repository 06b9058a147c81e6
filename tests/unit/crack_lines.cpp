// Cracks that move with their bodies, and what lies at nodes near them.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/contact/pairs/pair_memory.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("a crack flies with its body, wherever the grid begins") {
  for (const double shift : {0.0, 40.0, -40.0}) {
    CAPTURE(shift);
    const auto mm = [&](double x) { return std::to_string(x + shift) + " mm"; };
    const Scene scene = scene_from(R"(
space: plane_strain
materials: {rock: {model: neo_hookean, density: 2.6 g/cm^3, young: 5 GPa, poisson: 0.3}}
time: {end: 1 ms}
grid: {origin: [)" + mm(0) + ", " + mm(0) +
                                   R"(], size: [30 mm, 30 mm], cell: 1 mm}
bodies: [{name: block, box: {from: [)" +
                                   mm(6) + ", " + mm(7) + "], to: [" + mm(18) + ", " + mm(17) +
                                   R"(]}, material: rock, velocity: [30 m/s, 11 m/s]}]
cracks: [{body: block, law: frictionless, line: [[)" +
                                   mm(3) + ", " + mm(12) + "], [" + mm(14.2) + ", " + mm(13) + "]]}]\n");
    Step<2> step(scene);
    const std::vector<Vec<2>> start = step.cracks().lines()[0].points;
    advance(step, 10);
    const Vec<2> way = step.state().time * Vec<2>(30, 11);
    REQUIRE(way.norm() > 1e-5);
    for (std::size_t k = 0; k < start.size(); ++k)
      CHECK((step.cracks().lines()[0].points[k] - start[k] - way).norm() < 1e-9 * way.norm());
  }
}

TEST_CASE("nodes behind a third crack are counted where three meet, and nowhere else") {
  const auto third = [](const char* more) {
    const Scene scene = scene_from(std::string(R"(
space: plane_strain
grid: {size: [30 mm, 30 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {rock: {model: neo_hookean, density: 2.6 g/cm^3, young: 5 GPa, poisson: 0.3}}
bodies: [{name: block, box: {from: [6 mm, 6 mm], to: [24 mm, 24 mm]}, material: rock}]
)") + more);
    Step<2> step(scene);
    advance(step, 1);
    return step.cracks().counters().third;
  };
  const std::string two = R"(cracks:
  - {body: block, law: frictionless, line: [[3 mm, 15.1 mm], [27 mm, 15.1 mm]]}
  - {body: block, law: frictionless, line: [[15.1 mm, 3 mm], [15.1 mm, 27 mm]]}
)";
  CHECK(third("") == 0);
  CHECK(third(two.c_str()) == 0);
  CHECK(
      third((two + "  - {body: block, law: frictionless, line: [[3 mm, 3 mm], [27 mm, 27 mm]]}\n").c_str()) >
      0);
}

/// Else what one of them keeps from step to step would be the other's.
TEST_CASE("where two cracks cross, each surface at a node has a name of its own") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [30 mm, 30 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {rock: {model: neo_hookean, density: 2.6 g/cm^3, young: 5 GPa, poisson: 0.3}}
bodies: [{name: block, box: {from: [6 mm, 6 mm], to: [24 mm, 24 mm]}, material: rock}]
cracks:
  - {body: block, law: frictionless, line: [[3 mm, 15.1 mm], [27 mm, 15.1 mm]]}
  - {body: block, law: frictionless, line: [[15.1 mm, 3 mm], [15.1 mm, 27 mm]]}
)");
  Step<2> step(scene);
  advance(step, 1);
  const auto& list = step.contact_list();
  std::vector<std::uint64_t> names;
  int most = 0;
  for (const auto& node : list.nodes) {
    most = std::max(most, node.pair_end - node.pair_begin);
    for (int e = node.pair_begin; e < node.pair_end; ++e)
      names.push_back(pair_key(step.state(), list, node, list.pairs.pair[e]));
  }
  CHECK(most == 4);  // each crack, on both sides of the other
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
}

}  // namespace
}  // namespace mpmfast
