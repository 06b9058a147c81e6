#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/fill.hpp"
#include "engine/geometry/surface.hpp"

using namespace mpmfast;

namespace {

constexpr CellLattice kGrid{{0, 0, 0}, {1, 1, 1}, 0.02};
constexpr Seeding kAlong;  // the axes

/// What the particles' domains cover together.
double measure(const Seeds& seeds, int dimension) {
  double each = 1;
  for (int k = 0; k < dimension; ++k) each *= 2 * seeds.half_size[static_cast<std::size_t>(k)];
  return each * static_cast<double>(seeds.position.size());
}

/// A lattice of spacing h misjudges at most the cells that the outline cuts: fewer than perimeter/h × √2 + 4,
/// each in error by less than h²; in truth the errors cancel like a random walk, so half of that is a test
/// that can fail.
double area_slack(double perimeter, double h) {
  return 0.5 * (perimeter * h * std::numbers::sqrt2 + 4 * h * h);
}

std::shared_ptr<GreyImage> stripes(int width, int height, int levels) {
  auto image = std::make_shared<GreyImage>();
  image->width = width;
  image->height = height;
  for (int i = 0; i < width * height; ++i)
    image->pixel.push_back(static_cast<unsigned char>(i % width * levels / width));
  return image;
}

}  // namespace

TEST_CASE("a box is filled exactly, whatever its place and size") {
  for (const Vec3& upper : {Vec3{0.313, 0.5, 0.77}, Vec3{0.105, 0.9, 0.11}, Vec3{0.1001, 0.1001, 0.1001}}) {
    const BoxShape box{{0.1, 0.07, 0.09}, upper};
    const Seeds flat = fill(box, kAlong, kGrid, 2),
                solid = fill(box, kAlong, {{0, 0, 0}, {1, 1, 1}, 0.02, {1, 2, 3}}, 3);
    const double area = (upper[0] - 0.1) * (upper[1] - 0.07);
    CHECK(measure(flat, 2) == doctest::Approx(area).epsilon(1e-13));
    CHECK(measure(solid, 3) == doctest::Approx(area * (upper[2] - 0.09)).epsilon(1e-13));
    CHECK(flat.position.front()[0] - flat.half_size[0] == doctest::Approx(0.1).epsilon(1e-14));
    CHECK(flat.position.back()[1] + flat.half_size[1] == doctest::Approx(upper[1]).epsilon(1e-14));
  }
}

TEST_CASE("a box on the grid's lattice has particles_per_cell particles a side in each cell") {
  const Seeds seeds =
      fill(BoxShape{{0.2, 0.2, 0}, {0.4, 0.3, 0}}, kAlong, {{0, 0, 0}, {1, 1, 1}, 0.02, {2, 3, 1}}, 2);
  CHECK(seeds.position.size() == 10u * 2u * 5u * 3u);
  CHECK(seeds.half_size[0] == doctest::Approx(0.005));
  CHECK(seeds.half_size[2] == 0);
  CHECK(seeds.position[0] == Vec3{0.2 + seeds.half_size[0], 0.2 + seeds.half_size[1], 0});
}

TEST_CASE("the area of every plane shape is right to its lattice") {
  const double h = 0.01;
  const auto area = [](const Shape& shape) { return measure(fill(shape, kAlong, kGrid, 2), 2); };
  const double pi = std::numbers::pi;
  CHECK(std::abs(area(EllipsoidShape{{0.503, 0.497, 0}, {0.3, 0.3, 0}, 0}) - pi * 0.09) <
        area_slack(2 * pi * 0.3, h));
  CHECK(std::abs(area(EllipsoidShape{{0.5, 0.5, 0}, {0.4, 0.1, 0}, 0.7}) - pi * 0.04) < area_slack(1.8, h));
  CHECK(std::abs(area(RingShape{{0.5, 0.5, 0}, 0.2, 0.3, 0}) - pi * 0.05) < area_slack(2 * pi * 0.5, h));
  CHECK(std::abs(area(PolygonShape{{{0.1, 0.1}, {0.9, 0.2}, {0.5, 0.8}}, 0, 0}) - 0.26) < area_slack(2.3, h));
}

