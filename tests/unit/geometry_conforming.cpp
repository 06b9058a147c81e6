// Particles that follow the outline of a plane shape (fill_conforming).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/fill.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr CellLattice kFourPerCell{{0, 0, 0}, {40, 40, 0}, 1, {2, 2, 1}};
constexpr double kLayer = 0.5;

Seeds conforming(const Shape& shape, const CellLattice& grid = kFourPerCell) {
  return fill(shape, {SeedingKind::conforming}, grid, 2);
}

/// Area, centroid and polar second moment about it, with that of the domains themselves.
struct ShapeMoments {
  double area = 0, x = 0, y = 0, polar = 0;
};
ShapeMoments shape_moments(const Seeds& seeds) {
  const double domain = 4 * seeds.half_size[0] * seeds.half_size[1];
  ShapeMoments m;
  for (std::size_t k = 0; k < seeds.position.size(); ++k) {
    const double area = domain * seeds.share[k];
    m.area += area;
    m.x += area * seeds.position[k][0];
    m.y += area * seeds.position[k][1];
  }
  m.x /= m.area;
  m.y /= m.area;
  for (std::size_t k = 0; k < seeds.position.size(); ++k) {
    const double x = seeds.position[k][0] - m.x, y = seeds.position[k][1] - m.y;
    m.polar += domain * seeds.share[k] * (x * x + y * y + domain / 6);
  }
  return m;
}

/// Where the outer face of a particle's domain has its middle.
Vec3 outer_face(const Seeds& seeds, std::size_t k) {
  const Vec3& x = seeds.position[k];
  const double angle = seeds.angle[k], reach = seeds.half_size[0];
  return {x[0] + reach * std::cos(angle), x[1] + reach * std::sin(angle), 0};
}

TEST_CASE("conforming particles of a disk have its area, its moments and its outline, wherever it lies") {
  const double radius = 8, area = std::numbers::pi * radius * radius;
  for (const double x : {20.0, 20.13, 20.31}) {
    CAPTURE(x);
    const Seeds seeds = conforming(EllipsoidShape{{x, 20.2, 0}, {radius, radius, 0}});
    const ShapeMoments m = shape_moments(seeds);
    CHECK(m.area == doctest::Approx(area).epsilon(5e-5));
    CHECK(m.x == doctest::Approx(x).epsilon(1e-6));
    CHECK(m.y == doctest::Approx(20.2).epsilon(1e-6));
    CHECK(m.polar == doctest::Approx(0.5 * area * radius * radius).epsilon(5e-4));
    int along = 0;
    for (std::size_t k = 0; k < seeds.position.size(); ++k) {
      if (seeds.angle[k] == 0 && seeds.position[k][0] < x) continue;  // of the lattice
      const Vec3 face = outer_face(seeds, k);
      const double distance = std::hypot(face[0] - x, face[1] - 20.2) - radius;
      if (std::hypot(seeds.position[k][0] - x, seeds.position[k][1] - 20.2) < radius - 0.6 * kLayer) continue;
      ++along;
      CHECK(std::abs(distance) < 0.002);
    }
    CHECK(along == 100);  // the multiple of four next to 2 pi 8 / 0.5
  }
}

