#pragma once

/// @file What a scene will ask of the machine's memory, known before any of it is asked for.

#include <cstdint>

#include "engine/plan/plan.hpp"

namespace mpmfast {

/// Particles of a scene, within a few per cent: the boxes around its bodies, less what lies outside their
/// shapes (judged on a raster).
double estimated_particles(const Scene& scene);

/// Bytes of particles, nodes, tiles and the sort of that many particles, within a third.
double estimated_bytes(const Scene& scene, const Plan& plan, double particles);

/// Bytes of memory that the machine has; 0 when it does not tell.
std::uint64_t machine_memory();

/// Throws SceneError with the figures when a scene would take more than `available` bytes. 0: unlimited
void check_memory(const Scene& scene, const Plan& plan, std::uint64_t available);

}  // namespace mpmfast
