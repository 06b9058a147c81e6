// Expressions made at random, with their values and units, against what the parser and its machine make of
// their text.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "engine/quantities/expression.hpp"

namespace mpmfast {
namespace {

using Draw = std::mt19937_64;

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

using Measured = std::optional<Dimensions>;  ///< nothing: the units do not fit

/// A piece of text with what it is worth.
struct Piece {
  std::string text;
  int binds;  ///< 1: a sum, 2: a product, 3: a signed one, 4: a power, 5: anything that holds together
  double plain = 0, value = 0;
  Measured dimensions;
};

struct Named {
  std::string name, written;
  double value;
  Dimensions dimensions;
};
const std::vector<Named>& names() {
  static const std::vector<Named> all{
      {"alpha", "alpha", 0.75, {}},     {"b.c2", "b.c2", -2.5, {1, 0, 0, 0, 0}},
      {"_d", "_d", 3, {0, 0, 1, 0, 0}}, {"left-block vx", "`left-block vx`", 1.5, {1, 0, -1, 0, 0}},
      {"zero", "zero", 0, {}},          {"turn", "turn", 0.5, {0, 0, 0, 1, 0}}};
  return all;
}

class Maker {
 public:
  explicit Maker(int seed) : draw_(static_cast<std::uint64_t>(seed)) {}
  std::vector<std::string> seen;  ///< names, as they come first

  Piece make(int depth) {
    const int kind = depth <= 0 ? whole(draw_, 0, 3) : whole(draw_, 0, 13);
    if (kind <= 1) return number();
    if (kind == 2) return unit();
    if (kind == 3) return name();
    if (kind == 4) return sign(depth);
    if (kind <= 10) return binary(depth, kind);
    return call(depth);
  }

