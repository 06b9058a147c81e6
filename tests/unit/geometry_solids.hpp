#pragma once

/// @file Bodies of triangles, and what is inside them told by angles instead of crossings.

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast::test {

struct Solid {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// How often a closed polygon turns round a point: the sum of the angles under which its edges are seen.
inline double turns_round(const std::vector<std::array<double, 2>>& points, double x, double y) {
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto &a = points[k], &b = points[(k + 1) % points.size()];
    const double ax = a[0] - x, ay = a[1] - y, bx = b[0] - x, by = b[1] - y;
    sum += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  return sum / (2 * std::numbers::pi);
}

/// How often a surface surrounds a point: the sum of the solid angles of its triangles (Van Oosterom and
/// Strackee) over 4π.
inline double surrounded(const std::vector<Vec3>& points,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles, const Vec3& x) {
  double sum = 0;
  for (const auto& t : triangles) {
    double r[3][3], size[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t d = 0; d < 3; ++d) r[k][d] = points[t[k]][d] - x[d];
      size[k] = std::hypot(r[k][0], r[k][1], r[k][2]);
    }
    const auto dot = [&](int a, int b) { return r[a][0] * r[b][0] + r[a][1] * r[b][1] + r[a][2] * r[b][2]; };
    const double triple = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                          r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                          r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    sum += 2 * std::atan2(triple, size[0] * size[1] * size[2] + dot(0, 1) * size[2] + dot(1, 2) * size[0] +
                                      dot(2, 0) * size[1]);
  }
  return sum / (4 * std::numbers::pi);
}

/// A prism over a star of so many tips, from z = −0.5 to 0.7.
inline Solid star_prism(int tips) {
  Solid out;
  const auto n = static_cast<std::uint32_t>(2 * tips);
  for (const double z : {-0.5, 0.7}) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const double angle = std::numbers::pi * k / tips, radius = k % 2 == 0 ? 1.0 : 0.55;
      out.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    out.points.push_back({0, 0, z});
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n, up = n + 1;
    out.triangles.push_back({k, next, next + up});
    out.triangles.push_back({k, next + up, k + up});
    out.triangles.push_back({n, next, k});
    out.triangles.push_back({n + up, k + up, next + up});
  }
  return out;
}

/// A tetrahedron with one long edge.
inline Solid thread_of(double length) {
  return {{{0.1, 0, 0}, {length, 0.3, 0.2}, {0, 0.8, -0.1}, {0.2, 0.1, 0.9}},
          {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}};
}

}  // namespace mpmfast::test
