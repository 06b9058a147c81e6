#include "plot_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "complain.hpp"
#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/output/output.hpp"
#include "engine/output/shown_units.hpp"
#include "exit_codes.hpp"
#include "tools/study/column_names.hpp"
#include "tools/study/handy_units.hpp"
#include "tools/study/line_chart.hpp"
#include "tools/study/usual_charts.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

/// Which columns one of the usual charts shows.
struct UsualChart {
  const char* stem;
  const char* title;
  const char* unit;
  const char* part;  ///< of the column's name
};
constexpr UsualChart kUsual[] = {
    {"plot_energy", "Energy", "J", "_J"},
    {"plot_momentum", "Momentum", "kg m/s", "momentum_"},
    {"plot_stress", "Mean stress", "Pa", ".mean_stress_"},
    {"plot_force", "Force", "N", ".force_"},
};
constexpr UsualChart kStressStrain{"plot_stress_strain", "Mean stress against strain", "Pa", ".mean_stress_"};
/// A run that replaces this one removes its charts by their names.
constexpr bool is_known(const char* stem) {
  return std::find(kChartStems.begin(), kChartStems.end(), std::string_view(stem)) != kChartStems.end();
}
constexpr const char* kOwnStem = "plot_columns";
static_assert(std::all_of(std::begin(kUsual), std::end(kUsual),
                          [](const UsualChart& chart) { return is_known(chart.stem); }) &&
              is_known(kStressStrain.stem) && is_known(kOwnStem));
Expression column(const std::string& name) {
  return std::get<Expression>(Expression::parse("`" + name + "`"));
}

/// That of a piston, where there is one.
std::optional<Expression> strain_of(const Table& history) {
  for (const std::string& name : history.names)
    if (name.ends_with(".strain")) return column(name);
  return std::nullopt;
}

struct RunHistory {
  std::string folder, name;  ///< as given, and in a legend
  Table table;
  bool per_metre;  ///< its masses, forces and energies
};

/// Nothing is lost where the scene cannot be read again, such as when its picture was moved away: SI then, as
/// the columns say.
bool is_per_metre(const fs::path& folder) {
  try {
    return is_per_metre(read_scene(folder / "scene.yaml"));
  } catch (const std::exception&) {
    return false;
  }
}

/// The last parts of their paths tell runs apart, or else the paths as given.
std::vector<RunHistory> read_histories(const std::vector<std::string>& folders) {
  std::vector<RunHistory> out;
  for (const std::string& folder : folders)
    out.push_back({folder, fs::absolute(fs::path(folder) / "").lexically_normal().parent_path().filename(),
                   read_table(fs::path(folder) / "history.csv", Unended::torn), is_per_metre(folder)});
  const auto is_taken = [&](const std::string& name) {
    return std::count_if(out.begin(), out.end(), [&](const RunHistory& run) { return run.name == name; }) > 1;
  };
  if (std::any_of(out.begin(), out.end(), [&](const RunHistory& run) { return is_taken(run.name); }))
    for (RunHistory& run : out) run.name = run.folder;
  return out;
}

/// The expression for all runs, or nothing after saying, once, what is wrong with it.
std::optional<Expression> read_expression(const std::string& option, const std::string& text,
                                          const std::vector<RunHistory>& runs) {
  const auto refuse = [&](const std::string& why, const std::string& hint) {
    complain("mpmfast: {}: {}, got '{}'{}\n", option, why, text, hint.empty() ? "" : ". " + hint);
  };
  // A column that is no name of an expression, such as left-block.vx, is meant as it stands.
  const auto parsed = Expression::parse(runs[0].table.find(text) ? "`" + text + "`" : text);
  if (const auto* wrong = std::get_if<std::string>(&parsed)) {
    refuse("not an expression: " + *wrong, "");
    return std::nullopt;
  }
  for (const RunHistory& run : runs) {
    const std::vector<UnknownName> unknown = unknown_names(std::get<Expression>(parsed), run.table.names);
    for (const UnknownName& one : unknown)
      refuse(fmt::format("no column '{}'{}", one.name, runs.size() > 1 ? " in " + run.folder : ""), one.hint);
    if (!unknown.empty()) return std::nullopt;
  }
  return std::get<Expression>(parsed);
}

/// Brings numbers of one unit into one that reads well, and returns its symbol.
std::string make_handy(const std::string& unit, const std::vector<std::vector<double>*>& all) {
  double largest = 0;
  for (const std::vector<double>* numbers : all)
    for (const double number : *numbers) largest = std::fmax(largest, std::abs(number));
  const HandyUnit handy = handy_unit(unit, largest);
  for (std::vector<double>* numbers : all)
    for (double& number : *numbers) number *= handy.factor;
  return handy.symbol;
}

std::string axis_label(const std::string& quantity, const std::string& unit) {
  if (quantity.empty() || unit.empty()) return quantity + unit;
  return fmt::format("{} ({})", quantity, unit);
}

std::string shown(const Expression& expression) {
  std::string out = expression.text();
  out.erase(std::remove(out.begin(), out.end(), '`'), out.end());
  return out;
}

