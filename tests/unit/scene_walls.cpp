#include <doctest/doctest.h>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// The plain scene (10 x 20 mm, cells of 1 mm, a block from (1, 1) to (4, 3) mm, 1 us) with boundaries.
std::string with(const std::string& boundaries) {
  return plain_scene() + "boundaries: {" + boundaries + "}\n";
}

}  // namespace

TEST_CASE("a wall with more than a cell of a body behind it is refused") {
  CHECK(fault(with("bottom: {wall: sliding, position: 2.5 mm}")) ==
        "scene.yaml:8:22: boundaries.bottom: body 'block' reaches 0.0015 m behind the bottom wall, which is "
        "at y = "
        "0.0025 m");
  CHECK(
      holds(fault(with("right: {piston: 1 m/s, position: 2 mm}")), "reaches 0.002 m behind the right wall"));
  CHECK(faults(with("bottom: {wall: sliding, position: 1.9 mm}")).empty());
  CHECK(faults(
            replaced(
                with("bottom: {wall: sliding, position: 2.5 mm}"), "bodies:",
                "  tool: {model: rigid}\nbodies:\n  - {disk: {centre: [8 mm, 1 mm], radius: 1 mm}, material: "
                "tool}"))
            .size() == 1);  // the block alone
}

TEST_CASE("a piston that goes through the wall on the other side before the end is refused") {
  CHECK(faults(with("top: {piston: 20 km/s}, bottom: wall")).size() == 1);  // 20 mm in 1 us
  CHECK(faults(with("top: {piston: 19 km/s}, bottom: wall")).empty());
  CHECK(faults(with("top: {piston: 30 km/s}")).empty());  // nothing to go through
  CHECK(faults(with("top: {piston: 30 km/s, direction: up}, bottom: wall")).empty());
  CHECK(faults(with("top: {piston: 11 km/s}, bottom: {piston: 11 km/s}")).size() == 2);
  CHECK(faults(with("top: {piston: [[0, 40 km/s], [0.5 us, 0]]}, bottom: wall")).empty());
  // There and back again: at the end it is clear, on its way it was not.
  CHECK(holds(
      fault(with("top: {piston: [[0, 90 km/s], [0.4 us, 90 km/s], [0.401 us, -90 km/s]]}, bottom: wall")),
      "the piston goes through the bottom wall: 0.02 m apart at first, it has moved 0.036 m by 4e-07 s"));
  // Also a wall that the scene leaves to the program: its written form states it.
  const std::string left = replaced(plain_scene(), "cell: 1 mm", "cell: 1 mm, leaving: wall");
  CHECK(holds(fault(left + "boundaries: {left: {piston: [[0, 0], [1 ns, 1e9 m/s]]}}\n"),
              "the piston goes through the right wall"));
}

TEST_CASE("what is no YAML is told by what was done, at the place to mend") {
  CHECK(fault(plain_scene() + "contact: {law: coulomb\noutput: {frames: 2}\n") ==
        "scene.yaml:8:10: not valid YAML: this '{' is not closed. Put a '}' where it ends");
  CHECK(fault(plain_scene() + "gravity: [0, 1}\n") ==
        "scene.yaml:8:15: not valid YAML: this '}' meets the '[' of line 8, column 10");
  CHECK(fault(plain_scene() + "gravity: [0, 1]]\n") ==
        "scene.yaml:8:16: not valid YAML: this ']' closes nothing");
  CHECK(fault(plain_scene() + "gravity:\n\tramp: 1\n") ==
        "scene.yaml:9:1: not valid YAML: a tab indents this line. Use blanks");
  CHECK(fault(plain_scene() + "title\noutput: {frames: 2}\n") ==
        "scene.yaml:8:1: not valid YAML: no ':' between a key and its value");
  CHECK(fault(plain_scene() + "title:two\noutput: {frames: 2}\n") ==
        "scene.yaml:8:6: not valid YAML: no blank after the ':' of a key");
  CHECK(fault(plain_scene() + "title: a: b\n") ==
        "scene.yaml:8:9: not valid YAML: a second ':' in the value of a key. Put a text that holds ': ' in "
        "quotes");
  CHECK(fault(plain_scene() + "gravity:\n  - ain\n    title: x\n") ==
        "scene.yaml:10:5: not valid YAML: this line is indented more than line 9, which has its value "
        "already. Keys of one "
        "map begin in one column, entries of a list with '- '");
  // Brackets in comments, quotes and expressions do not count.
  CHECK(fault(plain_scene() + "# [\nname: \"{\"\ncell: ${min(1,2)}\ngravity: [0, 1]]\n") ==
        "scene.yaml:11:16: not valid YAML: this ']' closes nothing");
}

TEST_CASE("a cell of a body may lie behind a wall, wherever both stand on the grid, and no more") {
  const auto reaches = [](const std::string& side, int wall, const std::string& from, const std::string& to) {
    return faults(replaced(with(side + ": {wall: sliding, position: " + std::to_string(wall) + " mm}"),
                           "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}",
                           "box: {from: [1 mm, " + from + "], to: [4 mm, " + to + "]}"));
  };
  for (int k = 2; k <= 18; ++k) {
    CAPTURE(k);
    const std::string below = std::to_string(k - 1), above = std::to_string(k + 1);
    CHECK(reaches("bottom", k, below + " mm", "20 mm").empty());
    CHECK(reaches("top", k, "0 mm", above + " mm").empty());
    const auto lower = reaches("bottom", k, "${" + below + " mm - 0.01 mm}", "20 mm"),
               upper = reaches("top", k, "0 mm", "${" + above + " mm + 0.01 mm}");
    REQUIRE(lower.size() == 1);
    REQUIRE(upper.size() == 1);
    CHECK(holds(lower[0], "body 'block' reaches 0.00101 m behind the bottom wall"));
    CHECK(holds(upper[0], "body 'block' reaches 0.00101 m behind the top wall"));
  }
}
