#pragma once

/// @file The numbers that the engine decides by: value, unit, meaning, range, and what moves with each. Cells
/// are multiples of the cell size of the grid. A number without a unit is a ratio. Those of kernels are in
/// kernels/constants.hpp.

#include <chrono>
#include <cstddef>
#include <cstdint>

/// Work of threads. These values change run time only; each is at least 1.
namespace mpmfast::constants::threads {

// A loop with no more items than these runs on one thread, since other threads would wait more than work.

/// Contact nodes with a pass over their pairs.
inline constexpr std::int64_t kFewNodes = 256;
/// Contact nodes whose impulses, springs or heat flows are solved.
inline constexpr std::int64_t kFewSolved = 64;
/// Nodes, pairs or slots of which little is copied or added.
inline constexpr std::int64_t kFewCopies = 1024;
/// Nodes with conditions.
inline constexpr std::int64_t kFewConstrained = 128;
/// Nodes that follow a block of an extended spline.
inline constexpr std::int64_t kFewFollowing = 1000;
/// Particles that are sorted.
inline constexpr std::size_t kFewParticles = 4096;
/// Node blocks or tiles with little work in each.
inline constexpr std::size_t kFewBlocks = 64;
/// Node blocks or tiles with more work in each: loads, gaps to walls, extension.
inline constexpr std::int64_t kFewBusyBlocks = 16;
/// Node blocks whose normals are fitted.
inline constexpr std::int64_t kFewFittedBlocks = 4;
/// Stretches of a long array (for_each_block).
inline constexpr std::int64_t kFewStretches = 4;

// Items that a thread takes at once. More: fewer accesses to the shared counter, and threads that wait longer
// for the last one.

/// Node blocks whose fits are checked.
inline constexpr std::int64_t kBlocksAtOnce = 8;
/// Contact nodes that are solved.
inline constexpr std::int64_t kSolvedAtOnce = 32;
/// Tiles of particles that deform.
inline constexpr std::int64_t kTilesAtOnce = 4;
/// Slots of a nodal column, a multiple of kTileNodes.
inline constexpr std::int64_t kSlotsAtOnce = 512;
/// Particles whose stress is found.
inline constexpr std::int64_t kStressesAtOnce = 1024;
/// Particles whose edges are measured.
inline constexpr std::int64_t kEdgesAtOnce = 4096;
/// Portions of the tiles for each thread in the extension of splines. Tiles at outlines have most work.
inline constexpr int kPortionsPerThread = 16;
/// Nodes of a slab of fits for each thread: few waits at its end. All nodes of its blocks count, also those
/// that are not due. More: more memory for clouds.
inline constexpr std::size_t kSlabNodesPerThread = 256;

/// Particles for each thread of a step. Scenes with fewer use fewer threads.
inline constexpr std::size_t kParticlesPerThread = 1000;

// How a thread waits (state/thread_team.cpp). More turns: faster answers, and less time for other programs.

/// Turns in which a thread spins, some 10 µs.
inline constexpr int kSpins = 200;
/// Turns in which it then yields the processor, some 5 ms.
inline constexpr int kYields = 10000;
/// Duration of a turn from which on others need the processor, µs.
inline constexpr auto kLongTurn = std::chrono::microseconds(300);
/// Waits within which a second long turn puts the thread to sleep.
inline constexpr int kAlertWaits = 1000;
/// Waits in which the thread then sleeps at once.
inline constexpr int kSleepingWaits = 100;

}  // namespace mpmfast::constants::threads

/// Tiles and their strips. Another value may change the order of sums, and with it results by round-off.
namespace mpmfast::constants::tiling {

/// Strips of a colour that the length of a strip aims at; at least 1. More: shorter strips.
inline constexpr int kStripsOfColour = 32;
/// Rows of tiles of a colour from which a strip is a whole row; half of the colours suffice.
inline constexpr int kFewestRows = 16;
/// Length of a strip, tiles. Short strips leave more threads something to do, long ones read memory as it
/// lies.
inline constexpr int kShortestStrip = 4, kLongestStrip = 64;
/// Tiles from which a strip may have several rows.
inline constexpr int kManyTiles = 2048;
/// Node tiles that are compared one by one before a search. The value changes run time only.
inline constexpr int kTilesAhead = 4;

}  // namespace mpmfast::constants::tiling