TEST_CASE("conforming particles of an ellipse, a ring and a wedge have their areas and moments") {
  const double pi = std::numbers::pi;
  const ShapeMoments ellipse = shape_moments(conforming(EllipsoidShape{{20, 20, 0}, {8, 4, 0}, 0.35}));
  CHECK(ellipse.area == doctest::Approx(32 * pi).epsilon(1e-4));
  CHECK(ellipse.polar == doctest::Approx(pi / 4 * 32 * (64 + 16)).epsilon(1e-3));
  const ShapeMoments ring = shape_moments(conforming(RingShape{{20, 20, 0}, 4, 8, 0}));
  CHECK(ring.area == doctest::Approx(48 * pi).epsilon(1e-4));
  CHECK(ring.polar == doctest::Approx(pi / 2 * (4096 - 256)).epsilon(1e-3));
  // Corners of 78, 47 and 55 degrees: the areas of strips and corners add up to that of the triangle.
  const ShapeMoments wedge = shape_moments(conforming(PolygonShape{{{3, 22}, {19, 22}, {6, 36}}}));
  CHECK(wedge.area == doctest::Approx(112).epsilon(1e-6));
  CHECK(wedge.x == doctest::Approx(28.0 / 3).epsilon(3e-7));
  CHECK(wedge.y == doctest::Approx(80.0 / 3).epsilon(3e-7));
  // A reentrant corner, about which the layer turns.
  const ShapeMoments bracket =
      shape_moments(conforming(PolygonShape{{{5, 5}, {25, 5}, {25, 12}, {13, 14}, {12, 25}, {5, 25}}}));
  const double exact = 0.5 * std::abs((5 * 5 - 25 * 5) + (25 * 12 - 25 * 5) + (25 * 14 - 13 * 12) +
                                      (13 * 25 - 12 * 14) + (12 * 25 - 5 * 25) + (5 * 5 - 5 * 25));
  CHECK(bracket.area == doctest::Approx(exact).epsilon(1e-5));
}

TEST_CASE("a step of one particle spacing keeps its layer and the area of its reentrant corner") {
  for (const auto& counts : {std::array{2, 2, 1}, {2, 3, 1}}) {
    CellLattice grid = kFourPerCell;
    grid.particles_per_cell = counts;
    const PolygonShape step{{{1, 1}, {21, 1}, {21, 11}, {11, 11}, {11, 11.5}, {1, 11.5}}};
    for (const bool clockwise : {false, true}) {
      PolygonShape shape = step;
      if (clockwise) std::reverse(shape.points.begin(), shape.points.end());
      const Seeds seeds = conforming(shape, grid);
      const double domain = 4 * seeds.half_size[0] * seeds.half_size[1];
      CHECK(std::abs(shape_moments(seeds).area - 205) < 0.01 * domain);
      CHECK(*std::min_element(seeds.share.begin(), seeds.share.end()) > 0.3);
    }
  }
}

