#pragma once

/// @file The surface of a shape as points and the facets between them.

#include <cstdint>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// The joint of two neighbouring facets, at an end in 2-D or an edge in 3-D: smooth, or a convex or reentrant
/// crease.
enum class Joint : std::uint8_t { smooth, convex, reentrant };

/// A closed surface. In 2-D it consists of segments a → b with the material on their left, in 3-D of
/// triangles that turn counter-clockwise seen from outside.
struct Outline {
  struct Facet {
    std::array<int, 3> point{-1, -1, -1};  ///< in 2-D the first two
    std::array<Joint, 3> joint{};          ///< 2-D: at these points; 3-D: of the edges opposite them
    int patch{};                           ///< the smooth part between creases that it belongs to
  };
  std::vector<Vec3> points;  ///< m
  std::vector<Facet> facets;
  int patches{};  ///< how many there are
};

/// Least angle between the normals of facets at a crease, rad. A larger value rounds sharp edges off; a
/// smaller one makes creases of coarsely divided arcs. Range: (0, π/2).
inline constexpr double kCrease = 0.5;

/// What an outline in the plane holds, m².
double plane_area(const Outline& outline);

/// The surface of a shape, with its corners.
/// @param spacing  about the distance of neighbouring points, m
Outline outline(const Shape& shape, double spacing, int dimension);

}  // namespace mpmfast
