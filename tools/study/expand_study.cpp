#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "column_names.hpp"
#include "engine/output/output.hpp"
#include "other_program.hpp"
#include "study.hpp"

namespace mpmfast {

namespace {

class Expansion {
 public:
  explicit Expansion(const Study& study) : study_(study), problems_({study.file.string()}) {}

  StudyRuns all() {
    std::vector<std::size_t> choice(study_.axes.size(), 0);
    do {
      if (allowed(choice)) runs_.variants.push_back(variant(choice));
    } while (next(choice));
    if (runs_.variants.empty()) problems_.add({0, 0, 0}, "variants", "no combination is left by `only`");
    std::vector<Diagnostic> found = problems_.sorted();
    found.insert(found.end(), of_scenes_.begin(), of_scenes_.end());
    if (!found.empty()) throw SceneError(found);
    return std::move(runs_);
  }

 private:
  /// The last axis turns fastest.
  bool next(std::vector<std::size_t>& choice) const {
    for (std::size_t k = choice.size(); k-- > 0;) {
      if (++choice[k] < study_.axes[k].choices.size()) return true;
      choice[k] = 0;
    }
    return false;
  }

  bool allowed(const std::vector<std::size_t>& choice) const {
    for (std::size_t k = 0; k < choice.size(); ++k)
      if (!goes_with(study_.axes, choice, study_.axes[k].choices[choice[k]].only)) return false;
    return true;
  }

  StudyRun variant(const std::vector<std::size_t>& choice) {
    std::vector<std::size_t> axes(choice.size());
    for (std::size_t k = 0; k < axes.size(); ++k) axes[k] = k;
    StudyRun run = make("", choice, axes, {});
    if (study_.reference.kind == Reference::Kind::runs) {
      run.reference = reference(choice);
      check_reference(runs_.references[run.reference], error_specs(study_, choice));
    }
    check_formulas(run);
    return run;
  }

  std::size_t reference(const std::vector<std::size_t>& choice) {
    std::vector<std::size_t> own(choice.size(), 0);
    for (const std::size_t axis : study_.reference.per) own[axis] = choice[axis];
    for (std::size_t k = 0; k < runs_.references.size(); ++k)
      if (runs_.references[k].choice == own) return k;
    runs_.references.push_back(make("reference", own, study_.reference.per, study_.reference.set));
    return runs_.references.size() - 1;
  }

  /// The scene with the common overrides, those of the axes that matter, and `more`, in this order.
  StudyRun make(std::string name, const std::vector<std::size_t>& choice,
                const std::vector<std::size_t>& axes, const std::vector<Setting>& more) {
    StudyRun run;
    run.choice = choice;
    std::vector<Setting> settings = study_.common;
    for (const std::size_t k : axes) {
      const Choice& chosen = study_.axes[k].choices[choice[k]];
      settings.insert(settings.end(), chosen.set.begin(), chosen.set.end());
      for (const auto& [constant, value] : chosen.let) run.let[constant] = value;
      if (chosen.program) run.program = program_path(study_, *chosen.program);
      name += (name.empty() ? "" : ", ") + chosen.label;
    }
    settings.insert(settings.end(), more.begin(), more.end());
    run.name = name;
    std::string wanted = file_name_of(name);
    if (wanted.empty() || wanted.front() == '-') wanted = "run" + wanted;  // no option of a launcher
    run.folder = wanted;
    run.scene_file = scene_of(study_, choice);
    for (int n = 2; !folders_.insert(run.folder).second; ++n) run.folder = fmt::format("{}_{}", wanted, n);
    read(settings, run);
    return run;
  }

  void read(const std::vector<Setting>& settings, StudyRun& run) {
    std::vector<Override> overrides;
    for (const Setting& setting : settings) overrides.push_back(setting.override);
    try {
      run.scene = read_scene(run.scene_file, overrides);
    } catch (const SceneError& error) {
      for (const Diagnostic& diagnostic : error.diagnostics()) locate(diagnostic, settings, run.name);
    }
  }

  /// What is wrong with an override is told where the study gives it.
  void locate(Diagnostic diagnostic, const std::vector<Setting>& settings, const std::string& run) {
    for (const Setting& setting : settings) {
      if (diagnostic.file != fmt::format("--set {}={}", setting.override.first, setting.override.second))
        continue;
      return problems_.add(setting.location, setting.path,
                           fmt::format("the scene says: {}: {}", diagnostic.path, diagnostic.message),
                           diagnostic.hint);
    }
    const auto same = [&](const Diagnostic& other) {
      return other.line == diagnostic.line && other.column == diagnostic.column &&
             other.path == diagnostic.path;
    };
    if (std::any_of(of_scenes_.begin(), of_scenes_.end(), same)) return;
    diagnostic.message += fmt::format(" (in the run '{}')", run);
    of_scenes_.push_back(diagnostic);
  }

