#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "engine/constants.hpp"
#include "engine/errors.hpp"
#include "engine/output/paint.hpp"
#include "engine/plan/memory.hpp"
#include "engine/run/contact_memory.hpp"
#include "engine/run/describe_bodies.hpp"
#include "engine/run/overlap_at_start.hpp"
#include "engine/run/run.hpp"
#include "engine/scene/keys/names.hpp"
#include "engine/step/crowding.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

namespace {

/// A whole number that is no less, but for round-off.
double whole_above(double number) { return std::ceil(number - 1e-6); }

/// Pairs of bodies at one place, a particle, beyond which no step is tried: some 64 bodies in a cell. Contact
/// would take seconds and gigabytes for each.
constexpr double kMostPairsTried = 8;

template <class Number>
std::string in_mebibytes(Number bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0);
}

/// @param bytes  of the columns and the keys of the sort
std::string checkpoint_text(const CheckpointSpec& checkpoint, std::size_t bytes) {
  if (!checkpoint.active) return "none";
  std::string when;
  if (checkpoint.every > 60) when += "after a minute, ";
  if (checkpoint.every > 0) when += fmt::format("every {:.4g} s of wall time, ", checkpoint.every);
  if (checkpoint.steps > 0) when += fmt::format("every {} steps, ", checkpoint.steps);
  return fmt::format("{}, {}at a signal and at the end", in_mebibytes(bytes), when);
}

/// A few steps of the scene itself measure what a step costs on this machine: the median, which neither the
/// first steps, that touch the memory, nor a busy moment disturb.
/// @param look  called once, after as many steps on any machine
template <int Dim, class F>
std::string estimated_time(Step<Dim>& step, double steps, const F& look) {
  constexpr std::size_t kFewest = 5, kMost = 100;
  constexpr double kPatience = 0.3;  // s
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::vector<double> walls;
  try {
    const auto begin = Clock::now();
    while (walls.size() < kFewest || (walls.size() < kMost && seconds_since(begin) < kPatience)) {
      const auto start = Clock::now();
      step.advance(step.stable_dt());
      walls.push_back(seconds_since(start));
      if (walls.size() == kFewest) look();
    }
  } catch (const RunFailure& failure) {
    if (walls.size() < kFewest) look();
    return fmt::format("unknown: {}", failure.what());
  }
  const auto middle = walls.begin() + static_cast<std::ptrdiff_t>(walls.size() / 2);
  std::nth_element(walls.begin(), middle, walls.end());
  return fmt::format(
      "{:.3g} s of stepping at {:.3g} ms a step (the median of the first {}; contact may come to cost more)",
      *middle * steps, *middle * 1e3, walls.size());
}

/// "80 x 40 cells of 0.25 mm"
std::string grid_text(const Scene& scene) {
  const GridSpec& grid = scene.grid;
  const DisplayUnit unit = length_unit(scene);
  std::string cells;
  for (int d = 0; d < scene.dimension(); ++d)
    cells += fmt::format("{}{:.0f}", d > 0 ? " x " : "", grid.size[static_cast<std::size_t>(d)] / grid.cell);
  return fmt::format("{} cells of {:.6g} {}", cells, grid.cell / unit.in_si, unit.name);
}

std::string contact_text(const ContactSpec& contact) {
  if (!contact.active) return "none: all bodies share one velocity field";
  std::string law = std::visit([](const auto& one) { return std::string(one.kKeyword); }, contact.law.acts);
  if (std::holds_alternative<Coulomb>(contact.law.acts))
    law += fmt::format(", friction {:g}", contact.law.friction);
  std::string pairs;
  if (!contact.pairs.empty())
    pairs = fmt::format(", and {} pair{} with laws of their own", contact.pairs.size(),
                        contact.pairs.size() == 1 ? "" : "s");
  if (contact.family == ContactFamily::penalty)
    return fmt::format("{}{}; between surfaces, with springs of {:g} moduli a cell", law, pairs,
                       contact.springs.stiffness);
  return fmt::format("{}{}; {}normals by {}", law, pairs,
                     contact.family == ContactFamily::surface ? "at points of the surface, " : "",
                     name_of(kNormals, contact.normal));
}

/// Memory for the whole run, memory for a while, and their sum. @param step  that has advanced
template <int Dim>
std::string memory_text(const Step<Dim>& step, const Scene& scene) {
  const State<Dim>& state = step.state();
  const auto& particles = state.particles;
  const std::size_t surfaces = step.penalty().active() ? state.surfaces.bytes() + step.penalty().bytes() : 0;
  const std::size_t extension = step.extension().active() ? step.extension().bytes() : 0;
  const ContactNeed contact = contact_need(step, scene);
  const double later =
      static_cast<double>(state.nodes.bytes() + state.tiling.bytes() + surfaces + extension) + contact.bytes;
  const double made = step.plan().split_edge > 0 ? constants::plan::kSplitAllowance : 0,
               made_bytes = made * static_cast<double>(particles.bytes() + state.tiling.bytes());
  const PassingNeed passing = passing_need(scene, (1 + made) * static_cast<double>(particles.size()), later);
  const double program = kProgramBytes + static_cast<double>(step.workspace_bytes()) +
                         (scene.output.checkpoint.active ? kCheckpointBytes : 0);
  std::string text = fmt::format(
      "{} of particles ({} bytes each), {} of nodes, {} of tiles and sorting, {} of the program,",
      in_mebibytes(particles.bytes()),
      particles.size() > 0 ? particles.planned_bytes() / particles.size() : 0,
      in_mebibytes(state.nodes.bytes()), in_mebibytes(state.tiling.bytes()), in_mebibytes(program));
  const std::string below = "\n" + std::string(18, ' ');
  if (step.plan().contact)
    text += below +
            fmt::format(
                "{} of contact, should two fifths of the surfaces meet others ({:.0f} nodes; {} now),",
                in_mebibytes(contact.bytes), whole_above(contact.nodes), step.contact_list().nodes.size());
  if (surfaces > 0)
    text += below + fmt::format("{} of surfaces and what is near them now,", in_mebibytes(surfaces));
  if (extension > 0) text += below + fmt::format("{} of the extension of splines,", in_mebibytes(extension));
  if (made > 0)
    text += below + fmt::format("{} should each particle be split once,", in_mebibytes(made_bytes));
  return text + below +
         fmt::format("{} for a while for {}; about {} at the peak", in_mebibytes(passing.bytes),
                     passing.reason,
                     in_mebibytes(static_cast<double>(particles.bytes()) + made_bytes + later +
                                  passing.bytes + program));
}

