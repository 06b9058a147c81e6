// What fills a shape, place by place: against lattices that are listed and looked at point by point, with
// insides that are told in another way than the engine does.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "engine/geometry/clip.hpp"
#include "engine/geometry/fill.hpp"
#include "engine/geometry/outline.hpp"
#include "engine/geometry/surface.hpp"
#include "tests/unit/geometry_solids.hpp"

namespace mpmfast {
namespace {

using namespace test;
using Draw = std::mt19937_64;
using Inside = std::function<bool(const Vec3&)>;

double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

/// (x, y) seen from a frame that is turned by an angle.
std::array<double, 2> seen_from(double angle, double x, double y) {
  return {x * std::cos(angle) + y * std::sin(angle), y * std::cos(angle) - x * std::sin(angle)};
}

/// A shape, what is inside of it, and its bounds in a frame that is turned about z.
struct Known {
  Shape shape;
  Inside inside;
  std::function<Bounds(double angle)> bounds;
};

/// Of points and the ends of z.
Bounds bounds_of(const std::vector<std::array<double, 2>>& points, double low, double high, double angle) {
  Bounds out{{1e9, 1e9, low}, {-1e9, -1e9, high}};
  for (const auto& p : points) {
    const auto at = seen_from(angle, p[0], p[1]);
    for (std::size_t k = 0; k < 2; ++k) {
      out.lower[k] = std::min(out.lower[k], at[k]);
      out.upper[k] = std::max(out.upper[k], at[k]);
    }
  }
  return out;
}

Known a_box(Draw& draw, int dimension) {
  Vec3 low{}, high{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    low[k] = uniform(draw, -0.9, 0.3);
    high[k] = low[k] + uniform(draw, 0.1, 0.7);
  }
  const std::vector<std::array<double, 2>> corners{
      {low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}};
  return {BoxShape{low, high},
          [=](const Vec3& x) {
            bool in = true;
            for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
              in = in && x[k] >= low[k] && x[k] < high[k];
            return in;
          },
          [=](double angle) { return bounds_of(corners, low[2], high[2], angle); }};
}

Known an_ellipsoid(Draw& draw, int dimension) {
  EllipsoidShape shape;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    shape.centre[k] = uniform(draw, -0.5, 0.5);
    shape.radii[k] = uniform(draw, 0.1, 0.6);
  }
  shape.angle = uniform(draw, -3, 3);
  return {
      shape,
      [=](const Vec3& x) {
        const auto at = seen_from(shape.angle, x[0] - shape.centre[0], x[1] - shape.centre[1]);
        double sum = std::pow(at[0] / shape.radii[0], 2) + std::pow(at[1] / shape.radii[1], 2);
        if (dimension == 3) sum += std::pow((x[2] - shape.centre[2]) / shape.radii[2], 2);
        return sum < 1;
      },
      [=](double angle) {
        // A quadric with the matrix A = R diag(r²) Rᵀ reaches √A_kk along k.
        const auto centre = seen_from(angle, shape.centre[0], shape.centre[1]);
        const double c = std::cos(shape.angle - angle), s = std::sin(shape.angle - angle),
                     a = shape.radii[0] * shape.radii[0], b = shape.radii[1] * shape.radii[1];
        const Vec3 reach{std::sqrt(c * c * a + s * s * b), std::sqrt(s * s * a + c * c * b), shape.radii[2]};
        return Bounds{{centre[0] - reach[0], centre[1] - reach[1], shape.centre[2] - reach[2]},
                      {centre[0] + reach[0], centre[1] + reach[1], shape.centre[2] + reach[2]}};
      }};
}

Known a_ring(Draw& draw, int dimension) {
  RingShape ring{{uniform(draw, -0.4, 0.4), uniform(draw, -0.4, 0.4), 0}, 0, 0, 0};
  ring.outer = uniform(draw, 0.2, 0.6);
  ring.inner = whole(draw, 0, 3) == 0 ? 0 : ring.outer * uniform(draw, 0.2, 0.8);
  if (dimension == 3) {
    ring.centre[2] = uniform(draw, -0.4, 0.4);
    ring.half_length = uniform(draw, 0.1, 0.5);
  }
  return {ring,
          [=](const Vec3& x) {
            const double radius = std::hypot(x[0] - ring.centre[0], x[1] - ring.centre[1]);
            return radius < ring.outer && (ring.inner == 0 || radius > ring.inner) &&
                   (dimension == 2 || std::abs(x[2] - ring.centre[2]) < ring.half_length);
          },
          [=](double angle) {
            const auto at = seen_from(angle, ring.centre[0], ring.centre[1]);
            return Bounds{{at[0] - ring.outer, at[1] - ring.outer, ring.centre[2] - ring.half_length},
                          {at[0] + ring.outer, at[1] + ring.outer, ring.centre[2] + ring.half_length}};
          }};
}

/// A star about a point, so that it does not cross itself; in either direction.
Known a_polygon(Draw& draw, int dimension) {
  PolygonShape polygon;
  const double x = uniform(draw, -0.3, 0.3), y = uniform(draw, -0.3, 0.3);
  const int corners = whole(draw, 3, 9), way = whole(draw, 0, 1) ? 1 : -1;
  for (int k = 0; k < corners; ++k) {
    const double angle = way * 2 * std::numbers::pi * (k + uniform(draw, 0, 0.4)) / corners;
    const double radius = uniform(draw, 0.2, 0.7);
    polygon.points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  if (dimension == 3) {
    polygon.z_lower = uniform(draw, -0.7, 0.1);
    polygon.z_upper = polygon.z_lower + uniform(draw, 0.1, 0.7);
  }
  return {polygon,
          [=](const Vec3& p) {
            return (dimension == 2 || (p[2] > polygon.z_lower && p[2] < polygon.z_upper)) &&
                   std::abs(turns_round(polygon.points, p[0], p[1])) > 0.5;
          },
          [=](double angle) { return bounds_of(polygon.points, polygon.z_lower, polygon.z_upper, angle); }};
}

Known a_bitmap(Draw& draw, int) {
  auto image = std::make_shared<GreyImage>();
  image->width = whole(draw, 1, 9);
  image->height = whole(draw, 1, 9);
  for (int k = 0; k < image->width * image->height; ++k)
    image->pixel.push_back(static_cast<unsigned char>(whole(draw, 3, 5)));
  BitmapShape bitmap{"", {uniform(draw, -0.9, 0), uniform(draw, -0.9, 0), 0}, {}, 4, image};
  bitmap.upper = {bitmap.lower[0] + uniform(draw, 0.2, 0.9), bitmap.lower[1] + uniform(draw, 0.2, 0.9), 0};
  return {bitmap,
          [=](const Vec3& x) {
            for (int row = 0; row < image->height; ++row)
              for (int column = 0; column < image->width; ++column) {
                if (image->pixel[static_cast<std::size_t>(row * image->width + column)] != 4) continue;
                const double wide = (bitmap.upper[0] - bitmap.lower[0]) / image->width,
                             high = (bitmap.upper[1] - bitmap.lower[1]) / image->height;
                const double left = bitmap.lower[0] + column * wide, top = bitmap.upper[1] - row * high;
                if (x[0] > left && x[0] < left + wide && x[1] < top && x[1] > top - high) return true;
              }
            return false;
          },
          {}};
}

/// A body of triangles: one of the solids, placed anyhow, perhaps inside out.
Known a_surface(Draw& draw, int) {
  Solid solid = whole(draw, 0, 1) ? star_prism(whole(draw, 3, 6)) : thread_of(uniform(draw, 0.5, 1.5));
  if (whole(draw, 0, 1))
    for (auto& t : solid.triangles) std::swap(t[1], t[2]);
  Vec3 axis{uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1)};
  const Vec3 unit = *unit_vector(axis);
  StlShape stl;
  stl.surface = std::make_shared<Surface>(
      Surface(solid.points, solid.triangles)
          .placed(uniform(draw, 0.3, 0.5), unit, uniform(draw, -3, 3),
                  {uniform(draw, -0.3, 0.3), uniform(draw, -0.3, 0.3), uniform(draw, -0.3, 0.3)}));
  const std::vector<Vec3> points = stl.surface->points();
  const auto triangles = stl.surface->triangles();
  return {stl, [=](const Vec3& x) { return std::abs(surrounded(points, triangles, x)) > 0.5; },
          [=](double angle) {
            std::vector<std::array<double, 2>> seen;
            double low = 1e9, high = -1e9;
            for (const Vec3& p : points) {
              seen.push_back({p[0], p[1]});
              low = std::min(low, p[2]);
              high = std::max(high, p[2]);
            }
            return bounds_of(seen, low, high, angle);
          }};
}

/// Of which the far ends may lie within a shape.
CellLattice a_grid(Draw& draw, int dimension) {
  CellLattice grid;
  grid.cell = uniform(draw, 0.17, 0.3);
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    grid.origin[k] = uniform(draw, -1.2, -0.3);
    grid.size[k] = grid.cell * whole(draw, 3, 9);
    grid.particles_per_cell[k] = whole(draw, 1, 3);
  }
  return grid;
}

