// Bodies from STL files: which points are inside, what is refused, and how fast.

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <numbers>

#include "engine/geometry/load.hpp"
#include "engine/geometry/surface.hpp"
#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

namespace fs = std::filesystem;
using Triangles = std::vector<std::array<Vec3, 3>>;

std::string text_stl(const Triangles& triangles) {
  std::string out = "solid test\n";
  for (const auto& corners : triangles) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& p : corners)
      out +=
          "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid test\n";
}

std::string binary_stl(const Triangles& triangles) {
  std::string out = "solid, says the head of many binary files";
  out.resize(80);
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
  };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& corners : triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const Vec3& p : corners)
      for (const double x : p) put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  return out;
}

std::shared_ptr<const Surface> decode(const std::string& content, std::string* why = nullptr) {
  std::string why_not;
  const auto surface =
      decode_stl({reinterpret_cast<const unsigned char*>(content.data()), content.size()}, why_not);
  if (why) *why = why_not;
  return surface;
}

std::string fault_of(const std::string& content) {
  std::string why;
  CHECK_FALSE(decode(content, &why));
  return why;
}

/// The box between two corners, two triangles a face; inside out when `turned`.
Triangles box(const Vec3& a, const Vec3& b, bool turned = false) {
  const auto corner = [&](int k) {
    return Vec3{k & 1 ? b[0] : a[0], k & 2 ? b[1] : a[1], k & 4 ? b[2] : a[2]};
  };
  const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  Triangles out;
  for (const auto& f : faces) {
    out.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    out.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  if (turned)
    for (auto& t : out) std::swap(t[1], t[2]);
  return out;
}

Triangles operator+(Triangles a, const Triangles& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The unit sphere cut into rings of quadrilaterals.
Triangles sphere(int rings) {
  const int around = 2 * rings;
  const auto at = [&](int i, int j) {
    if (i == 0 || i == rings) return Vec3{0, 0, i == 0 ? 1.0 : -1.0};
    const double polar = std::numbers::pi * i / rings, angle = 2 * std::numbers::pi * (j % around) / around;
    return Vec3{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)};
  };
  Triangles out;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      if (i > 0) out.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) out.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return out;
}

BodySpec body_of(std::shared_ptr<const Surface> surface, int per_cell = 2) {
  BodySpec body;
  body.shape = StlShape{"", 1, {0, 0, 1}, 0, {0, 0, 0}, std::move(surface)};
  body.particles_per_cell = {per_cell, per_cell, per_cell};
  return body;
}

GridSpec cube(double lower, double size, double cell) {
  return {{lower, lower, lower}, {size, size, size}, cell};
}

std::size_t count(const Triangles& triangles, const GridSpec& grid) {
  const auto surface = decode(binary_stl(triangles));
  REQUIRE(surface);
  return fill(body_of(surface), grid, 3).position.size();
}

}  // namespace

TEST_CASE("a box of triangles holds exactly the points of the box, also on its faces, edges and corners") {
  const BoxShape shape{{-0.5, 0, 0.25}, {0.5, 1, 1.5}};
  for (const bool turned : {false, true}) {
    for (const std::string& content : {text_stl(box(shape.lower, shape.upper, turned)),
                                       binary_stl(box(shape.lower, shape.upper, turned))}) {
      const auto surface = decode(content);
      REQUIRE(surface);
      CHECK(surface->points().size() == 8);
      CHECK(enclosed_volume(surface->points(), surface->triangles()) ==
            doctest::Approx(turned ? -1.25 : 1.25));
      const Shape stl = body_of(surface).shape;
      for (int i = -4; i <= 8; ++i) {
        for (int j = -4; j <= 8; ++j) {
          for (int k = -4; k <= 8; ++k) {
            const Vec3 point{0.25 * i, 0.25 * j, 0.25 * k};
            CAPTURE(i);
            CAPTURE(j);
            CAPTURE(k);
            CHECK(contains(stl, point) == contains(shape, point));
          }
        }
      }
    }
  }
}

TEST_CASE("boxes that share a face share no particle, and a row of the lattice is filled as its points are") {
  const GridSpec grid = cube(0, 4, 1);
  const auto left = decode(binary_stl(box({0, 0, 0}, {1.25, 4, 4}))),
             right = decode(binary_stl(box({1.25, 0, 0}, {4, 4, 4})));
  const std::size_t all = 8 * 8 * 8;
  CHECK(fill(body_of(left), grid, 3).position.size() + fill(body_of(right), grid, 3).position.size() == all);
  const auto ball = decode(binary_stl(sphere(12)));
  const GridSpec around = cube(-1, 2, 0.125);
  std::size_t inside = 0;
  for (int k = 0; k < 32 * 32 * 32; ++k)
    inside += contains(body_of(ball).shape,
                       {-1 + (k % 32 + 0.5) / 16, -1 + (k / 32 % 32 + 0.5) / 16, -1 + (k / 1024 + 0.5) / 16});
  CHECK(fill(body_of(ball), around, 3).position.size() == inside);
}

