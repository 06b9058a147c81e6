#pragma once

/// @file The numbers that kernels decide by: value, unit, meaning, range, and what moves with each.

namespace mpmfast::constants {

// Contacts of one node (kernels/contact/node_solver.hpp, lane_solver.hpp).

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

}  // namespace mpmfast::constants