class Plot {
 public:
  Plot(const std::vector<RunHistory>& runs, const PlotFiles& files, const Expression& x,
       const CommandLine& line)
      : runs_(runs), files_(files), x_(x), line_(line) {
    for (const RunHistory& run : runs) per_metre_.push_back(run.per_metre);
  }

  bool draw(const UsualChart& usual) const {
    std::vector<Expression> columns;
    for (const std::string& name : telling_columns(runs_[0].table, usual.part))
      columns.push_back(column(name));
    return columns.empty() || draw(usual.stem, usual.title, usual.unit, columns);
  }

  bool draw(const std::string& stem, const std::string& title, const std::string& unit,
            const std::vector<Expression>& columns) const {
    LineChart chart{title, "", "", {{"", curves(columns)}}};
    std::vector<std::vector<double>*> x, y;
    for (ChartCurve& curve : chart.panels[0].curves) {
      x.push_back(&curve.curve.x);
      y.push_back(&curve.curve.y);
    }
    const auto chosen = [](const std::string& asked, const std::string& usual) {
      return asked.empty() ? usual : asked;
    };
    const std::string of_x = name_beside(x_, unit_of(x_));
    chart.x_label = axis_label(chosen(line_.x_label, of_x), make_handy(shown_unit(unit_of(x_)), x));
    const std::string of_y = stands_on_axis(columns) ? name_beside(columns[0], unit) : quantity_in(unit);
    chart.y_label = axis_label(chosen(line_.y_label, of_y), make_handy(shown_unit(unit), y));
    return draw(stem, chart);
  }

 private:
  std::string shown_unit(const std::string& unit) const { return mpmfast::shown_unit(per_metre_, unit); }

  /// Then the legend names the runs alone.
  bool stands_on_axis(const std::vector<Expression>& columns) const {
    return runs_.size() > 1 && columns.size() == 1;
  }

  std::string curve_title(const RunHistory& run, const std::vector<Expression>& columns,
                          std::size_t k) const {
    if (runs_.size() == 1) return line_.labels.empty() ? shown(columns[k]) : line_.labels[k];
    return stands_on_axis(columns) ? run.name : run.name + ": " + shown(columns[k]);
  }

  std::vector<ChartCurve> curves(const std::vector<Expression>& columns) const {
    std::vector<ChartCurve> out;
    for (const RunHistory& run : runs_)
      for (std::size_t k = 0; k < columns.size(); ++k)
        out.push_back({curve_title(run, columns, k),
                       {evaluate(x_, run.table, {}), evaluate(columns[k], run.table, {})},
                       out.size(),
                       false});
    return out;
  }

  bool draw(const std::string& stem, const LineChart& chart) const {
    const fs::path& picture = files_.picture;
    const ChartFiles where =
        picture.empty() ? ChartFiles{files_.folder, stem}
                        : ChartFiles{files_.folder, picture.stem(), picture.extension().string().substr(1)};
    const std::string why_not = draw_line_chart(where, chart);
    if (!why_not.empty()) {
      complain("mpmfast: {}\n", why_not);
      return false;
    }
    say("chart            {}\n", files_.at(stem + ".png").string());
    return true;
  }

  const std::vector<RunHistory>& runs_;
  const PlotFiles& files_;
  const Expression& x_;
  const CommandLine& line_;
  std::vector<bool> per_metre_;  ///< of each run
};

/// That of all of them, or none.
std::string common_unit(const std::vector<Expression>& columns) {
  const std::string unit = unit_of(columns[0]);
  const bool alike = std::all_of(columns.begin(), columns.end(),
                                 [&](const Expression& other) { return unit_of(other) == unit; });
  return alike ? unit : "";
}

}  // namespace

int plot_history(const CommandLine& line, const PlotFiles& files) {
  std::vector<RunHistory> runs = read_histories(line.folders);
  if (runs.size() > 1 && !line.labels.empty())
    for (std::size_t k = 0; k < runs.size(); ++k) runs[k].name = line.labels[k];
  for (RunHistory& run : runs)
    if (line.columns.empty()) clear_round_off(run.table);
  const auto x = read_expression("--x", line.x, runs);
  std::vector<Expression> columns;
  for (const std::string& text : line.columns)
    if (const auto column = read_expression("--columns", text, runs)) columns.push_back(*column);
  if (!x || columns.size() < line.columns.size()) return kExitWrongInput;
  make_folder(files.folder);
  const Plot plot(runs, files, *x, line);
  if (!columns.empty()) {
    const std::string title = line.title.empty() ? "History" : line.title;
    return plot.draw(kOwnStem, title, common_unit(columns), columns) ? 0 : kExitFile;
  }
  bool all = true;
  for (const UsualChart& chart : kUsual) all = plot.draw(chart) && all;
  if (const auto strain = strain_of(runs[0].table); strain && line.x == "time_s")
    all = Plot(runs, files, *strain, line).draw(kStressStrain) && all;
  return all ? 0 : kExitFile;
}

}  // namespace mpmfast
