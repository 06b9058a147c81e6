#pragma once

/// @file Particles that follow the outline of a plane shape.

#include <optional>

#include "engine/geometry/fill.hpp"
#include "engine/geometry/outline.hpp"

namespace mpmfast {

/// Fills a plane shape: one layer of particles along its outline, whose outer faces lie on it, and the grid's
/// lattice inside. Lattice domains that the layer cuts keep the area and the centroid of what is left of
/// them.
///
/// The layer is as deep as the particle spacing d along x. A particle of it that has the length l of the
/// outline, which turns by θ there (positive: convex), has the area l d − ½ θ d² (Steiner's formula). A
/// convex corner that turns by τ has the area d² tan ½τ: as a particle of its own, or several, and at blunt
/// corners as part of the two particles beside it. At a reentrant one these two share the sector ½ d² |τ|. So
/// the areas add up to that of the shape, but for chords in place of arcs: a tenth of a domain at most.
///
/// All domains have one size. At acute corners they reach up to half a spacing beyond the outline.
///
/// No layer fits in shapes with parts thinner than two spacings, with edges too short for their corners, with
/// convex bends of less than a spacing, or with corners sharper than 28 degrees.
///
/// @param outline  of the shape, with points about a spacing / kConformingPoints apart
/// @return particles with angle and share; positions, m. Nothing where no layer fits
std::optional<Seeds> fill_conforming(const Outline& outline, const CellLattice& grid);

/// Points of the outline that fill_conforming wants in a particle spacing. The area of a disk of 16
/// spacings' radius is then exact to 1e-5. Range: 4 to 32; the cost of the layer grows with it.
inline constexpr double kConformingPoints = 8;

}  // namespace mpmfast
