// Every unit against its value in SI, every kind of quantity against the units that it names, numbers against
// what a regular expression says is one.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "engine/quantities/quantity.hpp"

namespace mpmfast {
namespace {

using Draw = std::mt19937_64;

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

struct Known {
  std::string symbol;
  double si;
  Dimensions dimensions;  ///< m kg s rad K
};

const std::vector<Known>& known_units() {
  static const std::vector<Known> units{{"m", 1, {1, 0, 0, 0, 0}},       {"km", 1000, {1, 0, 0, 0, 0}},
                                        {"dm", 0.1, {1, 0, 0, 0, 0}},    {"cm", 0.01, {1, 0, 0, 0, 0}},
                                        {"mm", 1e-3, {1, 0, 0, 0, 0}},   {"um", 1e-6, {1, 0, 0, 0, 0}},
                                        {"nm", 1e-9, {1, 0, 0, 0, 0}},   {"kg", 1, {0, 1, 0, 0, 0}},
                                        {"g", 1e-3, {0, 1, 0, 0, 0}},    {"mg", 1e-6, {0, 1, 0, 0, 0}},
                                        {"t", 1000, {0, 1, 0, 0, 0}},    {"s", 1, {0, 0, 1, 0, 0}},
                                        {"ms", 1e-3, {0, 0, 1, 0, 0}},   {"us", 1e-6, {0, 0, 1, 0, 0}},
                                        {"ns", 1e-9, {0, 0, 1, 0, 0}},   {"min", 60, {0, 0, 1, 0, 0}},
                                        {"h", 3600, {0, 0, 1, 0, 0}},    {"N", 1, {1, 1, -2, 0, 0}},
                                        {"kN", 1e3, {1, 1, -2, 0, 0}},   {"MN", 1e6, {1, 1, -2, 0, 0}},
                                        {"J", 1, {2, 1, -2, 0, 0}},      {"Pa", 1, {-1, 1, -2, 0, 0}},
                                        {"kPa", 1e3, {-1, 1, -2, 0, 0}}, {"MPa", 1e6, {-1, 1, -2, 0, 0}},
                                        {"GPa", 1e9, {-1, 1, -2, 0, 0}}, {"bar", 1e5, {-1, 1, -2, 0, 0}},
                                        {"rad", 1, {0, 0, 0, 1, 0}},     {"deg", M_PI / 180, {0, 0, 0, 1, 0}},
                                        {"K", 1, {0, 0, 0, 0, 1}},       {"W", 1, {2, 1, -3, 0, 0}},
                                        {"kW", 1e3, {2, 1, -3, 0, 0}},   {"MW", 1e6, {2, 1, -3, 0, 0}}};
  return units;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(", ", at), list.size());
    out.push_back(list.substr(at, end - at));
    at = end + 2;
  }
  return out;
}

Unit unit(const std::string& text) {
  const auto parsed = parse_unit(text, Measure::number);
  REQUIRE_MESSAGE(std::holds_alternative<Unit>(parsed), text);
  return std::get<Unit>(parsed);
}

std::string error(const std::string& text, Measure kind) {
  const auto parsed = parse_quantity(text, kind);
  const auto* fault = std::get_if<QuantityError>(&parsed);
  return fault ? fault->message + "|" + fault->hint : "good";
}

std::string hint(const std::string& text, Measure kind) {
  const std::string all = error(text, kind);
  return all.substr(all.find('|') + 1);
}

TEST_CASE("every unit is what it is in SI, and they are all there, in their order") {
  std::vector<std::string> symbols;
  for (const Known& known : known_units()) {
    CAPTURE(known.symbol);
    symbols.push_back(known.symbol);
    const Unit got = unit(known.symbol);
    CHECK(got.multiplier / got.divisor == doctest::Approx(known.si).epsilon(1e-15));
    CHECK(got.dimensions == known.dimensions);
    if (known.symbol != "deg") CHECK((got.multiplier == 1 || got.divisor == 1));
  }
  CHECK(unit_symbols() == symbols);
  CHECK(unit_symbols(Measure::length) == std::vector<std::string>{"m", "km", "dm", "cm", "mm", "um", "nm"});
  CHECK(unit_symbols(Measure::angle) == std::vector<std::string>{"rad", "deg"});
  CHECK(unit_symbols(Measure::velocity).empty());
}

