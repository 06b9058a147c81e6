#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "engine/scene/text/suggest.hpp"
#include "study_parts.hpp"

namespace mpmfast {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// A node as YAML on one line, so that it can override a value of the scene.
std::string flow_text(const Node& node) {
  if (node.kind == Node::Kind::null) return "~";
  if (node.kind == Node::Kind::scalar) {
    const std::string& text = node.scalar;
    const bool plain = !text.empty() && text.front() != ' ' && text.back() != ' ' &&
                       (text.front() != '-' || (text.size() > 1 && text[1] != ' ' && text[1] != '-')) &&
                       text.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                           "_.+-/^() ") == std::string::npos &&
                       text != "null" && text != "Null" && text != "NULL";
    if (plain) return text;
    return quoted(text);
  }
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    const std::string value = flow_text(node.items[k]);
    parts.push_back(node.kind == Node::Kind::map ? quoted(node.keys[k].text) + ": " + value : value);
  }
  const bool map = node.kind == Node::Kind::map;
  return (map ? "{" : "[") + fmt::format("{}", fmt::join(parts, ", ")) + (map ? "}" : "]");
}

}  // namespace

std::optional<Formula> read_formula(const Value& value) {
  const auto text = value.text();
  if (!text) return std::nullopt;
  auto parsed = Expression::parse(*text);
  if (const auto* wrong = std::get_if<std::string>(&parsed)) {
    value.complain("not an expression: " + *wrong);
    return std::nullopt;
  }
  return Formula{std::get<Expression>(parsed), value.node().location, value.path()};
}

void read_formula(MapReader& map, const std::string& key, std::optional<Formula>& out) {
  const auto found = map.find(key);
  if (auto formula = found ? read_formula(*found) : std::nullopt) out = formula;
}

std::vector<Setting> read_settings(MapReader& map) {
  std::vector<Setting> out;
  const auto found = map.find("set");
  if (!found) return out;
  if (!found->is(Node::Kind::map)) {
    found->complain("not a map of overrides such as {method.update: flip}");
    return out;
  }
  for (std::size_t k = 0; k < found->size(); ++k) {
    const Key& key = found->node().keys[k];
    const Node& node = found->node().items[k];
    out.push_back({{key.text, flow_text(node)}, node.location, join(found->path(), key.text)});
  }
  return out;
}

namespace {

Constants read_constants(MapReader& map) {
  Constants out;
  const auto found = map.find("let");
  if (!found) return out;
  if (!found->is(Node::Kind::map)) {
    found->complain("not a map of names and values");
    return out;
  }
  for (std::size_t k = 0; k < found->size(); ++k) {
    const std::string& name = found->node().keys[k].text;
    const Value value(found->node().items[k], join(found->path(), name), found->problems());
    const auto formula = read_formula(value);
    if (formula && !formula->expression.names().empty()) {
      value.complain("must be a number");
    } else if (formula) {
      out[name] = evaluate(formula->expression, {});
    }
  }
  return out;
}

/// Text, or a list of texts.
std::vector<std::string> read_words(const Value& value) {
  std::vector<std::string> out;
  if (!value.is(Node::Kind::list)) {
    if (const auto text = value.text()) out.push_back(*text);
    return out;
  }
  for (std::size_t k = 0; k < value.size(); ++k)
    if (const auto text = value.item(k).text()) out.push_back(*text);
  return out;
}

const Choice* find_choice(const Axis& axis, const std::string& name) {
  for (const Choice& choice : axis.choices)
    if (choice.name == name) return &choice;
  return nullptr;
}

/// A word says what it is, "flip"; of a number nobody can tell: "cfl=0.2".
std::string label_of(const std::string& value, const std::string& key) {
  const bool word = std::isalpha(static_cast<unsigned char>(value[0])) && value != "true" && value != "false";
  return word ? value : fmt::format("{}={}", key, value);
}

/// The last part of the axis' key; all of it where another axis ends alike.
std::string short_key(const Axis& axis, const std::vector<Axis>& axes) {
  const auto last_part = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  const auto alike = std::count_if(axes.begin(), axes.end(), [&](const Axis& other) {
    return last_part(other.name) == last_part(axis.name);
  });
  return alike > 1 ? axis.name : last_part(axis.name);
}

std::vector<std::string> axis_names(const std::vector<Axis>& axes) {
  std::vector<std::string> out;
  for (const Axis& axis : axes) out.push_back(axis.name);
  return out;
}

}  // namespace

