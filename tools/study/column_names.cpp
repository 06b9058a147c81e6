#include "column_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

bool needs_backquotes(const std::string& name) {
  const auto parsed = Expression::parse(name);
  const auto* expression = std::get_if<Expression>(&parsed);
  return !expression || expression->names() != std::vector{name};
}

/// Known names that stand in the text without the backquotes that they need.
std::vector<std::string> bare_names(const std::string& text, std::span<const std::string> known) {
  std::vector<std::string> out;
  for (const std::string& name : known)
    if (text.find(name) != std::string::npos && text.find('`' + name) == std::string::npos &&
        needs_backquotes(name))
      out.push_back(name);
  return out;
}

std::string nearest(const std::string& name, std::span<const std::string> known) {
  const std::string found = closest(name, known);
  if (found.empty()) return "";
  return needs_backquotes(found) ? fmt::format("Did you mean `{}`?", found) : did_you_mean(name, known);
}

}  // namespace

std::vector<UnknownName> unknown_names(const Expression& expression, std::span<const std::string> known) {
  const std::vector<std::string> bare = bare_names(expression.text(), known);
  std::vector<UnknownName> out;
  bool told = false;
  for (const std::string& name : expression.names()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const bool piece = std::any_of(bare.begin(), bare.end(), [&](const std::string& whole) {
      return whole.find(name) != std::string::npos;
    });
    if (!piece) {
      out.push_back({name, nearest(name, known)});
    } else if (!told) {
      out.push_back({name, fmt::format("Between backquotes it is known: `{}`", fmt::join(bare, "`, `"))});
      told = true;
    }
  }
  return out;
}

}  // namespace mpmfast
