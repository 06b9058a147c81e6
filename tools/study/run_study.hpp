#pragma once

/// @file Runs the variants of a study, one after another or side by side, each in a folder of its own.

#include <filesystem>
#include <functional>
#include <string>

#include "engine/run/run.hpp"
#include "study.hpp"

namespace mpmfast {

struct StudyOptions {
  std::filesystem::path folder;
  int threads = 0;     ///< 0: as a single run; 1 when there are several jobs
  int jobs = 1;        ///< runs side by side; their wall times are then of a busy machine
  bool force = false;  ///< also what has ended already
  std::string command;
  const volatile int* stop_signal = nullptr;
  /// All may be empty; called by one run at a time. With several jobs `progress` is not called. `note` says
  /// how a run ended.
  std::function<void(const StudyRun&, std::size_t index, std::size_t count)> starting;
  std::function<void(const Progress&)> progress;
  std::function<void(const StudyRun&, const std::string& note)> ended;
};

/// Is the folder absent, empty, or that of a study?
bool may_hold_study(const std::filesystem::path& folder);

/// Makes the folder and keeps the study in it. Throws FileError.
void prepare_study_folder(const Study& study, const std::filesystem::path& folder);

/// Sets every run up that has not ended, and drops it: throws SceneError before anything is written when one
/// cannot be (a particle outside the grid).
void try_set_up(const StudyRuns& runs, const StudyOptions& options);

struct StudyProgress {
  std::size_t ran = 0, kept = 0;  ///< kept: what an earlier start had ended
  bool stopped = false;           ///< by a signal
};

/// Runs what has not ended; a run that fails physically is kept as far as it got. Throws FileError.
StudyProgress run_study(const StudyRuns& runs, const StudyOptions& options);

}  // namespace mpmfast
