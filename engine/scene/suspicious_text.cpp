#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <numbers>

#include "engine/quantities/quantity.hpp"
#include "engine/scene/suspicions.hpp"

namespace mpmfast {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// "45": a bare number of more than a turn, alone in the brackets of a sine, cosine or tangent; else nothing.
std::string degrees_within(const std::string& expression, const std::string& function) {
  const std::string opening = function + "(";
  for (std::size_t at = expression.find(opening); at != std::string::npos;
       at = expression.find(opening, at + 1)) {
    if (at > 0 && is_letter(expression[at - 1])) continue;
    const std::size_t first = at + opening.size(), last = expression.find(')', first);
    if (last == std::string::npos) return "";
    const std::string argument = expression.substr(first, last - first);
    const auto number = parse_number(argument);
    if (number && std::abs(*number) > kTurn) return argument;
  }
  return "";
}

/// Looks at all values as they were written.
void walk(const Node& node, const std::string& path, const std::string& key, Problems& found) {
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    const std::string part = node.kind == Node::Kind::map ? node.keys[k].text : std::to_string(k);
    walk(node.items[k], join(path, part), part, found);
  }
  if (node.kind != Node::Kind::scalar) return;
  for (const char* function : {"sin", "cos", "tan"}) {
    const std::string degrees = degrees_within(node.written, function);
    if (!degrees.empty())
      found.add(node.location, path, fmt::format("a bare number is in radians in {}({})", function, degrees),
                fmt::format("Did you mean {}({} deg)?", function, degrees));
  }
  const auto bare = key == "angle" ? parse_number(node.scalar) : std::nullopt;
  if (bare && std::abs(*bare) > kTurn)
    found.add(node.location, path, fmt::format("a bare number is in radians: {:g} turns", *bare / kTurn),
              fmt::format("Did you mean {} deg?", node.scalar));
}

}  // namespace

void find_suspicious_text(const Node& root, Problems& found) { walk(root, "", "", found); }

}  // namespace mpmfast