TEST_CASE("the volume of every solid shape is right to its lattice") {
  const auto volume = [](const Shape& shape) { return measure(fill(shape, kAlong, kGrid, 3), 3); };
  const double pi = std::numbers::pi;
  CHECK(volume(EllipsoidShape{{0.5, 0.5, 0.5}, {0.3, 0.3, 0.3}, 0}) ==
        doctest::Approx(4 * pi / 3 * 0.027).epsilon(2e-3));
  CHECK(volume(EllipsoidShape{{0.5, 0.5, 0.5}, {0.4, 0.2, 0.1}, 0.4}) ==
        doctest::Approx(4 * pi / 3 * 0.008).epsilon(5e-3));
  CHECK(volume(RingShape{{0.5, 0.5, 0.5}, 0.2, 0.3, 0.1}) == doctest::Approx(pi * 0.05 * 0.2).epsilon(5e-3));
  CHECK(volume(PolygonShape{{{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.5}, {0.1, 0.5}}, 0.2, 0.4}) ==
        doctest::Approx(0.064).epsilon(1e-9));
}

TEST_CASE("every particle of a fill lies inside the shape and inside its bounds") {
  const Shape ellipse = EllipsoidShape{{0.5, 0.5, 0}, {0.4, 0.1, 0}, 0.7};
  const Bounds box = bounds(ellipse);
  for (const Vec3& point : fill(ellipse, kAlong, kGrid, 2).position) {
    CHECK(contains(ellipse, point));
    CHECK((point[0] > box.lower[0] && point[0] < box.upper[0] && point[1] > box.lower[1] &&
           point[1] < box.upper[1]));
  }
  // The turned ellipse's extreme abscissa is sqrt(a² cos² + b² sin²).
  CHECK(box.upper[0] - 0.5 ==
        doctest::Approx(std::sqrt(0.16 * std::pow(std::cos(0.7), 2) + 0.01 * std::pow(std::sin(0.7), 2))));
}