/// Splitting of particles with long domains.
namespace mpmfast::constants::splitting {

/// Halvings of a particle along one direction of its undeformed domain, at most; 1 to 20, since shares are
/// powers of two. A stretch of 16 times that of the first split is a filament, and each level doubles its
/// cost.
inline constexpr int kMostHalvings = 4;
/// Displacement of particles after which their edges are measured again, cells; 0 to 0.5. The ends of a
/// domain move with them, so that an edge grows by twice this value at most.
inline constexpr double kCheckDistance = 0.125;

}  // namespace mpmfast::constants::splitting

/// The time step and the sort.
namespace mpmfast::constants::step {

/// Least step, relative to the time at the end; above 1e-16. A shorter one makes no progress in time.
inline constexpr double kLeastStep = 1e-12;
/// Displacement of particles after which their distance from their cells is checked, cells; up to 1 less the
/// distance below. The second value is for contact clouds, cracks and CPDI domains.
inline constexpr double kCheckTravel = 0.45, kCheckTravelOfClouds = 0.5;
/// Distance from its cell up to which a particle need not be sorted, cells; 0 to 1. Smaller: more sorts. With
/// clouds, cracks and CPDI domains, a quarter of a cell is kept for the growth of domains.
inline constexpr double kNearHome = 0.5, kNearHomeOfClouds = 0.25;
/// Temperature at or below which a particle has failed, K: any that is not positive.
inline constexpr double kLeastTemperature = 1e-300;
/// Velocity fields up to which no cell is crowded.
inline constexpr std::size_t kFewFields = 32;

}  // namespace mpmfast::constants::step

/// Extended splines (step/extension.hpp).
namespace mpmfast::constants::extension {

/// Most Σ_J E_IJ² m_J of a node that others follow, relative to its mass m_I + Σ_J E_IJ m_J; 0 to 1. Beyond
/// 1, velocities grow that go to the particles and back. Of 360 disks and boxes at occupations from 0.5 to
/// 0.75, the largest eigenvalue of S⁺S is 1 in all below 0.91, and above 1 in all beyond 1. Smaller: more
/// nodes follow with one order less.
inline constexpr double kMostThrown = 0.9;
/// Length of a cell between walls, relative to the cell, down to which the cell counts as occupied; 0 to 1.
/// A thinner sliver has too few particles.
inline constexpr double kLeastInside = 0.25;
/// Round-off of the share of a cell that is occupied; above 1e-15. A share that is met exactly is not
/// exceeded.
inline constexpr double kOccupationRoundOff = 1e-9;
/// Difference of two distances below which they are equal, cells; above 1e-15. Blocks at equal distances
/// share a node.
inline constexpr double kEqualDistances = 1e-9;

}  // namespace mpmfast::constants::extension

/// Seeding, and properties that follow from the scene.
namespace mpmfast::constants::plan {

/// Most stiffness of interface springs, relative to the modulus of the stiffest body over a cell; above 10.
/// Stiffer ones are reduced to it, and yield by a hundredth of what a cell does. Springs of 500 in
/// compression and none in tension make energy.
inline constexpr double kMostStiffness = 100;
/// Stiffness in the same unit from which on surfaces are tied, if all of their springs have it; above
/// kMostStiffness.
inline constexpr double kTiedStiffness = 1000;
/// Initial stiffness of bonds in the same unit, where a scene gives none; up to kMostStiffness.
inline constexpr double kBondStiffness = 10;
/// Least initial stiffness of bonds, relative to the one with which they break at once at their strength;
/// above 1.
inline constexpr double kBrittleStiffness = 1.01;
/// Share of the impulse of walls that FLIP's particles take at once, where velocities are re-extrapolated; 0
/// to 1. Smaller: bars keep more energy (all but 0.02 % with 0), and pistons leave more noise. The stress of
/// the uniaxial case errs by 0.12 % with 0, by 0.10 % with 0.009 and by 0.08 % with 0.02.
inline constexpr double kWallShare = 0.009;
/// Mass and volume of the boundary points, relative to the layer of cells along the surface; 0 to 0.1. At
/// most they have this share of the body. K24 §3.5 has it of the body: a disk of 80 cells then has 2.4 % too
/// much material at its surface, and a stress 5 % too low.
inline constexpr double kBoundaryShare = 1e-3;
/// Distance outside the grid from which a boundary point is moved to its edge, cells; above round-off.
inline constexpr double kOutsideTolerance = 1e-6;
/// Particles that splits may add, relative to those at the start, in estimates of memory; 0 or more. With 1,
/// each particle is halved once.
inline constexpr double kSplitAllowance = 1;
/// Bodies above which the estimate counts all particles as near other bodies.
inline constexpr std::size_t kManyBodies = 32;

}  // namespace mpmfast::constants::plan

