#include "engine/scene/schema/schema_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace mpmfast {

namespace {

/// Digits as the reader takes them: no leading zeros.
constexpr const char* kDigits = "(?:(?:0|[1-9][0-9]*)(?:\\.[0-9]*)?|\\.[0-9]+)(?:[eE][+-]?[0-9]+)?";
constexpr const char* kNotZero = "(?![0.]+(?:[eE][+-]?[0-9]+)?(?![0-9.eE]))";

/// The symbols, also with the typographic signs that the reader takes.
std::vector<std::string> spellings(const std::vector<std::string>& symbols) {
  std::vector<std::string> out;
  for (const std::string& symbol : symbols) {
    const std::size_t micro = symbol.find('u');
    out.push_back(symbol == "deg"              ? "deg|°"
                  : micro == std::string::npos ? symbol
                                               : std::string(symbol).replace(micro, 1, "[uµμ]"));
  }
  return out;
}

/// A symbol of this dimension, or symbols multiplied and divided, whose dimension a pattern cannot know.
std::string unit_pattern(Measure measure) {
  std::vector<std::string> single = spellings(unit_symbols(measure)), any = spellings(unit_symbols());
  const std::string power = "(?:\\^-?[0-9]|[0-9]|[²³])";
  const std::string factor = fmt::format("(?:{}){}?", fmt::join(any, "|"), power);
  single.push_back(fmt::format("{0}(?: *[*/·] *{0})+", factor));
  single.push_back(fmt::format("(?:{}){}", fmt::join(any, "|"), power));
  return fmt::format("(?:{})", fmt::join(single, "|"));
}

/// "5 mm", "1/70 mm", "2.78 g/cm^3", or an expression.
std::string quantity_pattern(Measure measure, const Limit& limit) {
  const bool positive = !limit.moves && limit.lower >= 0;
  const std::string sign = positive ? "\\+?" : "[+-]?",
                    nonzero = positive && limit.lower_open ? kNotZero : "";
  return fmt::format("^\\s*{0}{1}{2}(?:\\s*/\\s*[+-]?{2})?(?:\\s*{3})?\\s*$|{4}", sign, nonzero, kDigits,
                     unit_pattern(measure), kExpression);
}

/// "a heat capacity" → "heat_capacity".
std::string definition_name(Measure measure) {
  std::string name = noun_of(measure);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace

Json Definitions::reference(const std::string& name, const Json& schema) {
  all_[name] = schema;
  return {{"$ref", "#/definitions/" + name}};
}

std::vector<Json> Definitions::quantity(Measure measure, const Limit& limit) {
  Json number{{"type", "number"}};
  if (!limit.moves && std::isfinite(limit.lower))
    number[limit.lower_open ? "exclusiveMinimum" : "minimum"] = limit.lower;
  if (!limit.moves && std::isfinite(limit.upper))
    number[limit.upper_open ? "exclusiveMaximum" : "maximum"] = limit.upper;
  std::string name = definition_name(measure);
  if (!limit.moves && limit.lower >= 0) name += limit.lower_open ? "_positive" : "_not_negative";
  const QuantityKind& kind = kind_of(measure);
  const std::string description =
      *kind.units ? fmt::format("{} with its unit: {}", kind.name, kind.units) : kind.name;
  return {number, reference(name, {{"type", "string"},
                                   {"pattern", quantity_pattern(measure, limit)},
                                   {"description", description}})};
}

Json Definitions::points(const Points& form) {
  const Json along{{"anyOf", quantity(form.along, kAny)}}, value{{"anyOf", quantity(form.value, kAny)}};
  return {{"type", "array"},
          {"minItems", 1},
          {"items", {{"type", "array"}, {"items", {along, value}}, {"minItems", 2}, {"maxItems", 2}}}};
}

Json Definitions::table(Measure measure) {
  const Json time{{"anyOf", quantity(Measure::time, kAny)}}, value{{"anyOf", quantity(measure, kAny)}};
  const auto column = [](const Json& entry) {
    return Json{{"type", "array"}, {"minItems", 1}, {"items", entry}};
  };
  const Json columns{{"type", "object"},
                     {"properties", {{"times", column(time)}, {"values", column(value)}}},
                     {"required", {"times", "values"}},
                     {"additionalProperties", false}};
  std::vector<Json> forms = quantity(measure, kAny);
  forms.insert(forms.end(), {points({Measure::time, measure}), columns});
  return reference(definition_name(measure) + "_table",
                   {{"anyOf", forms},
                    {"description",
                     "Constant, or pairs [time, value], or {times: […], values: […]}: linear between "
                     "the points, constant outside."}});
}

Json Definitions::words(const std::vector<KnownKeyword>& words, const Form& form) const {
  Json known = Json::array(), description = Json::array();
  std::vector<std::string> ordered;
  const auto add = [&](const Json& word, const std::string& meaning) {
    known.push_back(word);
    description.push_back(meaning);
  };
  for (const KnownKeyword& word : words) {
    if (word.name.ends_with("(m)")) {
      for (int m = form.least; m <= form.most; ++m)
        add(word.name.substr(0, word.name.size() - 2) + fmt::format("{})", m), word.description);
      continue;
    }
    add(word.name, word.description);
    const Json as_number = json_of(word.name);
    if (!as_number.is_string()) add(as_number, word.description);
  }
  Json out{{"enum", known}};
  const bool described =
      std::any_of(words.begin(), words.end(), [](const KnownKeyword& w) { return !w.description.empty(); });
  if (described) out["enumDescriptions"] = out["markdownEnumDescriptions"] = description;
  return out;
}

Json Definitions::name() const {
  return {{"type", {"string", "number", "boolean"}},
          {"pattern", fmt::format("^[0-9A-Za-z_\\u0080-\\uffff-]{{1,80}}$|{}", kExpression)}};
}

Json json_of(const std::string& text) {
  if (text.starts_with("[")) {
    Json list = Json::array();
    for (std::size_t begin = 1; begin < text.size();) {
      const std::size_t end = std::min(text.find(", ", begin), text.size() - 1);
      list.push_back(json_of(text.substr(begin, end - begin)));
      begin = end + 2;
    }
    return list;
  }
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = parse_number(text)) {
    if (*number == std::floor(*number) && std::abs(*number) < 1e9) return static_cast<long>(*number);
    return *number;
  }
  return text;
}

}  // namespace mpmfast