/// Without the places on a surface, where round-off decides: a lattice that ends on the corners of a shape
/// may have a diagonal on its edge.
std::vector<Vec3> off_surface(const std::vector<Vec3>& positions, const Inside& inside) {
  std::vector<Vec3> out;
  for (const Vec3& at : positions) {
    int in = 0;
    for (const double x : {-1e-9, 1e-9})
      for (const double y : {-1e-9, 1e-9})
        for (const double z : {-1e-9, 1e-9}) in += !inside || inside({at[0] + x, at[1] + y, at[2] + z});
    if (in == 0 || in == 8) out.push_back(at);
  }
  return out;
}

void check_same(const std::vector<Vec3>& all_got, const std::vector<Vec3>& all_wanted, const Inside& inside) {
  const std::vector<Vec3> got = off_surface(all_got, inside), wanted = off_surface(all_wanted, inside);
  REQUIRE(got.size() == wanted.size());
  for (std::size_t p = 0; p < got.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::abs(got[p][k] - wanted[p][k]) < 1e-13);
}

/// All points of counted rows that are in it, x fastest.
std::vector<Vec3> looked_at(const std::array<std::vector<double>, 3>& rows, double angle,
                            const Inside& inside) {
  std::vector<Vec3> out;
  for (const double z : rows[2])
    for (const double y : rows[1])
      for (const double x : rows[0]) {
        const auto at = seen_from(-angle, x, y);
        const Vec3 there{at[0], at[1], z};
        if (!inside || inside(there)) out.push_back(there);
      }
  return out;
}

