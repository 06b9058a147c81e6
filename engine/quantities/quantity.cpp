#include "engine/quantities/quantity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace mpmfast {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// How many characters at the front form a decimal number: [+-] digits [. digits] [e [+-] digits].
/// Written out because from_chars also takes "nan", "inf" and, elsewhere, "010" is eight.
std::size_t number_length(std::string_view text) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t first = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at - first;
  };
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
  std::size_t count = digits();
  if (at < text.size() && text[at] == '.') {
    ++at;
    count += digits();
  }
  if (count == 0) return 0;
  const std::size_t mantissa_end = at;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    if (digits() == 0) at = mantissa_end;
  }
  return at;
}

bool has_leading_zeros(std::string_view number) {
  if (number.front() == '+' || number.front() == '-') number.remove_prefix(1);
  return number.size() > 1 && number[0] == '0' && is_digit(number[1]);
}

/// The number at the front of `text`, which loses it.
std::variant<double, QuantityError> take_number(std::string_view& text, Measure measure) {
  const std::string expected = expected_of(measure);
  const std::size_t length = number_length(text);
  if (length == 0) {
    const bool unit_alone = !text.empty() && std::holds_alternative<Unit>(parse_unit(text, Measure::number));
    if (unit_alone) {
      return QuantityError{fmt::format("the number is missing before the unit '{}' ({})", text, expected),
                           ""};
    }
    const bool plain = kind_of(measure).dimensions == Dimensions{};
    return QuantityError{plain ? "not a number" : fmt::format("not a number ({})", expected), ""};
  }
  std::string_view number = text.substr(0, length);
  text.remove_prefix(length);
  if (has_leading_zeros(number)) {
    return QuantityError{fmt::format("a number with leading zeros is ambiguous ({})", expected), ""};
  }
  if (number.front() == '+') number.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) {
    return QuantityError{fmt::format("a number out of range ({})", expected), ""};
  }
  return value;
}

const QuantityKind* kind_with(const Dimensions& dimensions) {
  for (int k = 1; k < kMeasures; ++k) {
    const QuantityKind& kind = kind_of(static_cast<Measure>(k));
    if (kind.dimensions == dimensions) return &kind;
  }
  return nullptr;
}

QuantityError wrong_dimension(std::string_view unit, const Dimensions& dimensions, Measure measure) {
  const QuantityKind* actual = kind_with(dimensions);
  const QuantityKind& expected = kind_of(measure);
  const std::string wanted = *expected.units ? expected_of(measure) : "a number without a unit";
  if (!actual) return {fmt::format("'{}' is not a unit of {} ({})", unit, expected.name, wanted), ""};
  Dimensions unturned = expected.dimensions;
  unturned[kRadian] = 0;
  const bool turns = expected.dimensions[kRadian] != 0 && dimensions == unturned;
  return {fmt::format("'{}' is {} ({})", unit, actual->name, wanted),
          turns ? "Write rad/s, or multiply by 1 rad where it is computed" : ""};
}

/// A number with the unit that it was written with.
struct Written {
  double value = 0;  ///< SI
  Dimensions dimensions{};
  std::string_view unit;  ///< empty: none
};

/// "Write 1.2 g/cm^3" for "1,2 g/cm^3", "Write 10000 m" for "10 000 m"; nothing for "1,000", which may be
/// either.
std::string without_separator(std::string_view number, std::string_view rest) {
  const bool comma = rest.front() == ',', between = comma || rest.front() == '_';
  if (between) rest.remove_prefix(1);
  const auto digits = std::find_if_not(rest.begin(), rest.end(), is_digit) - rest.begin();
  if (digits == 0 || comma == (digits == 3)) return "";
  return fmt::format("Write {}{}{}", number, comma ? "." : "", rest);
}

