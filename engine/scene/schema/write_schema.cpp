#include "engine/scene/schema/write_schema.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/schema/known_keys.hpp"
#include "engine/scene/schema/schema_values.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

Json required(const std::vector<std::string>& keys) { return {{"required", keys}}; }

/// Those of the keys that must be there; an empty schema where there are none.
Json required_of(const std::vector<KnownKey>& keys) {
  std::vector<std::string> needed;
  for (const KnownKey& key : keys)
    if (known_at(key.pattern).needed) needed.push_back(key.name);
  return needed.empty() ? Json::object() : required(needed);
}

/// What an editor shows beside a key: plain, and with the words as a list.
void describe(const KnownKey& key, Json& schema) {
  const Known& known = known_at(key.pattern);
  std::string text = known.description;
  text += fmt::format("\n\nForm: {}.", form_text(key.pattern, true));
  const std::string standard = default_text(key.pattern);
  if (!standard.empty())
    text +=
        fmt::format(" Default: {}{}.", standard, known.varies ? ", where no other key says otherwise" : "");
  if (known.needed && key.condition == "3d") text += " Needed in 3-D.";
  schema["description"] = text;
  std::string list;
  for (const KnownKeyword& word : known.words)
    if (!word.description.empty()) list += fmt::format("\n- `{}`: {}", word.name, word.description);
  if (!list.empty()) schema["markdownDescription"] = text + "\n" + list;
  if (!standard.empty()) schema["default"] = json_of(standard);
}

class SchemaWriter {
 public:
  Json top() {
    Json out{
        {"$schema", "http://json-schema.org/draft-07/schema#"},
        {"$id", "mpmfast-scene.schema.json"},
        {"title", "Scene of mpmfast"},
        {"description",
         "What mpmfast reads. Write it with `mpmfast schema > mpmfast-scene.schema.json`, and let a scene "
         "begin with the line `# yaml-language-server: $schema=mpmfast-scene.schema.json`: editors then "
         "complete, explain and check its keys."}};
    Json scene = object("");
    scene["properties"].update(early_properties());
    // What a scene includes may hold what is needed.
    scene["if"] = required({"include"});
    scene["else"] = required(scene["required"]);
    scene.erase("required");
    out.update(scene);
    out["definitions"] = definitions_.all();
    out["definitions"]["expression"] = {{"type", "string"}, {"pattern", kExpression}};
    return out;
  }

 private:
  /// Of the early keys, which no description lists.
  static Json early_properties() {
    const Json text{{"type", "string"}};
    Json out{{"variables", {{"type", "object"}, {"additionalProperties", {{"type", {"number", "string"}}}}}},
             {"include", {{"anyOf", {text, {{"type", "array"}, {"items", text}}}}}}};
    for (const KnownKeyword& key : early_keys()) out[key.name]["description"] = key.description;
    return out;
  }

  Json property(const KnownKey& key) {
    Json out = value(key.pattern);
    describe(key, out);
    return out;
  }

  /// The forms that a value may have, and text with an expression wherever one of them is a scalar.
  Json value(const std::string& pattern) {
    std::vector<Json> forms;
    bool expression = false;
    for (const Form& form : known_at(pattern).forms) {
      for (Json& one : form_of(pattern, form)) forms.push_back(std::move(one));
      expression = expression || form.kind == Form::Kind::whole || form.kind == Form::Kind::truth ||
                   form.kind == Form::Kind::word;
    }
    if (expression) forms.push_back({{"$ref", "#/definitions/expression"}});
    if (forms.empty()) return Json::object();
    if (forms.size() == 1 && !forms[0].contains("$ref")) return forms[0];
    return {{"anyOf", forms}};
  }

  std::vector<Json> form_of(const std::string& pattern, const Form& form) {
    switch (form.kind) {
      case Form::Kind::quantity:
        return definitions_.quantity(form.measure, form.limit);
      case Form::Kind::whole:
        return {{{"type", "integer"}, {"minimum", form.least}, {"maximum", form.most}}};
      case Form::Kind::truth:
        return {{{"type", "boolean"}}};
      case Form::Kind::text:
        return {{{"type", {"string", "number", "boolean"}}}};
      case Form::Kind::name:
        return {definitions_.name()};
      case Form::Kind::vector:
        return {list(form, {{"anyOf", definitions_.quantity(form.measure, form.limit)}})};
      case Form::Kind::table:
        return {definitions_.table(form.measure)};
      case Form::Kind::points:
        return {definitions_.points({form.along, form.measure})};
      case Form::Kind::list:
        return {list(form, value(pattern + "[]"))};
      case Form::Kind::map:
        return {object(pattern)};
      case Form::Kind::word:
        return {definitions_.words(known_at(pattern).words, form)};
    }
    return {};
  }

