#include "engine/scene/schema/known_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

std::string count_text(int least, int most) {
  if (most == Form::kNoEnd) return fmt::format("{} or more", least);
  return least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most);
}

std::string limit_text(const Limit& limit) {
  if (limit.same(kAny)) return "";
  if (limit.same(kPositive)) return " > 0";
  if (limit.same(kNotNegative)) return " ≥ 0";
  return std::string(" ") + limit.description;
}

std::string units_text(Measure measure, bool units) {
  const char* known = kind_of(measure).units;
  return units && *known ? fmt::format(" ({})", known) : "";
}

/// "whole number, 0 to 255" → "whole numbers, 0 to 255".
std::string plural_first(const std::string& text) {
  const std::size_t comma = text.find(',');
  return text.substr(0, comma) + "s" + text.substr(comma);
}

std::string list_text(const std::string& pattern, const Form& form, bool units) {
  const std::string entries = form_text(pattern + "[]", units);
  const std::string count =
      form.least == 0 && form.most == Form::kNoEnd ? "" : count_text(form.least, form.most) + " ";
  if (entries == "map") return "list of maps";
  if (entries == "name") return fmt::format("list of {}names", count);
  if (entries.starts_with("whole"))
    return known_at(pattern).form(Form::Kind::whole)
               ? fmt::format("list of {}", count.substr(0, count.size() - 1))
               : "list of " + plural_first(entries);
  if (const Form* table = known_at(pattern + "[]").form(Form::Kind::table))
    return fmt::format("{}{}{} or tables", count, plural_of(table->measure),
                       units_text(table->measure, units));
  return fmt::format("{}lists of {}", count, entries);
}

std::string one_form(const std::string& pattern, const Form& form, bool units) {
  const auto number = [&](bool many) {
    return (many ? plural_of(form.measure) : noun_of(form.measure)) + units_text(form.measure, units) +
           limit_text(form.limit);
  };
  constexpr int kMany = 100000;
  switch (form.kind) {
    case Form::Kind::quantity:
      return number(false);
    case Form::Kind::whole:
      if (form.most == form.least + 1) return fmt::format("{} or {}", form.least, form.most);
      return form.most > kMany ? fmt::format("whole number ≥ {}", form.least)
                               : fmt::format("whole number, {} to {}", form.least, form.most);
    case Form::Kind::truth:
      return "true or false";
    case Form::Kind::text:
      return "text";
    case Form::Kind::name:
      return "name";
    case Form::Kind::vector:
      return fmt::format("{} {}", count_text(form.least, form.most), number(true));
    case Form::Kind::table:
      return number(false) + " or table";
    case Form::Kind::points:
      return fmt::format("points [{}, {}]", noun_of(form.along), noun_of(form.measure));
    case Form::Kind::list:
      return list_text(pattern, form, units);
    case Form::Kind::map:
      return "map";
    case Form::Kind::word:
      break;
  }
  constexpr std::size_t kFew = 3;
  std::vector<std::string> words;
  for (const KnownKeyword& word : known_at(pattern).words) words.push_back(word.name);
  return words.size() <= kFew ? fmt::format("{}", fmt::join(words, ", ")) : "word";
}

}  // namespace

const Known& known_at(const std::string& pattern) {
  static const Known kNothing;
  const auto found = known_values().find(pattern);
  return found == known_values().end() ? kNothing : found->second;
}

std::vector<std::string> conditions_of(const std::string& map) {
  std::vector<std::string> out;
  for (const auto& [pattern, known] : known_values()) {
    if (!pattern.starts_with(map + "<") || pattern.back() != '>') continue;
    const std::string condition = pattern.substr(map.size() + 1, pattern.size() - map.size() - 2);
    if (condition.find_first_of(".[>") == std::string::npos) out.push_back(condition);
  }
  return out;
}

std::vector<KnownKey> plain_keys(const std::string& map) {
  std::vector<KnownKey> out;
  for (const std::string& key : known_at(map).keys) out.push_back({key, join(map, key), ""});
  return out;
}

std::vector<KnownKey> all_keys(const std::string& map) {
  std::vector<KnownKey> out = plain_keys(map);
  for (const std::string& condition : conditions_of(map)) {
    const std::string inner = map + "<" + condition + ">";
    if (known_at(inner).closed) continue;
    for (const std::string& key : known_at(inner).keys) {
      const bool there =
          std::any_of(out.begin(), out.end(), [&](const KnownKey& k) { return k.name == key; });
      if (!there) out.push_back({key, join(inner, key), condition});
    }
  }
  return out;
}

std::string form_text(const std::string& pattern, bool units) {
  std::vector<std::string> parts;
  for (const Form& form : known_at(pattern).forms) parts.push_back(one_form(pattern, form, units));
  return fmt::format("{}", fmt::join(parts, ", or "));
}

std::string default_text(const std::string& pattern) { return known_at(pattern).standard.value_or(""); }

std::string keys_text(const std::string& map) {
  const KeyGroups& groups = known_at(map).one_of;
  const bool instead = groups.size() == 2 && groups[0].size() > 1;  // bulk, shear or young, poisson
  std::vector<std::string> parts;
  for (const KnownKey& key : all_keys(map)) {
    const auto& second = instead ? groups[1] : std::vector<std::string>{};
    if (std::find(second.begin(), second.end(), key.name) != second.end()) continue;
    std::string text = key.name;
    const std::vector<KnownKey> inner = all_keys(key.pattern);
    if (!inner.empty()) text += fmt::format(": {{{}}}", keys_text(key.pattern));
    if (const std::string standard = default_text(key.pattern); !standard.empty()) text += " = " + standard;
    if (key.condition == "3d") text += " (3-D)";
    if (!key.condition.empty() && key.condition != "3d" && key.condition[0] != '!')
      text += fmt::format(" (with {})", key.condition);
    if (instead && key.name == groups[0].back()) text += fmt::format(" (or {})", fmt::join(second, ", "));
    parts.push_back(text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string law_keys_text(const ContactLawKind& law) {
  std::vector<std::string> parts;
  for (const LawParameter& parameter : law.parameters) {
    parts.push_back(parameter.name);
    if (!parameter.needed) parts.back() += " = " + default_text(join("contact", parameter.name));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace mpmfast
