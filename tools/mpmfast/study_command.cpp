#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "commands.hpp"
#include "complain.hpp"
#include "exit_codes.hpp"
#include "progress_display.hpp"
#include "signals.hpp"
#include "tools/study/other_program.hpp"
#include "tools/study/report.hpp"
#include "tools/study/run_study.hpp"
#include "tools/study/stability_map.hpp"
#include "tools/study/study_folder.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

std::string counts_text(const StudyCounts& counts) {
  return fmt::format("{} under way, {} done, {} failed{}, {} to come", counts.under_way, counts.done,
                     counts.failed, counts.lost > 0 ? fmt::format(", {} lost", counts.lost) : "",
                     counts.to_come);
}

StudyOptions options_of(const CommandLine& line, ProgressDisplay& display) {
  StudyOptions options;
  options.folder = line.out.empty() ? fs::path("runs") / fs::path(line.scene).stem() : fs::path(line.out);
  options.threads = line.threads;
  options.jobs = line.jobs;
  options.launcher = line.launcher;
  options.program = fs::read_symlink("/proc/self/exe");
  options.restarts = line.restarts;
  options.force = line.force;
  options.command = line.text;
  options.stop_signal = stop_signal();
  const bool quiet = line.progress == ProgressStyle::none;
  options.progress = [&display](const Progress& progress) { display.show(progress); };
  options.starting = [&display, quiet](const StudyRun& run, std::size_t index, std::size_t count) {
    display.clear();
    if (!quiet) complain("[{}/{}] {}\n", index, count, run.name);
  };
  options.ended = [&display, quiet](const StudyRun&, const std::string& note) {
    display.finish();
    if (!quiet) complain("    {}\n", note);
  };
  options.again = [&display, quiet](const StudyRun& run, const std::string& note) {
    display.clear();
    if (!quiet) complain("{}: {}\n", run.name, note);
  };
  if (!line.launcher.empty())
    options.counted = [&display, ended = std::size_t{0}](const StudyCounts& counts) mutable {
      const std::size_t before = std::exchange(ended, counts.done + counts.failed + counts.lost);
      display.show(counts_text(counts), ended != before);
    };
  return options;
}

auto failures(const StudyResults& results) {
  return std::count_if(results.variants.begin(), results.variants.end(),
                       [](const StudyResult& result) { return result.status == "failed"; });
}

/// Says which do not. A file that was removed while the study went on may be why.
bool all_have_results(const StudyRuns& runs, const StudyResults& results) {
  bool all = true;
  for (std::size_t k = 0; k < results.variants.size(); ++k)
    if (results.variants[k].status.empty()) {
      complain("mpmfast: no result of the run '{}' is left in its folder\n", runs.variants[k].name);
      all = false;
    }
  return all;
}

}  // namespace

int study_command(const CommandLine& line) {
  const Study study = read_study(line.scene);
  const StudyRuns runs = expand_study(study);
  ProgressDisplay display(line.progress);
  const StudyOptions options = options_of(line, display);
  if (!may_hold_study(options.folder)) {
    complain("mpmfast: the output folder {} holds something else than a study (--out DIR names another)\n",
             options.folder.string());
    return kExitWrongInput;
  }
  if (const std::string why = other_study(study, runs, options.folder); !why.empty() && !line.force) {
    complain("mpmfast: {} (--force replaces it, --out DIR names another folder)\n", why);
    return kExitWrongInput;
  }
  check_programs(study);
  try_set_up(runs, options);
  catch_stop_signals();
  const FolderLock lock = prepare_study_folder(study, options.folder);
  const StudyProgress progress = run_study(runs, options);
  const StudyResults results = collect_results(study, runs, options.folder);
  const std::vector<std::string> missing = write_report(study, runs, results, options.folder);
  say("{}\nruns             {} now, {} kept{}\noutput           {}\n",
      study.map ? map_overview(study, runs, results) : study_table(study, runs, results), progress.ran,
      progress.kept, progress.kept > 0 ? " (--force runs all again)" : "", options.folder.string());
  if (const auto failed = failures(results); failed > 0)
    say("failed           {} of {} variants (study.csv says why)\n", failed, results.variants.size());
  if (progress.lost > 0)
    say("lost             {} of {} runs (said above); the same command tries them again\n", progress.lost,
        progress.ran + progress.kept);
  for (const std::string& why : missing) complain("mpmfast: {}\n", why);
  if (!progress.stopped) return progress.lost > 0 || !all_have_results(runs, results) ? kExitFile : 0;
  const int signal = *stop_signal();
  return kExitSignal +
         (signal != 0 ? signal : SIGTERM);  // none came to us: a program of the study was stopped
}

}  // namespace mpmfast
