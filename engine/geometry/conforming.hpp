#pragma once

/// @file Particles that follow the outline of a plane shape.

#include "engine/geometry/fill.hpp"
#include "engine/geometry/outline.hpp"

namespace mpmfast {

/// Fills a plane shape: one layer of particles along its outline, whose domains lie along it and end on it,
/// and the grid's lattice inside, of which each domain at the layer has its exact area and centroid.
///
/// The layer is one particle spacing d deep. A particle of it that has the length l of the outline, which
/// turns by θ there, has the area l d − ½ θ d² (Steiner's formula), and a convex corner that turns by τ the
/// area d² tan ½τ. So the areas of all particles add up to that of the shape.
///
/// A shape with parts thinner than two spacings, or with edges too short for their corners, gets no layer:
/// its lattice is cut off at the outline.
///
/// @param outline  of the shape, with points at most kConformingPoints spacings apart
/// @return particles with angle and share; positions, m
Seeds fill_conforming(const Outline& outline, const CellLattice& grid);

/// Points of the outline that fill_conforming wants in a particle spacing. The area of a circle of 16
/// spacings is then exact to 1e-5. Range: 4 to 32; the cost of the layer grows with it.
inline constexpr double kConformingPoints = 8;

}  // namespace mpmfast
