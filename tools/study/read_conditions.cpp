#include <set>

#include "study_parts.hpp"

namespace mpmfast {

void read_window(MapReader& map, std::optional<Formula>& from, std::optional<Formula>& to) {
  const auto window = map.find("window");
  if (!window) return;
  if (!window->is(Node::Kind::list) || window->size() != 2)
    return window->complain("not a list [from, to] of values of x");
  from = read_formula(window->item(0));
  to = read_formula(window->item(1));
}

std::vector<Condition> read_conditions(const Value& list, const std::vector<Axis>& axes) {
  std::vector<Condition> out;
  if (!list.is(Node::Kind::list) || list.size() == 0) {
    list.complain("not a list of {name, quantity, at_least, at_most, …}");
    return out;
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    MapReader map(list.item(k),
                  "a map {name, quantity, change, over, at_least, at_most, at_end, window, only}");
    if (!map.valid()) continue;
    Condition condition;
    if (const auto name = map.need("name", "what is wrong where it does not hold"))
      condition.name = name->text().value_or("");
    map.need("quantity", "a column of history.csv or an expression of columns");
    read_formula(map, "quantity", condition.quantity);
    read_formula(map, "over", condition.over);
    read_formula(map, "at_least", condition.at_least);
    read_formula(map, "at_most", condition.at_most);
    if (!map.find("at_least") && !map.find("at_most"))
      list.item(k).report("at_least or at_most was expected, or both");
    map.boolean("change", condition.change);
    map.boolean("at_end", condition.at_end);
    read_window(map, condition.from, condition.to);
    condition.only = read_only(map, axes);
    map.finish();
    out.push_back(std::move(condition));
  }
  return out;
}

MapSpec read_map(const Value& value, const std::vector<Axis>& axes) {
  MapSpec out;
  MapReader map(value, "a map {panels, columns, judged}");
  if (!map.valid()) return out;
  const auto panels = map.need("panels", "an axis: a map for each of its values");
  const auto columns = map.need("columns", "an axis");
  const auto read_one = [&](const std::optional<Value>& name, std::size_t& axis) {
    if (const auto found = name ? read_axis(*name, axes) : std::nullopt) axis = *found;
  };
  read_one(panels, out.panels);
  read_one(columns, out.columns);
  if (columns && panels && out.panels == out.columns) columns->report("is the axis of panels");
  if (const auto judged = map.find("judged")) {
    const std::string text = judged->text().value_or("");
    const bool known = columns && out.columns < axes.size();  // a study without axes has none to name
    for (std::size_t k = 0; known && k < axes[out.columns].choices.size(); ++k)
      if (axes[out.columns].choices[k].name == text) out.judged = k;
    if (!out.judged) judged->complain("no such value of the columns' axis");
  }
  map.finish();
  return out;
}

}  // namespace mpmfast
