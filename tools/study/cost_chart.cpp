#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gnuplot.hpp"
#include "report.hpp"
#include "study_units.hpp"

namespace mpmfast {

namespace {

constexpr double kSmallest = 1e-16;  // an error of zero has no place on a logarithmic axis
constexpr const char* kGrey = "#666666";
constexpr std::array<int, 6> kFilled{7, 5, 9, 13, 11, 15};
constexpr int kCross = 2;
constexpr std::array<double, 5> kSizes{2.1, 1.5, 1.0, 2.7, 0.7};

enum class Standing { front, beaten, failed };  // filled, open, a cross

/// How a point looks: the first axis chooses the colour, the second the shape, the third the size. With one
/// axis the shape helps to tell the colours apart.
struct Look {
  std::size_t colour = 0, shape = 0, size = 0;
  Standing standing = Standing::front;
  auto operator<=>(const Look&) const = default;

  std::string style() const {
    const int filled = kFilled[shape % kFilled.size()];
    const int type = standing == Standing::front    ? filled
                     : standing == Standing::beaten ? filled - 1
                                                    : kCross;
    return fmt::format("with points pt {} ps {}*point lc rgb '{}'", type, kSizes[size % kSizes.size()],
                       chart_colour(colour));
  }
};

Look look_of(const std::vector<std::size_t>& choice, Standing standing) {
  Look look;
  if (!choice.empty()) look.colour = choice[0];
  look.shape = choice.size() > 1 ? choice[1] : look.colour;
  if (choice.size() > 2) look.size = choice[2];
  look.standing = standing;
  return look;
}

Standing standing_of(const StudyResult& result) {
  if (result.status != "finished") return Standing::failed;
  return result.pareto ? Standing::front : Standing::beaten;
}

/// The one axis in which two runs differ.
std::optional<std::size_t> only_difference(const StudyRun& a, const StudyRun& b) {
  std::optional<std::size_t> out;
  for (std::size_t k = 0; k < a.choice.size(); ++k) {
    if (a.choice[k] == b.choice[k]) continue;
    if (out) return std::nullopt;
    out = k;
  }
  return out;
}

/// The axis along which the cells change and nothing else does, within a panel.
std::optional<std::size_t> resolution_axis(const Study& study, const StudyRuns& runs) {
  for (const StudyRun& a : runs.variants)
    for (const StudyRun& b : runs.variants)
      if (a.scene.grid.cell != b.scene.grid.cell)
        if (const auto axis = only_difference(a, b); axis && axis != study.panels) return axis;
  return std::nullopt;
}

/// Ticks, the more of a decade the fewer decades the axis spans.
std::string ticks(double low, double high) {
  std::string out;
  const std::vector<double> digits = high / low < 20    ? std::vector{1.0, 1.5, 2.0, 3.0, 5.0, 7.0}
                                     : high / low < 300 ? std::vector{1.0, 2.0, 5.0}
                                                        : std::vector{1.0};
  for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::ceil(std::log10(high));
       ++power)
    for (const double digit : digits) {
      const double tick = digit * std::pow(10.0, power);
      if (tick < low || tick > high) continue;
      out += fmt::format("{}{:g}", out.empty() ? "(" : ", ", tick);
    }
  return out.empty() ? "auto" : out + ")";
}

struct Range {
  double low = INFINITY, high = 0;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// As gnuplot commands for one axis.
  std::string commands(char axis) const {
    if (!(high > 0)) return "";
    const double margin = std::max(1.15, std::pow(high / low, 0.05));
    const double from = low / margin, to = high * margin;
    return fmt::format("set {0}range [{1:g}:{2:g}]\nset {0}tics {3}\n", axis, from, to, ticks(from, to));
  }
};

struct Points {
  std::vector<double> x, y;
  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
};

/// The axes that points tell apart: all but that of the panels.
std::vector<std::size_t> told_apart(const Study& study) {
  std::vector<std::size_t> out;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
    if (axis != study.panels) out.push_back(axis);
  return out;
}

std::string legend(const Study& study) {
  std::string out;
  const std::vector<std::size_t> axes = told_apart(study);
  const auto heading = [&](const std::string& text) {
    out += fmt::format(", \\\n  NaN with points pt 0 lc rgb 'white' title {}", gnuplot_text(text));
  };
  for (std::size_t axis = 0; axis < std::min<std::size_t>(axes.size(), 3); ++axis) {
    const Axis& shown = study.axes[axes[axis]];
    if (shown.choices.size() < 2 && axes.size() > 1) continue;
    if (axes.size() > 1) heading(shown.name + ":");
    for (std::size_t k = 0; k < shown.choices.size(); ++k) {
      Look look;
      if (axis == 0)
        look = look_of(axes.size() == 1 ? std::vector{k} : std::vector<std::size_t>{k, 0}, Standing::front);
      if (axis == 1) look.shape = k;
      if (axis == 2) look.size = k;
      std::string style = look.style();
      if (axis > 0) style.replace(style.find('#'), 7, kGrey);
      out += fmt::format(", \\\n  NaN {} title {}", style, gnuplot_text(shown.choices[k].name));
    }
  }
  return out;
}

/// What the chart shows, by how it is drawn.
struct ChartPoints {
  std::map<Look, Points> groups;
  std::map<std::vector<std::size_t>, Points> methods;  ///< joined; by their choices but that of the cells
  std::map<double, double> front;                      ///< cost → error
  Range across, up;
  bool failed = false;
};

/// @param panel  the value of the study's axis of panels
ChartPoints collect(const Study& study, const StudyRuns& runs, const StudyResults& results, Cost cost,
                    std::optional<std::size_t> resolution, std::size_t panel) {
  const double percent = !study.error || study.error->rule.relative == Relative::absolute ? 1 : 100;
  ChartPoints out;
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const StudyResult& result = results.variants[k];
    if (study.panels && runs.variants[k].choice[*study.panels] != panel) continue;
    if (result.errors.empty() || !std::isfinite(result.errors[0]) || !(cost_of(result, cost) > 0)) continue;
    const double x = cost_of(result, cost), y = percent * std::max(result.errors[0], kSmallest);
    const Standing standing = standing_of(result);
    std::vector<std::size_t> told;
    for (const std::size_t axis : told_apart(study)) told.push_back(runs.variants[k].choice[axis]);
    out.groups[look_of(told, standing)].add(x, y);
    if (resolution && standing != Standing::failed) {
      std::vector<std::size_t> method = runs.variants[k].choice;
      method[*resolution] = 0;
      out.methods[method].add(x, y);
    }
    out.across.add(x);
    out.up.add(y);
    out.failed = out.failed || standing == Standing::failed;
    if (standing == Standing::front) out.front.emplace(x, y);
  }
  return out;
}

