#pragma once

/// @file Numerical constants of cracks. Lengths in cells are multiples of the cell size of the grid. The
/// constants of the integrals at a tip are in kernels/fracture/constants.hpp.

#include <cstddef>
#include <cstdint>

namespace mpmfast::crack_constants {

// Visibility: on which side of a crack a particle lies, for each node that it reaches.

/// Displacement after which the sides are classified again, cells; 0 to kSupportMargin. A larger value delays
/// the effect of a crack end that moves through the grid.
inline constexpr double kReclassify = 0.25;
/// Margin around the support of a particle in which nodes are classified ahead of time, cells. It exceeds
/// kReclassify, since particle domains may grow while they move.
inline constexpr double kSupportMargin = 0.32;
/// Least displacement between two classifications at the start of a run, cells. A crack end that starts on a
/// node leaves the node with the first displacement.
inline constexpr double kFirstReclassify = 1e-5;
/// Share of the displacement since the start that may pass before the next classification; 0 to 1.
inline constexpr double kReclassifyGrowth = 0.5;
/// Segments that share one bounding box. The value changes run time only.
inline constexpr std::size_t kSegmentsPerBox = 16;
/// Tiles that a thread takes at once. The value changes run time only.
inline constexpr std::int64_t kTilesPerShare = 8;
/// Least length of the sum of the unit normals of the crossed segments. A crack that turns back on itself has
/// a smaller sum, and no normal at the node.
inline constexpr double kLeastNormal = 1e-3;

// Motion of crack lines.

/// Least mass of a crack side at a node, relative to a node inside the body. Lighter nodes give no velocity.
inline constexpr double kLeastNodeMass = 1e-3;
/// Relative round-off of the number of pieces into which a straight part of a line is divided.
inline constexpr double kPieceRoundOff = 1e-9;

// Growth.

/// Length that a crack grows straight before it may turn again, cells. The stress on a shorter part is not
/// resolved by the grid.
inline constexpr double kStraight = 3;
/// Length of undamaged bonds between the leading softening bond and the end of a growing crack, cells. The
/// damage of bonds then decides when the crack grows.
inline constexpr double kBondedLength = 4;
/// Least normal traction behind the end at which a bonded crack may turn, relative to the strength; 0 to 1.
inline constexpr double kLeastTraction = 0.1;
/// Distance within which an end joins another crack or an older part of its own, cells.
inline constexpr double kJoin = 1;
/// Part of its own line, behind the end, that an end does not join; multiples of the join distance.
inline constexpr double kOwnLine = 4;
/// Length by which a crack that reaches the outline of its body is extended beyond it, cells.
inline constexpr double kBeyondOutline = 2;
/// Angle above which a new piece counts as a turn, rad.
inline constexpr double kTurn = 0.01;
/// Radius around the former end within which nodes ahead have new crack sides after growth, cells.
inline constexpr double kNewSides = 3;

// Loads at a tip.

/// Length behind an end over which its direction and its tractions are measured, cells.
inline constexpr double kDirection = 2;
/// Relative round-off of lengths along a line.
inline constexpr double kLengthRoundOff = 1e-6;
/// Length over which corners of the line are smoothed, cells.
inline constexpr double kSmoothing = 0.75;
/// Distance of the end from the outline of the body within which the crack has reached the outline, cells.
inline constexpr double kOutline = 1.5;
/// Least radius of the domain of J, cells.
inline constexpr double kLeastRadius = 2;
/// Radius of the domain of J, at most, relative to the distance of the two ends; 0 to 1.
inline constexpr double kOtherEnd = 0.8;
/// Part of the line behind an end that is searched for softening bonds, in radii of the domain of J.
inline constexpr double kSearchRadii = 2;
/// The same part in cells, at least. It exceeds kBondedLength.
inline constexpr double kSearchCells = 8;
/// Damage from which a bond counts as softening; 0 to 1.
inline constexpr double kDamageOnset = 0.02;
/// Half the width of the band along the end in which tractions are averaged, cells.
inline constexpr double kTractionBand = 1;

// Material ahead of a tip: strips across a wedge ahead of it.

/// Length of a strip, cells.
inline constexpr double kStrip = 0.5;
/// Strips that are evaluated at least.
inline constexpr std::size_t kLeastStrips = 4;
/// Half the width of the wedge, relative to the distance from the tip.
inline constexpr double kWedge = 0.5;
/// Share of the area of the wedge above which it counts as filled with material; 0 to 1.
inline constexpr double kFilled = 0.8;
/// Share of the area of the first kLeastStrips strips below which the body ends at the tip; 0 to kFilled.
inline constexpr double kEmpty = 0.4;

}  // namespace mpmfast::crack_constants