void check_straight(const Known& known, const CellLattice& grid, int dimension) {
  std::array<std::vector<double>, 3> rows{std::vector<double>{0}, {0}, {0}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    rows[k].clear();
    const double step = grid.cell / grid.particles_per_cell[k];
    for (int i = 0; (i + 0.5) * step < grid.size[k]; ++i)
      rows[k].push_back(grid.origin[k] + (i + 0.5) * step);
  }
  const Seeds seeds = fill(known.shape, {}, grid, dimension);
  check_same(seeds.position, looked_at(rows, 0, known.inside), known.inside);
  CHECK(seeds.angle.empty());
  CHECK(seeds.share.empty());
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(seeds.half_size[k] == doctest::Approx(k < static_cast<std::size_t>(dimension)
                                                    ? 0.5 * grid.cell / grid.particles_per_cell[k]
                                                    : 0));
}

/// A lattice that ends on the faces of the box around, as the shape is seen from a turned frame.
void check_turned(const Known& known, double angle, const CellLattice& grid, int dimension, bool all) {
  const Bounds box = known.bounds(angle);
  std::array<std::vector<double>, 3> rows{std::vector<double>{0}, {0}, {0}};
  Vec3 half{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    rows[k].clear();
    const double edge = box.upper[k] - box.lower[k];
    const int count =
        std::max(1, static_cast<int>(std::round(edge / (grid.cell / grid.particles_per_cell[k]))));
    half[k] = 0.5 * edge / count;
    for (int i = 0; i < count; ++i) rows[k].push_back(box.lower[k] + (2 * i + 1) * half[k]);
  }
  const Seeds seeds = fill(known.shape, {SeedingKind::lattice, angle}, grid, dimension);
  const Inside inside = all ? Inside() : known.inside;
  check_same(seeds.position, looked_at(rows, angle, inside), inside);
  CHECK(seeds.angle == std::vector<double>(angle == 0 ? 0 : seeds.position.size(), angle));
  CHECK(seeds.share.empty());
  for (std::size_t k = 0; k < 3; ++k) CHECK(seeds.half_size[k] == doctest::Approx(half[k]));
}