TEST_CASE("a compound unit is the product of the powers of its factors, however it is spelled") {
  Draw draw(31);
  for (int round = 0; round < 400; ++round) {
    std::string text;
    double si = 1, largest_part = 1;
    Dimensions dimensions{};
    const int factors = whole(draw, 1, 4);
    for (int k = 0; k < factors; ++k) {
      const Known& known = known_units()[static_cast<std::size_t>(whole(draw, 0, 31))];
      int exponent = whole(draw, -3, 3), sign = 1;
      if (k > 0) {
        sign = whole(draw, 0, 1) ? 1 : -1;
        const std::string mark = sign == 1 ? (whole(draw, 0, 2) ? "*" : "\xC2\xB7") : "/";
        text += std::string(static_cast<std::size_t>(whole(draw, 0, 2)), ' ') + mark +
                std::string(static_cast<std::size_t>(whole(draw, 0, 2)), ' ');
      }
      text += known.symbol;
      if (exponent == 1 && whole(draw, 0, 1)) {
      } else if (exponent == 2 && whole(draw, 0, 1)) {
        text += "\xC2\xB2";
      } else if (exponent >= 0 && whole(draw, 0, 1)) {
        text += std::to_string(exponent);
      } else {
        text += "^" + std::to_string(exponent);
      }
      si *= std::pow(known.si, sign * exponent);
      largest_part = std::max(largest_part, std::abs(std::log(si)));
      for (std::size_t d = 0; d < 5; ++d) dimensions[d] += sign * exponent * known.dimensions[d];
    }
    CAPTURE(text);
    const Unit got = unit(text);
    CHECK(got.multiplier / got.divisor == doctest::Approx(si).epsilon(1e-13));
    CHECK(got.dimensions == dimensions);
    const auto amount = parse_amount("2.5 " + text);
    REQUIRE(std::holds_alternative<Amount>(amount));
    CHECK(std::get<Amount>(amount).value == doctest::Approx(2.5 * si).epsilon(1e-13));
    CHECK(std::get<Amount>(amount).dimensions == dimensions);
  }
  CHECK(unit("g/cm^3").multiplier == 1000);
  CHECK(unit("g/cm^3").divisor == 1);
  CHECK(unit("mm/cm^2").multiplier == 10);
  CHECK(unit("mm^2/cm").multiplier == 1);
  CHECK(unit("mm^2/cm").divisor == 1e4);
  CHECK(unit("m^9").dimensions[0] == 9);
  for (const char* bad :
       {"",    " m", "m*",  "m/",   "m^",   "m^-", "m^10", "m10", "m^+2", "m**s", "m s", "2m",    "m^2s",
        "m-2", "m-", "m/2", "m//s", "m^ 2", "*m",  "/s",   "m.",  "q",    "kPA",  "m*q", "m/s*q2"})
    CHECK_MESSAGE(!std::holds_alternative<Unit>(parse_unit(bad, Measure::number)), bad);
}