TEST_CASE("a shape that reaches beyond the grid is filled as far as the grid goes") {
  const CellLattice grid{{1, 2, 3}, {0.5, 0.4, 0.3}, 0.1};
  // The cube from 0 to 5: corners by the bits of their number, each face as two triangles seen from outside.
  std::vector<Vec3> corners;
  for (int c = 0; c < 8; ++c) corners.push_back({5.0 * (c & 1), 5.0 * (c >> 1 & 1), 5.0 * (c >> 2 & 1)});
  const std::vector<Surface::Triangle> faces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                             {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                             {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  REQUIRE(Surface::fault(corners, faces).empty());
  StlShape cube;
  cube.surface = std::make_shared<Surface>(corners, faces);
  auto image = std::make_shared<GreyImage>();
  image->width = image->height = 1;
  image->pixel = {7};
  const std::vector<std::array<double, 2>> square{{0, 0}, {5, 0}, {5, 5}, {0, 5}};
  const auto fills = [&](const Shape& shape, int dimension) {
    const auto position = fill(shape, kAlong, grid, dimension).position;
    CHECK(position.size() == (dimension == 3 ? 10u * 8u * 6u : 10u * 8u));
    for (const Vec3& point : position)
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
        CHECK((point[k] > grid.origin[k] && point[k] < grid.origin[k] + grid.size[k]));
  };
  fills(EllipsoidShape{{1, 2, 0}, {3, 3, 0}, 0}, 2);
  fills(RingShape{{0, 0, 0}, 1, 9, 0}, 2);
  fills(PolygonShape{square, 0, 0}, 2);
  fills(BitmapShape{"", {0, 0, 0}, {5, 5, 0}, 7, image}, 2);
  fills(EllipsoidShape{{1, 2, 3}, {3, 3, 3}, 0}, 3);
  fills(RingShape{{0, 0, 3}, 1, 9, 4}, 3);
  fills(PolygonShape{square, 0, 5}, 3);
  fills(cube, 3);
}

TEST_CASE("shapes that share a face share no particle and leave none out") {
  const Shape left = PolygonShape{{{0, 0}, {0.613, 0.1}, {0.4, 1}, {0, 1}}, 0, 0};
  const Shape right = PolygonShape{{{0, 0}, {1, 0}, {1, 1}, {0.4, 1}, {0.613, 0.1}}, 0, 0};
  const std::size_t total =
      fill(left, kAlong, kGrid, 2).position.size() + fill(right, kAlong, kGrid, 2).position.size();
  CHECK(total == 100u * 100u);
  const Shape disk = EllipsoidShape{{0.5, 0.5, 0}, {0.2, 0.2, 0}, 0},
              ring = RingShape{{0.5, 0.5, 0}, 0.2, 0.3, 0};
  const Shape both = EllipsoidShape{{0.5, 0.5, 0}, {0.3, 0.3, 0}, 0};
  CHECK(fill(disk, kAlong, kGrid, 2).position.size() + fill(ring, kAlong, kGrid, 2).position.size() ==
        fill(both, kAlong, kGrid, 2).position.size());
}

TEST_CASE("points on a surface belong to the lower side") {
  const Shape box = BoxShape{{0, 0, 0}, {1, 1, 0}};
  CHECK(contains(box, {0, 0, 0}));
  CHECK_FALSE(contains(box, {1, 0.5, 0}));
  CHECK_FALSE(contains(box, {0.5, 1, 0}));
  const Shape disk = EllipsoidShape{{0, 0, 0}, {1, 1, 0}, 0};
  CHECK(contains(disk, {-1, 0, 0}));
  CHECK(contains(disk, {0, -1, 0}));
  CHECK_FALSE(contains(disk, {1, 0, 0}));
  CHECK_FALSE(contains(disk, {0, 1, 0}));
  const Shape square = PolygonShape{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0, 0};
  CHECK(contains(square, {0, 0.5, 0}));
  CHECK(contains(square, {0.5, 0, 0}));
  CHECK_FALSE(contains(square, {1, 0.5, 0}));
  CHECK_FALSE(contains(square, {0.5, 1, 0}));
}

TEST_CASE("the ends of a turned ellipse belong to the lower side too") {
  const EllipsoidShape upright{{0, 0, 0}, {2, 1, 0}, std::numbers::pi / 2};
  for (const double y : {-1e-9, 1e-9}) {  // on the surface: what they are off it is below the last digit
    CHECK(contains(upright, {-1, y, 0}));
    CHECK_FALSE(contains(upright, {1, y, 0}));
  }
}

TEST_CASE("a bitmap's row 0 is its top, and a point belongs to its pixel") {
  auto image = std::make_shared<GreyImage>();
  image->width = 2;
  image->height = 2;
  image->pixel = {1, 2, 3, 4};
  const auto grey_at = [&](const Vec3& point) {
    for (int grey = 1; grey <= 4; ++grey) {
      if (contains(BitmapShape{"", {0, 0, 0}, {2, 1, 0}, grey, image}, point)) return grey;
    }
    return 0;
  };
  CHECK(grey_at({0.5, 0.9, 0}) == 1);
  CHECK(grey_at({1.5, 0.9, 0}) == 2);
  CHECK(grey_at({0.5, 0.1, 0}) == 3);
  CHECK(grey_at({1.5, 0.1, 0}) == 4);
  CHECK(grey_at({1, 0, 0}) == 4);
  CHECK(grey_at({2, 0.5, 0}) == 0);
  const Bounds box = bounds(BitmapShape{"", {0, 0, 0}, {2, 1, 0}, 2, image});
  CHECK(box.lower == Vec3{1, 0.5, 0});
  CHECK(box.upper == Vec3{2, 1, 0});
}

TEST_CASE("the bounds of a level are those of its pixels, wherever the bitmap lies") {
  auto image = std::make_shared<GreyImage>();
  image->width = 8;
  image->height = 4;
  image->pixel.assign(32, 0);
  image->pixel[8 + 2] = image->pixel[16 + 4] = 9;  // of the rows 1 and 2 from the top, the columns 2 and 4
  image->pixel[0] = 1;
  image->pixel[31] = 2;
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{3, 5, 0}, Vec3{-16, -32, 0}, Vec3{-1, -1, 0}}) {
    const double x = corner[0], y = corner[1];  // pixels are 1/4 wide and 1/2 high
    const auto of_level = [&](int grey) {
      return bounds(BitmapShape{"", corner, {x + 2, y + 2, 0}, grey, image});
    };
    CHECK(of_level(9).lower == Vec3{x + 0.5, y + 0.5, 0});
    CHECK(of_level(9).upper == Vec3{x + 1.25, y + 1.5, 0});
    CHECK(of_level(1).lower == Vec3{x, y + 1.5, 0});
    CHECK(of_level(1).upper == Vec3{x + 0.25, y + 2, 0});
    CHECK(of_level(2).lower == Vec3{x + 1.75, y, 0});
    CHECK(of_level(2).upper == Vec3{x + 2, y + 0.5, 0});
    CHECK(of_level(0).lower == corner);
    CHECK(of_level(0).upper == Vec3{x + 2, y + 2, 0});
    CHECK(of_level(77).lower == of_level(77).upper);
    CHECK(of_level(77).lower == corner);
  }
}