/// "2: left, right"; of many the first few.
std::string fields_text(const std::vector<std::string>& fields, bool all) {
  constexpr std::size_t kMost = 12, kShown = 6;
  const std::size_t shown = all || fields.size() <= kMost ? fields.size() : kShown;
  std::string names;
  for (std::size_t k = 0; k < shown; ++k) names += (k > 0 ? ", " : "") + fields[k];
  return fmt::format("{}: {}{}", fields.size(), names, shown < fields.size() ? ", …" : "");
}

template <int Dim>
std::string describe(const Scene& scene, bool verbose) {
  Step<Dim> step(scene);
  std::string overlap;
  if constexpr (Dim == 2) overlap = overlap_at_start(step.state(), scene).text;
  const Crowding crowd = crowding(step.state(), step.plan().fields.size());
  const double dt = step.stable_dt(), steps = std::ceil(scene.time.end / dt);
  std::string text = fmt::format("{}\n", scene.title.empty() ? scene.file.filename().string() : scene.title);
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<16}{}\n", name, value);
  };

  const auto bodies = body_lines(scene, step.state().particles);
  std::string memory, estimate;
  if (crowd.pairs <= kMostPairsTried * static_cast<double>(step.state().particles.size())) {
    estimate = estimated_time(step, steps, [&] { memory = memory_text(step, scene); });
  } else {
    memory = fmt::format("{} of particles; unknown of contact", in_mebibytes(step.state().particles.bytes()));
    estimate = fmt::format(
        "unknown: up to {} bodies lie in one cell, '{}' and '{}' among them, and {:.2g} pairs "
        "of bodies meet",
        crowd.fields, scene.bodies[crowd.one].name, scene.bodies[crowd.other].name, crowd.pairs);
  }

  const auto& particles = step.state().particles;
  std::string columns, nodal, passes;
  for (Quantity q : particles.quantities()) {
    const auto& info = kQuantityTable[static_cast<std::size_t>(q)];
    columns += fmt::format("\n    {:<22}{} x {} ({})", info.name, Particles<Dim>::components(q), info.unit,
                           info.reason);
  }
  for (Nodal q : step.state().nodes.quantities())
    nodal += fmt::format("\n    {:<22}({})", kNodalTable[static_cast<std::size_t>(q)].name,
                         kNodalTable[static_cast<std::size_t>(q)].reason);
  for (const auto& p : step.plan().passes) passes += "\n    " + p;
  const std::size_t planned = particles.planned_bytes();
  line("dimension", fmt::format("{} ({})", Dim, name_of(kSpaces, scene.space)));
  line("grid", grid_text(scene));
  const auto list = [&](const std::vector<std::string>& lines) {
    for (const std::string& one : folded(lines, verbose)) text += fmt::format("    {}\n", one);
  };
  line("bodies", fmt::format("{}", scene.bodies.size()));
  list(bodies);
  line("particles", fmt::format("{}", particles.size()));
  line("fields", fields_text(step.plan().fields, verbose));
  if (step.plan().fields.size() > 1 || !scene.contact.active) {
    line("contact", contact_text(scene.contact));
    list(pair_lines(scene));
  }
  if (!overlap.empty()) line("overlap", overlap);
  line("node slots", fmt::format("{} in {} tiles, over {} places", step.state().tiling.slots(),
                                 step.state().tiling.node_tiles.size(), step.state().tiling.block_nodes()));
  line("memory", memory);
  line("checkpoint",
       checkpoint_text(scene.output.checkpoint, planned + particles.size() * sizeof(std::uint64_t)));
  const DisplayUnit unit = display_unit(dt, "s");
  line("time step",
       fmt::format("{:.4g} {} at first (it follows the wave speed)", dt / unit.in_si, unit.name));
  line("steps", fmt::format("{:.0f} at that step", steps));
  line("estimated time", estimate);
  if (!verbose) {
    line("passes",
         fmt::format("{} a step, over {} columns of particles and {} of nodes (--verbose names them)",
                     step.plan().passes.size(), particles.quantities().size(),
                     step.state().nodes.quantities().size()));
    return text;
  }
  line("passes", passes);
  line("particle columns", columns);
  line("nodal columns", nodal);
  return text;
}

}  // namespace

std::string describe_plan(const Scene& scene, bool verbose) {
  return scene.dimension() == 3 ? describe<3>(scene, verbose) : describe<2>(scene, verbose);
}

}  // namespace mpmfast