/// Prescribed velocities and walls.
namespace mpmfast::constants::conditions {

/// 1 − |cos| of the angle between two directions below which they are one; above 1e-15.
inline constexpr double kParallel = 1e-12;
/// Length of a unit direction without its projections on the others below which it depends on them; above
/// 1e-15.
inline constexpr double kDependent = 1e-9;
/// Distance of a plane from a row of nodes below which it lies on the row, cells; above 1e-15.
inline constexpr double kRowTolerance = 1e-6;
/// Least distance of a plane from the last row inside, cells; 0 to 1. A thinner sliver is strained as one of
/// this thickness, since it would need a smaller time step. Columns pressed at CFL 0.5 and 0.9 swing with
/// less (0.01; splines 0.05) and have too little stress with more. Wide supports need more.
inline constexpr double kThinnestCut = 0.05, kThinnestCutWide = 0.15;

// Walls `at: surface`.

/// Gap up to which a surface that touches is held until forces pull, cells; above round-off. Larger values
/// make no difference.
inline constexpr double kTouchingGap = 1e-3;
/// Gap beyond which a column cannot reach the plane in a step, cells; 1 or more.
inline constexpr double kFarGap = 1;
/// Distance of the plane from the last row inside below which the next row shares the line, cells; 0 to 1. A
/// thin sliver of a cell by itself would need a small time step.
inline constexpr double kThinLayer = 0.5;
/// Depth beyond the plane up to which a column stays, cells; 0 to 0.5.
inline constexpr double kKeptDepth = 0.05;
/// Share of the further depth that is removed in a step; 0 to 1. A larger one makes energy of the noise of
/// particle extents.
inline constexpr double kDepthShare = 0.02;
/// Share of −P v_s that FLIP's particles take; 0 to 1. The energy of a bar that rebounds (strain first;
/// uGIMP, lCPDI, quadratic splines) changes by 0.8, 1.1 and 0.2 % with 0, by 0.2, 0.3 and 0.2 % with 0.03, by
/// 0.0, 0.2 and −0.2 % with 0.1, and by 0.5, 0.1 and −0.3 % with 1. With 1 the first force is a seventh too
/// low.
inline constexpr double kFlipShare = 0.1;
/// Factor on the widths of particle domains, since domains on rings leave gaps; 1 to 2.
inline constexpr double kDomainWidening = 1.25;
/// Depth by which a particle may pass between two columns, cells; 0 to 0.1. With 0, Hertz's cylinders are
/// 37 % too stiff at first, against 12 % with 0.02. With 0.1, particles stay beyond a piston.
inline constexpr double kColumnSlack = 0.02;

}  // namespace mpmfast::constants::conditions

/// Heat conduction.
namespace mpmfast::constants::heat {

/// Gap up to which surfaces conduct whether they press or not, cells; 0 to 0.5.
inline constexpr double kTouchingGap = 0.02;
/// Most conductance of a surface, relative to the conductivity of the best conductor over a cell; above 1.
/// Larger: fluxes closer to perfect contact.
inline constexpr double kMostConductance = 100;
/// A stable step is min(cfl, kMostCfl) kFourierNumber h²/α, α the diffusivity; both 0 to 1. ΔtC⁻¹K then has
/// no eigenvalue above a half.
inline constexpr double kMostCfl = 0.5, kFourierNumber = 0.25;
/// Area that an ambient flux is divided by at least, m²; above 0. It keeps 0/0 out.
inline constexpr double kLeastArea = 1e-300;

}  // namespace mpmfast::constants::heat

