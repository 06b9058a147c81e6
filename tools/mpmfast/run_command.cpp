#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include "commands.hpp"
#include "complain.hpp"
#include "engine/errors.hpp"
#include "engine/run/run.hpp"
#include "exit_codes.hpp"
#include "progress_display.hpp"
#include "shell_text.hpp"
#include "signals.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

void print_passes(const RunSummary& summary) {
  if (summary.seconds.empty()) return;
  std::size_t width = 0;
  for (const auto& [pass, seconds] : summary.seconds) width = std::max(width, pass.size());
  say("seconds by pass\n");
  for (const auto& [pass, seconds] : summary.seconds) {
    if (seconds == 0) continue;  // it did not run
    const double share = summary.wall > 0 ? 100 * seconds / summary.wall : 0;
    say("  {:<{}}  {:9.3f} s  {:5.1f} %\n", pass, width, seconds, share);
  }
}

void print_contact(const RunSummary::Contact& contact) {
  if (contact.nodes_peak == 0) return;
  say("contact          {} nodes at most, {} screened in all; ", contact.nodes_peak, contact.screened);
  say("{} normals of {:.2f} iterations: ", contact.regressions, contact.mean_iterations);
  say("{} did not converge, {} fell back ({} doubtful)\n", contact.unconverged, contact.fallbacks,
      contact.doubtful);
}

/// Where to look at the results.
void print_files(const fs::path& folder) {
  std::vector<std::string> pictures;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("picture_", 0) == 0 && entry.path().extension() == ".png")
      pictures.push_back(entry.path().string());
  }
  std::sort(pictures.begin(), pictures.end());
  for (const std::string& picture : pictures) say("picture          {}\n", picture);
  const fs::path series = folder / "particles.pvd";
  if (fs::exists(series, error)) say("particles        {}\n", series.string());
  say("output           {}\n", folder.string());
  say("report           mpmfast report {}\n", shell_text(folder.string()));
}

std::string ending(const std::string& reason) {
  if (reason.empty()) return "";
  if (reason == "signal") return " by a signal";
  if (reason == "steps") return " the steps asked for";
  return ": " + reason;
}

void print_summary(const RunSummary& summary, const fs::path& folder) {
  say("{}{} at {}, step {}\n", summary.status, ending(summary.reason), time_text(summary.time),
      summary.steps);
  say("wall time        {:.2f} s on {} thread{}\n", summary.wall, summary.threads,
      summary.threads == 1 ? "" : "s");
  say("speed            {}particle-steps/s ({} particles, {} fields)\n",
      count_text(summary.particle_steps_per_second), summary.particles, summary.fields);
  say("memory           {:.1f} MiB at most\n",
      static_cast<double>(summary.peak_memory_bytes) / (1024.0 * 1024.0));
  print_passes(summary);
  print_contact(summary.contact);
  say("energy error     {:.3g} %\n", 100 * summary.energy_error);
  for (const RunWarning& warning : run_warnings(summary)) say("warning          {}\n", warning.text);
  say("checksum         {}\n", summary.checksum);
  print_files(folder);
  std::error_code error;
  if (summary.status == "stopped" && fs::exists(folder / "checkpoint.h5", error))
    say("to go on         mpmfast resume {}\n", shell_text(folder.string()));
}

/// What a run that failed has left.
void print_remains(const fs::path& folder) {
  const auto remains = [&](const char* name) {
    std::error_code error;
    return fs::exists(folder / name, error);
  };
  complain("kept             {}: the history, pictures and particles so far\n", folder.string());
  if (remains("failed.vtu"))
    complain("the place        {}: the particles around it\n", (folder / "failed.vtu").string());
  complain("report           mpmfast report {}\n", shell_text(folder.string()));
  if (remains("checkpoint.h5"))
    complain("to go on         mpmfast resume {} (from the last checkpoint)\n", shell_text(folder.string()));
}

/// Reads the scene and says what in it is likely a mistake.
Scene read_and_warn(const CommandLine& line, std::vector<std::string>& warnings) {
  std::vector<Diagnostic> found;
  Scene scene = read_scene(line.scene, line.overrides(), &found);
  for (const Diagnostic& warning : found) warnings.push_back(warning.warning());
  for (const std::string& warning : warnings) complain("{}\n", warning);
  return scene;
}

void say_warning(const std::string& warning) { complain("mpmfast: warning: {}\n", warning); }

fs::path output_folder(const CommandLine& line) {
  return line.out.empty() ? fs::path("runs") / fs::path(line.scene).stem() : fs::path(line.out);
}

/// @param run  starts or resumes; nothing where there is nothing to do
int run_and_report(const CommandLine& line, RunOptions& options,
                   const std::function<std::optional<RunSummary>()>& run) {
  catch_stop_signals();
  ProgressDisplay display(line.progress);
  options.threads = line.threads;
  options.until = line.until;
  options.command = line.text;
  options.progress = [&](const Progress& progress) { display.show(progress); };
  options.stop_signal = stop_signal();
  std::optional<RunSummary> summary;
  try {
    summary = run();
  } catch (const RunFailure& failure) {
    display.finish();
    complain("mpmfast: the run failed: {}\n", failure.what());
    for (const std::string& warning : failure.warnings()) complain("warning          {}\n", warning);
    print_remains(options.folder);
    return kExitRunFailed;
  } catch (...) {
    display.finish();
    throw;
  }
  display.finish();
  if (!summary) {
    say("the run in {} has come so far already; a later --until TIME lets it go on\n",
        options.folder.string());
    return 0;
  }
  print_summary(*summary, options.folder);
  const int signal = *stop_signal();
  return signal != 0 && summary->status == "stopped" ? kExitSignal + signal : 0;
}

}  // namespace

int run_command(const CommandLine& line) {
  RunOptions options;
  const Scene scene = read_and_warn(line, options.scene_warnings);
  const fs::path folder = output_folder(line);
  std::error_code error;
  const bool empty = fs::is_directory(folder, error) && fs::is_empty(folder, error);
  if (!line.force && !empty && fs::exists(fs::symlink_status(folder, error))) {
    complain(
        "mpmfast: the output folder {} exists (--force replaces a run, --out DIR names another folder)\n",
        folder.string());
    return kExitWrongInput;
  }
  options.folder = folder;
  options.force = line.force;
  options.max_steps = line.steps;
  options.overrides = line.set;
  options.warn = say_warning;
  return run_and_report(line, options, [&] { return std::optional(run_scene(scene, options)); });
}

int resume_command(const CommandLine& line) {
  RunOptions options;
  options.folder = line.scene;
  options.warn = say_warning;
  return run_and_report(line, options, [&] { return resume_run(options); });
}

int check_command(const CommandLine& line) {
  std::vector<std::string> warnings;
  const Scene scene = read_and_warn(line, warnings);
  std::string plan = describe_plan(scene, line.verbose);
  while (!plan.empty() && plan.back() == '\n') plan.pop_back();
  say("{}\n", plan);
  return 0;
}

}  // namespace mpmfast
