#pragma once

/// @file The run loop: from a scene to a finished output folder.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/output.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Where a run stands; handed to the progress callback a few times a second.
struct Progress {
  std::uint64_t step = 0;
  double time = 0, end = 0;              ///< s, simulated
  double wall = 0;                       ///< s, since stepping began
  double particle_steps_per_second = 0;  ///< since stepping began
  double seconds_left = 0;               ///< wall, estimated; 0 when unknown
  double energy_error = 0;
};

/// Is a run that goes to `end` over? The last step may miss it by round-off.
inline bool has_ended(double time, double end) { return time >= end * (1 - 1e-12); }

struct RunOptions {
  std::filesystem::path folder;
  bool force = false;
  int threads = 0;  ///< 0: OMP_NUM_THREADS or the cores
  std::uint64_t max_steps = std::numeric_limits<std::uint64_t>::max();
  double until = std::numeric_limits<double>::infinity();  ///< s
  std::string command;
  std::vector<std::string> overrides;
  std::vector<std::string>
      scene_warnings;  ///< what in the scene is likely a mistake, for run.json and run.log
  std::function<void(const Progress&)> progress;  ///< may be empty
  std::function<void(const std::string&)> warn;   ///< may be empty
  const volatile int* stop_signal = nullptr;      ///< non-zero: finish the step and stop
  std::function<bool()> stop;  ///< asked between steps, every 50 ms at most: true stops it; may be empty
};

/// What is in the folder does not go on: the checkpoint is spoilt, or scene, history and checkpoint do not
/// belong together.
class CannotResume : public FileError {
 public:
  using FileError::FileError;
};

/// Runs a scene and writes everything of design §4. Throws FileError (exit 4); RunFailure (exit 3) after the
/// history is closed and run.json says status "failed": the last checkpoint stays.
RunSummary run_scene(const Scene& scene, const RunOptions& options);

/// Goes on with the run in options.folder from its checkpoint, to the bit as if it had never stopped, up to
/// options.until or, without it, to where the run was to go: to the limit that it had, unless it ended there.
/// What was written after the checkpoint is cut off. Returns nothing, and changes nothing, when the run is
/// there already. Throws as run_scene; CannotResume when checkpoint, scene and history do not belong
/// together, SceneError when the scene was spoilt.
std::optional<RunSummary> resume_run(const RunOptions& options);

/// What `mpmfast check` prints: bodies, particles, nodes, fields, contact, memory, time step, steps,
/// estimated time; verbose: all bodies, passes and columns. Throws SceneError when the scene cannot be set up
/// (a particle outside the grid, a body without particles).
std::string describe_plan(const Scene& scene, bool verbose = false);

}  // namespace mpmfast