  static Json list(const Form& form, const Json& entry) {
    Json out{{"type", "array"}, {"items", entry}};
    if (form.least > 0) out["minItems"] = form.least;
    if (form.most != Form::kNoEnd) out["maxItems"] = form.most;
    return out;
  }

  Json object(const std::string& map) {
    Json out{{"type", "object"}, {"properties", Json::object()}};
    const Known& known = known_at(map);
    for (const KnownKey& key : all_keys(map)) add_property(map, key, out);
    out.update(required_of(plain_keys(map)));
    if (known.closed) out["additionalProperties"] = false;
    Json rules = Json::array();
    if (!known.one_of.empty()) rules.push_back(one_of(known.one_of));
    for (const std::string& condition : conditions_of(map)) add_rule(map, condition, rules);
    if (out["properties"].contains("law")) add_law_rules(map == "contact", rules);
    if (!rules.empty()) out["allOf"] = rules;
    return out;
  }

  /// A key, or what stands for keys that users choose: faces by name, others as further properties.
  void add_property(const std::string& map, const KnownKey& key, Json& out) {
    if (key.name == "FACE") {
      const std::string name = map == "boundaries" ? "face" : map.substr(0, map.find('.')) + "_face";
      const Json face_schema = definitions_.reference(name, property(key));
      for (const FaceName& face : kFaces) out["properties"][face.name] = face_schema;
    } else if (key.name == "NAME") {
      out["additionalProperties"] = property(key);
    } else if (key.name == "GREY") {
      out["patternProperties"]["^[0-9]{1,3}$"] = property(key);
      out["additionalProperties"] = false;
    } else {
      out["properties"][key.name] = property(key);
    }
  }

  /// Exactly one group of keys, whole, and none of the others.
  static Json one_of(const KeyGroups& groups) {
    Json out = Json::array();
    for (const auto& group : groups) {
      Json others = Json::array();
      for (const auto& other : groups)
        for (const std::string& key : other)
          if (&other != &group && groups.size() == 2) others.push_back(required({key}));
      Json one = required(group);
      if (!others.empty()) one["not"] = {{"anyOf", others}};
      out.push_back(one);
    }
    return {{"oneOf", out}};
  }

  /// What a map must and may hold under a condition.
  void add_rule(const std::string& map, const std::string& condition, Json& rules) {
    if (condition == "3d") return;
    const std::string inner = map + "<" + condition + ">";
    const bool absent = condition[0] == '!';
    const std::size_t begin = absent ? 1 : 0, equals = condition.find('=');
    const std::string key = condition.substr(begin, equals - begin);
    Json test = required({key});
    if (equals != std::string::npos) test["properties"][key] = {{"const", condition.substr(equals + 1)}};
    Json then, otherwise;
    if (known_at(inner).closed) {
      then = object(inner);
      for (const KnownKey& common : plain_keys(map)) then["properties"][common.name] = true;
    } else {
      then = required_of(plain_keys(inner));
      Json forbidden = Json::object();
      for (const KnownKey& one : plain_keys(inner))
        if (!known_elsewhere(map, condition, one.name)) forbidden[one.name] = false;
      if (!forbidden.empty()) otherwise["properties"] = forbidden;
    }
    Json rule{{"if", absent ? Json{{"not", test}} : test}, {"then", then}};
    if (!otherwise.is_null()) rule["else"] = otherwise;
    rules.push_back(rule);
  }

  static bool known_elsewhere(const std::string& map, const std::string& condition, const std::string& key) {
    const auto holds = [&](const std::string& pattern) {
      const auto& keys = known_at(pattern).keys;
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    if (holds(map)) return true;
    for (const std::string& other : conditions_of(map))
      if (other != condition && holds(map + "<" + other + ">")) return true;
    return false;
  }

  /// A law has its own parameters; those of a pair may be the ones of `contact`.
  static void add_law_rules(bool complete, Json& rules) {
    for (const ContactLawKind& law : contact_laws()) {
      Json then{{"properties", Json::object()}};
      std::vector<std::string> needed;
      for (const std::string& name : contact_parameters()) {
        const auto own = std::find_if(law.parameters.begin(), law.parameters.end(),
                                      [&](const LawParameter& parameter) { return parameter.name == name; });
        const bool owns = own != law.parameters.end();
        if (owns && own->needed && complete) needed.push_back(name);
        if (!owns && name != "friction") then["properties"][name] = false;
      }
      if (!needed.empty()) then["required"] = needed;
      rules.push_back({{"if", {{"properties", {{"law", {{"const", law.name}}}}}, {"required", {"law"}}}},
                       {"then", then}});
    }
  }

  Definitions definitions_;
};

}  // namespace

std::string write_schema() { return SchemaWriter().top().dump(1) + "\n"; }

}  // namespace mpmfast
