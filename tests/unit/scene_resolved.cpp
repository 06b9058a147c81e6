#include <doctest/doctest.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

#include <filesystem>
#include <string>

#include "engine/geometry/shapes.hpp"
#include "scene_helpers.hpp"
#include "tests/support.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// Reading what was written changes nothing, from whatever folder it is read.
void check_fixed_point(const std::string& text, const std::filesystem::path& file = "scene.yaml") {
  const Scene first = parse_scene(text, file);
  const Scene second = parse_scene(first.resolved_yaml, "/another/folder/scene.yaml");
  CHECK(second.resolved_yaml == first.resolved_yaml);
  REQUIRE(second.bodies.size() == first.bodies.size());
  for (std::size_t b = 0; b < first.bodies.size(); ++b) {
    CHECK(second.bodies[b].name == first.bodies[b].name);
    CHECK(second.bodies[b].field == first.bodies[b].field);
    CHECK(bounds(second.bodies[b].shape).lower == bounds(first.bodies[b].shape).lower);
    CHECK(bounds(second.bodies[b].shape).upper == bounds(first.bodies[b].shape).upper);
  }
  CHECK(second.boundaries.size() == first.boundaries.size());
  CHECK(second.grid.cell == first.grid.cell);
}

/// 4 × 4 pixels: levels 10 and 20 above, 30 below, one pixel of 255 at the lower right.
void write_image(const std::filesystem::path& file, int channels = 1) {
  const unsigned char grey[16] = {10, 10, 20, 20, 10, 10, 20, 20, 30, 30, 30, 30, 30, 30, 30, 255};
  std::vector<unsigned char> bytes;
  for (const unsigned char level : grey) bytes.insert(bytes.end(), static_cast<std::size_t>(channels), level);
  stbi_write_png(file.c_str(), 4, 4, channels, bytes.data(), 4 * channels);
}

std::string bitmap_scene(const std::string& keys) {
  return replaced(plain_scene(), "name: block, box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}, material: steel",
                  "bitmap: grains.png, " + keys);
}

}  // namespace

TEST_CASE("the resolved scene is a fixed point, with every default written") {
  check_fixed_point(plain_scene());
  check_fixed_point(solid_scene());
  const std::string resolved = parse(plain_scene()).resolved_yaml;
  for (const char* part :
       {"cfl: 0.5", "max_step: none", "basis: ugimp", "law: coulomb", "frames: 20", "left: free"}) {
    CHECK_MESSAGE(holds(resolved, part), part);
  }
}

TEST_CASE("the resolved scene keeps every kind of shape, boundary, table and choice") {
  check_fixed_point(
      replaced(plain_scene(), "bodies:\n", "  tool: {model: rigid}\nbodies:\n") +
      "  - {disk: {centre: [1/3 cm, 8 mm], radius: 1/7 mm}, material: steel, field: both, velocity: [1/3 "
      "m/s, 0]}\n"
      "  - {ellipse: {centre: [5 mm, 8 mm], radii: [1 mm, 0.7 mm], angle: 33 deg}, material: steel, field: "
      "both}\n"
      "  - {ring: {centre: [5 mm, 12 mm], inner: 1 mm, outer: 2 mm}, material: steel, particles_per_cell: "
      "[1, 3]}\n"
      "  - {polygon: [[1 mm, 15 mm], [2 mm, 15 mm], [1.3 mm, 17 mm]], material: steel}\n"
      "  - {box: {from: [7 mm, 1 mm], to: [8 mm, 2 mm]}, material: tool, velocity: [[[0, 1], [1 us, 2]], "
      "0]}\n"
      "boundaries:\n"
      "  top: {piston: {times: [0, 0.3 us], values: [0, 1/3 m/s]}, held: true, position: 19.3 mm}\n"
      "  right: {wall: held}\n"
      "  null-ish: {box: {from: [0, 0], to: [1 mm, 1 mm]}, direction: [1, 2], speed: [[0, 1], [1 us, -2]]}\n"
      "title: \"quotes \\\" and \\\\ and \\t and \\x01 # : é\"\n"
      "method: {basis: bspline2, update: xpic(7), strain: average, position: trapezoid, deformation_terms: "
      "1}\n"
      "contact: {normal: specified, specified_normal: [1, 3], law: stick, hysteresis: 0.1, mass_screen: "
      "1e-4}\n"
      "gravity: [0, -9.81]\n"
      "output: {frames: 0, picture: stress_xy, overlap: true}\n"
      "thickness: 1/3 mm\n");
}

TEST_CASE("the resolved scene keeps the words of every method") {
  for (const char* method :
       {"basis: bspline3, update: apic, deformation_terms: exponential", "basis: bspline2, update: apic",
        "basis: qcpdi, update: xpic(2)", "update: fmpm(3), position: trapezoid"})
    check_fixed_point(plain_scene() + "method: {" + method + "}\n");
}

TEST_CASE("the resolved scene keeps how particles lie") {
  const std::string rubber =
      replaced(plain_scene(), "bodies:\n",
               "  rubber: {model: neo_hookean, density: 1 g/cm^3, young: 2 MPa, poisson: "
               "0.3}\nbodies:\n");
  const std::string disk = "  - {disk: {centre: [5 mm, 12 mm], radius: 1 mm}, material: rubber, seeding: ";
  check_fixed_point(rubber + disk + "rings}\n");
  check_fixed_point(rubber + disk + "conforming}\n");
  check_fixed_point(rubber + disk + "{angle: 33 deg}}\n");
  CHECK(holds(parse(rubber + disk + "conforming}\n").resolved_yaml, "seeding: conforming"));
  CHECK(holds(parse(rubber + disk + "rings}\n").resolved_yaml, "seeding: rings"));
  CHECK(holds(parse(plain_scene()).resolved_yaml, "seeding: lattice"));
}