  /// A reference is measured by the same expressions, but knows only the constants of its own axes.
  void check_reference(const StudyRun& run, const std::vector<ErrorSpec>& errors) {
    if (run.scene.bodies.empty()) return;  // it could not be read
    std::set<std::string> others;
    for (const Axis& axis : study_.axes)
      for (const Choice& choice : axis.choices)
        for (const auto& [constant, value] : choice.let)
          if (!run.let.contains(constant)) others.insert(constant);
    const auto check = [&](const std::optional<Formula>& formula) {
      if (!formula) return;
      for (const std::string& name : formula->expression.names())
        if (others.contains(name))
          problems_.add(formula->location, formula->path,
                        fmt::format("the reference has no constant '{}': its axis is not in per", name));
    };
    for (const ErrorSpec& spec : errors)
      for (const auto& formula : {spec.quantity, spec.x}) check(formula);
    for (const CurveSpec& curve : study_.curves)
      for (const auto& formula : {curve.x, curve.y}) check(formula);
  }

  void check_formulas(const StudyRun& run) {
    if (run.scene.bodies.empty()) return;  // it could not be read
    std::vector<std::string> known = history_columns(run.scene);
    for (const auto& [constant, value] : run.let) known.push_back(constant);
    const auto check = [&](const std::optional<Formula>& formula) {
      if (formula) check_names(*formula, known, "column of the history");
    };
    std::vector<std::string> constants;
    for (const auto& [constant, value] : run.let) constants.push_back(constant);
    const auto check_constant = [&](const std::optional<Formula>& formula) {
      if (formula) check_names(*formula, constants, "constant (let)");
    };
    for (const Condition& condition : study_.conditions) {
      if (!goes_with(study_.axes, run.choice, condition.only)) continue;
      for (const auto& formula : {condition.quantity, condition.over}) check(formula);
      for (const auto& formula : {condition.at_least, condition.at_most, condition.from, condition.to})
        check_constant(formula);
    }
    for (const ErrorSpec& spec : error_specs(study_, run.choice)) {
      for (const auto& formula : {spec.quantity, spec.x}) check(formula);
      for (const auto& formula : {spec.from, spec.to, spec.threshold, spec.expected}) check_constant(formula);
    }
    for (const QuantitySpec& quantity : study_.quantities) check(quantity.quantity);
    check(study_.reference.expression);
    for (const CurveSpec& curve : study_.curves) {
      check(curve.x);
      check(curve.y);
      check_constant(curve.from);
      check_constant(curve.to);
    }
    check_table(run);
  }

  void check_table(const StudyRun& run) {
    if (study_.reference.kind != Reference::Kind::table) return;
    std::vector<std::string> known = study_.reference.table.names;
    for (const auto& [constant, value] : run.let) known.push_back(constant);
    for (const ErrorSpec& error : error_specs(study_, run.choice))
      for (const auto& formula : {study_.reference.x ? study_.reference.x : error.x,
                                  study_.reference.y ? study_.reference.y : error.quantity})
        if (formula) check_names(*formula, known, "column of the table");
  }

  void check_names(const Formula& formula, const std::vector<std::string>& known, const std::string& what) {
    for (const UnknownName& unknown : unknown_names(formula.expression, known))
      problems_.add(formula.location, formula.path, fmt::format("no {} '{}'", what, unknown.name),
                    unknown.hint);
  }

  const Study& study_;
  Problems problems_;
  std::vector<Diagnostic> of_scenes_;
  std::set<std::string> folders_{"study"};  ///< taken: study.yaml is the study itself
  StudyRuns runs_;
};

}  // namespace

bool goes_with(const std::vector<Axis>& axes, const std::vector<std::size_t>& choice, const Only& only) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const auto values = only.find(axes[k].name);
    if (values == only.end()) continue;
    const std::string& name = axes[k].choices[choice[k]].name;
    if (std::find(values->second.begin(), values->second.end(), name) == values->second.end()) return false;
  }
  return true;
}

std::string file_name_of(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '.' || c == '=') {
      out += static_cast<char>(std::tolower(byte));
    } else if (c != '(' && c != ')' && !out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && (out.back() == '_' || out.back() == '.')) out.pop_back();
  return out.substr(0, kLongest);
}

std::vector<ErrorSpec> error_specs(const Study& study, const std::vector<std::size_t>& choice) {
  std::vector<ErrorSpec> out;
  if (study.error) out.push_back(*study.error);
  for (std::size_t k = 0; k < choice.size(); ++k)
    if (const auto& own = study.axes[k].choices[choice[k]].error) out.assign(1, *own);
  out.insert(out.end(), study.more.begin(), study.more.end());
  return out;
}

std::filesystem::path scene_of(const Study& study, const std::vector<std::size_t>& choice) {
  std::filesystem::path out = study.scene;
  for (std::size_t k = 0; k < choice.size(); ++k)
    if (const auto& scene = study.axes[k].choices[choice[k]].scene) out = *scene;
  return out;
}

StudyRuns expand_study(const Study& study) { return Expansion(study).all(); }

}  // namespace mpmfast
