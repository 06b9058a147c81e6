#pragma once

/// @file What a scene will ask of the machine's memory, known before any of it is asked for.

#include <cstdint>

#include "engine/plan/plan.hpp"

namespace mpmfast {

/// Particles of a scene, within a few per cent: the boxes around its bodies, less what lies outside their
/// shapes (judged on a raster).
double estimated_particles(const Scene& scene);

/// Bytes that a run takes for a while beside its particles, nodes, tiles and the sort: to look for bodies
/// that overlap at the start, for a frame, for a picture.
double passing_bytes(const Scene& scene, double particles);

/// Bytes that a run of that many particles takes at most, without the program itself: particles, nodes, tiles
/// and the sort within a third, and what passes.
double estimated_bytes(const Scene& scene, const Plan& plan, double particles);

inline constexpr double kProgramBytes = 12 << 20;  ///< of the program and its libraries, resident

/// Bytes of memory that the machine has; 0 when it does not tell.
std::uint64_t machine_memory();

/// Throws SceneError with the figures when a scene would take more than `available` bytes. 0: unlimited
void check_memory(const Scene& scene, const Plan& plan, std::uint64_t available);

}  // namespace mpmfast
