#include "engine/run/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mpmfast {

namespace {

struct Limits {
  double end = 0;  ///< s
  std::uint64_t max_steps = 0;
  bool operator==(const Limits&) const = default;
};

/// @param whole  did the run end in order? One that was killed at its limit has not ended there: its last
/// row, frame and summary are missing
Limits next_limits(const Limits& before, const Scene& scene, const RunOptions& options, double time,
                   std::uint64_t step, bool whole) {
  if (std::isfinite(options.until)) return {options.until, options.max_steps};
  const bool at_end = whole && has_ended(time, before.end), at_steps = whole && step >= before.max_steps;
  return {at_end ? scene.time.end : before.end,
          at_steps ? options.max_steps : std::min(before.max_steps, options.max_steps)};
}

}  // namespace

RunOrigin first_origin(const Scene& scene, const RunOptions& options) {
  RunOrigin origin;
  origin.scene_hash = text_hash(scene.resolved_yaml);
  origin.program = program_text();
  origin.scene_name = scene.file.filename().string();
  origin.command = options.command;
  origin.overrides = options.overrides;
  origin.warnings = options.scene_warnings;
  origin.end = std::min(scene.time.end, options.until);
  origin.max_steps = options.max_steps;
  return origin;
}

std::optional<NextOrigin> next_origin(const Scene& scene, const RunOptions& options,
                                      CheckpointReader& checkpoint) {
  NextOrigin next;
  RunOrigin& origin = next.origin;
  double time = 0;
  std::uint64_t step = 0;
  origin.visit(checkpoint);
  checkpoint.number("step/time", time);
  checkpoint.number("step/number", step);
  if (origin.scene_hash != text_hash(scene.resolved_yaml))
    throw CannotResume(
        fmt::format("{} was altered: it is not the scene of the checkpoint beside it", scene.file.string()));
  if (origin.program != program_text() && options.warn)
    options.warn(
        fmt::format("the run was begun by another program, {}: what follows need not be to the bit "
                    "what that would have given",
                    origin.program));
  const bool whole = std::filesystem::exists(options.folder / "run.json");
  const Limits before{origin.end, origin.max_steps};
  const Limits now = next_limits(before, scene, options, time, step, whole);
  if (whole && (has_ended(time, now.end) || step >= now.max_steps)) return std::nullopt;
  next.limits_changed = !(now == before);
  origin.end = now.end;
  origin.max_steps = now.max_steps;
  return next;
}

}  // namespace mpmfast
