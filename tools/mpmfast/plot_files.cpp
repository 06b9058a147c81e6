#include "plot_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/canvas.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

/// Has --out the name of a file, and is it no folder that exists?
bool names_file(const CommandLine& line) {
  std::error_code error;
  return fs::path(line.out).has_extension() && !fs::is_directory(line.out, error);
}

/// What is wrong with --out FILE; empty when nothing is.
std::string wrong_file(const CommandLine& line) {
  const std::size_t pictures = asks_for_particles(line) ? std::max<std::size_t>(line.fields.size(), 1) : 0;
  if (pictures + (line.columns.empty() ? 0 : 1) != 1)
    return fmt::format(
        "--out: one file holds one picture (--columns, or one --field), got '{}'. A folder takes all",
        line.out);
  if (!picture_format(line.out))
    return fmt::format("--out: a picture is drawn as svg, png or pdf, got '{}'", line.out);
  return "";
}

/// The runs of a study: folders with a history.
std::vector<std::string> runs_of_study(const fs::path& folder) {
  constexpr std::size_t kShown = 3;
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (fs::is_regular_file(entry.path() / "history.csv", error)) out.push_back(entry.path().string());
  std::sort(out.begin(), out.end());
  if (out.size() > kShown) {
    out.resize(kShown);
    out.emplace_back("…");
  }
  return out;
}

}  // namespace

bool asks_for_particles(const CommandLine& line) {
  return !line.fields.empty() || !line.frame.empty() || !line.range.empty();
}

PlotFiles plot_files(const CommandLine& line) {
  if (!line.out.empty() && names_file(line)) {
    const fs::path folder = fs::path(line.out).parent_path();
    return {folder.empty() ? "." : folder, line.out};
  }
  if (!line.out.empty()) return {line.out, {}};
  return {line.folders.size() > 1 ? fs::path(".") : fs::path(line.folders[0]), {}};
}

std::string contradiction(const CommandLine& line) {
  const bool several = line.folders.size() > 1, particles = asks_for_particles(line);
  if (several && particles) return "--field, --frame and --range draw the particles of one run";
  if (several && line.columns.empty())
    return "several runs in one chart: --columns says what of each is drawn";
  const std::pair<const char*, bool> of_chart[] = {{"--title", !line.title.empty()},
                                                   {"--label", !line.labels.empty()},
                                                   {"--x-label", !line.x_label.empty()},
                                                   {"--y-label", !line.y_label.empty()}};
  for (const auto& [option, given] : of_chart)
    if (given && line.columns.empty())
      return fmt::format("{} is that of the chart of --columns, which is missing", option);
  const std::size_t named = several ? line.folders.size() : line.columns.size();
  if (!line.labels.empty() && line.labels.size() != named)
    return fmt::format("--label: one for each of the {} {}, got {}", named, several ? "runs" : "columns",
                       line.labels.size());
  if (line.x != "time_s" && particles && line.columns.empty())
    return "--x is for charts of the history: --columns is missing";
  return !line.out.empty() && names_file(line) ? wrong_file(line) : "";
}

void check_run_folder(const fs::path& folder) {
  std::error_code error;
  for (const char* name : {"history.csv", "particles.pvd"})
    if (fs::is_regular_file(folder / name, error)) return;
  if (!fs::is_directory(folder, error))
    throw FileError(
        fmt::format("{}: no such folder (the output folder of a run was expected)", folder.string()));
  if (fs::is_regular_file(folder / "study.csv", error))
    throw FileError(fmt::format(
        "{} is the folder of a study: its charts are there already (.svg, .png). Plot its runs: {}",
        folder.string(), fmt::join(runs_of_study(folder), ", ")));
  throw FileError(
      fmt::format("{} is not the output folder of a run: it holds no history.csv", folder.string()));
}

}  // namespace mpmfast