TEST_CASE(
    "every kind of quantity has a name, and the units that it names are of its kind, in SI that of one") {
  const std::vector<std::string> names{"a number",
                                       "a length",
                                       "a time",
                                       "a mass",
                                       "a velocity",
                                       "an acceleration",
                                       "a density",
                                       "a pressure",
                                       "an angle",
                                       "an angular velocity",
                                       "a viscosity",
                                       "a temperature",
                                       "a heat capacity",
                                       "a rate",
                                       "a stiffness of an interface",
                                       "a heat conductivity",
                                       "a heat flux",
                                       "a heat conductance",
                                       "a thermal expansion",
                                       "an energy of a surface"};
  REQUIRE(names.size() == kMeasures);
  for (int k = 0; k < kMeasures; ++k) {
    const auto measure = static_cast<Measure>(k);
    const QuantityKind& kind = kind_of(measure);
    const std::string& name = names[static_cast<std::size_t>(k)];
    CAPTURE(name);
    CHECK(kind.name == name);
    CHECK(noun_of(measure) == name.substr(name.find(' ') + 1));
    CHECK(kind_text(kind.dimensions) == name);
    CHECK(unit_text(kind.dimensions) == kind.si);
    if (k == 0) {
      CHECK(kind.dimensions == Dimensions{});
      CHECK(expected_of(measure) == "a number");
      CHECK(quantity_text(0.25, measure) == "0.25");
      continue;
    }
    CHECK(expected_of(measure) == name + ": " + kind.units);
    const Unit one = unit(kind.si);
    CHECK(one.multiplier == 1);
    CHECK(one.divisor == 1);
    CHECK(one.dimensions == kind.dimensions);
    for (const std::string& written : split(kind.units)) {
      CAPTURE(written);
      CHECK(unit(written).dimensions == kind.dimensions);
      CHECK(error("1 " + written, measure) == "good");
    }
    CHECK(quantity_text(0.25, measure) == std::string("0.25 ") + kind.si);
    CHECK(error("1 K*rad", measure).find("'K*rad' is not a unit of " + name) == 0);
    CHECK(error("1 qq", measure) == "unknown unit 'qq' (" + name + ": " + kind.units + ")|");
  }
  CHECK(plural_of(Measure::length) == "lengths");
  CHECK(plural_of(Measure::velocity) == "velocities");
  CHECK(plural_of(Measure::conductivity) == "heat conductivities");
  CHECK(plural_of(Measure::temperature) == "temperatures");
  CHECK(vector_text({1, 2.5, 3}, Measure::length, 2) == "[1 m, 2.5 m]");
  CHECK(vector_text({1, 2.5, 3}, Measure::number, 3) == "[1, 2.5, 3]");
  CHECK(vector_text({1, 2.5, 3}, Measure::number, 0) == "[]");
}

TEST_CASE("what has no kind is told in units of SI") {
  CHECK(unit_text({2, -1, 1, 0, 3}) == "m^2*kg^-1*s*K^3");
  CHECK(unit_text({0, 1, 0, 1, 1}) == "kg*rad*K");
  CHECK(kind_text({2, 0, 0, 0, 0}) == "a quantity in m^2");
  CHECK(kind_text({0, 0, 0, 0, 0}) == "a number");
  CHECK(amount_text({0.5, {1, 0, 0, 0, 0}}) == "0.5 m");
  CHECK(amount_text({0.5, {}}) == "0.5");
  CHECK(amount_text({-2, {3, 0, 0, 0, 0}}) == "-2 m^3");
}

TEST_CASE("a number is what a regular expression says is one, a rational two of them, and nothing else") {
  const std::string one = "([+-]?(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][+-]?[0-9]+)?)";
  const std::regex form("[ \t]*" + one + "[ \t]*(?:/[ \t]*" + one + "[ \t]*)?", std::regex::optimize),
      zeros("[+-]?0[0-9].*");
  Draw draw(32);
  const std::string letters = "0123456789+-.eE/ \t_,0123456789";
  int good = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string text(static_cast<std::size_t>(whole(draw, 0, 7)), ' ');
    for (char& c : text) c = letters[static_cast<std::size_t>(whole(draw, 0, 29))];
    std::smatch parts;
    std::optional<double> wanted;
    if (std::regex_match(text, parts, form) && !std::regex_match(parts.str(1), zeros) &&
        !std::regex_match(parts.str(2), zeros)) {
      errno = 0;
      const double above = std::strtod(parts.str(1).c_str(), nullptr),
                   below = parts[2].matched ? std::strtod(parts.str(2).c_str(), nullptr) : 1;
      if (errno == 0 && below != 0 && std::isfinite(above / below)) wanted = above / below;
    }
    CAPTURE(text);
    CHECK(parse_number(text) == wanted);
    good += wanted.has_value();
  }
  CHECK(good > 300);
}

