#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "commands.hpp"
#include "engine/scene/suggest.hpp"
#include "exit_codes.hpp"
#include "plot_particles.hpp"
#include "tools/study/line_chart.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

/// Which columns one of the usual charts shows.
struct UsualChart {
  const char* stem;
  const char* title;
  const char* y_label;
  const char* part;  ///< of the column's name
};
constexpr UsualChart kUsual[] = {
    {"plot_energy", "Energy", "J", "_J"},
    {"plot_momentum", "Momentum", "kg m/s", "momentum_"},
    {"plot_stress", "Mean stress", "Pa", ".mean_stress_"},
    {"plot_force", "Force", "N", ".force_"},
};
constexpr std::size_t kMostCurves = 16;  // more cannot be told apart: then those of all bodies together

bool matches(const std::string& name, const std::string& part) {
  if (part == "_J") return name.size() > 2 && name.compare(name.size() - 2, 2, part) == 0;
  return name.find(part) != std::string::npos;
}

std::vector<std::string> chosen_columns(const Table& history, const std::string& part) {
  std::vector<std::string> out;
  for (const std::string& name : history.names)
    if (matches(name, part)) out.push_back(name);
  if (out.size() <= kMostCurves) return out;
  std::vector<std::string> together;
  for (const std::string& name : out)
    if (name.rfind("all.", 0) == 0) together.push_back(name);
  if (together.empty()) together.assign(out.begin(), out.begin() + kMostCurves);
  return together;
}

/// The expression, or nothing after saying what is wrong with it.
std::optional<Expression> read_expression(const std::string& option, const std::string& text,
                                          const Table& history) {
  const auto refuse = [&](const std::string& why, const std::string& hint) {
    fmt::print(stderr, "mpmfast: {}: {}, got '{}'{}\n", option, why, text, hint.empty() ? "" : ". " + hint);
    return std::nullopt;
  };
  // A column that is no name of an expression, such as left-block.vx, is meant as it stands.
  const auto parsed = Expression::parse(history.find(text) ? "`" + text + "`" : text);
  if (const auto* wrong = std::get_if<std::string>(&parsed))
    return refuse("not an expression: " + *wrong, "");
  for (const std::string& name : std::get<Expression>(parsed).names())
    if (!history.find(name))
      return refuse(fmt::format("no column '{}'", name), did_you_mean(name, history.names));
  return std::get<Expression>(parsed);
}

class Plot {
 public:
  Plot(const CommandLine& line, const Table& history, Expression x)
      : folder_(line.scene), history_(history), x_(std::move(x)), x_label_(line.x) {}

  bool draw(const UsualChart& chart) {
    std::vector<Expression> columns;
    for (const std::string& name : chosen_columns(history_, chart.part))
      columns.push_back(std::get<Expression>(Expression::parse("`" + name + "`")));
    return columns.empty() || draw(chart.stem, chart.title, chart.y_label, columns);
  }

  bool draw(const std::string& stem, const std::string& title, const std::string& y_label,
            const std::vector<Expression>& columns) {
    LineChart chart{title, x_label_, y_label, {{"", {}}}};
    const std::vector<double> x = evaluate(x_, history_, {});
    for (std::size_t k = 0; k < columns.size(); ++k) {
      std::string name = columns[k].text();
      name.erase(std::remove(name.begin(), name.end(), '`'), name.end());
      chart.panels[0].curves.push_back({name, {x, evaluate(columns[k], history_, {})}, k, false});
    }
    const std::string why_not = draw_line_chart(folder_, stem, chart);
    if (!why_not.empty()) {
      fmt::print(stderr, "mpmfast: {}\n", why_not);
      return false;
    }
    fmt::print("chart            {}\n", (folder_ / (stem + ".png")).string());
    return true;
  }

 private:
  fs::path folder_;
  const Table& history_;
  Expression x_;
  std::string x_label_;
};

int plot_history(const CommandLine& line) {
  const Table history = read_table(fs::path(line.scene) / "history.csv");
  auto x = read_expression("--x", line.x, history);
  std::vector<Expression> columns;
  for (const std::string& text : line.columns) {
    const auto column = read_expression("--columns", text, history);
    if (!column) return kExitWrongInput;
    columns.push_back(*column);
  }
  if (!x) return kExitWrongInput;
  Plot plot(line, history, *x);
  bool all = true;
  if (!columns.empty()) {
    all = plot.draw("plot_columns", "History", "", columns);
  } else {
    for (const UsualChart& chart : kUsual) all = plot.draw(chart) && all;
  }
  return all ? 0 : kExitFile;
}

}  // namespace

int plot_command(const CommandLine& line) {
  const bool particles = !line.fields.empty() || !line.frame.empty() || !line.range.empty();
  if (particles && line.columns.empty()) return plot_particles(line);
  const int code = plot_history(line);
  if (code == kExitWrongInput || !(particles || (line.columns.empty() && has_particle_files(line.scene))))
    return code;
  const int drawn = plot_particles(line);
  return drawn != 0 ? drawn : code;
}

}  // namespace mpmfast