 private:
  std::string blanks() { return std::string(static_cast<std::size_t>(whole(draw_, 0, 3) / 3), ' '); }
  /// In parentheses where the place asks for what binds more, sometimes elsewhere too.
  std::string within(const Piece& piece, int least) {
    if (piece.binds >= least && whole(draw_, 0, 5) > 0) return piece.text;
    return "(" + blanks() + piece.text + blanks() + ")";
  }
  Piece number() {
    const double value = whole(draw_, 0, 40) / 8.0;
    return {fmt::format("{}", value), 5, value, value, Dimensions{}};
  }
  Piece unit() {
    struct Simple {
      const char* symbol;
      double si;
      Dimensions dimensions;
    };
    static const std::vector<Simple> units{{"mm", 1e-3, {1, 0, 0, 0, 0}},   {"km", 1e3, {1, 0, 0, 0, 0}},
                                           {"s", 1, {0, 0, 1, 0, 0}},       {"kg", 1, {0, 1, 0, 0, 0}},
                                           {"MPa", 1e6, {-1, 1, -2, 0, 0}}, {"K", 1, {0, 0, 0, 0, 1}},
                                           {"rad", 1, {0, 0, 0, 1, 0}}};
    const Simple& of = units[static_cast<std::size_t>(whole(draw_, 0, 6))];
    const double value = whole(draw_, 0, 16) / 4.0;
    // A power behind it would be taken for one of the unit.
    return {fmt::format("{}{}{}", value, blanks(), of.symbol), 4, value * of.si, value * of.si,
            of.dimensions};
  }
  Piece name() {
    const Named& of = names()[static_cast<std::size_t>(whole(draw_, 0, 5))];
    if (std::find(seen.begin(), seen.end(), of.name) == seen.end()) seen.push_back(of.name);
    return {of.written, 5, of.value, of.value, of.dimensions};
  }
  Piece sign(int depth) {
    const bool minus = whole(draw_, 0, 3) > 0;
    const Piece a = make(depth - 1);
    return {(minus ? "-" : "+") + blanks() + within(a, 3), 3, minus ? -a.plain : a.plain,
            minus ? -a.value : a.value, a.dimensions};
  }
  Piece binary(int depth, int kind) {
    const Piece a = make(depth - 1), b = make(depth - 1);
    const char mark = "+-*/^*"[kind - 5];
    const int binds = mark == '+' || mark == '-' ? 1 : mark == '^' ? 4 : 2;
    Piece out;
    out.binds = binds;
    out.text = within(a, binds == 4 ? 5 : binds) + blanks() + mark + blanks() +
               within(b, binds == 4 ? 3 : binds + 1);
    switch (mark) {
      case '+':
        out.plain = a.plain + b.plain;
        out.dimensions = common(a, b);
        break;
      case '-':
        out.plain = a.plain - b.plain;
        out.dimensions = common(a, b);
        break;
      case '*':
      case '/':
        out.plain = mark == '*' ? a.plain * b.plain : a.plain / b.plain;
        if (a.dimensions && b.dimensions && (mark == '*' || b.plain != 0)) {
          out.dimensions = *a.dimensions;
          for (std::size_t k = 0; k < 5; ++k) {
            int& power = (*out.dimensions)[k];
            power += (mark == '*' ? 1 : -1) * (*b.dimensions)[k];
          }
          for (const int power : *out.dimensions)
            if (std::abs(power) > 99) return {out.text, binds, out.plain, out.plain, {}};
        }
        break;
      default:
        out.plain = std::pow(a.plain, b.plain);
        if (b.dimensions == Dimensions{}) out.dimensions = raised(a.dimensions, b.plain);
    }
    out.value = out.plain;
    return out;
  }
  Piece call(int depth) {
    static const std::vector<std::string> functions{"abs",  "sqrt", "exp",  "log",   "sin",   "cos", "tan",
                                                    "atan", "erf",  "step", "atan2", "hypot", "min", "max"};
    const std::string function = functions[static_cast<std::size_t>(whole(draw_, 0, 13))];
    const bool two = function == "atan2" || function == "hypot" || function == "min" || function == "max";
    const Piece a = make(depth - 1), b = two ? make(depth - 1) : Piece{};
    Piece out;
    out.binds = 5;
    out.text =
        function + blanks() + "(" + blanks() + a.text + blanks() + (two ? "," + blanks() + b.text : "") + ")";
    const double x = a.plain, y = b.plain;
    static const std::map<std::string, double (*)(double, double)> values{
        {"abs", [](double u, double) { return std::fabs(u); }},
        {"sqrt", [](double u, double) { return std::sqrt(u); }},
        {"exp", [](double u, double) { return std::exp(u); }},
        {"log", [](double u, double) { return std::log(u); }},
        {"sin", [](double u, double) { return std::sin(u); }},
        {"cos", [](double u, double) { return std::cos(u); }},
        {"tan", [](double u, double) { return std::tan(u); }},
        {"atan", [](double u, double) { return std::atan(u); }},
        {"erf", [](double u, double) { return std::erf(u); }},
        {"step", [](double u, double) { return u > 0 ? 1.0 : 0.0; }},
        {"atan2", [](double u, double v) { return std::atan2(u, v); }},
        {"hypot", [](double u, double v) { return std::hypot(u, v); }},
        {"min", [](double u, double v) { return v < u ? v : u; }},
        {"max", [](double u, double v) { return u < v ? v : u; }}};
    out.plain = out.value = values.at(function)(x, y);
    const Dimensions none{}, angle{0, 0, 0, 1, 0};
    const Measured& of = a.dimensions;
    if (function == "abs") out.dimensions = of;
    if (function == "sqrt") out.dimensions = raised(of, 0.5);
    if (function == "step" && of) out.dimensions = none;
    if ((function == "exp" || function == "log" || function == "erf") && of == none) out.dimensions = none;
    if ((function == "sin" || function == "cos" || function == "tan") && (of == none || of == angle))
      out.dimensions = none;
    if (function == "atan" && of == none) out.dimensions = angle;
    if (function == "atan2" && common(a, b)) out.dimensions = angle;
    if (function == "hypot" || function == "min" || function == "max") out.dimensions = common(a, b);
    return out;
  }

