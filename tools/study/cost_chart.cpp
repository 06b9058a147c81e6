#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "gnuplot.hpp"
#include "report.hpp"

namespace mpmfast {

namespace {

constexpr double kSmallest = 1e-16;  // an error of zero has no place on a logarithmic axis
constexpr std::array<int, 6> kFilled{7, 5, 9, 13, 11, 15};
constexpr std::array<double, 5> kSizes{1.9, 1.3, 0.8, 2.5, 0.5};

/// How a point looks: the first axis chooses the colour, the second the shape, the third the size. With one
/// axis the shape helps to tell the colours apart.
struct Look {
  std::size_t colour = 0, shape = 0, size = 0;
  bool whole = true;  ///< the run finished; open points are runs that failed on the way
  auto operator<=>(const Look&) const = default;

  std::string style() const {
    const int filled = kFilled[shape % kFilled.size()];
    return fmt::format("with points pt {} ps {}*point lc rgb '{}'", whole ? filled : filled - 1,
                       kSizes[size % kSizes.size()], chart_colour(colour));
  }
};

Look look_of(const std::vector<std::size_t>& choice, bool whole) {
  Look look;
  if (!choice.empty()) look.colour = choice[0];
  look.shape = choice.size() > 1 ? choice[1] : look.colour;
  if (choice.size() > 2) look.size = choice[2];
  look.whole = whole;
  return look;
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
};

std::string legend(const Study& study) {
  std::string out;
  const auto heading = [&](const std::string& text) {
    out += fmt::format(", \\\n  NaN with points pt 0 lc rgb 'white' title {}", gnuplot_text(text));
  };
  for (std::size_t axis = 0; axis < std::min<std::size_t>(study.axes.size(), 3); ++axis) {
    if (study.axes[axis].choices.size() < 2 && study.axes.size() > 1) continue;
    if (study.axes.size() > 1) heading(study.axes[axis].name + ":");
    for (std::size_t k = 0; k < study.axes[axis].choices.size(); ++k) {
      Look look;
      if (axis == 0)
        look = look_of(study.axes.size() == 1 ? std::vector{k} : std::vector<std::size_t>{k, 0}, true);
      if (axis == 1) look.shape = k;
      if (axis == 2) look.size = k;
      std::string style = look.style();
      if (axis > 0) style.replace(style.find('#'), 7, "#666666");
      out += fmt::format(", \\\n  NaN {} title {}", style, gnuplot_text(study.axes[axis].choices[k].name));
    }
  }
  return out;
}

}  // namespace

std::string draw_cost_chart(const Study& study, const StudyRuns& runs, const StudyResults& results,
                            const std::filesystem::path& folder, Cost cost, const std::string& stem) {
  const double percent = !study.error || study.error->rule.relative == Relative::absolute ? 1 : 100;
  std::map<Look, Points> groups;
  std::vector<std::pair<double, double>> front;
  Range across, up;
  bool failed = false;
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const StudyResult& result = results.variants[k];
    if (result.errors.empty() || !std::isfinite(result.errors[0]) || !(cost_of(result, cost) > 0)) continue;
    const double x = cost_of(result, cost), y = percent * std::max(result.errors[0], kSmallest);
    Points& points = groups[look_of(runs.variants[k].choice, result.status == "finished")];
    points.x.push_back(x);
    points.y.push_back(y);
    across.add(x);
    up.add(y);
    failed = failed || result.status != "finished";
    if (result.pareto) front.emplace_back(x, y);
  }
  std::sort(front.begin(), front.end());
  Points line;
  for (const auto& [x, y] : front) {
    line.x.push_back(x);
    line.y.push_back(y);
  }
  std::string data = gnuplot_data("front", line.x, line.y);
  std::string plot = fmt::format(
      "set title {}\nset logscale xy\nset grid lt 1 lc rgb '#dddddd'\n"
      "set key outside right top Left reverse samplen 1\nset xlabel {}\nset ylabel {}\n{}{}"
      "plot $front with lines lw 2 lc rgb '#999999' title '{}'",
      gnuplot_text(study.title), gnuplot_text(cost == Cost::wall ? "wall time (s)" : "particle-steps"),
      gnuplot_text(percent == 100 ? "error (%)" : "error"), across.commands('x'), up.commands('y'),
      cost == study.costs.front() ? "Pareto front" : "Pareto front of the first cost");
  std::size_t blocks = 0;
  for (const auto& [look, points] : groups) {
    const std::string name = fmt::format("points{}", blocks++);
    data += gnuplot_data(name, points.x, points.y);
    plot += fmt::format(", \\\n  ${} {} notitle", name, look.style());
  }
  plot += legend(study);
  if (failed) plot += ", \\\n  NaN with points pt 6 lc rgb '#666666' title 'open: failed on the way'";
  return draw_with_gnuplot({folder, stem}, data, plot + "\nunset logscale\n", 1000, 620);
}

}  // namespace mpmfast
