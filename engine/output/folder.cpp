#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "engine/errors.hpp"
#include "engine/geometry/read_regular.hpp"
#include "engine/output/files.hpp"
#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"

namespace mpmfast {
namespace {

constexpr std::array<std::string_view, 8> kOurFiles{"scene.yaml",  "run.json",      "run.log",
                                                    "history.csv", "particles.pvd", "grid.pvd",
                                                    "failed.vtu",  "checkpoint.h5"};
/// Those of which one at least proves that a run was here: a scene.yaml may be anyone's.
constexpr std::array<std::string_view, 4> kProofs{"run.json", "run.log", "history.csv", "checkpoint.h5"};
constexpr std::array<std::string_view, 2> kSeries{"particles", "grid"};

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Of space, whose names hold those of the plane.
bool is_field(std::string_view text) {
  const std::vector<std::string> known = field_names(3);
  return std::find(known.begin(), known.end(), text) != known.end();
}

/// plot_energy.svg and the like; its script may have been edited.
bool is_chart(std::string_view name) {
  const auto point = name.rfind('.');
  if (point == std::string_view::npos) return false;
  const std::string_view stem = name.substr(0, point), format = name.substr(point);
  return (format == ".png" || format == ".svg" || format == ".pdf") &&
         std::find(kChartStems.begin(), kChartStems.end(), stem) != kChartStems.end();
}

/// picture_first_FIELD.png, picture_last_FIELD.png, plot_FIELD.png, plot_FIELD_NNNNNN.png.
bool is_picture(std::string_view name) {
  if (!ends_with(name, ".png")) return false;
  name.remove_suffix(4);
  for (const std::string_view begin : {"picture_first_", "picture_last_"})
    if (name.substr(0, begin.size()) == begin) return is_field(name.substr(begin.size()));
  constexpr std::string_view kPlot = "plot_";
  if (name.substr(0, kPlot.size()) != kPlot) return false;
  name.remove_prefix(kPlot.size());
  if (is_field(name)) return true;
  const auto last = name.rfind('_');
  return last != std::string_view::npos && name.size() - last > 6 && all_digits(name.substr(last + 1)) &&
         is_field(name.substr(0, last));
}

/// A name that a run of ours writes at the top of its folder.
bool is_ours(std::string name) {
  if (ends_with(name, ".tmp")) name.resize(name.size() - 4);
  if (std::find(kOurFiles.begin(), kOurFiles.end(), name) != kOurFiles.end()) return true;
  // What `mpmfast plot` and `report` made of the earlier run would belong to another one.
  return name == "report.html" || is_chart(name) || is_picture(name);
}

/// NNNNNN.vtu, or what a kill left of it.
bool is_frame(std::string name) {
  if (ends_with(name, ".tmp")) name.resize(name.size() - 4);
  if (!ends_with(name, ".vtu") || name.size() < 10) return false;
  return all_digits(std::string_view(name).substr(0, name.size() - 4));
}

template <class Chosen>
void remove_files(const std::filesystem::path& folder, Chosen chosen) {
  std::error_code error;
  std::vector<std::filesystem::path> doomed;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (!entry->is_directory(error) && chosen(entry->path().filename().string()))
      doomed.push_back(entry->path());
  if (error) throw_file_error("read the folder", folder, error.value());
  for (const auto& path : doomed) {
    std::filesystem::remove(path, error);
    if (error) throw_file_error("remove", path, error.value());
  }
}

bool holds_text(const std::filesystem::path& path, const std::string& text) {
  std::string why_not;
  return read_regular(path, text.size(), why_not) == text;
}

/// --force may replace a run of ours, and what a run left that was killed as it began; never what a user
/// wrote.
void check_replaceable(const std::filesystem::path& folder, const Scene& scene) {
  std::error_code error;
  if (std::filesystem::is_empty(folder, error)) return;
  const auto itself = folder.has_filename() ? folder : folder.parent_path();  // a last / would follow a link
  if (std::filesystem::is_symlink(itself, error))
    throw FileError(fmt::format("{} is a symbolic link, and --force removes nothing behind one (--out {})",
                                folder.string(), std::filesystem::weakly_canonical(folder, error).string()));
  const bool same_scene = holds_text(folder / "scene.yaml", scene.resolved_yaml);
  if (!same_scene && std::filesystem::equivalent(scene.file, folder / "scene.yaml", error))
    throw FileError(fmt::format("{} is the scene that is to run: --force would replace it with the run's own",
                                scene.file.string()));
  const bool holds_run = std::any_of(kProofs.begin(), kProofs.end(), [&](std::string_view name) {
    return std::filesystem::exists(folder / name, error);
  });
  const auto begun = folder / "scene.yaml.tmp";
  if (!holds_run && !same_scene && !std::filesystem::exists(begun, error))
    throw FileError(fmt::format("{} holds no run (none of {}), and --force replaces nothing else",
                                folder.string(), fmt::join(kProofs, ", ")));
}

/// A run that goes on holds its history too: where folders cannot be locked, this is what is left.
void check_unclaimed(const std::filesystem::path& folder) {
  const auto history = folder / "history.csv";
  std::error_code error;
  if (!std::filesystem::is_regular_file(history, error) || ::access(history.c_str(), W_OK) != 0) return;
  if (!Descriptor::open(history, true).claim())
    throw FileError(folder.string() + " belongs to a run that goes on now");
}

void remove_earlier_run(const std::filesystem::path& folder) {
  remove_files(folder, is_ours);
  for (const std::string_view series : kSeries) {
    const auto frames = folder / series;
    std::error_code error;
    if (std::filesystem::is_symlink(frames, error)) {  // the link goes, what is behind it stays
      std::filesystem::remove(frames, error);
      if (error) throw_file_error("remove", frames, error.value());
    }
    if (!std::filesystem::is_directory(frames, error)) continue;
    remove_files(frames, is_frame);
    if (std::filesystem::is_empty(frames, error)) std::filesystem::remove(frames, error);
  }
}

}  // namespace

void reopen_folder(const std::filesystem::path& folder) {
  const auto half_written = [](const std::string& name) { return ends_with(name, ".tmp") && is_ours(name); };
  remove_files(folder, [&](const std::string& name) {
    return name == "run.json" || name == "failed.vtu" || half_written(name);
  });
  std::error_code error;
  for (const std::string_view series : kSeries)
    if (std::filesystem::is_directory(folder / series, error))
      remove_files(folder / series,
                   [](const std::string& name) { return ends_with(name, ".tmp") && is_frame(name); });
}

FolderLock prepare_folder(const std::filesystem::path& folder, const Scene& scene, bool force) {
  if (has_control_character(folder))
    throw FileError("the name of the output folder holds a control character");
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error))
    throw FileError("output folder " + folder.string() + " is a file");
  make_folder(folder);
  FolderLock lock(folder, FolderWriter::run);
  check_unclaimed(folder);
  if (!force && !std::filesystem::is_empty(folder, error))
    throw FileError("output folder " + folder.string() +
                    " exists already; with force the run in it is replaced");
  check_replaceable(folder, scene);
  remove_earlier_run(folder);
  write_aside(folder / "scene.yaml", scene.resolved_yaml);
  return lock;
}

}  // namespace mpmfast
