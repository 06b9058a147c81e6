#include "study_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/errors.hpp"
#include "engine/output/json_depth.hpp"
#include "engine/output/output.hpp"
#include "other_program.hpp"
#include "pareto.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// run.json, or nothing when it is not there or not whole.
std::optional<nlohmann::json> read_summary(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / "run.json", error)) return std::nullopt;
  const std::string text = read_text(folder / "run.json");
  if (!is_shallow_json(text)) return std::nullopt;
  auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return std::nullopt;
  return json;
}

/// Empty where there is no text of that name.
std::string text(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

double number(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : std::nan("");
}

std::uint64_t count(const nlohmann::json& json, const char* key) {
  const double value = number(json, key);
  return value > 0 ? static_cast<std::uint64_t>(value) : 0;
}

void read_summary(const nlohmann::json& json, StudyResult& result) {
  result.status = text(json, "status");
  result.reason = text(json, "reason");
  result.particle_steps = number(json, "particles") * number(json, "steps");
  result.wall = number(json, "wall_s");
  result.speed = number(json, "particle_steps_per_s");
  result.energy_error = number(json, "energy_error");
  const auto contact = json.find("contact");
  if (contact == json.end()) return;
  result.mean_iterations = number(*contact, "mean_iterations");
  result.fallbacks = count(*contact, "fallbacks");
  result.unconverged = count(*contact, "unconverged");
  result.doubtful = number(*contact, "doubtful") / number(*contact, "touching");
}

double constant(const std::optional<Formula>& formula, double otherwise, const Constants& constants) {
  return formula ? evaluate(formula->expression, constants) : otherwise;
}

ErrorRule rule_of(const ErrorSpec& spec, const Constants& constants) {
  ErrorRule rule = spec.rule;
  rule.from = constant(spec.from, rule.from, constants);
  rule.to = constant(spec.to, rule.to, constants);
  rule.threshold = constant(spec.threshold, rule.threshold, constants);
  rule.expected = constant(spec.expected, rule.expected, constants);
  return rule;
}

/// The reference of one variant, for one rule.
Curve reference_curve(const Study& study, const StudyRuns& runs, const StudyRun& run, const fs::path& folder,
                      const ErrorSpec& spec) {
  const Expression &x = spec.x->expression, &y = spec.quantity->expression;
  const Reference& reference = study.reference;
  switch (reference.kind) {
    case Reference::Kind::runs:
      return history_curve(runs.references[run.reference], folder, x, y);
    case Reference::Kind::expression:
      return history_curve(run, folder, x, reference.expression->expression);
    case Reference::Kind::table:
      return {evaluate(reference.x ? reference.x->expression : x, reference.table, run.let),
              evaluate(reference.y ? reference.y->expression : y, reference.table, run.let)};
    case Reference::Kind::none:
      break;
  }
  return {};
}

void measure(const Study& study, const StudyRuns& runs, const StudyRun& run, const fs::path& folder,
             StudyResult& result) {
  for (const ErrorSpec& spec : error_specs(study, run.choice)) {
    const Curve curve = history_curve(run, folder, spec.x->expression, spec.quantity->expression);
    const Measured measured =
        measure_error(rule_of(spec, run.let), curve, reference_curve(study, runs, run, folder, spec));
    if (result.errors.empty()) {
      result.value = measured.value;
      result.reached = curve.x.empty() ? 0 : curve.x.back();
    }
    result.errors.push_back(measured.error);
  }
}

void judge(const Study& study, const StudyRun& run, const fs::path& folder, StudyResult& result) {
  if (study.conditions.empty()) return;
  const Table history = read_table(folder / run.folder / "history.csv", Unended::torn);
  double share = 0;
  for (const Condition& condition : study.conditions) {
    result.judged.emplace_back();
    if (!goes_with(study.axes, run.choice, condition.only)) continue;
    result.judged.back() = judge(condition, history, run.let);
    share = std::fmax(share, result.judged.back()->share);
  }
  if (!study.error) result.errors.assign(1, share);
}

double over_rows(Over over, const std::vector<double>& values) {
  if (values.empty()) return std::nan("");
  switch (over) {
    case Over::final_value:
      return values.back();
    case Over::maximum:
      return *std::max_element(values.begin(), values.end());
    case Over::minimum:
      return *std::min_element(values.begin(), values.end());
    case Over::mean:
      return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  return std::nan("");
}

/// The quantities, and how far the run got where no error says so.
void tabulate(const Study& study, const StudyRun& run, const fs::path& folder, StudyResult& result) {
  if (study.error && study.quantities.empty()) return;
  const Table history = read_table(folder / run.folder / "history.csv", Unended::torn);
  for (const QuantitySpec& one : study.quantities)
    result.quantities.push_back(over_rows(one.over, evaluate(one.quantity->expression, history, run.let)));
  if (study.error) return;
  const std::vector<double>* time = history.find("time_s");
  result.reached = time && !time->empty() ? time->back() : 0;
}

void mark_front(const Study& study, const StudyRuns& runs, std::vector<StudyResult>& results) {
  const std::size_t panels = study.panels ? study.axes[*study.panels].choices.size() : 1;
  for (std::size_t panel = 0; panel < panels; ++panel) {
    const auto is_here = [&](std::size_t k) {
      return !study.panels || runs.variants[k].choice[*study.panels] == panel;
    };
    std::vector<double> costs, errors;
    for (std::size_t k = 0; k < results.size(); ++k) {
      const bool whole = is_here(k) && results[k].status == "finished" && !results[k].errors.empty();
      costs.push_back(cost_of(results[k], study.costs.front()));
      errors.push_back(whole ? results[k].errors[0] : std::nan(""));
    }
    const std::vector<bool> front = pareto_front(costs, errors);
    for (std::size_t k = 0; k < results.size(); ++k)
      if (is_here(k)) results[k].pareto = front[k];
  }
}

/// Why an earlier run does not count; empty if it does.
std::string what_differs(const StudyRun& run, const fs::path& folder, const nlohmann::json& json) {
  if (!run.program.empty())
    return read_text(order_file(run, folder)) == order_text(run) ? ""
                                                                 : "the scene or the program was another";
  if (read_text(folder / run.folder / "scene.yaml") != run.scene.resolved_yaml)
    return "the scene was another";
  const ProgramIdentity program = program_identity();
  const std::array<std::pair<const char*, const char*>, 4> now{{{"version", program.version},
                                                                {"git", program.git},
                                                                {"compiler", program.compiler},
                                                                {"flags", program.flags}}};
  for (const auto& [key, value] : now)
    if (const std::string was = text(json, key); was != value)
      return fmt::format("the program's {} was {}", key, was.empty() ? "not known" : was);
  return "";
}

/// Does a history have rows, and the last one that of the run's last step? For programs that tell no hash.
bool ends_with_run(const fs::path& history, const nlohmann::json& json) {
  try {
    const Table table = read_table(history, Unended::torn);
    if (table.rows() == 0) return false;
    const std::vector<double>* step = table.find("step");
    const double last = number(json, "steps");
    return text(json, "status") == "failed" || !step || std::isnan(last) || step->back() == last;
  } catch (const FileError&) {
    return false;
  }
}

/// Why what an ended run left is no result; empty if it is one.
std::string no_result(const fs::path& folder, const nlohmann::json& json) {
  const std::string by = text(json, "failed_by");
  if (!by.empty() && by != "physics")
    return fmt::format("it was no failure of the run: {}", text(json, "reason"));
  const fs::path history = folder / "history.csv";
  std::error_code error;
  if (!fs::is_regular_file(history, error)) return "its history is gone";
  const auto mark = json.find("history");
  const bool same = mark != json.end() && mark->is_object()
                        ? text_hash(read_text(history)) == text(*mark, "hash")
                        : ends_with_run(history, json);
  return same ? "" : "its history is not the one that it wrote";
}

}  // namespace

EarlierRun earlier_run(const StudyRun& run, const fs::path& folder, int threads) {
  const auto json = read_summary(folder / run.folder);
  if (!json) return {};
  const std::string status = text(*json, "status"), other = what_differs(run, folder, *json);
  if (status != "finished" && status != "failed") return {false, other.empty(), "it was stopped before"};
  if (!other.empty()) return {false, false, other};
  if (threads > 0 && number(*json, "threads") != threads) return {false, false, "the threads were others"};
  if (text(*json, "failed_by") == "files") return {false, true, text(*json, "reason"), true};
  if (const std::string why = no_result(folder / run.folder, *json); !why.empty()) return {false, false, why};
  if (status == "failed") return {true, false, fmt::format("failed: {}", text(*json, "reason"))};
  return {true, false, fmt::format("finished, {:.2f} s", number(*json, "wall_s"))};
}

bool holds(const StudyResult& result) {
  return result.status == "finished" &&
         std::all_of(result.judged.begin(), result.judged.end(),
                     [](const std::optional<Judgement>& judged) { return !judged || judged->holds; });
}

Curve history_curve(const StudyRun& run, const fs::path& folder, const Expression& x, const Expression& y) {
  const Table table = read_table(folder / run.folder / "history.csv", Unended::torn);
  return {evaluate(x, table, run.let), evaluate(y, table, run.let)};
}

double cost_of(const StudyResult& result, Cost cost) {
  return cost == Cost::wall ? result.wall : result.particle_steps;
}

StudyResults collect_results(const Study& study, const StudyRuns& runs, const fs::path& folder) {
  StudyResults out;
  bool references_ended = true;
  for (const StudyRun& run : runs.references) {
    references_ended = references_ended && earlier_run(run, folder, 0).ended;
    const auto json = read_summary(folder / run.folder);
    if (json && text(*json, "status") == "failed") out.reference_failed = true;
  }
  for (const StudyRun& run : runs.variants) {
    StudyResult result;
    const auto json = read_summary(folder / run.folder);
    if (json && earlier_run(run, folder, 0).ended) {
      read_summary(*json, result);
      out.machine.cpu = text(*json, "cpu");
      if (run.program.empty())
        out.machine.version = fmt::format("{} ({})", text(*json, "version"), text(*json, "git"));
      out.machine.threads = static_cast<int>(count(*json, "threads"));
      if (references_ended) measure(study, runs, run, folder, result);
      judge(study, run, folder, result);
      tabulate(study, run, folder, result);
    }
    out.variants.push_back(std::move(result));
  }
  mark_front(study, runs, out.variants);
  return out;
}

}  // namespace mpmfast