  static Measured raised(const Measured& of, double exponent) {
    if (!of) return of;
    Dimensions out{};
    for (std::size_t k = 0; k < 5; ++k) {
      const double power = (*of)[k] * exponent;
      if ((*of)[k] == 0) continue;
      if (!(power == std::floor(power) && std::abs(power) <= 99)) return {};
      out[k] = static_cast<int>(power);
    }
    return out;
  }
  /// Zero has any unit, radians are numbers.
  static Measured common(const Piece& a, const Piece& b) {
    if (!a.dimensions || !b.dimensions) return {};
    const auto zero = [](const Piece& x) { return x.plain == 0 && *x.dimensions == Dimensions{}; };
    if (*a.dimensions == *b.dimensions) return a.dimensions;
    if (zero(a)) return b.dimensions;
    if (zero(b)) return a.dimensions;
    for (const std::size_t k : {0, 1, 2, 4})
      if ((*a.dimensions)[k] != (*b.dimensions)[k]) return {};
    return (*b.dimensions)[3] != 0 ? b.dimensions : a.dimensions;
  }

  Draw draw_;
};

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || a == b || std::abs(a - b) <= 1e-14 * std::abs(b);
}

TEST_CASE(
    "an expression has the value and the unit that its parts have, put together by the rules of print") {
  int with_units = 0, refused = 0;
  for (int seed = 0; seed < 3000; ++seed) {
    Maker maker(seed);
    const Piece piece = maker.make(1 + seed % 5);
    CAPTURE(piece.text);
    const auto parsed = Expression::parse(piece.text);
    REQUIRE(std::holds_alternative<Expression>(parsed));
    const auto& expression = std::get<Expression>(parsed);
    CHECK(expression.text() == piece.text);
    REQUIRE(expression.names() == maker.seen);
    std::vector<double> plain;
    std::vector<Amount> amounts;
    for (const std::string& name : expression.names())
      for (const Named& known : names())
        if (known.name == name) {
          plain.push_back(known.value);
          amounts.push_back({known.value, known.dimensions});
        }
    CHECK(same(expression.value(plain), piece.plain));
    const auto amount = expression.amount(amounts);
    if (!piece.dimensions || !std::isfinite(piece.value)) {
      ++refused;
      CHECK(std::holds_alternative<std::string>(amount));
      continue;
    }
    REQUIRE(std::holds_alternative<Amount>(amount));
    const Amount& got = std::get<Amount>(amount);
    CHECK(same(got.value, piece.value));
    CHECK(!(got.value == 0 && std::signbit(got.value)));
    // Radians that make no quantity of their own are left out.
    Dimensions wanted = *piece.dimensions;
    if (kind_text(wanted).find("a quantity in") == 0) wanted[3] = 0;
    CHECK(got.dimensions == wanted);
    with_units += wanted != Dimensions{};
  }
  CHECK(with_units > 300);
  CHECK(refused > 300);
}

std::string wrong(const std::string& text) {
  const auto out = Expression::parse(text);
  const auto* message = std::get_if<std::string>(&out);
  return message ? *message : "";
}

std::string amount(const std::string& text) {
  const auto parsed = Expression::parse(text);
  REQUIRE_MESSAGE(std::holds_alternative<Expression>(parsed), text);
  const auto out = std::get<Expression>(parsed).amount({});
  return std::holds_alternative<Amount>(out) ? amount_text(std::get<Amount>(out))
                                             : std::get<std::string>(out);
}

TEST_CASE("what does not fit in an expression's units is told, the first of it") {
  CHECK(amount("1 m + 1 s") == "a time cannot be added to a length");
  CHECK(amount("1 m - 1 s") == "a time cannot be subtracted from a length");
  CHECK(amount("min(1 m, 1 s)") == "a time cannot be compared with a length");
  CHECK(amount("atan2(1 m, 1)") == "a number cannot be compared with a length");
  CHECK(amount("(1 m + 1 s) / 0") == "a time cannot be added to a length");
  CHECK(amount("1 / 0 + exp(1 m)") == "division by zero");
  CHECK(amount("2 ^ (1 m)") == "an exponent must be a number, not a length");
  CHECK(amount("(1 m)^0.5") == "a length to the power 0.5 has no unit");
  CHECK(amount("sqrt(1 s)") == "a time to the power 0.5 has no unit");
  CHECK(amount("(1 m)^99") == "1 m^99");
  CHECK(amount("(1 m)^-99") == "1 m^-99");
  CHECK(amount("(1 m)^100") == "a length to the power 100 has no unit");
  CHECK(amount("(1 m)^99 * 1 m") == "a unit of too high a power");
  CHECK(amount("(1 m)^-99 / 1 m") == "a unit of too high a power");
  CHECK(amount("(1 m)^-99 * 1 m") == "1 m^-98");
  CHECK(amount("exp(1 m)") == "exp takes a number, not a length");
  CHECK(amount("log(1 s)") == "log takes a number, not a time");
  CHECK(amount("erf(1 K)") == "erf takes a number, not a temperature");
  CHECK(amount("sin(1 kg)") == "sin takes an angle, not a mass");
  CHECK(amount("atan(1 rad)") == "atan takes a number, not an angle");
  CHECK(amount("1e300 * 1e300") == "the result is not a finite number");
  CHECK(amount("log(0)") == "the result is not a finite number");
  CHECK(amount("1 rad * 2 m / 1 s") == "2 m/s");
  CHECK(amount("1 rad * 2 m * 1 m") == "2 m^2");
  CHECK(amount("1 rad * 1 rad / 1 s") == "1 s^-1");
}

TEST_CASE("what is wrong with an expression's text is told with the next twenty characters") {
  CHECK(wrong("1 + * 2345678901234567890123") == "a number or a name was expected at '* 234567890123456789'");
  CHECK(wrong(" ") == "a number or a name was expected at the end");
  CHECK(wrong("2 ^") == "a number or a name was expected at the end");
  CHECK(wrong("-") == "a number or a name was expected at the end");
  CHECK(wrong("?") == "a number or a name was expected at '?'");
  CHECK(wrong(".") == "not a number at '.'");
  CHECK(wrong("1 2") == "an operator was expected at '2'");
  CHECK(wrong("(1") == "a ')' is missing at the end");
  CHECK(wrong("(1 2)") == "a ')' is missing at '2)'");
  CHECK(wrong("sin(1") == "a ')' is missing after the argument of sin at the end");
  CHECK(wrong("max(1, 2, 3)") == "a ')' is missing after the argument of max at ', 3)'");
  CHECK(wrong("max(1 2)") == "max takes 2 arguments at '2)'");
  CHECK(wrong("max()") == "a number or a name was expected at ')'");
  CHECK(wrong("5 mmm") == "an operator or a unit was expected at 'mmm'");
  CHECK(wrong("5 mm^2") == "a unit takes no power (write (5 mm)^2) at '^2'");
  CHECK(wrong("1 + `a") == "a closing '`' is missing at '`a'");
  CHECK(wrong("nothing(1)") ==
        "no function 'nothing' (one of abs, sqrt, exp, log, sin, cos, tan, atan, atan2, erf, step, hypot, "
        "min, max)");
  CHECK(wrong("Sin(1)") ==
        "no function 'Sin' (one of abs, sqrt, exp, log, sin, cos, tan, atan, atan2, erf, step, hypot, min, "
        "max). "
        "Did you mean 'sin'?");
  // 64 levels are not too deep: the innermost is a sign's too.
  for (const auto& [open, close] : {std::pair{"(", ")"}, std::pair{"-", ""}, std::pair{"1^", ""}}) {
    const auto nested = [&, one = std::string(open), other = std::string(close)](int depth) {
      std::string text = "1";
      for (int k = 0; k < depth; ++k) text = one + text + other;
      return wrong(text);
    };
    CHECK(nested(63) == "");
    CHECK(nested(64).find("nested too deeply at '1") == 0);
  }
  std::string side_by_side = "1";
  for (int k = 0; k < 100; ++k) side_by_side += "+(-1)*2^1";
  CHECK(wrong(side_by_side) == "");
}

TEST_CASE("a name behind a unit and a sign is kept, for those who know whether it is a unit") {
  const auto after = [](const std::string& text) {
    const auto parsed = Expression::parse(text);
    REQUIRE_MESSAGE(std::holds_alternative<Expression>(parsed), text);
    return std::get<Expression>(parsed).names_after_units();
  };
  CHECK(after("5 mm/h + 2 kg*min*s") == std::vector<std::string>{"h", "min"});
  CHECK(after("5 mm + h") == std::vector<std::string>{});
  CHECK(after("5/h") == std::vector<std::string>{});
  CHECK(after("x*5 mm") == std::vector<std::string>{});
  CHECK(after("2 * 5 mm/h2") == std::vector<std::string>{"h"});
}

}  // namespace
}  // namespace mpmfast
