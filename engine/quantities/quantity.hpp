#pragma once

/// @file Numbers with units: "5 mm", "2.78 g/cm^3", "1/70 mm", or a bare number in SI.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kernels/measure.hpp"

namespace mpmfast {

/// Exponents of metre, kilogram, second, radian and kelvin.
using Dimensions = std::array<int, 5>;
inline constexpr std::size_t kRadian = 3;

struct QuantityKind {
  const char* name;   ///< "a length"
  const char* units;  ///< what a user may write, e.g. "m, cm, mm, um"
  const char* si;     ///< the unit of a bare number, empty for a pure number
  Dimensions dimensions;
};
const QuantityKind& kind_of(Measure quantity);
/// "length", "lengths"; "a length: m, cm, mm, um", what a message says was expected.
std::string noun_of(Measure quantity);
std::string plural_of(Measure quantity);
std::string expected_of(Measure quantity);

/// A unit as a ratio of whole numbers times SI, so that "5 mm" is 5/1000: rounded once, hence exactly 0.005.
struct Unit {
  double multiplier = 1, divisor = 1;
  Dimensions dimensions{};
};

struct QuantityError {
  std::string message;  ///< without the value, which the caller shows
  std::string hint;
};

/// "g/cm^3" → its factor and dimensions.
std::variant<Unit, QuantityError> parse_unit(std::string_view text, Measure expected);

/// Symbols of units of this measure alone: m, km, … for a length.
std::vector<std::string> unit_symbols(Measure quantity);
/// All symbols.
std::vector<std::string> unit_symbols();

/// "5 mm" → 0.005.
std::variant<double, QuantityError> parse_quantity(std::string_view text, Measure expected);

/// A number of whatever dimensions, SI. A bare number has none.
struct Amount {
  double value{};
  Dimensions dimensions{};
};
std::variant<Amount, QuantityError> parse_amount(std::string_view text);

/// "m^2": in SI; empty for a pure number.
std::string unit_text(const Dimensions& dimensions);
/// "a velocity", "a quantity in m^2".
std::string kind_text(const Dimensions& dimensions);
/// "0.005 m", as quantity_text.
std::string amount_text(const Amount& amount);

/// A decimal number that is the whole of `text`; nothing when it is none, is not finite or has leading zeros.
std::optional<double> parse_number(std::string_view text);

/// "0.005 m": the shortest text that reads back as the same number, with the SI unit.
std::string quantity_text(double value, Measure quantity);
/// "[0.005 m, 0 m]": the first `count` components.
std::string vector_text(const std::array<double, 3>& vector, Measure quantity, int count);

}  // namespace mpmfast
