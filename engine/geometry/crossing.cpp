#include "engine/geometry/crossing.hpp"

#include <algorithm>

namespace mpmfast {

namespace {

bool between(const Point2& a, const Point2& b, const Point2& p) {
  return turn(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double c_side = turn(a, b, c), d_side = turn(a, b, d), a_side = turn(c, d, a), b_side = turn(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return between(a, b, c) || between(a, b, d) || between(c, d, a) || between(c, d, b);
}

}  // namespace

bool crosses_itself(const std::vector<Point2>& points) {
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto back = [&](std::size_t from, std::size_t to) {
      return between(points[from], points[k], points[to]);
    };
    if (k + 1 < points.size() && (back(k - 1, k + 1) || back(k + 1, k - 1))) return true;
    for (std::size_t m = 1; m + 1 < k; ++m)
      if (meet(points[m - 1], points[m], points[k - 1], points[k])) return true;
  }
  return false;
}

}  // namespace mpmfast
