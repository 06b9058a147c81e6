/// Cracks of a scene, against each other.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
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

TEST_CASE("a crack that ends a hair outside of a body has no part in it, one that ends a hair inside has") {
  // The disk about (5, 10) mm of 2 mm; the lines point at its middle from the lower left, where the box
  // around it is empty.
  const auto taken = [](double nearest, bool towards) {
    const auto point = [](double away) {
      const std::string at = " mm - " + std::to_string(away * std::sqrt(0.5)) + " mm}";
      return "[\"${5" + at + "\", \"${10" + at + "\"]";
    };
    const std::string near = point(nearest), far = point(4);
    const std::string scene = replaced(plain_scene(), "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}",
                                       "disk: {centre: [5 mm, 10 mm], radius: 2 mm}") +
                              "cracks:\n  - {body: block, line: [" +
                              (towards ? far + ", " + near : near + ", " + far) + "]}\n";
    const auto all = faults(scene);
    CHECK((all.empty() || fault(scene) == "scene.yaml:9:5: cracks.0: no part of it lies in 'block'"));
    return all.empty();
  };
  for (const bool towards : {true, false}) {
    CAPTURE(towards);
    CHECK_FALSE(taken(2.1, towards));
    CHECK_FALSE(taken(2.0002, towards));
    CHECK(taken(1.9998, towards));
    CHECK(taken(1.9, towards));
  }
}

TEST_CASE(
    "a crack along an arc goes from its first angle to its last in equal steps of five degrees or less") {
  const auto arc = [](double from, double to) {
    const auto degrees = [](double angle) { return std::to_string(angle) + " deg"; };
    return plain_scene() +
           "cracks:\n  - {body: block, arc: {centre: [2.5 mm, 2 mm], radius: 0.5 mm, from: " + degrees(from) +
           ", to: " + degrees(to) + "}}\n";
  };
  struct Arc {
    double from, to;
    std::size_t steps;  // 0: a whole number of five degrees, which may be rounded up
  };
  for (const auto& [from, to, steps] :
       {Arc{0, 12, 3}, Arc{12, 0, 3}, Arc{30, 150, 0}, Arc{150, 30, 0}, Arc{-40, 63, 21}, Arc{-170, -171, 1},
        Arc{200, 559, 72}, Arc{359, 0, 72}}) {
    CAPTURE(from);
    CAPTURE(to);
    const auto points = parse(arc(from, to)).cracks[0].points;
    REQUIRE(points.size() >= 2);
    const auto taken = static_cast<double>(points.size() - 1);
    if (steps > 0) CHECK(points.size() == steps + 1);
    CHECK(std::abs(to - from) / taken <= 5 + 1e-9);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double angle = (from + (to - from) * static_cast<double>(k) / taken) * std::numbers::pi / 180;
      CHECK(points[k][0] == doctest::Approx(2.5e-3 + 0.5e-3 * std::cos(angle)).epsilon(1e-12).scale(0));
      CHECK(points[k][1] == doctest::Approx(2e-3 + 0.5e-3 * std::sin(angle)).epsilon(1e-12).scale(0));
    }
  }
  const std::string refused =
      "scene.yaml:9:24: cracks.0.arc: an arc of more than nothing and less than a full turn was expected";
  CHECK(fault(arc(30, 30)) == refused);
  CHECK(fault(arc(0, 360)) == refused);
  CHECK(fault(arc(360, 0)) == refused);
  CHECK(fault(arc(-10, 400)) == refused);
}
