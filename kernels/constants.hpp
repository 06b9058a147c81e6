#pragma once

/// @file The numbers that kernels decide by: value, unit, meaning, range, and what moves with each. A number
/// without a unit is a ratio. Those of the engine are in engine/constants.hpp.

#include <cstddef>
#include <cstdint>

namespace mpmfast::constants {

/// Above all numbers that a sound step has. A temperature or speed beyond it counts as no number; within a
/// few decades of the largest double.
inline constexpr double kMostSound = 1e300;
/// Stands for a bound that does not exist; above every value that is compared with it.
inline constexpr double kUnbounded = 1e300;
/// Particles ahead of a loop whose columns are fetched: two tiles in the plane. The value changes run time
/// only.
inline constexpr std::uint32_t kFetchAhead = 128;

// Basis functions (kernels/basis).

/// Distance from the edge of a support within which round-off decides, cells; in (1e-14, 1e-6). Larger: nodes
/// of small weight are left out.
inline constexpr double kSupportEdge = 1e-9;
/// Most half-diagonal of a CPDI domain, cells; above √Dim/2, that of an undeformed domain with one particle a
/// cell, and below 1, so that CpdiBasis::kMaxSupport nodes a side suffice. Smaller: gaps at smaller
/// stretches.
inline constexpr double kMostHalfDiagonal = 0.999;
/// Least |det R|/Π |r_j| of edges that are kept; in (0, 1). Of two edges it is the sine between them, which
/// simple shear by 3.2 reaches. Punched, flowing and pressed bodies give like results with 0.25 to 0.4.
inline constexpr double kLeastSine = 0.3;
/// Difference of two squared lengths, relative to their sum, below which no axis is the longer one; some
/// units of 2^-53. The edges of such a domain keep their directions.
inline constexpr double kEqualEdges = 1e-15;

/// Sweeps of Jacobi rotations of a matrix (kernels/principal_axes.hpp), at least 4: three or four reach
/// round-off.
inline constexpr int kJacobiSweeps = 20;
/// Cosine between two columns below which they count as orthogonal; some units of 2^-53.
inline constexpr double kJacobiRoundOff = 1e-15;

// Clouds and their normals (kernels/contact/regression.hpp, margin.hpp, collect.hpp).

/// Particles of capacity of a cloud beyond those needed. The value changes memory and run time only.
inline constexpr std::size_t kCloudReserve = 256;
/// Pivot of the normal equations, relative to its diagonal entry, below which a fit has no solution; in
/// (1e-15, 1e-8). No scaling of the unknowns changes the test.
inline constexpr double kLeastFitPivot = 1e-12;
/// Squared lengths between which a vector has a direction; far from the ends of the range of a double.
inline constexpr double kLeastSquaredLength = 1e-200, kMostSquaredLength = 1e200;
/// Squared distance of two centroids, relative to the squared size of the cloud, below which they coincide by
/// round-off; in (1e-30, 1e-12).
inline constexpr double kCoincidentCentroids = 1e-18;
/// Distance of two hulls below which they count as meeting, cells; in (0, 0.5). The direction between closer
/// hulls is noise, so that a larger value leaves more nodes without this normal.
inline constexpr double kLeastHullDistance = 0.05;
/// Passes over a cloud for the distance of its hulls, at most. Fewer: normals that have not converged.
inline constexpr int kHullPasses = 30;
/// Bound of the squared relative distance to the solution at which the search ends; in (1e-15, 1e-4). The
/// value is an angle of the normal below 1e-5 rad.
inline constexpr double kHullTolerance = 1e-10;
/// Pivot of a Gram matrix, relative to its largest diagonal entry, below which the matrix is singular; some
/// units of 2^-53.
inline constexpr double kLeastGramPivot = 1e-14;

// Closest-point projection (kernels/contact/closest_point.hpp).

/// Tolerance of the weight of a corner; above 1e-15, far below 1. A weight down to its negative belongs to
/// the facet, so that no point falls between two facets by round-off.
inline constexpr double kWeightTolerance = 1e-9;
/// Newton iterations for a triangle, at least 4. Two to four suffice for normals within half a radian.
inline constexpr int kProjectionIterations = 8;
/// Square of the residual at which Newton's iteration ends, over twice the area of the triangle; above 1e-30.
/// It is (1e-13)², near round-off. A larger value moves the closest point.
inline constexpr double kSquaredResidual = 1e-26;
/// Least Jacobian of the map (β, g) ↦ x(β) + g n(β), over twice the area of the triangle; in (0, 0.1). It
/// vanishes where the normals of a concave facet meet, beyond which the projection is not unique.
inline constexpr double kLeastJacobian = 1e-3;

// Contact laws (kernels/contact).

/// Relative change of the squared jump in a step below which differences of its energy or work are round-off;
/// in (1e-10, 1e-3). The law itself then replaces their quotient.
inline constexpr double kSmallJumpChange = 1e-6;
/// Newton iterations for the damage of exponential softening, at most. They end before, at kDamageStep.
inline constexpr int kDamageIterations = 60;
/// Increment of damage at which these iterations end; some units of 2^-53.
inline constexpr double kDamageStep = 1e-16;
/// Newton iterations for the slip speed of friction that depends on it, at most. They end before, at
/// kSlipSpeedTolerance.
inline constexpr int kSlipSpeedIterations = 50;
/// Relative change of the slip speed at which these iterations end; some units of 2^-53.
inline constexpr double kSlipSpeedTolerance = 1e-14;
/// Most phase of the oscillator of an interface spring in a step, rad; in (0, π). π/2 is four steps a period.
/// Beyond it the ratio of inertias stays constant.
inline constexpr double kMostPhase = 1.5707963267948966;
/// Half the phase below which this ratio is 1, rad; in (1e-8, 1e-3). The error of the ratio is
/// two thirds of the square.
inline constexpr double kLeastHalfPhase = 1e-4;
/// Secant steps for the largest root of a function (largest_root.hpp), at most. They end before, at
/// kRootTolerance.
inline constexpr int kRootIterations = 100;
/// Relative accuracy of this root; above 1e-15.
inline constexpr double kRootTolerance = 1e-13;

// Contacts of one node (kernels/contact/node_solver.hpp, lane_solver.hpp, two_pairs.hpp).

/// Relative change of the largest impulse below which a sweep has converged; in (0, 1e-6]. Larger: fewer
/// sweeps, and impulses that obey their laws less closely.
inline constexpr double kSweepTolerance = 1e-9;
/// Round-off of a velocity, relative to the fastest field of a node; some units of 2^-53. Larger: slow
/// motions count as converged.
inline constexpr double kVelocityRoundOff = 1e-14;
/// Largest impulse, in units of the momentum that the fields of a node have against the heaviest one. Beyond
/// it, friction wedges fields by stresses that no motion supplied; above 1.
inline constexpr double kMostImpulse = 30;
/// Pivot of the Delassus operator (its diagonal is one) below which an equation follows from those before; in
/// (1e-14, 1e-8). Smaller: impulses that are not unique are mistaken for large ones.
inline constexpr double kRedundantPivot = 1e-11;
/// N s: an impulse below this has no inverse.
inline constexpr double kLeastImpulse = 1e-290;
/// How far friction may exceed what its law allows before it is cut; just above 1.
inline constexpr double kSpareFriction = 1.001;

/// Sweeps of one node: converged nodes take two to ten. More: nodes that jam cost more before friction lags.
inline constexpr int kMostSweeps = 100;
/// Sweeps after which a Newton step follows only every so many: where statuses still change, it seldom helps.
inline constexpr int kEarlyNewtonSteps = 10;
/// Rounds of friction that follows the last normal impulses.
inline constexpr int kFrictionRounds = 8;
/// Sweeps of a node in a lane; nodes that need more are solved alone.
inline constexpr int kMostLaneSweeps = 8;
/// Halvings of a Newton step after which the share that keeps every status is known well enough (1/64).
inline constexpr int kStepHalvings = 6;

/// Rounds of statuses that are tried for two pairs that share a field. Nodes that do not settle are lumped.
inline constexpr int kTwoPairRounds = 60;
/// Round-off of an impulse of two pairs, relative to the largest one; some units of 2^-53. Smaller impulses
/// have no direction.
inline constexpr double kTwoPairRoundOff = 1e-13;
/// Change of the frictional impulse of two pairs, relative to the largest impulse, at which they have
/// settled; above kTwoPairRoundOff.
inline constexpr double kTwoPairTolerance = 1e-12;

// Materials (kernels/materials).

/// Largest principal stretch of the isochoric part of F that a material keeps, 1 or more. Fluids have no
/// shape; grains of soil change neighbours early; F of metals is kept until its determinant would lose
/// digits.
inline constexpr double kShapeOfFluids = 1, kShapeOfSoils = 4, kShapeOfMetals = 20;
/// The same of a material that keeps all of F; above every stretch.
inline constexpr double kWholeShape = 1e300;
/// Most (det F)^(1/Dim) that F has; above 1. Material that has come apart does not fill the gaps.
inline constexpr double kMostOpening = 2;
/// Round-off of the squared norm of F that is compared with the bound of its shape; in (1e-15, 1e-6).
inline constexpr double kShapeRoundOff = 1e-12;
/// Relative difference of det F and J above which F is scaled to J; in (1e-12, 1e-3). Larger: F and J drift
/// apart. Smaller: F is decomposed more often.
inline constexpr double kVolumeDrift = 1e-6;

/// Power of D at which the series of the matrix exponential ends; odd. The remainder exceeds round-off beyond
/// |D| = 3, which no step reaches.
inline constexpr int kExponentialPowers = 25;
/// Iterations of the lower bound of the smallest stretch in space, at least 1. Fewer: a lower bound, so that
/// the wave speed is overestimated.
inline constexpr int kStretchIterations = 4;
/// Newton iterations for the stretch along the normal in plane stress; three to five reach round-off.
inline constexpr int kPlaneStressIterations = 5;
/// Newton iterations for the mean of b̄ in a radial return; five reach round-off from any trial below
/// tr b̄ = 6.
inline constexpr int kReturnIterations = 5;
/// Iterations for the plastic increment, in a bracket. Bisection alone would need 60; Newton's method takes
/// about five.
inline constexpr int kPlasticIterations = 60;
/// Residual stress of soil, relative to the trial stress, at which these iterations end and below which it
/// does not yield; some units of 2^-53.
inline constexpr double kSoilTolerance = 1e-14;
/// Round-off of the pressure of soil, relative to its bulk modulus; some units of 2^-53. The pressure is the
/// small difference 1 − J².
inline constexpr double kPressureRoundOff = 1e-15;
/// Residual stress of metals, relative to the trial stress, at which these iterations end; some units of
/// 2^-53.
inline constexpr double kMetalTolerance = 1e-13;
/// Plastic strain from which hardening α^n has a derivative; in (0, 1e-6). Larger: more strength at first
/// yield.
inline constexpr double kLeastPlasticStrain = 1e-12;
/// Homologous temperature of which a logarithm is taken; in (0, 1e-100).
inline constexpr double kLeastHomologous = 1e-300;
/// Share of the pole 1/S1 of the Hugoniot beyond which the curve continues along its tangent; in (0, 1). No
/// shock reaches it.
inline constexpr double kHugoniotPole = 0.95;

// Transfers (kernels/transfer).

/// J below which a particle counts as compressed; in (0.85, 1). With 1, waves switch the weight, and a disk
/// that vibrates comes apart.
inline constexpr double kCompressionStart = 0.95;
/// Increase of the compression weight with the decrease of J, to 1; above 1. With 10, the weight is 1 from
/// J = 0.85 on.
inline constexpr double kCompressionRamp = 10;

}  // namespace mpmfast::constants

/// Integrals at a crack tip (kernels/fracture). Lengths are relative to the radius of the domain.
namespace mpmfast::fracture_constants {

/// Radius within which the weight |q| of the domain integral is 1; 0 to 1. Cells cannot resolve the stress
/// close to the tip, so its gradient is not weighted there.
inline constexpr double kPlateau = 0.4;
/// Length behind the tip to which the opening is measured, at most; 0 to 1.
inline constexpr double kOpeningLength = 0.7;
/// Length behind the tip from which the opening is measured, relative to that length; 0 to 1.
inline constexpr double kOpeningStart = 0.25 / kOpeningLength;
/// Distance from the crack within which particles tell the displacement of its sides, at least; 0 to 1.
inline constexpr double kOpeningWidth = 0.18;
/// Steps over the radius in which the direction of the crack path is tabulated.
inline constexpr int kPathSteps = 64;

}  // namespace mpmfast::fracture_constants
