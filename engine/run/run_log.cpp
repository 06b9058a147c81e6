#include "engine/run/run_log.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>

#include "engine/quantities/printable.hpp"

namespace mpmfast {

namespace {

std::string threads_text(int threads) { return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"); }

}  // namespace

RunLog::RunLog(const std::filesystem::path& folder, const RunSummary& figures)
    : file_(folder / "run.log", figures.resumes > 0 ? std::ios::app : std::ios::trunc) {
  if (figures.resumes > 0) {
    fmt::print(file_, "goes on from step {} at {:.6g} s ({}, {})\n", figures.steps, figures.time,
               program_text(), threads_text(figures.threads));
    return;
  }
  fmt::print(file_, "{}\n{}\n{}: {} particles in {} velocity fields, {}-D, {}\n", program_text(),
             printable(figures.command), printable(figures.scene_name), figures.particles, figures.fields,
             figures.dimension, threads_text(figures.threads));
  for (const std::string& warning : figures.scene_warnings) fmt::print(file_, "{}\n", printable(warning));
  fmt::print(file_, "{:>10} {:>12} {:>12} {:>10} {:>17} {:>13}\n", "step", "time (s)", "dt (s)", "wall (s)",
             "particle-steps/s", "energy error");
  file_.flush();
}

void RunLog::row(const RunSummary& figures, double dt) {
  fmt::print(file_, "{:>10} {:>12.6g} {:>12.4g} {:>10.2f} {:>17.4g} {:>11.3f} %\n", figures.steps,
             figures.time, dt, figures.wall, figures.particle_steps_per_second, 100 * figures.energy_error);
  count(figures);
  file_.flush();  // whoever looks on sees it, and a kill loses nothing
}

void RunLog::count(const RunSummary& figures) {
  ++rows_;
  for (RunWarning& warning : run_warnings(figures)) {
    const auto known = std::find_if(warnings_.begin(), warnings_.end(),
                                    [&](const Counted& c) { return c.warning.about == warning.about; });
    if (known == warnings_.end()) {
      fmt::print(file_, "warning: {}\n", printable(warning.text));
      warnings_.push_back({std::move(warning), 1});
    } else {
      known->warning = std::move(warning);
      ++known->rows;
    }
  }
}

void RunLog::close(const RunSummary& summary) {
  fmt::print(file_, "{}{}{} at step {}, {:.6g} s, after {:.2f} s\n", summary.status,
             summary.reason.empty() ? "" : ": ", printable(summary.reason), summary.steps, summary.time,
             summary.wall);
  for (const auto& [pass, seconds] : summary.seconds)
    if (seconds > 0)  // it ran
      fmt::print(file_, "  {:<18}{:>10.3f} s {:>6.1f} %\n", pass, seconds,
                 summary.wall > 0 ? 100 * seconds / summary.wall : 0);
  for (const Counted& counted : warnings_)
    fmt::print(file_, "warning in {} of {} rows, last: {}\n", counted.rows, rows_,
               printable(counted.warning.text));
  fmt::print(file_, "checksum {}\n", summary.checksum);
  file_.flush();
}

}  // namespace mpmfast