TEST_CASE("the levels of a bitmap share out all particles") {
  const auto image = stripes(100, 400, 20);
  const CellLattice grid{{0, 0, 0}, {1, 1, 0}, 0.01};
  std::size_t total = 0;
  for (int grey = 0; grey < 20; ++grey)
    total += fill(BitmapShape{"", {0, 0, 0}, {1, 1, 0}, grey, image}, kAlong, grid, 2).position.size();
  CHECK(total == 40000u);
}

TEST_CASE("a turned lattice fills a turned block exactly, row upon row from its faces") {
  const double angle = 0.7, cosine = std::cos(angle), sine = std::sin(angle);
  const auto at = [&](double u, double v) {
    return std::array<double, 2>{0.5 + cosine * u - sine * v, 0.5 + sine * u + cosine * v};
  };
  const double u = 0.213, v = 0.117;  // half-edges
  const PolygonShape block{{at(-u, -v), at(u, -v), at(u, v), at(-u, v)}, 0, 0};
  const Seeds seeds = fill(block, {SeedingKind::lattice, angle}, kGrid, 2);
  CHECK(measure(seeds, 2) == doctest::Approx(4 * u * v).epsilon(1e-12));
  CHECK(seeds.angle == std::vector<double>(seeds.position.size(), angle));
  for (const Vec3& x : seeds.position) {  // the distance from the lower face is an odd number of half-edges
    const double rows = (cosine * (x[1] - 0.5) - sine * (x[0] - 0.5) + v) / (2 * seeds.half_size[1]) + 0.5;
    CHECK(rows == doctest::Approx(std::round(rows)).epsilon(1e-10));
  }
  CHECK(std::abs(measure(fill(block, kAlong, kGrid, 2), 2) - 4 * u * v) > 1e-5);  // stairs
}

