// Outlines: every facet of a solid where it belongs, whatever a polygon begins with; plane ones in their
// plane.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/geometry/outline.hpp"

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

TEST_CASE("outlines of plane shapes lie in their plane") {
  for (const Shape& shape :
       {Shape(BoxShape{{1, 2, 0}, {4, 4, 0}}), Shape(EllipsoidShape{{1, 2, 0}, {3, 1, 0}, 0.7}),
        Shape(RingShape{{0, 0, 0}, 1, 2, 0}), Shape(PolygonShape{{{0, 0}, {2, 0}, {1, 1}}, 0, 0})})
    for (const Vec3& x : outline(shape, 0.3, 2).points) CHECK(x[2] == 0);
}

}  // namespace
}  // namespace mpmfast
