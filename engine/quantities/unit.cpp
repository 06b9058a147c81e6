#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "engine/quantities/closest.hpp"
#include "engine/quantities/code_point.hpp"
#include "engine/quantities/quantity.hpp"

namespace mpmfast {

namespace {

struct NamedUnit {
  const char* symbol;
  Unit unit;
};

constexpr Dimensions kLength{1, 0, 0, 0}, kMass{0, 1, 0, 0}, kTime{0, 0, 1, 0}, kAngle{0, 0, 0, 1},
    kTemperature{0, 0, 0, 0, 1};
constexpr Dimensions kForce{1, 1, -2, 0}, kPressure{-1, 1, -2, 0}, kEnergy{2, 1, -2, 0}, kPower{2, 1, -3, 0};

const NamedUnit kUnits[] = {
    {"m", {1, 1, kLength}},       {"km", {1e3, 1, kLength}},
    {"dm", {1, 10, kLength}},     {"cm", {1, 100, kLength}},
    {"mm", {1, 1e3, kLength}},    {"um", {1, 1e6, kLength}},
    {"nm", {1, 1e9, kLength}},    {"kg", {1, 1, kMass}},
    {"g", {1, 1e3, kMass}},       {"mg", {1, 1e6, kMass}},
    {"t", {1e3, 1, kMass}},       {"s", {1, 1, kTime}},
    {"ms", {1, 1e3, kTime}},      {"us", {1, 1e6, kTime}},
    {"ns", {1, 1e9, kTime}},      {"min", {60, 1, kTime}},
    {"h", {3600, 1, kTime}},      {"N", {1, 1, kForce}},
    {"kN", {1e3, 1, kForce}},     {"MN", {1e6, 1, kForce}},
    {"J", {1, 1, kEnergy}},       {"Pa", {1, 1, kPressure}},
    {"kPa", {1e3, 1, kPressure}}, {"MPa", {1e6, 1, kPressure}},
    {"GPa", {1e9, 1, kPressure}}, {"bar", {1e5, 1, kPressure}},
    {"rad", {1, 1, kAngle}},      {"deg", {3.14159265358979323846, 180, kAngle}},
    {"K", {1, 1, kTemperature}},  {"W", {1, 1, kPower}},
    {"kW", {1e3, 1, kPower}},     {"MW", {1e6, 1, kPower}},
};

const QuantityKind kKinds[] = {
    {"a number", "", "", {0, 0, 0, 0}},
    {"a length", "m, cm, mm, um", "m", kLength},
    {"a time", "s, ms, us, ns", "s", kTime},
    {"a mass", "kg, g, t", "kg", kMass},
    {"a velocity", "m/s, mm/s, km/s", "m/s", {1, 0, -1, 0}},
    {"an acceleration", "m/s^2, mm/s^2", "m/s^2", {1, 0, -2, 0}},
    {"a density", "kg/m^3, g/cm^3, t/m^3", "kg/m^3", {-3, 1, 0, 0}},
    {"a pressure", "Pa, kPa, MPa, GPa", "Pa", kPressure},
    {"an angle", "rad, deg", "rad", kAngle},
    {"an angular velocity", "rad/s, deg/s", "rad/s", {0, 0, -1, 1}},
    {"a viscosity", "Pa*s", "Pa*s", {-1, 1, -1, 0}},
    {"a temperature", "K", "K", kTemperature},
    {"a heat capacity", "J/kg/K", "J/kg/K", {2, 0, -2, 0, -1}},
    {"a rate", "s^-1, us^-1", "s^-1", {0, 0, -1}},
    {"a stiffness of an interface", "Pa/m, MPa/mm, GPa/m", "Pa/m", {-2, 1, -2, 0}},
    {"a heat conductivity", "W/m/K", "W/m/K", {1, 1, -3, 0, -1}},
    {"a heat flux", "W/m^2, kW/m^2, MW/m^2", "W/m^2", {0, 1, -3, 0}},
    {"a heat conductance", "W/m^2/K, kW/m^2/K", "W/m^2/K", {0, 1, -3, 0, -1}},
    {"a thermal expansion", "K^-1", "K^-1", {0, 0, 0, 0, -1}},
    {"an energy of a surface", "J/m^2, N/m, N/mm", "J/m^2", {0, 1, -2, 0}},
};

/// Words and symbols that people use for units, and what stands for them here.
std::string other_spelling(const std::string& symbol) {
  static const std::pair<std::string_view, std::string_view> kSpellings[] = {
      {"sec", "s"},       {"second", "s"},   {"seconds", "s"},   {"msec", "ms"},    {"usec", "us"},
      {"microns", "um"},  {"micron", "um"},  {"meter", "m"},     {"metre", "m"},    {"meters", "m"},
      {"metres", "m"},    {"degree", "deg"}, {"degrees", "deg"}, {"radian", "rad"}, {"radians", "rad"},
      {"gram", "g"},      {"grams", "g"},    {"tonne", "t"},     {"tonnes", "t"},   {"pascal", "Pa"},
      {"minutes", "min"}, {"hour", "h"},     {"hours", "h"},     {"kph", "km/h"},   {"kmh", "km/h"}};
  for (const auto& [from, to] : kSpellings)
    if (symbol == from) return fmt::format("Did you mean '{}'?", to);
  if (symbol == "C" || symbol == "degC") return "Temperatures are in K: add 273.15";
  return "";
}

/// The letters and digits of a compound unit, which people join in many ways: "kgm-3", "kg m^-3", "m s-1".
std::string bare_letters(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) && c != '1') out += c;
  return out;
}

