#include "handy_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace mpmfast {

namespace {

// The ends of columns, and the units as an axis shows them.
constexpr std::array<std::pair<const char*, const char*>, 8> kEnds{{{"s", "s"},
                                                                    {"J", "J"},
                                                                    {"N", "N"},
                                                                    {"Pa", "Pa"},
                                                                    {"m", "m"},
                                                                    {"m2", "m²"},
                                                                    {"kg", "kg"},
                                                                    {"Nm", "N m"}}};
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
  const std::size_t last = name.rfind('_');
  for (const auto& [end, unit] : kEnds)
    if (last != std::string::npos && name.compare(last + 1, std::string::npos, end) == 0) return unit;
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

HandyUnit handy_unit(const std::string& unit, double largest) {
  const bool prefixed = unit == "s" || unit == "J" || unit == "N" || unit == "Pa" || unit == "m";
  if (!prefixed || !(largest > 0) || !std::isfinite(largest)) return {1, unit};
  const int highest = unit == "s" ? kNoPrefix : static_cast<int>(kPrefixes.size()) - 1;
  const int thousands = static_cast<int>(std::floor(std::log10(largest) / 3));
  const int place = std::clamp(thousands + kNoPrefix, 0, highest);
  return {std::pow(1000.0, kNoPrefix - place), kPrefixes[static_cast<std::size_t>(place)] + unit};
}

}  // namespace mpmfast