std::string explanation(bool failed) {
  std::string out;
  const auto explain = [&](int type, const char* words) {
    out +=
        fmt::format(", \\\n  NaN with points pt {} lc rgb '{}' title {}", type, kGrey, gnuplot_text(words));
  };
  explain(kFilled[0], "filled: on the front");
  explain(kFilled[0] - 1, "open: beaten by another");
  if (failed) explain(kCross, "cross: failed on the way");
  return out;
}

std::string error_label(const Study& study, const StudyRuns& runs) {
  if (!study.error) return "error (of the bound)";
  if (study.error->rule.relative != Relative::absolute) return "error (%)";
  const std::string unit = measured_unit(runs, *study.error);
  return unit.empty() ? "error" : fmt::format("error ({})", unit);
}

/// The points of a panel as gnuplot commands, without what they mean.
/// @param colour  the axis that gives connected methods their colour; one that is none: they are grey
/// @param suffix  of the names of its blocks; @param data  the blocks are added
std::string plot_of(const ChartPoints& points, std::size_t colour, const std::string& front_title,
                    const std::string& suffix, std::string& data) {
  const auto block = [&](const std::string& name, const Points& shown) {
    data += gnuplot_data(name + suffix, shown.x, shown.y);
    return name + suffix;
  };
  Points line;
  for (const auto& [x, y] : points.front) line.add(x, y);
  std::string plot =
      fmt::format("{}{}plot ${} with lines lw 5 lc rgb '#cccccc' {}", points.across.commands('x'),
                  points.up.commands('y'), block("front", line), front_title);
  std::size_t count = 0;
  for (const auto& [choice, joined] : points.methods)
    plot += fmt::format(", \\\n  ${} with lines lw 1 lc rgb '{}' notitle",
                        block(fmt::format("method{}", count++), joined),
                        colour < choice.size() ? chart_colour(choice[colour]) : kGrey);
  count = 0;
  for (const auto& [look, group] : points.groups)
    plot +=
        fmt::format(", \\\n  ${} {} notitle", block(fmt::format("points{}", count++), group), look.style());
  return plot;
}

}  // namespace