TEST_CASE("what is wrong with a number is told") {
  const Measure length = Measure::length;
  const std::string kinds = "(a length: m, cm, mm, um)|";
  CHECK(error("010 m", length) == "a number with leading zeros is ambiguous " + kinds);
  CHECK(error("-00", length) == "a number with leading zeros is ambiguous " + kinds);
  CHECK(error("1e999 m", length) == "a number out of range " + kinds);
  CHECK(error("1e200/1e-200 m", length) == "a number out of range (a length)|");
  CHECK(error("x", Measure::number) == "not a number|");
  CHECK(error("", Measure::rate) == "not a number (a rate: s^-1, us^-1)|");
  CHECK(error("mm^2", Measure::time) ==
        "the number is missing before the unit 'mm^2' (a time: s, ms, us, ns)|");
  CHECK(error("1/mm", length) == "a number is missing after '/' (a length)|");
  CHECK(error("1 / 0.0 mm", length) == "division by zero (a length)|");
  CHECK(error("5 m", Measure::number) == "'m' is a length (a number without a unit)|");
  CHECK(error("5 qq", Measure::number) == "unknown unit 'qq' (a number without a unit)|");
  const std::string separator = "digits take no separator, and the decimal sign is a point|";
  CHECK(error("1,2 m", length) == separator + "Write 1.2 m");
  CHECK(error("1,25", length) == separator + "Write 1.25");
  CHECK(error("1,2345 m", length) == separator + "Write 1.2345 m");
  CHECK(error("1,234 m", length) == separator);
  CHECK(error("10 000 m", length) == separator + "Write 10000 m");
  CHECK(error("10_000 m", length) == separator + "Write 10000 m");
  CHECK(error("10 00 m", length) == separator);
  CHECK(error("10_0000 m", length) == separator);
  CHECK(error("1, m", length) == separator);
  CHECK(error("2/1,5 m", length) == separator + "Write 2/1.5 m");
  CHECK(error("5 rad/s", Measure::rate).find("'rad/s' is an angular velocity (a rate: s^-1, us^-1)|") == 0);
}

TEST_CASE("other spellings of units are told the one that is known here") {
  const std::vector<std::array<std::string, 2>> spellings{
      {"sec", "s"},       {"second", "s"},   {"seconds", "s"},   {"msec", "ms"},    {"usec", "us"},
      {"microns", "um"},  {"micron", "um"},  {"meter", "m"},     {"metre", "m"},    {"meters", "m"},
      {"metres", "m"},    {"degree", "deg"}, {"degrees", "deg"}, {"radian", "rad"}, {"radians", "rad"},
      {"gram", "g"},      {"grams", "g"},    {"tonne", "t"},     {"tonnes", "t"},   {"pascal", "Pa"},
      {"minutes", "min"}, {"hour", "h"},     {"hours", "h"},     {"kph", "km/h"},   {"kmh", "km/h"}};
  for (const auto& [from, to] : spellings)
    CHECK_MESSAGE(hint("5 " + from, Measure::length) == "Did you mean '" + to + "'?", from);
  for (const char* celsius : {"C", "degC",
                              "\xC2\xB0"
                              "C"})
    CHECK_MESSAGE(
        hint(std::string("5 ") + celsius, Measure::temperature) == "Temperatures are in K: add 273.15",
        celsius);
  CHECK(hint("5 Mm", Measure::length) == "Did you mean 'mm'?");  // of its kind first
  CHECK(hint("5 kn", Measure::length) == "Did you mean 'km'?");
  CHECK(hint("5 kn", Measure::temperature) == "Did you mean 'K'?");
  CHECK(hint("5 mPas", Measure::temperature) == "Did you mean 'MPa'?");
  for (int k = 1; k < kMeasures; ++k) {
    const auto measure = static_cast<Measure>(k);
    const auto written = split(kind_of(measure).units);
    for (const std::string& usual : written) {
      const auto same_letters = [&](const std::string& other) {
        std::string a, b;
        for (const char c : usual)
          if (std::isalnum(static_cast<unsigned char>(c)) && c != '1') a += c;
        for (const char c : other)
          if (std::isalnum(static_cast<unsigned char>(c)) && c != '1') b += c;
        return a == b;
      };
      const auto first = std::find_if(written.begin(), written.end(), same_letters);
      CHECK_MESSAGE(hint("5 " + usual + ".", measure) == "Write " + *first, usual);
    }
  }
}

}  // namespace
}  // namespace mpmfast
