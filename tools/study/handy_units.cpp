#include "handy_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace mpmfast {

namespace {

struct ColumnEnd {
  const char *end, *unit, *quantity;
};
constexpr ColumnEnd kEnds[] = {{"s", "s", "time"},        {"J", "J", "energy"},     {"N", "N", "force"},
                               {"Pa", "Pa", "stress"},    {"m", "m", "length"},     {"m2", "m²", "area"},
                               {"kg", "kg", "mass"},      {"Nm", "N m", "moment"},  {"vx", "m/s", "velocity"},
                               {"vy", "m/s", "velocity"}, {"vz", "m/s", "velocity"}};
constexpr std::array<const char*, 7> kPrefixes{"n", "µ", "m", "", "k", "M", "G"};
constexpr int kNoPrefix = 3;  // its place among them

/// The text without what stands between backquotes.
std::string without_names(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (const char c : text) {
    if (c == '`') quoted = !quoted;
    if (!quoted) out += c;
  }
  return out;
}

}  // namespace

std::string unit_of_column(const std::string& name) {
  const std::size_t last = name.find_last_of("_.");
  for (const ColumnEnd& known : kEnds)
    if (last != std::string::npos && name.compare(last + 1, std::string::npos, known.end) == 0)
      return known.unit;
  return "";
}

std::string quantity_in(const std::string& unit) {
  for (const ColumnEnd& known : kEnds)
    if (unit == known.unit) return known.quantity;
  return "";
}

std::string unit_of(const Expression& expression) {
  if (expression.names().empty()) return "";
  if (without_names(expression.text()).find_first_of("*/^(") != std::string::npos) return "";
  const std::string unit = unit_of_column(expression.names()[0]);
  const bool alike = std::all_of(expression.names().begin(), expression.names().end(),
                                 [&](const std::string& name) { return unit_of_column(name) == unit; });
  return alike ? unit : "";
}

std::string name_beside(const Expression& expression, const std::string& unit) {
  std::string name = expression.text();
  name.erase(std::remove(name.begin(), name.end(), '`'), name.end());
  if (name == "time_s") return "time";
  const std::string end = "_" + unit;
  const bool is_one = name.find(' ') == std::string::npos && !unit.empty() && name.ends_with(end);
  return is_one ? name.substr(0, name.size() - end.size()) : name;
}

HandyUnit handy_unit(const std::string& unit, double largest) {
  constexpr std::array<std::string_view, 7> kPrefixed{"s", "J", "N", "Pa", "m", "J/m", "N/m"};
  const bool prefixed = std::find(kPrefixed.begin(), kPrefixed.end(), unit) != kPrefixed.end();
  if (!prefixed || !(largest > 0) || !std::isfinite(largest)) return {1, unit};
  const int highest = unit == "s" ? kNoPrefix : static_cast<int>(kPrefixes.size()) - 1;
  const int thousands = static_cast<int>(std::floor(std::log10(largest) / 3));
  const int step = std::clamp(thousands + kNoPrefix, 0, highest);
  return {std::pow(1000.0, kNoPrefix - step), kPrefixes[static_cast<std::size_t>(step)] + unit};
}

}  // namespace mpmfast
