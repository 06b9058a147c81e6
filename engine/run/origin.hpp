#pragma once

/// @file Where a run comes from and how far it is to go: at its start, and when it goes on from a checkpoint.

#include <optional>

#include "engine/output/checkpoint_file.hpp"
#include "engine/run/run.hpp"
#include "engine/run/run_counters.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

RunOrigin first_origin(const Scene& scene, const RunOptions& options);

struct NextOrigin {
  RunOrigin origin;             ///< as the checkpoint states it, with the limits of now
  bool limits_changed = false;  ///< are they others than those of the checkpoint?
};

/// Of a run that goes on. Limits that are asked for now hold; an end that is asked for lifts an earlier
/// number of steps too. Else the limits of the run hold, and each gives way where the run ended at it.
/// Returns nothing when the limits are reached and all is written. Throws CannotResume when the scene is not
/// that of the checkpoint.
std::optional<NextOrigin> next_origin(const Scene& scene, const RunOptions& options,
                                      CheckpointReader& checkpoint);

}  // namespace mpmfast