TEST_CASE(
    "a shape holds the places of the grid's lattice that lie inside it, row by row along x, no others") {
  Draw draw(11);
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    for (const auto& plane : {an_ellipsoid, a_ring, a_polygon, a_bitmap})
      check_straight(plane(draw, 2), a_grid(draw, 2), 2);
    if (round % 4 > 0) continue;
    for (const auto& solid : {an_ellipsoid, a_ring, a_polygon, a_surface})
      check_straight(solid(draw, 3), a_grid(draw, 3), 3);
  }
}

TEST_CASE("a box, and every shape on a turned lattice, is filled from face to face of the box around it") {
  Draw draw(12);
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    check_turned(a_box(draw, 2), 0, a_grid(draw, 2), 2, true);
    check_turned(a_box(draw, 3), 0, a_grid(draw, 3), 3, true);
    for (const auto& plane : {a_box, an_ellipsoid, a_ring, a_polygon})
      check_turned(plane(draw, 2), uniform(draw, -3, 3), a_grid(draw, 2), 2, false);
    if (round % 4 > 0) continue;
    for (const auto& solid : {a_box, an_ellipsoid, a_ring, a_polygon, a_surface})
      check_turned(solid(draw, 3), uniform(draw, -3, 3), a_grid(draw, 3), 3, false);
  }
}

TEST_CASE("bounds of every shape are those of what is inside it") {
  Draw draw(13);
  for (int round = 0; round < 20; ++round) {
    CAPTURE(round);
    for (const auto& known :
         {a_box(draw, 2), a_box(draw, 3), an_ellipsoid(draw, 2), an_ellipsoid(draw, 3), a_ring(draw, 2),
          a_ring(draw, 3), a_polygon(draw, 2), a_polygon(draw, 3), a_surface(draw, 3)}) {
      const Bounds got = bounds(known.shape), wanted = known.bounds(0);
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(got.lower[k] == doctest::Approx(wanted.lower[k]).epsilon(1e-13));
        CHECK(got.upper[k] == doctest::Approx(wanted.upper[k]).epsilon(1e-13));
      }
      for (int k = 0; k < 40; ++k) {
        const Vec3 at{uniform(draw, -0.9, 0.9), uniform(draw, -0.9, 0.9), uniform(draw, -0.9, 0.9)};
        REQUIRE(contains(known.shape, at) == known.inside(at));
      }
    }
  }
}

