#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "handy_units.hpp"
#include "report.hpp"
#include "study_units.hpp"

namespace mpmfast {

namespace {

constexpr const char* kNone = "–";

std::string markdown_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c == '\n' ? ' ' : c);
  return out;
}

std::string headed(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

std::string percent_text(double share) {
  if (std::isnan(share)) return kNone;
  return 100 * std::abs(share) < 0.1 ? fmt::format("{:.2g}", 100 * share)
                                     : fmt::format("{:.2f}", 100 * share);
}

/// What the study is about, column by column; runs that have not ended have no row.
class StudyTable {
 public:
  StudyTable(const Study& study, const StudyRuns& runs, const StudyResults& results)
      : study_(study), runs_(runs), results_(results) {}

  std::string text() {
    return study_.panels && study_.error ? overview(*study_.panels) + "\n" + rows() : rows();
  }

 private:
  /// A row for each value of an axis, a column for each combination of the others: error and wall time, bold
  /// on the front.
  std::string overview(std::size_t axis) const {
    std::vector<std::string> methods;
    std::vector<std::vector<std::string>> cells(study_.axes[axis].choices.size());
    for (std::size_t k = 0; k < results_.variants.size(); ++k) {
      if (results_.variants[k].status.empty()) continue;
      std::vector<std::string> parts;
      for (std::size_t other = 0; other < study_.axes.size(); ++other)
        if (other != axis) parts.push_back(study_.axes[other].choices[runs_.variants[k].choice[other]].label);
      const std::string method = fmt::format("{}", fmt::join(parts, ", "));
      const auto column =
          static_cast<std::size_t>(std::find(methods.begin(), methods.end(), method) - methods.begin());
      if (column == methods.size()) methods.push_back(method);
      auto& row = cells[runs_.variants[k].choice[axis]];
      row.resize(std::max(row.size(), column + 1), kNone);
      row[column] = error_and_cost(results_.variants[k]);
    }
    std::string out = "| " + markdown_text(study_.axes[axis].name), rule = "|---|";
    for (const std::string& method : methods) {
      out += " | " + markdown_text(method);
      rule += "---|";
    }
    out += " |\n" + rule + "\n";
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (cells[k].empty()) continue;
      cells[k].resize(methods.size(), kNone);
      out += fmt::format("| {} | {} |\n", markdown_text(study_.axes[axis].choices[k].name),
                         fmt::join(cells[k], " | "));
    }
    return out;
  }

  std::string error_and_cost(const StudyResult& result) const {
    if (result.status == "failed") return "failed";
    const double error = result.errors.empty() ? std::nan("") : result.errors[0];
    const bool absolute = study_.error->rule.relative == Relative::absolute;
    const std::string text = std::isnan(error) ? kNone
                             : absolute        ? fmt::format("{:.3g}", error)
                                               : fmt::format("{:.2g} %", 100 * error);
    return fmt::format("{0}{1}{0}, {2:.3g} s", result.pareto ? "**" : "", text, result.wall);
  }

  std::string rows() {
    for (std::size_t axis = 0; axis < study_.axes.size(); ++axis) add_axis(axis);
    for (std::size_t k = 0; k < study_.more.size(); ++k)
      add_error(study_.more[k].name, &study_.more[k], k + 1);
    if (has_error(study_)) add_error("error", study_.error ? &*study_.error : nullptr, 0);
    if (study_.error && looks_for_value(*study_.error) && !has_own_errors())
      add_numbers("value", measured_unit(runs_, *study_.error), 6,
                  [](const StudyResult& r) { return r.value; });
    for (std::size_t k = 0; k < study_.quantities.size(); ++k)
      add_numbers(study_.quantities[k].name,
                  shown_unit(runs_, unit_of(study_.quantities[k].quantity->expression)), 6,
                  [k](const StudyResult& r) { return r.quantities[k]; });
    add_effort();
    if (has_error(study_))
      add("front", [](const StudyResult& r) { return std::string(r.pareto ? "yes" : ""); });
    return written();
  }

  template <class F>
  void add(const std::string& name, F cell) {
    heads_.push_back(markdown_text(name));
    std::size_t row = 0;
    for (std::size_t k = 0; k < results_.variants.size(); ++k) {
      if (results_.variants[k].status.empty()) continue;
      if (row == rows_.size()) rows_.emplace_back();
      rows_[row++].push_back(cell(results_.variants[k]));
    }
  }

  /// Numbers in SI, shown in a unit that suits the largest.
  /// @param note  what stands behind the number of a result
  template <class F, class Note>
  void add_numbers(const std::string& name, const std::string& unit, int digits, F number, Note note) {
    double largest = 0;
    for (const StudyResult& result : results_.variants)
      if (!result.status.empty() && std::isfinite(number(result)))
        largest = std::max(largest, std::abs(number(result)));
    const HandyUnit handy = handy_unit(unit, largest);
    add(headed(name, handy.symbol), [&](const StudyResult& result) {
      const double value = handy.factor * number(result);
      return (std::isnan(value) ? std::string(kNone) : fmt::format("{:.{}g}", value, digits)) + note(result);
    });
  }
  template <class F>
  void add_numbers(const std::string& name, const std::string& unit, int digits, F number) {
    add_numbers(name, unit, digits, number, [](const StudyResult&) { return ""; });
  }

  void add_axis(std::size_t axis) {
    const Axis& shown = study_.axes[axis];
    add(shown.name == "variants" ? "variant" : shown.name, [&](const StudyResult& result) {
      const auto run = static_cast<std::size_t>(&result - results_.variants.data());
      return markdown_text(shown.choices[runs_.variants[run].choice[axis]].name);
    });
  }

  /// @param spec  nothing: the largest share of a condition's bound
  void add_error(const std::string& name, const ErrorSpec* spec, std::size_t which) {
    const auto error = [which](const StudyResult& result) {
      return which < result.errors.size() ? result.errors[which] : std::nan("");
    };
    if (!spec) return add_numbers(name, "of the bound", 3, error);
    if (spec->rule.relative == Relative::absolute)
      return add_numbers(name, measured_unit(runs_, *spec), 3, error);
    add(headed(name, "%"), [&](const StudyResult& result) { return percent_text(error(result)); });
  }

  void add_effort() {
    const std::string x = study_.error ? shown_unit(runs_, unit_of(study_.error->x->expression)) : "s";
    add_numbers(
        "reached", x, 4, [](const StudyResult& r) { return r.reached; },
        [](const StudyResult& r) { return r.status == "failed" ? ", failed" : ""; });
    add("wall time (s)", [](const StudyResult& r) { return fmt::format("{:.2f}", r.wall); });
    add("speed (million particle-steps/s)",
        [](const StudyResult& r) { return fmt::format("{:.3g}", r.speed / 1e6); });
    add("iterations a regression",
        [](const StudyResult& r) { return fmt::format("{:.2f}", r.mean_iterations); });
    add("doubtful normals (%)", [](const StudyResult& r) { return percent_text(r.doubtful); });
    add("energy error (%)", [](const StudyResult& r) { return fmt::format("{:.2g}", 100 * r.energy_error); });
  }

  /// Errors of which each looks for another value.
  bool has_own_errors() const {
    return std::any_of(study_.axes.begin(), study_.axes.end(), [](const Axis& axis) {
      return std::any_of(axis.choices.begin(), axis.choices.end(),
                         [](const Choice& choice) { return choice.error.has_value(); });
    });
  }

  std::string written() const {
    std::string rule;
    for (std::size_t k = 0; k < heads_.size(); ++k) rule += "---|";
    std::string out = fmt::format("| {} |\n|{}\n", fmt::join(heads_, " | "), rule);
    for (const auto& cells : rows_) out += fmt::format("| {} |\n", fmt::join(cells, " | "));
    for (std::size_t k = 0; k < runs_.variants.size(); ++k)
      if (const StudyResult& r = results_.variants[k]; r.status == "failed")
        out +=
            fmt::format("\n{} failed: {}\n", markdown_text(runs_.variants[k].name), markdown_text(r.reason));
    const StudyMachine& machine = results_.machine;
    return out + fmt::format("\n{}, mpmfast {}, {} thread{}.{}\n", machine.cpu, machine.version,
                             machine.threads, machine.threads == 1 ? "" : "s",
                             results_.reference_failed
                                 ? " A reference run failed: errors are of what it reached."
                                 : "");
  }

  const Study& study_;
  const StudyRuns& runs_;
  const StudyResults& results_;
  std::vector<std::string> heads_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace

std::string study_table(const Study& study, const StudyRuns& runs, const StudyResults& results) {
  return StudyTable(study, runs, results).text();
}

}  // namespace mpmfast
