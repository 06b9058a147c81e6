/// Cracks of a scene, against each other.

#include <doctest/doctest.h>

#include <string>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// The plain scene, whose block is from (1, 1) to (4, 3) mm, with two cracks along these lines.
std::string two_cracks(const std::string& first, const std::string& second) {
  return plain_scene() + "cracks:\n  - {name: first, body: block, line: " + first +
         "}\n  - {name: second, body: block, line: " + second + "}\n";
}

}  // namespace

TEST_CASE("a crack that lies on another is refused, whichever of their segments do") {
  const std::string straight = "[[1.5 mm, 2 mm], [2.5 mm, 2 mm]]", over = "[[2 mm, 2 mm], [3 mm, 2 mm]]",
                    bent = "[[2 mm, 2 mm], [3 mm, 2 mm], [3 mm, 2.5 mm]]",
                    bent_last = "[[3 mm, 2.5 mm], [3 mm, 2 mm], [2 mm, 2 mm]]",
                    above = "[[2 mm, 2.4 mm], [3 mm, 2.4 mm]]";
  const std::string refused = "it goes on where 'first' ends, or lies on it: one line was expected";
  for (const std::string& other : {over, bent, bent_last}) {
    CAPTURE(other);
    CHECK(fault(two_cracks(straight, other)) == "scene.yaml:10:5: cracks.1: " + refused);
    CHECK(fault(two_cracks(other, straight)) == "scene.yaml:10:5: cracks.1: " + refused);
  }
  CHECK(faults(two_cracks(straight, above)).empty());
}

// A box holds its lower edges and not its upper ones.
TEST_CASE("a crack along the upper edge of a box is refused, wherever that lies") {
  for (int top = 2; top < 18; ++top) {
    CAPTURE(top);
    const std::string y = std::to_string(top) + " mm";
    std::string scene = plain_scene();
    const std::string block = "to: [4 mm, 3 mm]";
    REQUIRE(scene.find(block) != std::string::npos);
    scene.replace(scene.find(block), block.size(), "to: [4 mm, " + y + "]");
    scene += "cracks:\n  - {body: block, line: [[0, " + y + "], [8 mm, " + y + "]]}\n";
    const auto all = faults(scene);
    REQUIRE_FALSE(all.empty());
    CHECK(all.front().find("no part of it lies in 'block'") != std::string::npos);
  }
}