TEST_CASE(
    "rings of particles lie where equal turns from the x axis put them, with what is theirs of the area") {
  Draw draw(14);
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    const bool disk = round % 3 == 0;
    const double outer = uniform(draw, 0.1, 0.6), inner = disk ? 0 : outer * uniform(draw, 0.1, 0.95);
    const Vec3 centre{uniform(draw, -2, 2), uniform(draw, -2, 2), 0};
    const CellLattice grid = a_grid(draw, 2);
    const Seeds seeds = fill(disk ? Shape(EllipsoidShape{centre, {outer, outer, 0}, 0.3})
                                  : Shape(RingShape{centre, inner, outer, 0}),
                             {SeedingKind::rings}, grid, 2);
    const double along_radius = grid.cell / grid.particles_per_cell[0];
    const int rings = std::max(1, static_cast<int>(std::round((outer - inner) / along_radius)));
    const double depth = (outer - inner) / rings,
                 length = depth * grid.particles_per_cell[0] / grid.particles_per_cell[1];
    CHECK(seeds.half_size[0] == doctest::Approx(depth / 2));
    CHECK(seeds.half_size[1] == doctest::Approx(length / 2));
    CHECK(seeds.half_size[2] == 0);
    std::size_t p = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const double radius = inner + (ring + 0.5) * depth;
      const int count = std::max(3, static_cast<int>(std::round(2 * std::numbers::pi * radius / length)));
      for (int k = 0; k < count; ++k, ++p) {
        REQUIRE(p < seeds.position.size());
        const double angle = std::numbers::pi * (2 * k + 1) / count;
        CHECK(seeds.angle[p] == doctest::Approx(angle));
        CHECK(seeds.position[p][0] == doctest::Approx(centre[0] + radius * std::cos(angle)));
        CHECK(seeds.position[p][1] == doctest::Approx(centre[1] + radius * std::sin(angle)));
        CHECK(seeds.position[p][2] == 0);
        // Of the area between two circles.
        const double area =
            std::numbers::pi * (std::pow(radius + depth / 2, 2) - std::pow(radius - depth / 2, 2)) / count;
        CHECK(seeds.share[p] == doctest::Approx(area / (depth * length)));
      }
    }
    CHECK(p == seeds.position.size());
  }
}

/// Area and first moments of what a polygon has within a rectangle, cut side by side.
struct Cut {
  double area = 0, x = 0, y = 0;
};
Cut cut_out(std::vector<std::array<double, 2>> points, const Vec3& low, const Vec3& high) {
  for (std::size_t d = 0; d < 2; ++d)
    for (const bool upper : {false, true}) {
      std::vector<std::array<double, 2>> left;
      const auto depth = [&](const std::array<double, 2>& p) {
        return upper ? high[d] - p[d] : p[d] - low[d];
      };
      for (std::size_t k = 0; k < points.size(); ++k) {
        const auto &a = points[k], &b = points[(k + 1) % points.size()];
        if (depth(a) >= 0) left.push_back(a);
        if ((depth(a) >= 0) != (depth(b) >= 0)) {
          const double s = depth(a) / (depth(a) - depth(b));
          left.push_back({a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])});
        }
      }
      points = left;
    }
  Cut out;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto &a = points[k], &b = points[(k + 1) % points.size()];
    const double twice = a[0] * b[1] - b[0] * a[1];
    out.area += twice / 2;
    out.x += twice * (a[0] + b[0]) / 6;
    out.y += twice * (a[1] + b[1]) / 6;
  }
  return out;
}

