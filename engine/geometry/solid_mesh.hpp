#pragma once

/// @file Meshes of triangles on the surface of solids.

#include <array>
#include <cmath>
#include <vector>

#include "engine/geometry/polygon.hpp"
#include "engine/geometry/shapes.hpp"

namespace mpmfast::solid_mesh {

using Triangle = std::array<int, 3>;  ///< numbers of points, counter-clockwise seen from outside

inline Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Mesh {
  std::vector<Vec3> points;  ///< m
  std::vector<Triangle> triangles;

  const Vec3& at(int point) const { return points[static_cast<std::size_t>(point)]; }
  int add(const Vec3& point) {
    points.push_back(point);
    return static_cast<int>(points.size()) - 1;
  }
  /// Adds the two triangles a b c and a c d.
  void add_quad(int a, int b, int c, int d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  /// Unit normal of a triangle; zero of one without area.
  Vec3 normal(const Triangle& t) const {
    Vec3 n = cross(minus(at(t[1]), at(t[0])), minus(at(t[2]), at(t[0])));
    const double size = length(n);
    for (double& c : n) c /= size > 0 ? size : 1;
    return n;
  }
};

/// Halves edges until none is much longer than `spacing`, m. Both triangles at an edge are cut at its
/// midpoint, so that the surface stays closed.
void refine(Mesh& mesh, double spacing);

/// A prism over a simple polygon. @param base  in either direction, m
Mesh prism(Points2 base, double lower, double upper);

/// A unit sphere: the faces of an icosahedron, each divided into n² triangles and projected onto the sphere.
Mesh unit_sphere(long n);

}  // namespace mpmfast::solid_mesh
