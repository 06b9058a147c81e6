#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "assets.hpp"
#include "engine/errors.hpp"
#include "engine/geometry/read_regular.hpp"
#include "engine/output/files.hpp"
#include "engine/output/json_depth.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/shown_units.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/scene/text/diagnostic.hpp"
#include "frames.hpp"
#include "mpmfast_version.hpp"
#include "pack.hpp"
#include "tools/study/table.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPageBytes = 20'000'000;
constexpr std::size_t kMostHistory = 1'000'000;  // numbers

std::string read_text(const fs::path& path) {
  constexpr std::uintmax_t kLargestFile = 64u << 20;  // bytes; a scene, or a run.json with its warnings
  std::string why_not;
  const auto text = read_regular(path, kLargestFile, why_not);
  if (!text) throw FileError(fmt::format("cannot read {}: {}", path.string(), why_not));
  return *text;
}

void check_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(
        fmt::format("{}: no such folder (the output folder of a run was expected)", folder.string()));
  for (const char* name : {"scene.yaml", "history.csv"})
    if (!fs::is_regular_file(folder / name, error))
      throw FileError(
          fmt::format("{} is not the output folder of a run: it holds no {}", folder.string(), name));
}

/// Null while the run goes on, or after it was killed.
Json read_run(const fs::path& folder) {
  const fs::path path = folder / "run.json";
  std::error_code error;
  if (!fs::exists(path, error)) return nullptr;
  const std::string text = read_text(path);
  Json run = is_shallow_json(text) ? Json::parse(text, nullptr, false) : Json();
  if (!run.is_object())
    throw FileError(fmt::format("{} is no run.json of a run: not a JSON object", path.string()));
  return run;
}

/// Nothing, with a notice, where the scene cannot be read again, such as when its picture was moved away.
std::optional<Scene> read_names(const fs::path& folder, std::vector<std::string>& notices) {
  try {
    return read_scene(folder / "scene.yaml");
  } catch (const std::exception& error) {
    std::string why = error.what();
    why = why.substr(0, why.find('\n'));
    notices.push_back(
        fmt::format("The scene could not be read again, so materials have numbers for names and undeformed "
                    "particles are taken for squares: {}",
                    why));
    return std::nullopt;
  }
}

/// Every so many rows, and the last one.
std::vector<std::size_t> shown_rows(const Table& table, std::vector<std::string>& notices) {
  const std::size_t rows = table.rows(), stride = rows * table.names.size() / kMostHistory + 1;
  std::vector<std::size_t> shown;
  for (std::size_t row = 0; row < rows; ++row)
    if (row % stride == 0 || row + 1 == rows) shown.push_back(row);
  if (stride > 1)
    notices.push_back(
        fmt::format("One of {} rows of the history is shown, to keep this page small.", stride));
  return shown;
}

/// Energies make small differences of large numbers: they, and time, stay as they are, the rest is rounded to
/// seven digits.
bool stays_exact(const std::string& name) {
  return name == "step" || name == "time_s" || (name.size() > 2 && name.substr(name.size() - 2) == "_J");
}

Json pack_history(const Table& table, Chunks& chunks, std::vector<std::string>& notices) {
  std::vector<double> exact;
  std::vector<float> rounded;
  Json columns = Json::array();
  const std::vector<std::size_t> rows = shown_rows(table, notices);
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    const bool whole = stays_exact(table.names[c]);
    columns.push_back({{"name", table.names[c]}, {"exact", whole}});
    for (const std::size_t row : rows)
      if (whole) {
        exact.push_back(table.columns[c][row]);
      } else {
        rounded.push_back(static_cast<float>(table.columns[c][row]));
      }
  }
  const auto pack = [&](const auto& numbers) {
    return chunks.add(
        deflated({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0])}));
  };
  return {{"rows", rows.size()}, {"columns", columns}, {"exact", pack(exact)}, {"rounded", pack(rounded)}};
}

/// As the history names them: bodies that a picture makes have no name in the scene.
std::vector<std::string> body_names(const Table& history) {
  constexpr std::string_view end = ".mass_kg";
  std::vector<std::string> names;
  for (const std::string& name : history.names)
    if (name.size() > end.size() && name.substr(name.size() - end.size()) == end)
      names.push_back(name.substr(0, name.size() - end.size()));
  return names;
}

/// Only in space is there a shear stress across the plane.
int dimension_of(const Table& history) { return history.find("all.mean_stress_yz_Pa") ? 3 : 2; }

/// JSON that no text in it can end the script of.
std::string script_text(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

/// The template with what it names between doubled braces.
std::string filled(std::string_view text, const std::vector<std::pair<std::string, std::string>>& parts) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find("{{", at), close = text.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) return out.append(text.substr(at));
    out.append(text.substr(at, open - at));
    const std::string name(text.substr(open + 2, close - open - 2));
    for (const auto& [key, value] : parts)
      if (key == name) out += value;
    at = close + 2;
  }
  return out;
}

std::string chunk_scripts(const Chunks& chunks) {
  std::string out;
  for (std::size_t k = 0; k < chunks.all().size(); ++k)
    out +=
        fmt::format("<script type=\"text/plain\" id=\"chunk-{}\">{}</script>\n", k, base64(chunks.all()[k]));
  return out;
}

std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

}  // namespace

ReportResult write_report(const fs::path& folder, const fs::path& html) {
  check_folder(folder);
  ReportResult result;
  Chunks chunks;
  const Table history = read_table(folder / "history.csv", Unended::torn);
  const std::optional<Scene> scene = read_names(folder, result.notices);
  const std::string scene_text = read_text(folder / "scene.yaml");
  Json json;
  std::error_code error;
  const std::string name = fs::weakly_canonical(folder, error).filename().string();
  json["title"] = scene && !scene->title.empty() ? scene->title : name;
  json["folder"] = name;
  json["program"] = fmt::format("mpmfast {} ({})", kVersion, kGit);
  json["run"] = read_run(folder);
  json["scene"] = scene_text;
  json["bodies"] = body_names(history);
  json["materials"] = Json::array();
  if (scene)
    for (const auto& material : scene->materials) json["materials"].push_back(material.name);
  if (scene) {
    const DisplayUnit unit = length_unit(*scene);
    json["length"] = {{"name", unit.name}, {"size", unit.in_si}};
  }
  for (const char* unit : {"J", "N", "kg", "N m", "kg m/s"})
    json["units"][unit] = scene ? shown_unit(*scene, unit) : unit;
  json["axisymmetric"] = scene && scene->space == Space::axisymmetric;
  json["picture"] = scene ? scene->output.picture : "pressure";
  json["failed_file"] = fs::exists(folder / "failed.vtu", error);
  json["history"] = pack_history(history, chunks, result.notices);
  std::size_t used = script_text(json).size() + report_assets::kScript.size() + report_assets::kStyle.size();
  for (const std::string& chunk : chunks.all()) used += base64_size(chunk.size());
  FrameLimits limits;
  limits.bytes =
      (kPageBytes - std::min(kPageBytes, used)) / 100 * 74;  // of base64, and what names the columns
  json["frames"] = pack_frames(folder, scene, dimension_of(history), limits, chunks, result.notices);
  json["notices"] = result.notices;
  const std::string page =
      filled(report_assets::kTemplate, {{"title", escaped(json["title"])},
                                        {"style", std::string(report_assets::kStyle)},
                                        {"report", script_text(json)},
                                        {"chunks", chunk_scripts(chunks)},
                                        {"script", std::string(report_assets::kScript)}});
  write_aside(html, page);
  result.bytes = page.size();
  return result;
}

}  // namespace mpmfast