/// A square of edge 2 half about (20, 20), turned by 0.4 rad; with a point in the middle of an edge it is no
/// rectangle to the program.
PolygonShape turned_square(double half, bool divided) {
  const double cosine = std::cos(0.4), sine = std::sin(0.4);
  PolygonShape square;
  std::vector<std::array<double, 2>> corners{{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  if (divided) corners.push_back({-half, 0});
  for (const auto& [x, y] : corners)
    square.points.push_back({20 + cosine * x - sine * y, 20 + sine * x + cosine * y});
  return square;
}

TEST_CASE("a rectangle across the grid has the lattice of a box that is turned alike") {
  const Seeds seeds = conforming(turned_square(6, false));
  const Seeds turned = fill(turned_square(6, false), {SeedingKind::lattice, 0.4}, kFourPerCell, 2);
  REQUIRE(seeds.position.size() == 24 * 24);
  CHECK(seeds.share.empty());
  for (std::size_t k = 0; k < seeds.position.size(); ++k)
    for (std::size_t d = 0; d < 2; ++d)
      CHECK(seeds.position[k][d] == doctest::Approx(turned.position[k][d]).epsilon(1e-12));
  // A parallelogram is none, and one along the grid lies as a box does.
  CHECK(!conforming(PolygonShape{{{5, 5}, {15, 5}, {16, 15}, {6, 15}}}).share.empty());
  const Seeds straight = conforming(PolygonShape{{{3, 4}, {9, 4}, {9, 8}, {3, 8}}});
  CHECK(straight.position.size() == 12 * 8);
  CHECK(straight.angle[0] == 0);
}

TEST_CASE("conforming particles of a turned square end on its edges and fill its corners") {
  const double half = 6, cosine = std::cos(0.4), sine = std::sin(0.4);
  const Seeds seeds = conforming(turned_square(half, true));
  double farthest = 0;
  int corners = 0;
  for (std::size_t k = 0; k < seeds.position.size(); ++k) {
    const double dx = seeds.position[k][0] - 20, dy = seeds.position[k][1] - 20;
    const double x = std::abs(cosine * dx + sine * dy), y = std::abs(-sine * dx + cosine * dy);
    farthest = std::max({farthest, x, y});
    corners += std::abs(x - (half - 0.5 * kLayer)) < 1e-9 && std::abs(y - (half - 0.5 * kLayer)) < 1e-9;
  }
  CHECK(farthest == doctest::Approx(half - 0.5 * kLayer).epsilon(1e-12));
  CHECK(corners == 4);
  CHECK(shape_moments(seeds).area == doctest::Approx(4 * half * half).epsilon(1e-9));
}

TEST_CASE("a shape too thin for a layer has the grid's lattice, with its area") {
  const auto straight = [](const Seeds& seeds) { return seeds.angle.empty(); };
  // Edges too short for the corners at their ends.
  const Seeds seeds = conforming(PolygonShape{{{5, 5.1}, {9, 5.1}, {15, 5.1}, {15, 5.8}, {5, 5.8}}});
  CHECK(shape_moments(seeds).area == doctest::Approx(7).epsilon(1e-9));
  CHECK(straight(seeds));
  // Layers of both sides would overlap.
  const Seeds ring = conforming(RingShape{{20, 20, 0}, 7.2, 8, 0});
  CHECK(shape_moments(ring).area == doctest::Approx(std::numbers::pi * (64 - 7.2 * 7.2)).epsilon(1e-4));
  CHECK(straight(ring));
  // So would those of rings just too thin; in the thinnest each layer would lie beyond the other side.
  for (const double thickness : {0.1, 0.98, 0.995}) {
    CAPTURE(thickness);
    const double inner = 8 - thickness;
    const Seeds thin = conforming(RingShape{{20, 20, 0}, inner, 8, 0});
    CHECK(shape_moments(thin).area == doctest::Approx(std::numbers::pi * (64 - inner * inner)).epsilon(1e-4));
    CHECK(straight(thin));
  }
  // Three spacings have room for both layers.
  const Seeds strip = conforming(PolygonShape{{{5, 5.1}, {9, 5.1}, {15, 5.1}, {15, 6.6}, {5, 6.6}}});
  CHECK(shape_moments(strip).area == doctest::Approx(15).epsilon(1e-9));
  CHECK(!straight(strip));
}

TEST_CASE("conforming particles of an ellipse on a line of the lattice are mirrored there") {
  const Seeds seeds = conforming(EllipsoidShape{{20, 20, 0}, {7.3, 5.1, 0}});
  for (const Vec3& x : seeds.position)
    CHECK(std::any_of(seeds.position.begin(), seeds.position.end(), [&](const Vec3& y) {
      return std::abs(x[0] + y[0] - 40) < 1e-9 && std::abs(x[1] - y[1]) < 1e-9;
    }));
}

/// How far the corners of the domains of all particles lie beyond a convex polygon, at most.
double reach_beyond(const Seeds& seeds, const PolygonShape& polygon) {
  double farthest = -1;
  for (std::size_t k = 0; k < seeds.position.size(); ++k)
    for (const auto& [a, b] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      const double u = a * seeds.half_size[0], v = b * seeds.half_size[1];
      const double cosine = std::cos(seeds.angle[k]), sine = std::sin(seeds.angle[k]);
      const double x = seeds.position[k][0] + cosine * u - sine * v,
                   y = seeds.position[k][1] + sine * u + cosine * v;
      for (std::size_t i = 0; i < polygon.points.size(); ++i) {
        const auto &p = polygon.points[i], &q = polygon.points[(i + 1) % polygon.points.size()];
        const double ex = q[0] - p[0], ey = q[1] - p[1];
        farthest = std::max(farthest, (ey * (x - p[0]) - ex * (y - p[1])) / std::hypot(ex, ey));
      }
    }
  return farthest;
}

TEST_CASE("domains end on regular polygons, whose areas are exact") {
  for (const int corners : {5, 6, 8, 13, 16, 25}) {
    CAPTURE(corners);
    PolygonShape polygon;
    const double pi = std::numbers::pi, radius = 8;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * pi * (k + 0.3) / corners;
      polygon.points.push_back({20.2 + radius * std::cos(angle), 20.1 + radius * std::sin(angle)});
    }
    const Seeds seeds = conforming(polygon);
    CHECK(shape_moments(seeds).area ==
          doctest::Approx(0.5 * corners * radius * radius * std::sin(2 * pi / corners)).epsilon(1e-9));
    // A strip of n spacings' length has particles a spacing apart but for half a spacing over n.
    CHECK(reach_beyond(seeds, polygon) < 0.02 * kLayer);
    CHECK(std::any_of(seeds.angle.begin(), seeds.angle.end(), [](double a) { return a != 0; }));
  }
}

TEST_CASE("half disks and lenses have a layer, and their areas") {
  const double pi = std::numbers::pi;
  PolygonShape half_disk, lens;
  constexpr int kSteps = 400;
  for (const double radius : {2.0, 4.0, 8.0}) {
    CAPTURE(radius);
    half_disk.points.clear();
    for (int k = 0; k <= kSteps; ++k)
      half_disk.points.push_back(
          {20.1 + radius * std::cos(pi * k / kSteps), 20.3 + radius * std::sin(pi * k / kSteps)});
    const Seeds seeds = conforming(half_disk);
    CHECK(shape_moments(seeds).area == doctest::Approx(0.5 * pi * radius * radius).epsilon(4e-4));
    CHECK(std::abs(shape_moments(seeds).y - (20.3 + 4 * radius / (3 * pi))) < 0.015 * kLayer);
    CHECK(std::any_of(seeds.angle.begin(), seeds.angle.end(), [](double a) { return a != 0; }));
  }
  // Two arcs of a third of a turn each, of radius 8.
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < kSteps; ++k) {
      const double angle = (side == 0 ? pi / 6 : 7 * pi / 6) + 2 * pi / 3 * k / kSteps;
      lens.points.push_back({20 + 8 * std::cos(angle), 20.2 + 8 * std::sin(angle) + (side == 0 ? -4 : 4)});
    }
  const Seeds seeds = conforming(lens);
  CHECK(shape_moments(seeds).area == doctest::Approx(64 * (2 * pi / 3 - std::sin(2 * pi / 3))).epsilon(1e-4));
  CHECK(std::any_of(seeds.angle.begin(), seeds.angle.end(), [](double a) { return a != 0; }));
}

