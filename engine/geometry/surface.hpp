#pragma once

/// @file A closed surface of triangles, and where lines along x pass through it.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// Where a line enters the surface (from below in x: +1) or leaves it (−1).
struct Crossing {
  double x{};
  int winding{};
};

/// Triangles that close: every edge is passed as often one way as the other. A point is inside where the
/// surface winds round it, so shells may overlap, hold hollows, and be turned inside out as a whole.
class Surface {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of points, counter-clockwise seen from outside

  /// What keeps triangles from enclosing a body: open or crossed edges, no volume. Empty: nothing.
  static std::string fault(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

  /// @param points m; of triangles without a fault.
  Surface(std::vector<Vec3> points, std::vector<Triangle> triangles);

  /// The same, scaled, turned about an axis (unit) through the origin, then moved.
  Surface placed(double scale, const Vec3& axis, double angle, const Vec3& translate) const;

  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Bounds& bounds() const { return bounds_; }

  /// All crossings of the line along x through (y, z), lowest first; their windings sum to zero. Points on
  /// the surface count as inside on the lower side, as of all shapes.
  void crossings(double y, double z, std::vector<Crossing>& out) const;

 private:
  void sort_into_buckets();
  std::size_t bucket_at(double y, double z) const;

  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  Bounds bounds_;
  // Triangles by the cell of a coarse grid in y and z that their bounds touch: a line meets few of them.
  std::array<std::size_t, 2> buckets_{};
  std::vector<std::size_t> first_;  ///< of each bucket, in listed_
  std::vector<std::uint32_t> listed_;
};

/// Does the surface wind round a point of which these are the line's crossings?
bool wound_round(std::span<const Crossing> crossings, double x);

/// Volume that a closed surface winds round (negative when it is inside out).
double enclosed_volume(const std::vector<Vec3>& points, const std::vector<Surface::Triangle>& triangles);

}  // namespace mpmfast