/// "Write kg/m^3", where the unit is one of the usual ones but for the signs in it, or a point behind it.
std::string other_signs(const std::string& symbol, const QuantityKind& kind) {
  const std::string units = kind.units;
  for (std::size_t at = 0; at < units.size();) {
    const std::size_t end = std::min(units.find(", ", at), units.size());
    const std::string unit = units.substr(at, end - at);
    if (unit != symbol && bare_letters(unit) == bare_letters(symbol)) return "Write " + unit;
    at = end + 2;
  }
  return "";
}

/// @param symbol  what is not known of `whole`
QuantityError unknown_unit(const std::string& symbol, const std::string& whole, Measure expected) {
  const QuantityKind& kind = kind_of(expected);
  std::vector<std::string> same_kind, all;
  for (const NamedUnit& named : kUnits) {
    all.emplace_back(named.symbol);
    if (named.unit.dimensions == kind.dimensions) same_kind.emplace_back(named.symbol);
  }
  std::string hint = other_spelling(symbol);
  if (hint.empty()) hint = other_signs(whole, kind);
  if (hint.empty()) hint = closest_hint(symbol, same_kind);
  if (hint.empty()) hint = closest_hint(symbol, all);
  return {fmt::format("unknown unit '{}' ({}{})", symbol, kind.name,
                      *kind.units ? fmt::format(": {}", kind.units) : " without a unit"),
          hint};
}

/// Multiplies by symbol^exponent.
bool apply(const std::string& symbol, int exponent, Unit& unit) {
  for (const NamedUnit& named : kUnits) {
    if (symbol != named.symbol) continue;
    for (int k = 0; k < std::abs(exponent); ++k) {
      unit.multiplier *= exponent > 0 ? named.unit.multiplier : named.unit.divisor;
      unit.divisor *= exponent > 0 ? named.unit.divisor : named.unit.multiplier;
    }
    for (std::size_t d = 0; d < unit.dimensions.size(); ++d)
      unit.dimensions[d] += exponent * named.unit.dimensions[d];
    return true;
  }
  return false;
}

/// Cancels what divides, so that g/cm^3 is 1000 and not 1e6/1000.
void reduce(Unit& unit) {
  if (std::fmod(unit.multiplier, unit.divisor) == 0) {
    unit = {unit.multiplier / unit.divisor, 1, unit.dimensions};
  } else if (std::fmod(unit.divisor, unit.multiplier) == 0) {
    unit = {1, unit.divisor / unit.multiplier, unit.dimensions};
  }
}

/// One factor of a unit, "cm^3" or "cm3"; the text position moves behind it.
struct Factor {
  std::string symbol;
  int exponent = 1;
};
std::optional<Factor> next_factor(const std::string& text, std::size_t& at) {
  const auto letter = [&] { return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])); };
  const auto digit = [&] { return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])); };
  Factor factor;
  while (letter()) factor.symbol += text[at++];
  if (factor.symbol.empty()) return std::nullopt;
  const bool caret = at < text.size() && text[at] == '^';
  if (caret) ++at;
  const bool minus = caret && at < text.size() && text[at] == '-';
  if (minus) ++at;
  if (digit()) {
    factor.exponent = text[at++] - '0';
    if (minus) factor.exponent = -factor.exponent;
    if (digit()) return std::nullopt;
  } else if (caret) {
    return std::nullopt;
  }
  return factor;
}

}  // namespace

const QuantityKind& kind_of(Measure quantity) { return kKinds[static_cast<std::size_t>(quantity)]; }

std::string noun_of(Measure quantity) {
  const std::string name = kind_of(quantity).name;
  return name.substr(name.find(' ') + 1);
}

std::string plural_of(Measure quantity) {
  const std::string noun = noun_of(quantity);
  return noun.back() == 'y' ? noun.substr(0, noun.size() - 1) + "ies" : noun + "s";
}

std::string expected_of(Measure quantity) {
  const QuantityKind& kind = kind_of(quantity);
  return *kind.units ? fmt::format("{}: {}", kind.name, kind.units) : kind.name;
}

std::vector<std::string> unit_symbols(Measure quantity) {
  std::vector<std::string> out;
  for (const NamedUnit& named : kUnits)
    if (named.unit.dimensions == kind_of(quantity).dimensions) out.emplace_back(named.symbol);
  return out;
}

std::vector<std::string> unit_symbols() {
  std::vector<std::string> out;
  for (const NamedUnit& named : kUnits) out.emplace_back(named.symbol);
  return out;
}

std::variant<Unit, QuantityError> parse_unit(std::string_view written, Measure expected) {
  const std::string whole(written), text = plain_spelling(written);
  const auto skip_blanks = [&](std::size_t& at) {
    while (at < text.size() && text[at] == ' ') ++at;
  };
  Unit unit;
  int sign = 1;
  std::size_t at = 0;
  while (true) {
    const std::optional<Factor> factor = next_factor(text, at);
    if (!factor) return unknown_unit(whole, whole, expected);
    if (!apply(factor->symbol, sign * factor->exponent, unit))
      return unknown_unit(factor->symbol, whole, expected);
    skip_blanks(at);
    if (at == text.size()) break;
    if (text[at] != '*' && text[at] != '/') return unknown_unit(whole, whole, expected);
    sign = text[at++] == '/' ? -1 : 1;
    skip_blanks(at);
  }
  reduce(unit);
  return unit;
}

}  // namespace mpmfast