TEST_CASE("a wedge of 30 degrees has its layer, one of 25 the grid's lattice with its area") {
  for (const double degrees : {30.0, 25.0}) {
    CAPTURE(degrees);
    const double height = 20 * std::tan(degrees * std::numbers::pi / 180);
    const Seeds seeds = conforming(PolygonShape{{{5, 5}, {25, 5}, {25, 5 + height}}});
    CHECK(seeds.angle.empty() == (degrees < 28));
    double area = 0;
    for (const double share : seeds.share) area += share * kLayer * kLayer;
    CHECK(area == doctest::Approx(10 * height).epsilon(1e-6));
  }
}

TEST_CASE("a plate with a round notch has its layer, however small the notch and far the plate") {
  const double pi = std::numbers::pi;
  for (const double radius : {0.15, 0.25, 0.5, 0.8, 2.0})
    for (const double away : {0.0, 4e5}) {
      CAPTURE(radius);
      CAPTURE(away);
      PolygonShape plate{{{10 + away, 10}, {30 + away, 10}, {30 + away, 30}}};
      for (int k = 0; k <= 40; ++k)
        plate.points.push_back(
            {20 + away + radius * std::cos(pi * k / 40), 30 - radius * std::sin(pi * k / 40)});
      plate.points.push_back({10 + away, 30});
      CellLattice grid = kFourPerCell;
      grid.origin[0] = away;
      const Seeds seeds = conforming(plate, grid);
      double area = 0;
      for (const double share : seeds.share) area += share * kLayer * kLayer;
      CHECK(area == doctest::Approx(400 - 0.5 * pi * radius * radius).epsilon(2e-5));
      CHECK(!seeds.angle.empty());
    }
}

TEST_CASE("a box keeps its own lattice, conforming or not") {
  const BoxShape box{{3.3, 4.1, 0}, {9.7, 8.2, 0}};
  CHECK(conforming(box).position == fill(box, {}, kFourPerCell, 2).position);
}

}  // namespace
}  // namespace mpmfast