/// What the cells of a lattice have of a polygon, once those with less than half a cell gave theirs away:
/// beside, else across a corner, to the fullest, in equal parts where several are as full.
void check_clip(const std::vector<std::array<double, 2>>& polygon, const Vec3& origin, const Vec3& half) {
  Outline around;
  for (const auto& p : polygon) around.points.push_back({p[0], p[1], 0});
  const int n = static_cast<int>(polygon.size());
  for (int k = 0; k < n; ++k) around.facets.push_back({{k, (k + 1) % n, -1}, {}, 0});
  Seeds seeds;
  seeds.half_size = half;
  seeds.position = {{7, 7, 7}};
  seeds.share = {3};
  clip(around, origin, seeds);

  constexpr int kSide = 24;  // the polygon lies well within
  const double side[2] = {2 * half[0], 2 * half[1]}, whole_cell = side[0] * side[1];
  std::vector<Cut> has, gets;
  for (int j = -kSide; j < kSide; ++j)
    for (int i = -kSide; i < kSide; ++i) {
      const Vec3 low{origin[0] + i * side[0], origin[1] + j * side[1], 0};
      has.push_back(cut_out(polygon, low, {low[0] + side[0], low[1] + side[1], 0}));
    }
  gets = has;
  std::vector<bool> kept_whole;
  for (std::size_t c = 0; c < has.size(); ++c) kept_whole.push_back(has[c].area > (1 - 1e-12) * whole_cell);
  const int row = 2 * kSide;
  for (std::size_t c = 0; c < has.size(); ++c) {
    if (std::abs(has[c].area) < 1e-12 * whole_cell || has[c].area > (0.5 - 1e-9) * whole_cell) continue;
    for (const auto& steps : {std::vector<int>{-1, 1, -row, row}, {-row - 1, -row + 1, row - 1, row + 1}}) {
      double fullest = 0;
      for (const int step : steps) fullest = std::max(fullest, has[c + static_cast<std::size_t>(step)].area);
      if (fullest < (0.5 - 1e-9) * whole_cell) continue;
      std::vector<std::size_t> takers;
      for (const int step : steps)
        if (has[c + static_cast<std::size_t>(step)].area > fullest - 1e-9 * whole_cell)
          takers.push_back(c + static_cast<std::size_t>(step));
      for (const std::size_t to : takers) {
        const double part = 1.0 / static_cast<double>(takers.size());
        gets[to].area += part * has[c].area;
        gets[to].x += part * has[c].x;
        gets[to].y += part * has[c].y;
      }
      gets[c] = {};
      break;
    }
  }
  std::vector<Vec3> positions;
  std::vector<double> shares;
  for (const Cut& cut : gets)
    if (cut.area > 1e-9 * whole_cell) {
      positions.push_back({cut.x / cut.area, cut.y / cut.area, 0});
      shares.push_back(cut.area / whole_cell);
    }
  REQUIRE(seeds.position.size() == positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    REQUIRE(seeds.share[k] == doctest::Approx(shares[k]).epsilon(1e-9));
    for (std::size_t d = 0; d < 3; ++d) REQUIRE(std::abs(seeds.position[k][d] - positions[k][d]) < 1e-9);
  }
}

TEST_CASE("cut off at an outline, cells have the area and centroid of what is theirs of it, or pass it on") {
  Draw draw(15);
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    std::vector<std::array<double, 2>> polygon;
    const int corners = whole(draw, 3, 8);
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * (k + uniform(draw, 0, 0.5)) / corners;
      const double radius = uniform(draw, 0.15, 0.7);
      polygon.push_back({0.1 + radius * std::cos(angle), -0.2 + radius * std::sin(angle)});
    }
    const double width = uniform(draw, 0.05, 0.12);
    check_clip(polygon, {uniform(draw, -0.2, 0.2), uniform(draw, -0.2, 0.2), 0},
               {width, width * uniform(draw, 0.8, 1.4), 0});
  }
}

TEST_CASE("along the lines of the lattice too, cells that are as full take equal parts") {
  const Vec3 origin{0, 0, 0}, half{0.125, 0.125, 0};
  // A cross with arms of a quarter of a cell, blocks with rims of less than half a cell, and whole cells.
  check_clip({{0, 0}, {1, 0}, {1, 0.75}, {0, 0.75}}, origin, half);
  check_clip({{-0.1, -0.1}, {1.1, -0.1}, {1.1, 1.1}, {-0.1, 1.1}}, origin, half);
  check_clip({{0, 0}, {0.5, 0}, {0.5, -0.0625}, {0.75, -0.0625}, {0.75, 0}, {1.25, 0}, {1.25, 1}, {0, 1}},
             origin, half);
  check_clip({{0.05, 0.05}, {0.1, 0.05}, {0.1, 0.1}, {0.05, 0.1}}, origin, half);
  check_clip({{0.25, 0.25},
              {0.5, 0.25},
              {0.5, 0.3125},
              {0.75, 0.3125},
              {0.75, 0.25},
              {1, 0.25},
              {1, 0.5},
              {0.25, 0.5}},
             origin, half);
}

}  // namespace
}  // namespace mpmfast
