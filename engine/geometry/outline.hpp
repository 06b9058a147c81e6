#pragma once

/// @file The surface of a shape as points and the facets between them.

#include <cstdint>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// What a facet is at one of its ends (2-D) or edges (3-D): it goes over smoothly into its neighbour, or
/// there is a crease between them that sticks out or is sunk in.
enum class Joint : std::uint8_t { smooth, convex, reentrant };

/// A closed surface: in 2-D segments a → b with the material on their left, in 3-D triangles that turn
/// counter-clockwise seen from outside.
struct Outline {
  struct Facet {
    std::array<int, 3> point{-1, -1, -1};  ///< of 2-D the first two
    std::array<Joint, 3> joint{};          ///< 2-D: at these points; 3-D: of the edges opposite them
    int piece{};                           ///< smooth parts between creases
  };
  std::vector<Vec3> points;  ///< m
  std::vector<Facet> facets;
  int pieces{};
};

/// Facets whose normals are further apart than this meet in a crease, rad.
inline constexpr double kCrease = 0.5;

/// Points at about `spacing` (m) along the surface, corners kept.
Outline outline(const Shape& shape, double spacing, int dimension);

}  // namespace mpmfast