TEST_CASE("shells may lie in each other: a hollow is empty, what overlaps counts once") {
  const GridSpec grid = cube(0, 4, 0.5);  // 16³ points
  const Triangles outer = box({0, 0, 0}, {4, 4, 4}), inner = box({1, 1, 1}, {3, 3, 3}, true);
  CHECK(count(outer + inner, grid) == 16 * 16 * 16 - 8 * 8 * 8);
  CHECK(count(box({0, 0, 0}, {3, 4, 4}) + box({1, 0, 0}, {4, 4, 4}), grid) == 16 * 16 * 16);
  CHECK(count(box({0, 0, 0}, {1, 4, 4}) + box({2, 0, 0}, {4, 4, 4}), grid) == 12 * 16 * 16);
}

TEST_CASE("a turned surface keeps its volume, to the layer of particles at its skin") {
  const auto cube_surface = decode(binary_stl(box({-1, -1, -1}, {1, 1, 1})));
  const GridSpec grid = cube(-2, 4, 1.0 / 16);
  const double cell = std::pow(1.0 / 32, 3);
  for (const double angle : {0.0, 0.1, 0.7, 2.0}) {
    for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0.48, 0.64}}) {
      CAPTURE(angle);
      CAPTURE(axis[0]);
      const auto surface =
          std::make_shared<Surface>(cube_surface->placed(1, axis, angle, {0.013, -0.007, 0.021}));
      CHECK(enclosed_volume(surface->points(), surface->triangles()) == doctest::Approx(8).epsilon(1e-14));
      // 262144 particles, of which 24600 lie at the skin: their errors of half a particle are as good as
      // random unless a face lies along the lattice.
      const double volume = cell * static_cast<double>(fill(body_of(surface), grid, 3).position.size());
      CHECK(volume == doctest::Approx(8).epsilon(angle == 0 ? 0.05 : 3e-3));
    }
  }
}

TEST_CASE("a surface that does not close, or encloses nothing, is refused, and where") {
  Triangles open = box({0, 0, 0}, {1, 1, 1});
  open.pop_back();
  CHECK(holds(fault_of(binary_stl(open)),
              "not a closed surface: 3 edges have no second triangle, the first from ("));
  Triangles twisted = box({0, 0, 0}, {1, 1, 1});
  std::swap(twisted[0][1], twisted[0][2]);
  CHECK(holds(fault_of(binary_stl(twisted)),
              "3 edges have triangles that face different ways, the first from ("));
  CHECK(fault_of(binary_stl(box({0, 0, 0}, {1, 1, 0}))) == "the surface encloses no volume");
  CHECK(fault_of(binary_stl({})) == "no triangles");
  CHECK(fault_of("solid nothing\nendsolid nothing\n") == "no triangles");
}

TEST_CASE("a file that is cut off, holds no numbers, or is no STL file is refused, and where") {
  const Triangles good = box({0, 0, 0}, {1, 1, 1});
  const std::string binary = binary_stl(good), text = text_stl(good);
  CHECK(fault_of(binary.substr(0, binary.size() - 20)) ==
        "not an STL file, or cut short: 664 bytes, but 12 triangles, as its head says, have 684");
  CHECK(holds(fault_of(text.substr(0, text.find("outer"))), "was expected, got the end of the file"));
  CHECK(holds(fault_of(""), "not an STL file"));
  CHECK(holds(fault_of(std::string(3000, 'x')),
              "3000 bytes, but 2021161080 triangles, as its head says, have"));
  Triangles nowhere = good;
  nowhere[3][1][2] = std::numeric_limits<double>::quiet_NaN();
  CHECK(fault_of(binary_stl(nowhere)) == "triangle 3 has a corner at nan (finite numbers)");
  CHECK(fault_of(replaced(text, "vertex 0.000000", "vertex nan")) ==
        "line 4: a number was expected, got 'nan'");
  CHECK(fault_of(replaced(text, "vertex 0.000000", "vertex 1e999")) ==
        "line 4: a number was expected, got '1e999'");
  CHECK(fault_of(replaced(text, "outer", "inner")) == "line 3: 'outer' was expected, got 'inner'");
  CHECK(fault_of(replaced(text, "facet", "fact")) ==
        "line 2: 'facet' or 'endsolid' was expected, got 'fact'");
  CHECK(decode(replaced(text, "vertex 0.000000", "VERTEX +0E-999")));  // no less than text
}

