#pragma once

/// @file The shapes that bodies may have, and which points lie inside them.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace mpmfast {

using Vec3 = std::array<double, 3>;

/// The vector with length 1; one that has it to round-off is kept as it is, so that reading what was written
/// changes nothing. Nothing for a zero vector.
std::optional<Vec3> unit_vector(const Vec3& vector);

struct BoxShape {
  Vec3 lower{}, upper{};
};
/// Disk, sphere, ellipse, ellipsoid: radii along the axes, turned by `angle` about z.
struct EllipsoidShape {
  Vec3 centre{}, radii{};
  double angle{};  ///< rad
};
/// Ring (2-D) or tube along z (3-D, between the z values of lower and upper).
struct RingShape {
  Vec3 centre{};
  double inner{}, outer{};  ///< m
  double half_length{};     ///< m, along z, 3-D only
};
/// Simple closed polygon in the xy plane; in 3-D extruded from z_lower to z_upper.
struct PolygonShape {
  std::vector<std::array<double, 2>> points;  ///< m
  double z_lower{}, z_upper{};
};
/// An 8-bit grey image, row 0 at the top.
struct GreyImage {
  int width{}, height{};
  std::vector<unsigned char> pixel;

  /// Which levels it has.
  std::array<bool, 256> levels() const;
};
/// The pixels of one grey level of an image stretched over a rectangle (2-D).
struct BitmapShape {
  std::filesystem::path file;
  Vec3 lower{}, upper{};  ///< m
  int grey{};             ///< the level that belongs to this body
  std::shared_ptr<const GreyImage> image;
};
/// The inside of a closed surface from an STL file: scaled, turned about an axis through the file's origin,
/// moved (3-D).
struct StlShape {
  std::filesystem::path file;
  double scale = 1;                              ///< m, a length of 1 in the file
  Vec3 axis{0, 0, 1};                            ///< unit
  double angle{};                                ///< rad, right-handed about the axis
  Vec3 translate{};                              ///< m
  std::shared_ptr<const class Surface> surface;  ///< where it lies in the scene
};

using Shape = std::variant<BoxShape, EllipsoidShape, RingShape, PolygonShape, BitmapShape, StlShape>;

/// Is the point inside the shape? Points on the surface count as inside on the lower side only.
bool contains(const Shape& shape, const Vec3& point);

/// Axis-aligned bounds of a shape, m.
struct Bounds {
  Vec3 lower{}, upper{};
};
Bounds bounds(const Shape& shape);

}  // namespace mpmfast