Only read_only(MapReader& map, const std::vector<Axis>& axes) {
  Only out;
  const auto found = map.find("only");
  if (!found) return out;
  MapReader only(*found, "a map of axes and their values");
  for (const Axis& axis : axes) {
    const auto value = only.find(axis.name);
    if (!value) continue;
    std::vector<std::string> known;
    for (const Choice& choice : axis.choices) known.push_back(choice.name);
    for (const std::string& word : read_words(*value)) {
      if (!find_choice(axis, word))
        value->complain(fmt::format("no such value of {} (one of {})", axis.name, fmt::join(known, ", ")),
                        did_you_mean(word, known));
      out[axis.name].push_back(word);
    }
  }
  only.finish();
  return out;
}

std::optional<std::filesystem::path> read_scene_path(MapReader& map, const std::filesystem::path& folder) {
  const auto scene = map.find("scene");
  const auto text = scene ? scene->text() : std::nullopt;
  if (!text) return std::nullopt;
  const std::filesystem::path path = (folder / *text).lexically_normal();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) scene->complain("no such scene");
  return path;
}

/// The axes of `vary`: a list holds values of the scene's key, a map holds named choices.
void read_axes(const Value& vary, const std::filesystem::path& folder, std::vector<Axis>& axes) {
  if (!vary.is(Node::Kind::map)) return vary.complain("not a map of axes");
  for (std::size_t k = 0; k < vary.size(); ++k) {
    const Key& key = vary.node().keys[k];
    const Value value(vary.node().items[k], join(vary.path(), key.text), vary.problems());
    Axis axis{key.text, key.location, {}};
    if ((!value.is(Node::Kind::list) && !value.is(Node::Kind::map)) || value.size() == 0)
      value.complain("not a list of values, or a map of names to {set, let, scene, only, error}");
    for (std::size_t n = 0; n < value.size(); ++n) {
      const Node& node = value.node().items[n];
      Choice choice;
      if (value.is(Node::Kind::list)) {
        const std::string text = flow_text(node);
        choice.name = node.kind == Node::Kind::scalar ? node.scalar : text;
        choice.set.push_back({{key.text, text}, node.location, join(value.path(), std::to_string(n))});
      } else {
        choice.name = choice.label = value.node().keys[n].text;
        MapReader map(Value(node, join(value.path(), choice.name), value.problems()),
                      "a map {set, let, scene, only, error}");
        choice.set = read_settings(map);
        choice.let = read_constants(map);
        choice.scene = read_scene_path(map, folder);
        map.find("only");   // read when all axes are known
        map.find("error");  // and when the study's own is
        map.finish();
      }
      if (find_choice(axis, choice.name))
        value.problems().add(node.location, value.path(), fmt::format("'{}' is given twice", choice.name));
      axis.choices.push_back(std::move(choice));
    }
    axes.push_back(std::move(axis));
  }
  for (Axis& axis : axes)
    for (Choice& choice : axis.choices)
      if (choice.label.empty()) choice.label = label_of(choice.name, short_key(axis, axes));
}

void read_only_of_axes(const Value& vary, std::vector<Axis>& axes) {
  if (!vary.is(Node::Kind::map)) return;
  const std::size_t before = axes.size() - vary.size();  // the variants
  for (std::size_t k = 0; k < vary.size(); ++k) {
    Axis& axis = axes[before + k];
    const Value value(vary.node().items[k], join(vary.path(), axis.name), vary.problems());
    for (std::size_t n = 0; value.is(Node::Kind::map) && n < value.size(); ++n) {
      const std::string path = join(value.path(), axis.choices[n].name);
      if (value.node().items[n].kind != Node::Kind::map) continue;
      MapReader map(Value(value.node().items[n], path, value.problems()));
      axis.choices[n].only = read_only(map, axes);
    }
  }
}

/// `vary` was read before, so that `only` can name its axes.
Axis read_variants(const Value& list, const std::vector<Axis>& axes) {
  Axis axis{"variants", list.node().location, {}};
  if (!list.is(Node::Kind::list) || list.size() == 0) {
    list.complain("not a list of {name, set, let, only, program}");
    return axis;
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    MapReader map(list.item(k), "a map {name, set, let, only, program}");
    Choice choice;
    if (const auto name = map.need("name", "text")) choice.name = name->text().value_or("");
    choice.label = choice.name;
    choice.set = read_settings(map);
    choice.let = read_constants(map);
    choice.only = read_only(map, axes);
    if (const auto program = map.find("program"))
      if (const auto path = program->text())
        choice.program = Setting{{"program", *path}, program->node().location, program->path()};
    map.finish();
    if (find_choice(axis, choice.name)) list.item(k).report(fmt::format("'{}' is given twice", choice.name));
    axis.choices.push_back(std::move(choice));
  }
  return axis;
}

std::optional<std::size_t> read_axis(const Value& value, const std::vector<Axis>& axes) {
  return value.keyword_index(axis_names(axes));
}

}  // namespace mpmfast
