#include "stability_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "gnuplot.hpp"

namespace mpmfast {

namespace {

constexpr double kNear = 0.8;  // of a bound: shown in a colour of its own

struct Row {
  std::string name;
  std::vector<const StudyResult*> cells;  ///< by column; nothing where `only` leaves a run out
};

struct Map {
  std::string name, stem;
  std::filesystem::path scene;
  std::vector<std::string> columns;
  std::vector<Row> rows;
  std::vector<std::size_t> conditions;  ///< those that apply to one run at least
};

std::string row_name(const Study& study, const StudyRun& run) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < run.choice.size(); ++k)
    if (k != study.map->panels && k != study.map->columns)
      parts.push_back(study.axes[k].choices[run.choice[k]].label);
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Map> maps_of(const Study& study, const StudyRuns& runs, const StudyResults& results) {
  const Axis& panels = study.axes[study.map->panels];
  const Axis& columns = study.axes[study.map->columns];
  std::vector<Map> out(panels.choices.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].name = panels.choices[k].name;
    out[k].stem = "map_" + file_name_of(out[k].name);
    for (const Choice& choice : columns.choices) out[k].columns.push_back(choice.name);
  }
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const StudyRun& run = runs.variants[k];
    Map& map = out[run.choice[study.map->panels]];
    map.scene = run.scene_file;
    const std::string name = row_name(study, run);
    auto row = std::find_if(map.rows.begin(), map.rows.end(), [&](const Row& r) { return r.name == name; });
    if (row == map.rows.end())
      row = map.rows.insert(row, {name, std::vector<const StudyResult*>(map.columns.size(), nullptr)});
    row->cells[run.choice[study.map->columns]] = &results.variants[k];
    for (std::size_t n = 0; n < study.conditions.size(); ++n)
      if (goes_with(study.axes, run.choice, study.conditions[n].only) &&
          std::find(map.conditions.begin(), map.conditions.end(), n) == map.conditions.end())
        map.conditions.push_back(n);
  }
  for (Map& map : out) std::sort(map.conditions.begin(), map.conditions.end());
  return out;
}

bool was_run(const StudyResult* cell) { return cell && !cell->status.empty(); }

/// The conditions that do not hold, the one furthest from its bound first.
std::vector<std::size_t> broken(const StudyResult& cell) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < cell.judged.size(); ++k)
    if (cell.judged[k] && !cell.judged[k]->holds) out.push_back(k);
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
    return cell.judged[a]->share > cell.judged[b]->share;
  });
  return out;
}

double share_of(const StudyResult& cell) {
  double share = 0;
  for (const auto& judged : cell.judged)
    if (judged) share = std::max(share, judged->share);
  return share;
}

std::string cell_text(const Study& study, const StudyResult* cell) {
  if (!was_run(cell)) return "";
  if (cell->status != "finished") return "stops";
  const std::vector<std::size_t> wrong = broken(*cell);
  return wrong.empty() ? fmt::format("{:.2f}", share_of(*cell)) : study.conditions[wrong.front()].name;
}

const char* cell_colour(const StudyResult* cell) {
  if (!was_run(cell)) return "0xeeeeee";
  if (cell->status != "finished") return "0xd6604d";
  if (!broken(*cell).empty()) return "0xf4a582";
  return share_of(*cell) > kNear ? "0xe6e2a0" : "0xb7e1b1";
}

std::string draw(const Study& study, const Map& map, const std::filesystem::path& folder) {
  std::string data = "$map << EOD\n", rows, columns, texts;
  for (std::size_t y = 0; y < map.rows.size(); ++y) {
    rows += fmt::format("{}{} {}", y ? ", " : "", gnuplot_tic(map.rows[y].name), y);
    for (std::size_t x = 0; x < map.columns.size(); ++x) {
      const StudyResult* cell = map.rows[y].cells[x];
      data += fmt::format("{} {} {}\n", x, y, cell_colour(cell));
      if (was_run(cell))
        texts +=
            fmt::format("set label {} at {},{} center front\n", gnuplot_text(cell_text(study, cell)), x, y);
    }
  }
  data += "EOD\n" + texts;
  for (std::size_t x = 0; x < map.columns.size(); ++x)
    columns += fmt::format("{}{} {}", x ? ", " : "", gnuplot_tic(map.columns[x]), x);
  const std::string plot = fmt::format(
      "set title {}\nset xlabel {}\nset xtics ({}) scale 0\nset ytics ({}) scale 0\nunset key\n"
      "set xrange [-0.5:{}]\nset yrange [{}:-0.5]\nset style fill solid border rgb 'white'\n"
      "plot $map using 1:2:($1-0.5):($1+0.5):($2-0.5):($2+0.5):3 with boxxyerror lc rgb variable",
      gnuplot_text(map.name), gnuplot_text(study.axes[study.map->columns].name), columns, rows,
      static_cast<double>(map.columns.size()) - 0.5, static_cast<double>(map.rows.size()) - 0.5);
  const int width = 160 + 110 * static_cast<int>(map.columns.size());
  const int height = 100 + 22 * static_cast<int>(map.rows.size());
  return draw_with_gnuplot({folder, map.stem}, data, plot, width, height);
}

