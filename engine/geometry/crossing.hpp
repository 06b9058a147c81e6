#pragma once

/// @file Lines in the plane that cross: which side of a crack is a point on, seen from another?

#include <array>
#include <cstddef>
#include <vector>

namespace mpmfast {

using Point2 = std::array<double, 2>;

/// Twice the area of the triangle a, b, c: positive where c lies on the left of a → b.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Is a point on the left of a → b? One on the line itself counts as if it lay a little to the right of where
/// it is, and hardly above: the same whatever segment asks.
inline bool is_left(const Point2& a, const Point2& b, const Point2& x) {
  const double side = turn(a, b, x);
  return side != 0 ? side > 0 : a[1] != b[1] ? b[1] < a[1] : b[0] > a[0];
}

/// Does the way from p to n cross the segment a → b? +1: to its left, −1: to its right, 0: no. Where n lies
/// on the line, or the way meets an end of the segment, it is as if n were moved as in is_left: of a line of
/// segments a way crosses one where it would cross two, or none, with rounding.
inline int crossing(const Point2& p, const Point2& n, const Point2& a, const Point2& b) {
  const auto left_of_way = [&](const Point2& x) {
    const double side = turn(p, n, x);
    return side != 0 ? side > 0 : x[1] != p[1] ? x[1] > p[1] : x[0] <= p[0];
  };
  if (left_of_way(a) == left_of_way(b)) return 0;
  const bool n_left = is_left(a, b, n);
  return is_left(a, b, p) == n_left ? 0 : n_left ? 1 : -1;
}

/// Has an open polyline two segments that cross, or touch elsewhere than neighbours do?
bool crosses_itself(const std::vector<Point2>& points);

}  // namespace mpmfast
