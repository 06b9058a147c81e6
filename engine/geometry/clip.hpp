#pragma once

/// @file Particles cut off at an outline.

#include "engine/geometry/fill.hpp"
#include "engine/geometry/outline.hpp"

namespace mpmfast {

/// Gives the particles of a straight lattice in the plane what the outline leaves of their domains: its area
/// as their share and its centroid as their place, so that linear fields are summed up exactly over the body.
/// Domains with less than half of theirs left go to a neighbour that has more, where there is one.
/// @param origin  a corner of one of the lattice's domains, m
/// @param seeds   whose half-edges are the domains'; all of them are made anew
void clip(const Outline& outline, const Vec3& origin, Seeds& seeds);

}  // namespace mpmfast
