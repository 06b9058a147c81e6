#include "run_study.hpp"

#include <fmt/format.h>

#include <system_error>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/step/step.hpp"
#include "other_program.hpp"
#include "study_results.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

std::vector<const StudyRun*> all_of(const StudyRuns& runs) {
  std::vector<const StudyRun*> out;
  for (const StudyRun& run : runs.references) out.push_back(&run);
  for (const StudyRun& run : runs.variants) out.push_back(&run);
  return out;
}

RunOptions options_of(const StudyRun& run, const StudyOptions& options) {
  RunOptions out;
  out.folder = options.folder / run.folder;
  out.force = true;  // what an unfinished run left is replaced
  out.threads = options.threads;
  out.command = options.command;
  out.progress = options.progress;
  out.stop_signal = options.stop_signal;
  return out;
}

}  // namespace

bool may_hold_study(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return true;
  return fs::is_directory(folder, error) &&
         (fs::is_empty(folder, error) || fs::exists(folder / "study.yaml", error));
}

void prepare_study_folder(const Study& study, const fs::path& folder) {
  make_folder(folder);
  write_aside(folder / "study.yaml", study.text);
}

void try_set_up(const StudyRuns& runs, const StudyOptions& options) {
  for (const StudyRun* run : all_of(runs)) {
    if (!run->program.empty()) continue;  // that program sees for itself
    if (!options.force && earlier_run(*run, options.folder, options.threads).ended) continue;
    if (run->scene.dimension() == 3) {
      Step<3> step(run->scene);
    } else {
      Step<2> step(run->scene);
    }
  }
}

StudyProgress run_study(const StudyRuns& runs, const StudyOptions& options) {
  const std::vector<const StudyRun*> all = all_of(runs);
  StudyProgress progress;
  for (std::size_t k = 0; k < all.size() && !progress.stopped; ++k) {
    const StudyRun& run = *all[k];
    const auto ended = [&](const std::string& note) {
      if (options.ended) options.ended(run, note);
    };
    if (options.starting) options.starting(run, k + 1, all.size());
    const EarlierRun earlier = earlier_run(run, options.folder, options.threads);
    if (earlier.ended && !options.force) {
      ++progress.kept;
      ended("kept: " + earlier.note);
      continue;
    }
    const std::string again =
        options.force || earlier.note.empty() ? "" : fmt::format(" (again: {})", earlier.note);
    ++progress.ran;
    try {
      if (!run.program.empty()) {
        const std::string status = run_by_program(run, options.folder, options.threads);
        ended(status + again);
        progress.stopped = status == "stopped";
        continue;
      }
      const RunSummary summary = run_scene(run.scene, options_of(run, options));
      ended(fmt::format("{}, {:.2f} s{}", summary.status, summary.wall, again));
      progress.stopped = summary.status == "stopped";
    } catch (const RunFailure& failure) {
      ended(fmt::format("failed: {}{}", failure.what(), again));
    }
    progress.stopped = progress.stopped || (options.stop_signal && *options.stop_signal);
  }
  return progress;
}

}  // namespace mpmfast
