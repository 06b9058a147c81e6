#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/errors.hpp"
#include "engine/geometry/read_regular.hpp"
#include "study_parts.hpp"

namespace mpmfast {

namespace {

Reference read_reference(const Value& value, const Study& study) {
  Reference out;
  MapReader map(value, "a map {set, per}, {expression} or {table, x, y}");
  if (!map.valid()) return out;
  const bool runs = index_of(value.node(), "set") >= 0;
  const auto expression = map.find("expression"), table = map.find("table");
  if (int{runs} + int{expression.has_value()} + int{table.has_value()} != 1)
    value.report("exactly one of set (runs), expression and table was expected");
  if (runs) {
    out.kind = Reference::Kind::runs;
    out.set = read_settings(map);
    const auto per = map.find("per");
    if (per && !per->is(Node::Kind::list)) per->complain("not a list of axes");
    for (std::size_t k = 0; per && per->is(Node::Kind::list) && k < per->size(); ++k)
      if (const auto axis = read_axis(per->item(k), study.axes)) out.per.push_back(*axis);
  } else if (expression) {
    out.kind = Reference::Kind::expression;
    out.expression = read_formula(*expression);
  } else if (table) {
    out.kind = Reference::Kind::table;
    if (const auto file = table->text()) {
      try {
        out.table = read_table(study.file.parent_path() / *file, Unended::whole);
      } catch (const FileError& error) {
        table->report(error.what());
      }
    }
    read_formula(map, "x", out.x);
    read_formula(map, "y", out.y);
  }
  map.finish();
  return out;
}

/// What `spec` holds already is the default.
ErrorSpec read_error(const Value& value, ErrorSpec spec, bool has_reference) {
  MapReader map(value, "a map {quantity, x, compare, relative, window, above, below, expected}");
  if (!map.valid()) return spec;
  const std::size_t before = value.problems().count();
  if (!spec.quantity) map.need("quantity", "a column of history.csv or an expression of columns");
  read_formula(map, "quantity", spec.quantity);
  read_formula(map, "x", spec.x);
  map.word("compare", kCompares, spec.rule.compare);
  map.word("relative", kRelatives, spec.rule.relative);
  read_window(map, spec.from, spec.to);
  const auto above = map.find("above"), below = map.find("below");
  if (above && below) below->report("above is given too");
  if (above || below) {
    spec.rule.below = below.has_value();
    spec.threshold = read_formula(below ? *below : *above);
  }
  read_formula(map, "expected", spec.expected);
  map.finish();
  if (value.problems().count() > before) return spec;  // what would be missing then is not known
  const bool one_value = spec.rule.compare == Compare::crossing || spec.rule.compare == Compare::final_value;
  if (spec.rule.compare == Compare::crossing && !spec.threshold)
    value.report("a crossing needs above or below");
  if (!has_reference && !(one_value && spec.expected))
    value.report(one_value ? "expected or the study's reference is missing"
                           : "the study's reference is missing");
  return spec;
}

/// `error` of the choices of `vary`: what differs from the study's.
void read_own_errors(const Value& vary, bool has_reference, Study& study) {
  const std::size_t axis_of_vary = study.axes.size() - vary.size();  // behind that of the variants
  for (std::size_t k = 0; k < vary.size(); ++k) {
    const Node& axis = vary.node().items[k];
    if (axis.kind != Node::Kind::map) continue;
    for (std::size_t n = 0; n < axis.items.size(); ++n) {
      const int at = index_of(axis.items[n], "error");
      if (at < 0) continue;
      const std::string path = join(join(vary.path(), vary.node().keys[k].text), axis.keys[n].text);
      const Value value(axis.items[n].items[static_cast<std::size_t>(at)], join(path, "error"),
                        vary.problems());
      if (!study.error) {
        value.report("the study's own error is missing, from which this one differs");
        continue;
      }
      ErrorSpec own = read_error(value, *study.error, has_reference);
      const auto is_absolute = [](const ErrorSpec& e) { return e.rule.relative == Relative::absolute; };
      if (is_absolute(own) != is_absolute(*study.error))
        value.report("errors in percent and absolute ones have no common scale");
      study.axes[axis_of_vary + k].choices[n].error = std::move(own);
    }
  }
}

std::vector<ErrorSpec> read_more(const Value& value, const ErrorSpec& base, bool has_reference) {
  std::vector<ErrorSpec> out;
  if (!value.is(Node::Kind::map)) {
    value.complain("not a map of names to what differs from error");
    return out;
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    ErrorSpec spec = base;
    spec.name = value.node().keys[k].text;
    out.push_back(read_error(Value(value.node().items[k], join(value.path(), spec.name), value.problems()),
                             spec, has_reference));
  }
  return out;
}

std::vector<QuantitySpec> read_quantities(const Value& value) {
  std::vector<QuantitySpec> out;
  if (!value.is(Node::Kind::map) || value.size() == 0) {
    value.complain("not a map of names to expressions, or to {quantity, over}");
    return out;
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    QuantitySpec quantity{value.node().keys[k].text, {}};
    const Value item(value.node().items[k], join(value.path(), quantity.name), value.problems());
    if (item.is(Node::Kind::map)) {
      MapReader map(item, "a map {quantity, over}");
      map.need("quantity", "a column of history.csv or an expression of columns");
      read_formula(map, "quantity", quantity.quantity);
      map.word("over", kOvers, quantity.over);
      map.finish();
    } else {
      quantity.quantity = read_formula(item);
    }
    out.push_back(std::move(quantity));
  }
  return out;
}

/// Error against the first cost is study.svg, against another one study_COST.svg.
bool is_cost_chart(const std::string& name) {
  return name == "study" || std::any_of(kCosts.begin(), kCosts.end(), [&](const auto& cost) {
           return name == fmt::format("study_{}", name_of(kCosts, cost.value));
         });
}

std::vector<CurveSpec> read_curves(const Value& list, const std::vector<Axis>& axes) {
  std::vector<CurveSpec> out;
  if (!list.is(Node::Kind::list)) {
    list.complain("not a list of {name, x, y, …}");
    return out;
  }
  std::set<std::string> names;
  for (std::size_t k = 0; k < list.size(); ++k) {
    MapReader map(list.item(k), "a map {name, title, x, y, window, x_label, y_label, panels, only}");
    CurveSpec curve;
    const auto name = map.need("name", "the name of the picture");
    if (name) curve.name = name->name().value_or("");
    if (name && (!names.insert(curve.name).second || is_cost_chart(curve.name)))
      name->complain("is taken by another file of the study");
    map.need("y", "a column of history.csv or an expression of columns");
    read_formula(map, "x", curve.x);
    read_formula(map, "y", curve.y);
    read_window(map, curve.from, curve.to);
    const auto words = [&](const char* key, std::string& text) {
      const auto found = map.find(key);
      if (found) text = found->text().value_or("");
    };
    words("title", curve.title);
    words("x_label", curve.x_label);
    words("y_label", curve.y_label);
    if (const auto panels = map.find("panels")) curve.panels = read_axis(*panels, axes);
    curve.only = read_only(map, axes);
    map.finish();
    out.push_back(std::move(curve));
  }
  return out;
}

void read_costs(MapReader& top, std::vector<Cost>& costs) {
  const auto found = top.find("cost");
  if (!found) return;
  costs.clear();
  const bool list = found->is(Node::Kind::list);
  for (std::size_t k = 0; k < (list ? found->size() : 1); ++k)
    if (const auto cost = (list ? found->item(k) : *found).word(kCosts)) costs.push_back(*cost);
  if (list && found->size() == 0) found->complain("one cost at least was expected");
}

Formula time_column(SourceLocation location, const std::string& path) {
  return {std::get<Expression>(Expression::parse("time_s")), location, path};
}

bool names_every_scene(const Axis& axis) {
  return std::all_of(axis.choices.begin(), axis.choices.end(),
                     [](const Choice& choice) { return choice.scene.has_value(); });
}

void read_top(const Node& root, Study& study, Problems& problems) {
  MapReader top(Value(root, "", problems), "a map {title, scene, set, variants, vary, error, quantities, …}");
  if (!top.valid()) return;
  if (index_of(root, "bodies") >= 0 && index_of(root, "scene") < 0)
    return top.value().report("this is a scene, not a study", "Run it with 'mpmfast run'");
  study.title = study.file.stem().string();
  if (const auto title = top.find("title")) study.title = title->text().value_or("");
  const std::filesystem::path folder = study.file.parent_path();
  study.scene = read_scene_path(top, folder).value_or("");
  study.common = read_settings(top);
  const auto variants = top.find("variants"), vary = top.find("vary");
  if (vary) read_axes(*vary, folder, study.axes);
  if (std::none_of(study.axes.begin(), study.axes.end(), names_every_scene))
    top.need("scene", "the path of a scene, from this file");
  if (variants) study.axes.insert(study.axes.begin(), read_variants(*variants, study.axes));
  if (vary) read_only_of_axes(*vary, study.axes);
  if (!variants && !vary) top.need("variants", "a list of variants, or vary with axes");
  if (const auto reference = top.find("reference")) study.reference = read_reference(*reference, study);
  const bool has_reference = index_of(root, "reference") >= 0;
  const std::size_t before = problems.count();
  if (const auto holds = top.find("holds")) study.conditions = read_conditions(*holds, study.axes);
  if (const auto map = top.find("map")) study.map = read_map(*map, study.axes);
  const auto quantities = top.find("quantities");
  if (quantities) study.quantities = read_quantities(*quantities);
  const bool enough = quantities || !study.conditions.empty();
  const auto error =
      enough ? top.find("error") : top.need("error", "a map {quantity, compare, …}; or holds, or quantities");
  if (error) {
    ErrorSpec spec;
    spec.x = time_column(error->node().location, "error.x");
    study.error = read_error(*error, spec, has_reference);
  }
  if (vary && vary->is(Node::Kind::map) && problems.count() == before)
    read_own_errors(*vary, has_reference, study);
  if (const auto panels = top.find("panels")) study.panels = read_axis(*panels, study.axes);
  const auto more = top.find("more");
  if (more && !study.error) more->report("error is missing, from which these differ");
  if (more && study.error && problems.count() == before)
    study.more = read_more(*more, *study.error, has_reference);
  if (const auto curves = top.find("curves")) study.curves = read_curves(*curves, study.axes);
  for (CurveSpec& curve : study.curves)
    if (!curve.x) curve.x = study.error ? study.error->x : time_column({0, 0, 0}, "");
  read_costs(top, study.costs);
  if (const auto cost = top.find("cost"); cost && !error && study.conditions.empty())
    cost->report("error is missing, which is drawn against the cost");
  top.finish();
}

}  // namespace

Study parse_study(const std::string& text, const std::filesystem::path& file) {
  Problems problems({file.string()});
  Study study;
  study.file = file;
  study.text = text;
  if (const auto root = parse_tree(text, 0, problems)) read_top(*root, study, problems);
  if (!problems.empty()) throw SceneError(problems.sorted());
  return study;
}

Study read_study(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargestFile = 16u << 20;  // bytes
  std::string why_not;
  const auto text = read_regular(file, kLargestFile, why_not);
  if (!text) throw FileError(fmt::format("{}: cannot read the study: {}", file.string(), why_not));
  return parse_study(*text, file);
}

}  // namespace mpmfast
