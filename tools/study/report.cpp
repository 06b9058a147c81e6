#include "report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/output/files.hpp"
#include "line_chart.hpp"
#include "stability_map.hpp"
#include "study_units.hpp"

namespace mpmfast {

namespace {

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return out + "\"";
}

std::string csv_number(double number) { return std::isnan(number) ? "" : fmt::format("{:.9g}", number); }

ChartCurve curve_of(const StudyRun& run, const std::filesystem::path& folder, const CurveSpec& spec) {
  const double from = spec.from ? evaluate(spec.from->expression, run.let) : -INFINITY;
  const double to = spec.to ? evaluate(spec.to->expression, run.let) : INFINITY;
  const Curve whole = history_curve(run, folder, spec.x->expression, spec.y->expression);
  ChartCurve out{run.name, {}, 0, false};
  for (std::size_t k = 0; k < whole.x.size(); ++k) {
    if (whole.x[k] < from || whole.x[k] > to) continue;
    out.curve.x.push_back(whole.x[k]);
    out.curve.y.push_back(whole.y[k]);
  }
  return out;
}

/// The name of a variant without the axis that has panels and those of which one value is shown.
std::string name_in_panel(const Study& study, const StudyRun& run, const CurveSpec& spec) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < run.choice.size(); ++k)
    if (k != spec.panels &&
        !(spec.only.contains(study.axes[k].name) && spec.only.at(study.axes[k].name).size() == 1))
      parts.push_back(study.axes[k].choices[run.choice[k]].label);
  return fmt::format("{}", fmt::join(parts, ", "));
}

class CurveChart {
 public:
  CurveChart(const Study& study, const StudyRuns& runs, const StudyResults& results,
             const std::filesystem::path& folder, const CurveSpec& spec)
      : study_(study), runs_(runs), results_(results), folder_(folder), spec_(spec) {}

  std::string draw() {
    chart_.title = spec_.title.empty() ? study_.title : spec_.title;
    chart_.x_label = spec_.x_label.empty() ? axis_label(runs_, spec_.x->expression) : spec_.x_label;
    chart_.y_label = spec_.y_label.empty() ? axis_label(runs_, spec_.y->expression) : spec_.y_label;
    const std::size_t panels = spec_.panels ? study_.axes[*spec_.panels].choices.size() : 1;
    for (const StudyRun& run : runs_.variants)  // the colours in the order of the study
      if (goes_with(study_.axes, run.choice, spec_.only)) colour_of(name_in_panel(study_, run, spec_));
    for (std::size_t panel = 0; panel < panels; ++panel) fill(panel);
    return draw_line_chart({folder_, spec_.name}, chart_);
  }

 private:
  void fill(std::size_t panel) {
    ChartPanel out;
    if (spec_.panels) out.title = study_.axes[*spec_.panels].choices[panel].label;
    std::vector<std::size_t> references;
    for (std::size_t k = 0; k < runs_.variants.size(); ++k) {
      const StudyRun& run = runs_.variants[k];
      if (spec_.panels && run.choice[*spec_.panels] != panel) continue;
      if (results_.variants[k].status.empty() || !goes_with(study_.axes, run.choice, spec_.only)) continue;
      ChartCurve curve = curve_of(run, folder_, spec_);
      curve.title = name_in_panel(study_, run, spec_);
      curve.colour = colour_of(curve.title);
      out.curves.push_back(std::move(curve));
      if (study_.reference.kind == Reference::Kind::runs &&
          std::find(references.begin(), references.end(), run.reference) == references.end())
        references.push_back(run.reference);
    }
    for (const std::size_t k : references) {
      ChartCurve curve = curve_of(runs_.references[k], folder_, spec_);
      if (spec_.panels) curve.title = "reference";
      curve.dashed = true;
      out.curves.push_back(std::move(curve));
    }
    if (!out.curves.empty()) chart_.panels.push_back(std::move(out));
  }

  std::size_t colour_of(const std::string& title) {
    const auto known = std::find(titles_.begin(), titles_.end(), title);
    const auto index = static_cast<std::size_t>(known - titles_.begin());
    if (known == titles_.end()) titles_.push_back(title);
    return index;
  }

  const Study& study_;
  const StudyRuns& runs_;
  const StudyResults& results_;
  const std::filesystem::path& folder_;
  const CurveSpec& spec_;
  LineChart chart_;
  std::vector<std::string> titles_;
};

}  // namespace

std::string study_csv(const Study& study, const StudyRuns& runs, const StudyResults& results) {
  std::vector<std::string> head{"variant", "error", "particle_steps", "wall_s", "particle_steps_per_s",
                                "pareto"};
  for (const Axis& axis : study.axes) head.push_back(csv_text(axis.name));
  for (const char* name : {"status", "value", "reached", "mean_iterations", "fallbacks", "unconverged",
                           "energy_error", "reason"})
    head.emplace_back(name);
  for (const ErrorSpec& spec : study.more) head.push_back(csv_text(spec.name));
  if (!study.conditions.empty()) head.emplace_back("holds");
  for (const Condition& condition : study.conditions) head.push_back(csv_text(condition.name));
  for (const QuantitySpec& quantity : study.quantities) head.push_back(csv_text(quantity.name));
  std::string out = fmt::format("{}\n", fmt::join(head, ","));
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const StudyRun& run = runs.variants[k];
    const StudyResult& r = results.variants[k];
    if (r.status.empty()) continue;
    const auto error = [&](std::size_t n) { return n < r.errors.size() ? csv_number(r.errors[n]) : ""; };
    std::vector<std::string> cells{csv_text(run.name),           error(0),
                                   csv_number(r.particle_steps), csv_number(r.wall),
                                   csv_number(r.speed),          r.pareto ? "1" : "0"};
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      cells.push_back(csv_text(study.axes[axis].choices[run.choice[axis]].name));
    cells.push_back(r.status);
    for (const double number : {r.value, r.reached, r.mean_iterations}) cells.push_back(csv_number(number));
    cells.push_back(fmt::format("{}", r.fallbacks));
    cells.push_back(fmt::format("{}", r.unconverged));
    cells.push_back(csv_number(r.energy_error));
    cells.push_back(csv_text(r.reason));
    for (std::size_t n = 0; n < study.more.size(); ++n) cells.push_back(error(n + 1));
    if (!study.conditions.empty()) cells.emplace_back(holds(r) ? "1" : "0");
    for (const std::optional<Judgement>& judged : r.judged)
      cells.push_back(judged ? csv_number(judged->value) : "");
    for (const double number : r.quantities) cells.push_back(csv_number(number));
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

std::vector<std::string> write_report(const Study& study, const StudyRuns& runs, const StudyResults& results,
                                      const std::filesystem::path& folder) {
  write_aside(folder / "study.csv", study_csv(study, runs, results));
  write_aside(folder / "study.md",
              study.map ? map_page(study, runs, results) : study_table(study, runs, results));
  std::vector<std::string> missing;
  const auto note = [&](const std::string& why) {
    if (!why.empty()) missing.push_back(why);
  };
  if (study.map) {
    for (const std::string& why : draw_maps(study, runs, results, folder)) note(why);
    return missing;
  }
  for (const Cost cost : study.costs) {
    if (!has_error(study)) break;  // nothing to draw against cost
    const std::string stem =
        cost == study.costs.front() ? "study" : fmt::format("study_{}", name_of(kCosts, cost));
    note(draw_cost_chart(study, runs, results, folder, cost, stem));
  }
  for (const CurveSpec& spec : study.curves) note(CurveChart(study, runs, results, folder, spec).draw());
  return missing;
}

}  // namespace mpmfast
