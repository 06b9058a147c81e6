#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "engine/errors.hpp"
#include "engine/scene/names.hpp"
#include "engine/step/overlap_at_start.hpp"
#include "engine/step/run.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

namespace {

std::string in_mebibytes(std::size_t bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0);
}

/// @param bytes  of the columns and the keys of the sort
std::string checkpoint_text(const CheckpointSpec& checkpoint, std::size_t bytes) {
  if (!checkpoint.active) return "none";
  std::string when;
  if (checkpoint.every > 0) when += fmt::format("every {:.4g} s of wall time, ", checkpoint.every);
  if (checkpoint.steps > 0) when += fmt::format("every {} steps, ", checkpoint.steps);
  return fmt::format("{}, {}at a signal and at the end", in_mebibytes(bytes), when);
}

template <int Dim>
std::string describe(const Scene& scene) {
  Step<Dim> step(scene);
  std::string overlap;
  if constexpr (Dim == 2) overlap = overlap_at_start(step.state(), scene).text;
  const double dt = step.stable_dt(), steps = std::ceil(scene.time.end / dt);
  std::string text = fmt::format("{}\n", scene.title.empty() ? scene.file.filename().string() : scene.title);
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<16}{}\n", name, value);
  };

  // A few steps of the scene itself measure what a step costs on this machine.
  constexpr int kTrial = 5;
  std::string estimate;
  const auto start = std::chrono::steady_clock::now();
  try {
    for (int k = 0; k < kTrial; ++k) {
      const double stable = step.stable_dt();
      step.advance(stable);
    }
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kTrial;
    estimate = fmt::format("{:.3g} s of stepping at {:.3g} ms a step (measured over {} steps)", wall * steps,
                           wall * 1e3, kTrial);
  } catch (const RunFailure& failure) {
    estimate = fmt::format("unknown: {}", failure.what());
  }

  const auto& particles = step.state().particles;
  std::string columns, nodal, fields, passes;
  for (Quantity q : particles.quantities()) {
    const auto& info = kQuantityTable[static_cast<std::size_t>(q)];
    columns += fmt::format("\n    {:<22}{} x {} ({})", info.name, Particles<Dim>::components(q), info.unit,
                           info.reason);
  }
  for (Nodal q : step.state().nodes.quantities())
    nodal += fmt::format("\n    {:<22}({})", kNodalTable[static_cast<std::size_t>(q)].name,
                         kNodalTable[static_cast<std::size_t>(q)].reason);
  for (const auto& f : step.plan().fields) fields += (fields.empty() ? "" : ", ") + f;
  for (const auto& p : step.plan().passes) passes += "\n    " + p;
  const std::size_t planned = particles.planned_bytes();
  line("dimension", fmt::format("{} ({})", Dim, name_of(kSpaces, scene.space)));
  line("particles", fmt::format("{}", particles.size()));
  line("fields", fmt::format("{}: {}", step.plan().fields.size(), fields));
  if (!overlap.empty()) line("overlap", overlap);
  line("node slots", fmt::format("{} in {} tiles, over {} places", step.state().tiling.slots(),
                                 step.state().tiling.node_tiles.size(), step.state().tiling.places()));
  line("memory",
       fmt::format("{} of particles ({} bytes each), {} of nodes, {} of tiles and sorting",
                   in_mebibytes(planned), particles.size() > 0 ? planned / particles.size() : 0,
                   in_mebibytes(step.state().nodes.bytes()), in_mebibytes(step.state().tiling.bytes())));
  line("checkpoint",
       checkpoint_text(scene.output.checkpoint, planned + particles.size() * sizeof(std::uint64_t)));
  line("time step", fmt::format("{:.4g} s at first (it follows the wave speed)", dt));
  line("steps", fmt::format("{:.0f} at that step", steps));
  line("estimated time", estimate);
  line("passes", passes);
  line("particle columns", columns);
  line("nodal columns", nodal);
  return text;
}

}  // namespace

std::string describe_plan(const Scene& scene) {
  return scene.dimension() == 3 ? describe<3>(scene) : describe<2>(scene);
}

}  // namespace mpmfast