TEST_CASE("a turned lattice keeps the area of every shape, in solids too") {
  const auto turned = [](const Shape& shape, int dimension) {
    const Seeds seeds = fill(shape, {SeedingKind::lattice, -0.4}, kGrid, dimension);
    for (const Vec3& point : seeds.position) CHECK(contains(shape, point));
    return measure(seeds, dimension);
  };
  const double pi = std::numbers::pi, h = 0.01;
  CHECK(std::abs(turned(BoxShape{{0.3, 0.3, 0}, {0.6, 0.5, 0}}, 2) - 0.06) < area_slack(1, h));
  CHECK(std::abs(turned(EllipsoidShape{{0.5, 0.5, 0}, {0.3, 0.1, 0}, 0.7}, 2) - pi * 0.03) <
        area_slack(1.4, h));
  CHECK(std::abs(turned(RingShape{{0.5, 0.5, 0}, 0.1, 0.2, 0}, 2) - pi * 0.03) < area_slack(0.6 * pi, h));
  CHECK(turned(BoxShape{{0.4, 0.4, 0.4}, {0.6, 0.6, 0.5}}, 3) == doctest::Approx(0.004).epsilon(0.01));
}

TEST_CASE("rings of particles hold the area of a disk or a ring exactly, and end on its outline") {
  for (const double inner : {0.0, 0.113}) {
    const double outer = 0.237;
    const Vec3 centre{0.41, 0.52, 0};
    const Shape shape = inner > 0 ? Shape(RingShape{centre, inner, outer, 0})
                                  : Shape(EllipsoidShape{centre, {outer, outer, 0}, 0});
    const Seeds seeds = fill(shape, {SeedingKind::rings}, kGrid, 2);
    double shares = 0, nearest = 1, furthest = 0;
    Vec3 mean{};
    for (std::size_t k = 0; k < seeds.position.size(); ++k) {
      const double x = seeds.position[k][0] - centre[0], y = seeds.position[k][1] - centre[1];
      const double radius = std::hypot(x, y);
      nearest = std::min(nearest, radius);
      furthest = std::max(furthest, radius);
      shares += seeds.share[k];
      mean[0] += seeds.share[k] * x;
      mean[1] += seeds.share[k] * y;
      CHECK(std::remainder(seeds.angle[k] - std::atan2(y, x), 2 * std::numbers::pi) ==
            doctest::Approx(0).epsilon(1e-12));
      CHECK(std::abs(seeds.share[k] - 1) < 0.1);  // nearly squares, the few about the centre too
    }
    const double area = std::numbers::pi * (outer * outer - inner * inner);
    CHECK(shares * 4 * seeds.half_size[0] * seeds.half_size[1] == doctest::Approx(area).epsilon(1e-12));
    CHECK(furthest + seeds.half_size[0] == doctest::Approx(outer).epsilon(1e-12));
    CHECK(nearest - seeds.half_size[0] == doctest::Approx(inner).epsilon(1e-12));
    CHECK(std::hypot(mean[0], mean[1]) < 1e-12 * shares);
  }
}

TEST_CASE("every place of a bitmap goes to one level even where it lies on the corner of four pixels") {
  // Places and pixels as in a packing: 4 x 4 or 2 x 2 pixels to a place. Counted from each level's own corner
  // the places would differ by round-off, and some would go to two levels and some to none.
  auto image = std::make_shared<GreyImage>();
  image->width = 280;
  image->height = 560;
  for (int row = 0; row < 560; ++row)
    for (int column = 0; column < 280; ++column)
      image->pixel.push_back(static_cast<unsigned char>((row / 22 * 13 + column / 26 * 7) % 50));
  for (const int cells : {35, 70}) {
    const CellLattice grid{{0, 0, 0}, {1e-3, 2e-3, 0}, 1e-3 / cells};
    std::vector<Vec3> positions;
    for (int grey = 0; grey < 50; ++grey) {
      const Seeds seeds = fill(BitmapShape{"", {0, 0, 0}, {1e-3, 2e-3, 0}, grey, image}, kAlong, grid, 2);
      positions.insert(positions.end(), seeds.position.begin(), seeds.position.end());
    }
    const auto number = static_cast<std::size_t>(8 * cells * cells);
    CHECK(positions.size() == number);
    std::sort(positions.begin(), positions.end());
    CHECK(std::unique(positions.begin(), positions.end()) == positions.end());
  }
}
