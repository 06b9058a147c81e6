#pragma once

/// @file What the runs of a study came to.

#include <string>
#include <vector>

#include "conditions.hpp"
#include "study.hpp"

namespace mpmfast {

struct StudyResult {
  std::string status;  ///< of run.json: finished, failed; empty when not run yet
  std::string reason;  ///< of run.json: why it failed
  /// Of error_specs(), or the largest share of a condition's bound; not a number where nothing can be
  /// compared.
  std::vector<double> errors;
  std::vector<std::optional<Judgement>> judged;    ///< of Study::conditions; nothing where one does not apply
  std::vector<double> quantities;                  ///< of Study::quantities
  double value = 0;                                ///< of Study::error, where it looks for one
  double reached = 0;                              ///< x of the last row of the history
  double particle_steps = 0, wall = 0, speed = 0;  ///< speed: particle-steps per second of stepping
  double mean_iterations = 0, energy_error = 0;
  std::uint64_t fallbacks = 0, unconverged = 0;
  double doubtful = 0;  ///< share of the normals of surfaces that touch or overlap; not a number without any
  bool pareto = false;
};

/// Has the run finished, and does every condition hold that applies?
bool holds(const StudyResult& result);

/// The machine and the program of the first run.
struct StudyMachine {
  std::string cpu, version;
  int threads = 0;
};

struct StudyResults {
  std::vector<StudyResult> variants;  ///< as StudyRuns::variants
  StudyMachine machine;
  bool reference_failed = false;
};

/// Reads run.json and history.csv of every run that has ended below `folder`, measures errors and marks the
/// front of those that finished. Throws FileError.
StudyResults collect_results(const Study& study, const StudyRuns& runs, const std::filesystem::path& folder);

/// What an earlier start of the study left of a run.
struct EarlierRun {
  /// Finished or failed, with this scene and by this program, its history as it wrote it: nothing to do.
  bool ended = false;
  /// By a signal or a full disk, with this scene and by this program: its checkpoint serves.
  bool stopped = false;
  std::string note;        ///< how it ended, or why it does not count; empty when there is nothing
  bool unwritten = false;  ///< stopped, since a file could not be written
};

/// @param threads  the earlier run must have had as many, unless 0
EarlierRun earlier_run(const StudyRun& run, const std::filesystem::path& folder, int threads);

/// The x and y of one run's history.
Curve history_curve(const StudyRun& run, const std::filesystem::path& folder, const Expression& x,
                    const Expression& y);

double cost_of(const StudyResult& result, Cost cost);

}  // namespace mpmfast