TEST_CASE("the resolved scene keeps solid shapes") {
  check_fixed_point(
      solid_scene() +
      "  - {sphere: {centre: [5 mm, 8 mm, 2 mm], radius: 1/7 mm}, material: steel}\n"
      "  - {ellipsoid: {centre: [5 mm, 8 mm, 3 mm], radii: [1 mm, 0.7 mm, 0.3 mm], angle: 33 deg}, material: "
      "steel}\n"
      "  - {tube: {centre: [5 mm, 12 mm, 2.2 mm], inner: 0, outer: 2 mm, length: 1/3 mm}, material: steel}\n"
      "  - {polygon: {points: [[1 mm, 15 mm], [2 mm, 15 mm], [1.3 mm, 17 mm]], z: [1 mm, 1.1 mm]}, material: "
      "steel}\n"
      "contact: none\n"
      "boundaries: {front: fixed, back: symmetry}\n");
}

TEST_CASE("each grey level of a bitmap is a body, and the entry comes back as one") {
  const Folder folder;
  write_image(folder / "grains.png");
  const std::filesystem::path file = folder / "scene.yaml";
  const std::string text = bitmap_scene(
      "name: grain, origin: [0.1 mm, 0.7 mm], extent: [0.3 mm, 1/3 mm], skip: [255, 7], material: steel, "
      "materials: {20: tin}");
  const std::string two =
      replaced(text, "bodies:\n",
               "  tin: {model: neo_hookean, density: 7 g/cm^3, bulk: 1 GPa, shear: 1 GPa}\nbodies:\n");
  const Scene scene = parse_scene(two, file);
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.bodies[0].name == "grain_10");
  CHECK(scene.bodies[1].name == "grain_20");
  CHECK(scene.bodies[1].material == 1);
  CHECK(scene.bodies[2].field == "grain_30");
  CHECK(std::get<BitmapShape>(scene.bodies[0].shape).image ==
        std::get<BitmapShape>(scene.bodies[2].shape).image);
  check_fixed_point(two, file);
  check_fixed_point(replaced(two, "skip: [255, 7]", "field: all"), file);
  // One field for all, named as the first level is: no default, though that level alone would say so.
  const Scene shared = parse_scene(
      parse_scene(replaced(two, "skip: [255, 7]", "skip: [255, 7], field: grain_10"), file).resolved_yaml,
      file);
  REQUIRE(shared.bodies.size() == 3);
  CHECK(shared.bodies[2].field == "grain_10");
}

TEST_CASE("a bitmap that is none, or is coloured, or lacks what the scene says of it, is an error") {
  const Folder folder;
  const std::filesystem::path file = folder / "scene.yaml";
  const auto wrong = [&](const std::string& keys) {
    try {
      parse_scene(bitmap_scene(keys), file);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string("good");
  };
  write_image(folder / "grains.png");
  CHECK(wrong("extent: [1 mm, 1 mm], material: steel") == "good");
  CHECK(holds(wrong("material: steel"), "bodies.0.extent: missing"));
  CHECK(holds(wrong("extent: [1 mm, 1 mm]"), "no material for the grey level 10"));
  CHECK(holds(wrong("extent: [1 mm, 1 mm], material: steel, materials: {11: steel}"), "no such grey level"));
  CHECK(holds(wrong("extent: [1 mm, 1 mm], material: steel, skip: [10, 20, 30, 255]"),
              "every grey level of the image is skipped"));
  CHECK(holds(wrong("extent: [1 mm, 1 mm], material: steel, skip: [256]"), "from 0 to 255"));
  CHECK(holds(wrong("extent: [1 mm, 21 mm], material: steel"), "outside the grid, above in y"));
  write_image(folder / "grains.png", 3);
  CHECK(holds(wrong("extent: [1 mm, 1 mm], material: steel"), "8-bit RGB PNG (8-bit grey was expected)"));
  std::filesystem::resize_file(folder / "grains.png", 20);
  CHECK(holds(wrong("extent: [1 mm, 1 mm], material: steel"), "not a PNG file"));
}

TEST_CASE("the extent of a bitmap comes back where it is not the difference of its corners") {
  // Of 1.5 + ulp and -(0.5 + ulp/2), with ulp = 2^-52, the sum lies half an ulp above 1 and rounds to 1; from
  // there back the difference rounds to 1.5, which, added again, falls short of 1.
  const Folder folder;
  write_image(folder / "grains.png");
  const std::string extent = "1.5000000000000002", lower = "-0.50000000000000011";
  const std::string text =
      replaced(bitmap_scene("origin: [" + lower + ", " + lower + "], extent: [" + extent + ", " + extent +
                            "], material: steel"),
               "size: [10 mm, 20 mm], cell: 1 mm", "origin: [-1, -1], size: [2, 2], cell: 0.125");
  const Scene first = parse_scene(text, folder / "scene.yaml");
  const Scene second = parse_scene(first.resolved_yaml, folder / "scene.yaml");
  REQUIRE(second.bodies.size() == first.bodies.size());
  const auto& drawn = std::get<BitmapShape>(first.bodies[0].shape);
  const auto& again = std::get<BitmapShape>(second.bodies[0].shape);
  REQUIRE(drawn.upper[0] == 1);
  REQUIRE(drawn.lower[0] + (drawn.upper[0] - drawn.lower[0]) < 1);
  CHECK(again.lower == drawn.lower);
  CHECK(again.upper == drawn.upper);
}
