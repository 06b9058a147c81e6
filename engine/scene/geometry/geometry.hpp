#pragma once

/// @file Points inside shapes, and the particles that fill a body.

#include <memory>
#include <vector>

#include "engine/scene/scene.hpp"

namespace mpmfast {

/// An 8-bit grey image, row 0 at the top.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<unsigned char> pixel;
};

/// Is the point inside the shape? Points on the surface count as inside on the lower side only.
bool contains(const Shape& shape, const Vec3& point);

/// Axis-aligned bounds of a shape, m.
struct Bounds {
  Vec3 lower{}, upper{};
};
Bounds bounds(const Shape& shape);

/// The particles that fill a body: where they are, and their undeformed domains.
struct Seeds {
  std::vector<Vec3> position;  ///< m
  Vec3 half_size{};            ///< m, half-edges of every domain
  std::vector<double> angle;   ///< rad, about z, of each domain; empty: all lie along the axes
  std::vector<double> share;   ///< volume of each particle over that of the domain; empty: 1
};

/// Fills a body with particles_per_cell particles per cell side. A box gets a lattice of its own that ends on
/// its faces (spacing = edge / round(edge / h)), so that its volume is exact; every other shape keeps the
/// points of the grid's lattice (cell / particles_per_cell, from the grid's origin) that lie inside it. A
/// turned lattice ends on the faces of the box around the shape that is turned alike, so that the surfaces of
/// a turned block are smooth; rings (disks and rings only) end on the outline.
Seeds fill(const BodySpec& body, const GridSpec& grid, int dimension);

}  // namespace mpmfast
