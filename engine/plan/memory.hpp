#pragma once

/// @file What a scene will ask of the machine's memory, known before any of it is asked for.

#include <cstdint>

#include "engine/plan/memory_limits.hpp"
#include "engine/plan/plan.hpp"

namespace mpmfast {

/// Particles of a scene, within a few per cent: the boxes around its bodies, less what lies outside their
/// shapes (judged on a raster).
double estimated_particles(const Scene& scene);

/// Memory that a run needs for a while only.
struct PassingNeed {
  double bytes{};
  const char* reason = "";  ///< what takes it
};

/// The most that is taken at a time: to look for bodies that overlap, for a frame, for a picture, or for a
/// row of the history.
/// @param later  bytes that are not taken yet at the start, where bodies are first looked at: of nodes,
/// tiles, the sort and contact
PassingNeed passing_need(const Scene& scene, double particles, double later);

/// Bytes that a run of that many particles takes at most, without the program itself and contact: particles,
/// nodes, tiles and the sort within a third, and what passes.
double estimated_bytes(const Scene& scene, const Plan& plan, double particles);

/// Of the program and its libraries, resident; those that write checkpoints come with the first.
inline constexpr double kProgramBytes = 18.5 * (1 << 20), kCheckpointBytes = 4.5 * (1 << 20);

/// Throws SceneError with the figures when a scene would take more than what is available. 0 bytes: unlimited
void check_memory(const Scene& scene, const Plan& plan, const MemoryLimit& available);

}  // namespace mpmfast
