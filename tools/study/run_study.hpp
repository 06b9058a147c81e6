#pragma once

/// @file Runs the variants of a study, one after another or side by side, here or where a launcher starts
/// them, each in a folder of its own.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/run/run.hpp"
#include "study.hpp"

namespace mpmfast {

/// Where the runs of a study stand.
struct StudyCounts {
  std::size_t under_way = 0, done = 0, failed = 0, lost = 0, to_come = 0;
};

struct StudyOptions {
  std::filesystem::path folder;
  int threads = 0;     ///< 0: as a single run; 1 when there are several jobs here, or a launcher
  int jobs = 1;        ///< runs side by side; their wall times are then of a busy machine
  bool force = false;  ///< also what has ended already
  std::string command;
  std::vector<std::string> launcher;  ///< starts the runs elsewhere (Launch::words); empty: they run here
  std::filesystem::path program;      ///< what it starts: mpmfast, by an absolute path
  int restarts = 2;                   ///< of a run that the launcher loses
  const volatile int* stop_signal = nullptr;
  /// All may be empty; called by one run at a time. With several jobs or a launcher `progress` is not called.
  /// `note` says how a run ended, or why it is started again.
  std::function<void(const StudyRun&, std::size_t index, std::size_t count)> starting;
  std::function<void(const Progress&)> progress;
  std::function<void(const StudyRun&, const std::string&note)> ended, again;
  std::function<void(const StudyCounts&)> counted;
};

/// Is the folder absent, empty, or that of a study? A study that begins, or was killed as it began, has only
/// study.yaml.tmp.
bool may_hold_study(const std::filesystem::path& folder);

/// Makes the folder and keeps the study in it. What it returns holds the folder: refuses one in which a study
/// goes on. Throws FileError.
FolderLock prepare_study_folder(const Study& study, const std::filesystem::path& folder);

/// Sets every run up that has not ended, and drops it: throws SceneError before anything is written when one
/// cannot be (a particle outside the grid).
void try_set_up(const StudyRuns& runs, const StudyOptions& options);

struct StudyProgress {
  std::size_t ran = 0, kept = 0;  ///< kept: what an earlier start had ended
  std::size_t lost = 0;           ///< by the launcher, as often as they were started
  bool stopped = false;           ///< by a signal
};

/// Runs what has not ended; a run that fails physically is kept as far as it got, one that a launcher loses
/// holds up no other. Throws FileError.
StudyProgress run_study(const StudyRuns& runs, const StudyOptions& options);

}  // namespace mpmfast