TEST_CASE("a hundred thousand triangles and a million points take seconds") {
  const Triangles triangles = sphere(224);  // 100k
  CHECK(triangles.size() > 99000);
  const std::clock_t begin = std::clock();
  const auto surface = decode(binary_stl(triangles));
  REQUIRE(surface);
  const std::size_t inside = fill(body_of(surface), cube(-1, 2, 0.02), 3).position.size();
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  CHECK(static_cast<double>(inside) * 1e-6 == doctest::Approx(4 * std::numbers::pi / 3).epsilon(1e-3));
  CHECK(seconds < 60);  // 0.5 s without sanitizers
}

TEST_CASE("long triangles beside small ones are not listed everywhere") {
  // A needle across the whole surface for every one of its triangles, each a closed sliver of its own.
  Triangles triangles = sphere(40);
  for (int k = 0; k < 3000; ++k) {
    const double shift = 1e-3 * k;
    const Vec3 a{0, -1, -1 + 1e-4 * shift}, b{0, 1, 1}, c{1e-3, 1, 1 - 1e-3}, d{0, 0.99, 1 - 2e-3};
    for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}, std::array{a, d, b}, std::array{b, d, c}})
      triangles.push_back(t);
  }
  const std::clock_t begin = std::clock();
  const auto surface = decode(binary_stl(triangles));
  REQUIRE(surface);
  CHECK(fill(body_of(surface), cube(-1, 2, 0.05), 3).position.size() > 30000);
  CHECK(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC < 60);
}

TEST_CASE("an STL body is scaled, turned and moved, and written so that reading it changes nothing") {
  const fs::path folder = fs::temp_directory_path() / "mpmfast_scene_surfaces";
  fs::create_directories(folder / "deeper");
  std::ofstream(folder / "box.stl") << text_stl(box({0, 0, 0}, {1, 2, 3}));
  const std::string stl =
      "stl: {file: ../box.stl, scale: 1 mm, angle: 90 deg, translate: [5 mm, 6 mm, 1 mm]}";
  const std::string text =
      replaced(solid_scene(), "box: {from: [1 mm, 1 mm, 0], to: [4 mm, 3 mm, 2 mm]}", stl);
  const Scene scene = parse_scene(text, folder / "deeper" / "scene.yaml");
  const Bounds box = bounds(scene.bodies[0].shape);
  const Vec3 lower{3e-3, 6e-3, 1e-3}, upper{5e-3, 7e-3, 4e-3};
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(box.lower[k] == doctest::Approx(lower[k]));
    CHECK(box.upper[k] == doctest::Approx(upper[k]));
  }
  const Scene again = parse_scene(scene.resolved_yaml, "elsewhere/scene.yaml");
  CHECK(again.resolved_yaml == scene.resolved_yaml);
  CHECK(fill(again.bodies[0], again.grid, 3).position == fill(scene.bodies[0], scene.grid, 3).position);

  const auto fault_with = [&](const std::string& from, const std::string& to) {
    try {
      parse_scene(replaced(text, from, to), folder / "deeper" / "scene.yaml");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  CHECK(holds(fault_with("../box.stl", "none.stl"), ":7:31: bodies.0.stl.file: cannot read the surface "));
  CHECK(holds(fault_with("../box.stl", "none.stl"), "none.stl: no such file, got 'none.stl'"));
  CHECK(holds(fault_with("../box.stl", ".."), ": it is a folder, got '..'"));
  CHECK(holds(fault_with("scale: 1 mm, ", ""), "bodies.0.stl.scale: missing (a length"));
  CHECK(holds(fault_with("scale: 1 mm", "scale: -1 mm"), "bodies.0.stl.scale: must be positive"));
  CHECK(holds(fault_with("scale: 1 mm", "scale: 1e308"), "bodies.0.stl: the surface is out of range"));
  CHECK(holds(fault_with("scale: 1 mm", "size: 1 mm"), "bodies.0.stl.size: unknown key"));
  CHECK(holds(fault_with("scale: 1 mm", "scale: 1 m"), "m outside the grid, above in"));
  CHECK(holds(fault_with("angle: 90 deg", "axis: [0, 0, 0]"), "the zero vector has no direction"));
  CHECK(holds(fault(replaced(plain_scene(), "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}", stl)),
              "bodies.0.stl: an stl exists in 3-D only"));
  fs::remove_all(folder);
}
