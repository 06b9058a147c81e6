#pragma once

/// @file The particles that fill a body.

#include <array>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// The lattice of a grid: cubic cells from a corner on, so many particles along the side of each.
struct CellLattice {
  Vec3 origin{}, size{};  ///< m
  double cell{};          ///< m
  std::array<int, 3> particles_per_cell{2, 2, 2};
};

/// Where the particles of a body lie: on a lattice, on rings, or along the outline about a lattice.
enum class SeedingKind { lattice, rings, conforming };
struct Seeding {
  SeedingKind kind = SeedingKind::lattice;
  double angle{};  ///< rad, of the lattice, about z

  /// Do domains lie at an angle to the axes?
  bool turned() const { return kind != SeedingKind::lattice || angle != 0; }
};

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
/// a turned block are smooth; rings (disks and rings only) end on the outline, and so do conforming particles
/// (fill_conforming; a box keeps its own lattice, and so does a rectangle across the grid).
Seeds fill(const Shape& shape, const Seeding& seeding, const CellLattice& grid, int dimension);

}  // namespace mpmfast