/// Contact on nodes (engine/contact without penalty/).
namespace mpmfast::constants::contact {

// Normals and their fits.

/// Cosine of the angle within which the normals around confirm a normal, 10°; 0 to 1. Smaller angles leave
/// more normals in doubt.
inline constexpr double kConfirmingCosine = 0.984807753012208;
/// Share of `refit` from which a fit is renewed together with an older one of its block; 0 to 1. Smaller:
/// more fits, and fewer gatherings of particles.
inline constexpr double kEarlyRefit = 0.5;
/// Drift of a fit per slip of surfaces in contact, since slip brings other support particles; 1 or more.
/// Smaller: fewer fits, and normals that lag.
inline constexpr double kSlipDrift = 30;
/// Least length of a unit normal along the free directions of a node; in (0, 0.1). A surface along the
/// constrained plane has a shorter one, and no contact.
inline constexpr double kLeastFreeNormal = 1e-3;
/// `rigid_bias` from which the gradient of the rigid body replaces a regression.
inline constexpr double kCertainRigidBias = 10;

// The active set of the second correction.

/// Bounds of the elastic recovery length, cells; 0 to 1. Larger: pairs persist with wider gaps, as beside a
/// round contact. Smaller: gaps close against a load, which loses energy.
inline constexpr double kLeastRecovery = 0.05, kMostRecovery = 0.3;
/// Share of the new value in the mean of the recovery length; 0 to 1. Its inverse is the number of steps of
/// the mean.
inline constexpr double kRecoveryShare = 0.1;
/// Velocity below which round-off decides, cells a step; above 1e-14.
inline constexpr double kVelocityRoundOff = 1e-10;

// Contact at points of the surface.

/// Distance of neighbouring points along a surface, cells, at most (in space in the mean); 0.34 to 0.5. More
/// leaves motion of the surface free: corners of turned bodies are not held. Less costs time, and there are
/// more points than motions.
inline constexpr double kPointSpacing = 0.35;
/// By how much a later axis must be nearer to a normal to be taken; 1.01 to 1.1. So neighbouring nodes take
/// the same one where a surface lies at 45° to the grid.
inline constexpr double kNearerAxis = 1.05;
/// How far a point may lie beyond the edge of a deformable body, cells; 0.5 to 1. With less, the last nodes
/// of an edge are free to roll up.
inline constexpr double kBeyondEdge = 0.6;
/// Gap beyond which there is no point, cells; more than what surfaces approach in a step.
inline constexpr double kFarPoint = 0.6;
/// Farthest that a point may lie from its node along an axis, cells; 1 to 2. Points of two blocks of one
/// colour would share nodes beyond.
inline constexpr double kFarOffset = 1.5;
/// Least sum of the weights of the nodes with mass around a point; in (0, 1).
inline constexpr double kLeastWeight = 0.2;
/// Distance within which a point takes over what an earlier one knew, cells; 0.5 to 1.
inline constexpr double kInheritReach = 0.75;
/// Sweeps over the points of a correction, at most; 20 or more. Fewer leave the rows at oblique surfaces
/// uneven.
inline constexpr int kPointSweeps = 30;
/// Largest change of an impulse in a sweep, over the largest impulse, below which they have converged.
inline constexpr double kPointTolerance = 1e-6;

// Interfaces and bonds.

/// Sweeps over the springs of a node with several, at most.
inline constexpr int kSpringSweeps = 200;
/// Squared relative change of the impulses below which these sweeps have converged; above 1e-30.
inline constexpr double kSpringTolerance = 1e-24;
/// Gap up to which surfaces are bonded at the start, cells; 0 to 1.
inline constexpr double kBondedGap = 0.25;
/// Weight of a squared distance across the surface, in the search for the nearest material point; 0 to 1.
inline constexpr double kAcrossWeight = 0.01;
/// Share of the largest area around a node up to which its own bond follows the others; 0 to 1. The jump of
/// a smaller area is noise.
inline constexpr double kLittleArea = 0.05;
/// Offset of the material point along the surface beyond which the next node takes over its bond, cells.
/// Half a cell is the nearest node.
inline constexpr double kBondOffset = 0.5;

/// Nodes whose friction work makes one partial sum. Another value changes the work by round-off.
inline constexpr std::int64_t kNodesOfSum = 64;

}  // namespace mpmfast::constants::contact

/// Penalty contact.
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

/// Least number of buckets of facet bins, a power of two, –. It affects time only.
inline constexpr std::size_t kLeastBuckets = 16;

/// Buckets per facet, –, so that few bins share a bucket. It affects time only.
inline constexpr std::size_t kBucketsPerFacet = 2;

}  // namespace mpmfast::penalty

/// Cracks. The constants of the integrals at a tip are in kernels/constants.hpp.
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
