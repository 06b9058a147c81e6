#include "run_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/step/step.hpp"
#include "launcher.hpp"
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

bool has_launcher(const StudyOptions& options) { return !options.launcher.empty(); }

bool is_one_by_one(const StudyOptions& options) { return options.jobs <= 1 && !has_launcher(options); }

/// Threads that a run has, and that an earlier one must have had; 0: any number.
int threads_of(const StudyOptions& options) {
  if (has_launcher(options)) return 0;
  return options.jobs > 1 ? 1 : options.threads;
}

RunOptions options_of(const StudyRun& run, const StudyOptions& options) {
  RunOptions out;
  out.folder = options.folder / run.folder;
  out.force = true;  // what an unfinished run left is replaced
  out.threads = threads_of(options);
  out.command = options.command;
  if (is_one_by_one(options)) out.progress = options.progress;
  out.stop_signal = options.stop_signal;
  return out;
}

Launch launch_of(const StudyOptions& options) {
  return {options.launcher, options.program,    options.folder, std::max(1, options.threads),
          options.restarts, options.stop_signal};
}

/// The runs in their order, taken by one worker or several.
class StudyQueue {
 public:
  StudyQueue(const StudyRuns& runs, const StudyOptions& options) : runs_(all_of(runs)), options_(options) {}

  StudyProgress run() {
    std::vector<std::thread> others;
    for (int k = 1; k < options_.jobs; ++k) others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    if (failure_) std::rethrow_exception(failure_);
    return progress_;
  }

 private:
  void work() {
    while (const StudyRun* run = next()) {
      try {
        execute(*run);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
      }
    }
  }

  /// Nothing when all are taken, one could not be written, or a signal came.
  const StudyRun* next() {
    const std::lock_guard lock(mutex_);
    if (options_.stop_signal && *options_.stop_signal) progress_.stopped = true;
    if (progress_.stopped || failure_ || next_ == runs_.size()) return nullptr;
    const StudyRun* run = runs_[next_++];
    if (options_.starting && is_one_by_one(options_)) options_.starting(*run, next_, runs_.size());
    tell_counts();
    return run;
  }

  void execute(const StudyRun& run) {
    const EarlierRun earlier = earlier_run(run, options_.folder, threads_of(options_));
    const bool kept = earlier.ended && !options_.force;
    const std::string again =
        options_.force || earlier.note.empty() ? "" : fmt::format(" (again: {})", earlier.note);
    const Launched ending = kept ? Launched{false, false, earlier.note} : end_of(run, earlier);
    const std::lock_guard lock(mutex_);
    ++(kept ? progress_.kept : progress_.ran);
    ++ended_;
    if (ending.stopped) progress_.stopped = true;
    if (ending.lost) ++progress_.lost;
    if (!ending.stopped) ++(ending.lost ? counts_.lost : failed(ending) ? counts_.failed : counts_.done);
    if (options_.starting && !is_one_by_one(options_)) options_.starting(run, ended_, runs_.size());
    if (options_.ended) options_.ended(run, (kept ? "kept: " : "") + ending.note + again);
    tell_counts();
  }

  /// Runs it, here or elsewhere.
  Launched end_of(const StudyRun& run, const EarlierRun& earlier) {
    if (!has_launcher(options_)) {
      const std::string status = status_of(run, earlier.stopped && !options_.force);
      return {false, status == "stopped", status};
    }
    return run_launched(run, launch_of(options_), options_.force, [&](const std::string& why) {
      const std::lock_guard lock(mutex_);
      if (options_.again) options_.again(run, why);
    });
  }

  static bool failed(const Launched& ending) { return ending.note.starts_with("failed"); }

  /// Under the lock.
  void tell_counts() {
    counts_.under_way = next_ - ended_;
    counts_.to_come = runs_.size() - next_;
    if (options_.counted) options_.counted(counts_);
  }

  /// Runs it here: "finished, 0.25 s", "failed: why".
  std::string status_of(const StudyRun& run, bool go_on) const {
    if (!run.program.empty()) return status_by_program(run);
    const RunOptions how = options_of(run, options_);
    try {
      const std::optional<RunSummary> resumed = go_on ? resume(how) : std::nullopt;
      const RunSummary summary = resumed ? *resumed : run_scene(run.scene, how);
      return summary.status == "stopped" ? summary.status
                                         : fmt::format("{}, {:.2f} s", summary.status, summary.wall);
    } catch (const RunFailure& failure) {
      return fmt::format("failed: {}", failure.what());
    }
  }

  /// Nothing where there is no checkpoint that serves: the run begins anew.
  static std::optional<RunSummary> resume(const RunOptions& how) {
    if (!fs::exists(how.folder / "checkpoint.h5")) return std::nullopt;
    try {
      return resume_run(how);
    } catch (const CannotResume&) {
      return std::nullopt;
    }
  }

  /// By another program, which need not be one that leaves results.
  std::string status_by_program(const StudyRun& run) const {
    const std::string ending =
        run_by_program(run, options_.folder, threads_of(options_), options_.stop_signal);
    const EarlierRun left = earlier_run(run, options_.folder, 0);
    if (left.ended || left.stopped || ending == "stopped") return ending;
    throw FileError(fmt::format("{} left no result of the run '{}': {}", run.program.string(), run.name,
                                left.note.empty() ? "no run.json that can be read" : left.note));
  }

  std::vector<const StudyRun*> runs_;
  const StudyOptions& options_;
  std::mutex mutex_;  ///< over what follows, and the callbacks
  std::size_t next_ = 0, ended_ = 0;
  StudyCounts counts_;
  StudyProgress progress_;
  std::exception_ptr failure_;
};

}  // namespace

bool may_hold_study(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return true;
  // One listing, since another study may begin in the folder while this one looks: asked for in turn, the
  // folder would be neither empty nor hold a study.yaml yet.
  bool holds_study = false, holds_else = false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    holds_study = holds_study || name == "study.yaml";
    holds_else = holds_else || name != "study.yaml.tmp";
  }
  return !error && (holds_study || !holds_else);
}

FolderLock prepare_study_folder(const Study& study, const fs::path& folder) {
  make_folder(folder);
  FolderLock lock(folder, FolderWriter::study);
  write_aside(folder / "study.yaml", study.text);
  return lock;
}

void try_set_up(const StudyRuns& runs, const StudyOptions& options) {
  for (const StudyRun* run : all_of(runs)) {
    if (!run->program.empty()) continue;  // that program sees for itself
    if (!options.force && earlier_run(*run, options.folder, threads_of(options)).ended) continue;
    if (run->scene.dimension() == 3) {
      Step<3> step(run->scene);
    } else {
      Step<2> step(run->scene);
    }
  }
}

StudyProgress run_study(const StudyRuns& runs, const StudyOptions& options) {
  return StudyQueue(runs, options).run();
}

}  // namespace mpmfast
