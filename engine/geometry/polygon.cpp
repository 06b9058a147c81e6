#include "engine/geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace mpmfast {

namespace {

using Point = std::array<double, 2>;

/// Twice the signed area of a triangle: positive when c lies left of a → b.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool within_bounds(const Point& a, const Point& b, const Point& c) {
  return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= c[1] &&
         c[1] <= std::max(a[1], b[1]);
}

/// Do the closed segments ab and cd share a point?
bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0)))
    return true;
  return (abc == 0 && within_bounds(a, b, c)) || (abd == 0 && within_bounds(a, b, d)) ||
         (cda == 0 && within_bounds(c, d, a)) || (cdb == 0 && within_bounds(c, d, b));
}

/// Neighbouring edges share their corner; they overlap beyond it when one folds back onto the other.
bool folds_back(const Point& before, const Point& corner, const Point& after) {
  const double along =
      (before[0] - corner[0]) * (after[0] - corner[0]) + (before[1] - corner[1]) * (after[1] - corner[1]);
  return turn(before, corner, after) == 0 && along > 0;
}

}  // namespace

std::string polygon_fault(const Points2& points) {
  constexpr std::size_t kMost = 5000;  // the test below compares every two edges
  const std::size_t n = points.size();
  if (n < 3) return "a polygon has three or more points";
  if (n > kMost) return fmt::format("{} points (at most {})", n, kMost);
  if (points.front() == points.back())
    return "a polygon closes by itself: leave out the last point, it repeats the first";
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = points[i], &b = points[(i + 1) % n];
    if (a == b) return fmt::format("points {} and {} are the same", i, (i + 1) % n);
    if (folds_back(a, b, points[(i + 2) % n]))
      return fmt::format("the outline folds back at point {}", (i + 1) % n);
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours
      if (segments_meet(a, b, points[j], points[(j + 1) % n])) {
        return fmt::format("the outline crosses itself: the edges from point {} and from point {} meet", i,
                           j);
      }
    }
  }
  return "";
}

bool polygon_contains(const Points2& points, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
    // Each edge is taken from its lower end, so that both polygons of a shared edge round alike.
    const bool rising = points[j][1] < points[i][1];
    const Point& lower = rising ? points[j] : points[i];
    const Point& upper = rising ? points[i] : points[j];
    if (y < lower[1] || y >= upper[1]) continue;
    const double crossing = lower[0] + (y - lower[1]) * ((upper[0] - lower[0]) / (upper[1] - lower[1]));
    if (x < crossing) inside = !inside;
  }
  return inside;
}

}  // namespace mpmfast
