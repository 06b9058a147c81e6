// Outlines: every facet of a solid where it belongs, whatever a polygon begins with; plane ones in their
// plane.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/geometry/outline.hpp"
#include "engine/geometry/polygon.hpp"

namespace mpmfast {
namespace {

const Vec3& point(const Outline& outline, int k) { return outline.points[static_cast<std::size_t>(k)]; }

/// Twice the area of a facet as seen from above, positive where it turns counter-clockwise.
double seen_from_above(const Outline& outline, const Outline::Facet& f) {
  const Vec3 &a = point(outline, f.point[0]), &b = point(outline, f.point[1]),
             &c = point(outline, f.point[2]);
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

TEST_CASE("the lid of a prism covers its polygon once, whichever corner the polygon begins with") {
  // A star of five points: every other corner is sunk in. Its area is that of ten triangles about the centre.
  std::vector<std::array<double, 2>> star;
  for (int k = 0; k < 10; ++k) {
    const double radius = k % 2 == 0 ? 0.4 : 1, angle = 0.1 + k * std::numbers::pi / 5;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  const double area = 10 * 0.5 * 0.4 * std::sin(std::numbers::pi / 5);
  for (int first = 0; first < 10; ++first) {
    CAPTURE(first);
    const Outline solid = outline(PolygonShape{star, 0, 1}, 10, 3);
    double lid = 0;
    for (const auto& f : solid.facets) {
      if (!std::all_of(f.point.begin(), f.point.end(), [&](int k) { return point(solid, k)[2] == 1; }))
        continue;
      CHECK(seen_from_above(solid, f) > 0);
      lid += 0.5 * std::abs(seen_from_above(solid, f));
    }
    CHECK(lid == doctest::Approx(area).epsilon(1e-12));
    std::rotate(star.begin(), star.begin() + 1, star.end());
  }
}

TEST_CASE("the surface of a ball is the same seen from opposite sides") {
  const Outline ball = outline(EllipsoidShape{{0, 0, 0}, {1, 1, 1}, 0}, 0.4, 3);
  for (const Vec3& x : ball.points) {
    CHECK(std::hypot(x[0], x[1], x[2]) == doctest::Approx(1).epsilon(1e-12));
    double nearest = 2;
    for (const Vec3& y : ball.points)
      nearest = std::min(nearest, std::hypot(x[0] + y[0], x[1] + y[1], x[2] + y[2]));
    CHECK(nearest < 1e-12);
  }
}

TEST_CASE("the straight sides of a level of a picture lie between its pixels and the others") {
  constexpr int kWidth = 40, kHeight = 30;
  const int left = 8, right = 27, bottom = 6, top = 21;  // pixels, counted from the lower left corner
  auto image = std::make_shared<GreyImage>();
  image->width = kWidth;
  image->height = kHeight;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      const int y = kHeight - 1 - row;
      const bool in = column >= left && column < right && y >= bottom && y < top;
      image->pixel.push_back(in ? 7 : 200);
    }
  const double pixel_x = 0.5, pixel_y = 0.25;
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{-3, 11, 0}}) {
    const Vec3 end{corner[0] + kWidth * pixel_x, corner[1] + kHeight * pixel_y, 0};
    const Outline level = outline(BitmapShape{"", corner, end, 7, image}, 0.2, 2);
    Vec3 low = end, high = corner;
    for (const Vec3& x : level.points)
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    CHECK(low[0] == doctest::Approx(corner[0] + left * pixel_x).epsilon(1e-12));
    CHECK(high[0] == doctest::Approx(corner[0] + right * pixel_x).epsilon(1e-12));
    CHECK(low[1] == doctest::Approx(corner[1] + bottom * pixel_y).epsilon(1e-12));
    CHECK(high[1] == doctest::Approx(corner[1] + top * pixel_y).epsilon(1e-12));
  }
}

TEST_CASE("a polygon may go straight on through a point and not back, wherever it is and in any direction") {
  for (const double x : {0.0, 5.0, -20.0})
    for (const double y : {0.0, 7.0, -3.0})
      for (int u = -2; u <= 2; ++u)
        for (int v = -2; v <= 2; ++v) {
          if (u == 0 && v == 0) continue;
          CAPTURE(x);
          CAPTURE(y);
          CAPTURE(u);
          CAPTURE(v);
          const auto at = [&](int along, int beside) {
            return std::array<double, 2>{x + along * u - beside * v, y + along * v + beside * u};
          };
          CHECK(polygon_fault({at(-1, 0), at(0, 0), at(1, 0), at(0, 3)}) == "");
          CHECK(polygon_fault({at(-1, 0), at(0, 0), at(0, 3)}) == "");
          for (const int back : {1, 2, 3})
            CHECK(polygon_fault({at(-2, 0), at(0, 0), at(-back, 0), at(0, 3)}).find("at point 1") !=
                  std::string::npos);
        }
}

TEST_CASE("outlines of plane shapes lie in their plane") {
  for (const Shape& shape :
       {Shape(BoxShape{{1, 2, 0}, {4, 4, 0}}), Shape(EllipsoidShape{{1, 2, 0}, {3, 1, 0}, 0.7}),
        Shape(RingShape{{0, 0, 0}, 1, 2, 0}), Shape(PolygonShape{{{0, 0}, {2, 0}, {1, 1}}, 0, 0})})
    for (const Vec3& x : outline(shape, 0.3, 2).points) CHECK(x[2] == 0);
}

}  // namespace
}  // namespace mpmfast
