#pragma once

/// @file Constants of penalty contact, each with its unit, meaning and range.

#include <cstdint>

namespace mpmfast::penalty {

/// Points of integration on a facet: the two Gauss points of a segment, exact for cubics, or the centroid of
/// a triangle. Three points on a triangle take twice the time; spheres, cubes and gaps then have the same
/// errors at facets of a cell and more.
template <int Dim>
inline constexpr int kFacetPoints = Dim == 2 ? 2 : 1;

/// Weight of the nearer end in a Gauss point of a segment, –: (1 + 1/√3)/2.
inline constexpr double kGaussWeight = 0.7886751345948129;

/// Approach that candidate lists allow for, cells of the grid: lists hold until a point has moved by half of
/// it. A larger value means longer lists that are rebuilt less often, with the same result. Range: (0, 1].
inline constexpr double kListSkin = 0.4;

/// Patches of one body that a point is projected onto, –. Further ones are left out. Range: at least the
/// number of faces at a corner within a cell.
inline constexpr int kMaxPatches = 8;

/// Patches whose candidates are thinned by their distance, –. A facet with more near it keeps all candidates.
inline constexpr int kMaxListedPatches = 4 * kMaxPatches;

/// Tangential springs that a point keeps from step to step, –: one for each patch that it is in contact with.
/// Range: at least the number of faces at a corner.
inline constexpr int kMaxSprings = 4;

/// Least length of the sum of the facet normals of a vertex normal cone, –. A surface with a shorter sum is
/// folded onto itself, and its normal is undefined. Range: (0, 1).
inline constexpr double kLeastNormalSum = 0.1;

/// Largest Courant number of a step without springs, –. A spring of ω = s ρc²/Δh on the mass of a node adds
/// s (c/Δh)² to the squares of its frequencies, so that this value is divided by √(1 + s). Rings of s = 1, 4
/// and 16 gain energy from 0.75, 0.5 and 0.3 on.
inline constexpr double kCourantNumber = 0.8;

/// Facets or candidate lists up to this number are processed by one thread, –. It affects time only.
inline constexpr std::int64_t kSerialFacets = 256;

}  // namespace mpmfast::penalty