/// The comment that a scene opens with.
std::string opening_comment(const std::filesystem::path& scene) {
  std::ifstream file(scene);
  std::string line, out;
  while (std::getline(file, line) && line.starts_with('#'))
    out += line.substr(std::min<std::size_t>(2, line.size())) + "\n";
  return out;
}

/// "up to 0.5", "none": the columns in their order as far as all hold.
std::string holds_up_to(const Map& map, const Row& row) {
  std::string last = "none";
  for (std::size_t x = 0; x < row.cells.size(); ++x) {
    if (!was_run(row.cells[x])) continue;
    if (!holds(*row.cells[x])) break;
    last = map.columns[x];
  }
  return last;
}

bool holds_as_judged(const MapSpec& spec, const Row& row) {
  const std::size_t last = spec.judged.value_or(row.cells.size() - 1);
  for (std::size_t x = 0; x <= last; ++x)
    if (was_run(row.cells[x]) && !holds(*row.cells[x])) return false;
  return true;
}

std::string overview(const Study& study, const std::vector<Map>& maps) {
  const Axis& columns = study.axes[study.map->columns];
  const std::string judged = columns.choices[study.map->judged.value_or(columns.choices.size() - 1)].name;
  std::string out =
      fmt::format("| {} | {} holds up to | methods that hold up to {} | of |\n|---|---|---|---|\n",
                  study.axes[study.map->panels].name,
                  maps.front().rows.empty() ? "" : maps.front().rows.front().name, judged);
  for (const Map& map : maps) {
    if (map.rows.empty()) continue;
    const auto held = std::count_if(map.rows.begin(), map.rows.end(),
                                    [&](const Row& row) { return holds_as_judged(*study.map, row); });
    out += fmt::format("| {} | {} | {} | {} |\n", map.name, holds_up_to(map, map.rows.front()), held,
                       map.rows.size());
  }
  return out;
}

/// What the first row comes to, by column.
std::string conditions_table(const Study& study, const Map& map) {
  std::string out = fmt::format("| {}: | bound | {} |\n|---|---|{}\n", map.rows.front().name,
                                fmt::join(map.columns, " | "), [&] {
                                  std::string rule;
                                  for (std::size_t k = 0; k < map.columns.size(); ++k) rule += "---|";
                                  return rule;
                                }());
  for (const std::size_t n : map.conditions) {
    std::vector<std::string> cells;
    for (const StudyResult* cell : map.rows.front().cells) {
      const bool known = was_run(cell) && n < cell->judged.size() && cell->judged[n];
      cells.push_back(known ? fmt::format("{:.3g}", cell->judged[n]->value) : "–");
    }
    out += fmt::format("| {} | {} | {} |\n", study.conditions[n].name, bounds_text(study.conditions[n]),
                       fmt::join(cells, " | "));
  }
  return out;
}

std::string what_is_wrong(const Study& study, const StudyResult& cell) {
  if (cell.status != "finished") return cell.reason;
  std::vector<std::string> parts;
  for (const std::size_t n : broken(cell))
    parts.push_back(fmt::format("{} {:.3g}", study.conditions[n].name, cell.judged[n]->value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string failures_table(const Study& study, const Map& map) {
  std::string out;
  for (const Row& row : map.rows)
    for (std::size_t x = 0; x < row.cells.size(); ++x) {
      const StudyResult* cell = row.cells[x];
      if (!was_run(cell) || holds(*cell)) continue;
      if (out.empty())
        out = fmt::format("\n| method | {} | what does not hold |\n|---|---|---|\n",
                          study.axes[study.map->columns].name);
      out += fmt::format("| {} | {} | {} |\n", row.name, map.columns[x], what_is_wrong(study, *cell));
    }
  return out.empty() ? "\nAll hold.\n" : out;
}

}  // namespace

std::string map_overview(const Study& study, const StudyRuns& runs, const StudyResults& results) {
  return overview(study, maps_of(study, runs, results));
}

std::string map_page(const Study& study, const StudyRuns& runs, const StudyResults& results) {
  const std::vector<Map> maps = maps_of(study, runs, results);
  std::string out = overview(study, maps);
  for (const Map& map : maps) {
    if (map.rows.empty()) continue;
    out += fmt::format("\n## {}\n\n{}\n{}\n![{}]({}.svg)\n{}", map.name, opening_comment(map.scene),
                       conditions_table(study, map), map.name, map.stem, failures_table(study, map));
  }
  return out;
}

std::vector<std::string> draw_maps(const Study& study, const StudyRuns& runs, const StudyResults& results,
                                   const std::filesystem::path& folder) {
  std::vector<std::string> missing;
  for (const Map& map : maps_of(study, runs, results)) {
    if (map.rows.empty()) continue;
    if (const std::string why = draw(study, map, folder); !why.empty()) missing.push_back(why);
  }
  return missing;
}

}  // namespace mpmfast