std::variant<Written, QuantityError> parse_written(std::string_view written, Measure expected) {
  const QuantityKind& kind = kind_of(expected);
  const std::string_view whole = trimmed(written);
  std::string_view text = whole;
  const auto numerator = take_number(text, expected);
  if (const auto* error = std::get_if<QuantityError>(&numerator)) return *error;
  double over = 1;
  text = trimmed(text);
  if (!text.empty() && text.front() == '/') {  // 1/70 mm
    text = trimmed(text.substr(1));
    const auto denominator = take_number(text, expected);
    if (std::holds_alternative<QuantityError>(denominator)) {
      return QuantityError{fmt::format("a number is missing after '/' ({})", kind.name), ""};
    }
    over = std::get<double>(denominator);
    if (over == 0) return QuantityError{fmt::format("division by zero ({})", kind.name), ""};
    text = trimmed(text);
  }
  Unit unit;
  if (!text.empty()) {
    if (text.front() == '_' || text.front() == ',' || is_digit(text.front())) {
      const std::string_view number = trimmed(whole.substr(0, whole.size() - text.size()));
      return QuantityError{"digits take no separator, and the decimal sign is a point",
                           without_separator(number, text)};
    }
    auto parsed = parse_unit(text, expected);
    if (const auto* error = std::get_if<QuantityError>(&parsed)) return *error;
    unit = std::get<Unit>(parsed);
  }
  // One multiplication or one division in all common cases: as exact as the decimal text allows.
  const double value = std::get<double>(numerator) * unit.multiplier / (over * unit.divisor);
  if (!std::isfinite(value)) return QuantityError{fmt::format("a number out of range ({})", kind.name), ""};
  return Written{value, unit.dimensions, text};
}

}  // namespace

std::variant<double, QuantityError> parse_quantity(std::string_view text, Measure expected) {
  const auto parsed = parse_written(text, expected);
  if (const auto* error = std::get_if<QuantityError>(&parsed)) return *error;
  const auto& [value, dimensions, unit] = std::get<Written>(parsed);
  if (!unit.empty() && dimensions != kind_of(expected).dimensions)
    return wrong_dimension(unit, dimensions, expected);
  return value;
}

std::variant<Amount, QuantityError> parse_amount(std::string_view text) {
  const auto parsed = parse_written(text, Measure::number);
  if (const auto* error = std::get_if<QuantityError>(&parsed)) return *error;
  return Amount{std::get<Written>(parsed).value, std::get<Written>(parsed).dimensions};
}

std::optional<double> parse_number(std::string_view text) {
  const auto value = parse_quantity(text, Measure::number);
  if (std::holds_alternative<QuantityError>(value)) return std::nullopt;
  return std::get<double>(value);
}

std::string quantity_text(double value, Measure quantity) {
  const char* unit = kind_of(quantity).si;
  return *unit ? fmt::format("{} {}", value, unit) : fmt::format("{}", value);
}

std::string vector_text(const std::array<double, 3>& vector, Measure quantity, int count) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    parts.push_back(quantity_text(vector[k], quantity));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

std::string unit_text(const Dimensions& dimensions) {
  if (const QuantityKind* kind = kind_with(dimensions)) return kind->si;
  constexpr std::array<const char*, 5> kBase{"m", "kg", "s", "rad", "K"};
  std::string out;
  for (std::size_t k = 0; k < kBase.size(); ++k) {
    if (dimensions[k] == 0) continue;
    if (!out.empty()) out += '*';
    out += dimensions[k] == 1 ? kBase[k] : fmt::format("{}^{}", kBase[k], dimensions[k]);
  }
  return out;
}

std::string kind_text(const Dimensions& dimensions) {
  if (dimensions == Dimensions{}) return "a number";
  const QuantityKind* kind = kind_with(dimensions);
  return kind ? kind->name : "a quantity in " + unit_text(dimensions);
}

std::string amount_text(const Amount& amount) {
  const std::string unit = unit_text(amount.dimensions);
  return unit.empty() ? fmt::format("{}", amount.value) : fmt::format("{} {}", amount.value, unit);
}

}  // namespace mpmfast