std::string draw_cost_chart(const Study& study, const StudyRuns& runs, const StudyResults& results,
                            const std::filesystem::path& folder, Cost cost, const std::string& stem) {
  const auto resolution = resolution_axis(study, runs);
  const auto* axis = study.panels ? &study.axes[*study.panels] : nullptr;
  std::vector<std::pair<std::string, ChartPoints>> panels;
  bool failed = false;
  for (std::size_t k = 0; k < (axis ? axis->choices.size() : 1); ++k) {
    ChartPoints points = collect(study, runs, results, cost, resolution, k);
    failed = failed || points.failed;
    if (!points.groups.empty())
      panels.emplace_back(axis ? axis->choices[k].label : study.title, std::move(points));
  }
  if (panels.empty())
    return fmt::format("no chart of the error against {}: no variant has an error", name_of(kCosts, cost));
  const std::string front = cost == study.costs.front() ? "Pareto front" : "Pareto front of the first cost";
  const std::size_t cells = panels.size() + 1, across = axis ? (cells <= 4 ? 2 : 3) : 1;
  const std::size_t down = axis ? (cells + across - 1) / across : 1;
  std::string data, plot = "set logscale xy\nset grid lt 1 lc rgb '#dddddd'\n";
  plot += fmt::format("set xlabel {}\nset ylabel {}\n",
                      gnuplot_text(cost == Cost::wall ? "wall time (s)" : "particle-steps"),
                      gnuplot_text(error_label(study, runs)));
  plot += axis ? fmt::format("set multiplot layout {},{} title {}\nunset key\n", down, across,
                             gnuplot_text(study.title))
               : "set key outside right top Left reverse samplen 1\n";
  const std::string meaning = legend(study) + explanation(failed);
  const std::vector<std::size_t> told = told_apart(study);
  const std::size_t colour = told.empty() || resolution == told.front() ? study.axes.size() : told.front();
  std::size_t count = 0;
  for (const auto& [title, points] : panels) {
    const std::string suffix = axis ? fmt::format("_{}", count++) : "";
    plot += fmt::format("set title {}\n", gnuplot_text(title)) +
            plot_of(points, colour, axis ? "notitle" : "title " + gnuplot_text(front), suffix, data);
    if (!axis) plot += meaning;
    plot += "\n";
  }
  if (axis)
    plot +=
        "unset logscale\nunset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\nunset grid\n"
        "set key at graph 0,1 left top Left reverse samplen 1\n"
        "plot [0:1][0:1] NaN with lines lw 5 lc rgb '#cccccc' title " +
        gnuplot_text(front) + meaning + "\nset border\nset tics\nunset multiplot\n";
  return draw_with_gnuplot({folder, stem}, data, plot + "\nunset logscale\n",
                           axis ? static_cast<int>(480 * across) : 1000,
                           axis ? static_cast<int>(360 * down + 30) : 620);
}

}  // namespace mpmfast
