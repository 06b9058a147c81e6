#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "engine/quantities/expression.hpp"
#include "engine/quantities/expression_functions.hpp"

namespace mpmfast {

namespace {

/// Numbers whose units nobody looks at.
struct PlainArithmetic {
  static double number(double value, const Dimensions&) { return value; }
  static double negate(double a) { return -a; }
  static double add(double a, double b) { return a + b; }
  static double subtract(double a, double b) { return a - b; }
  static double multiply(double a, double b) { return a * b; }
  static double divide(double a, double b) { return a / b; }
  static double power(double a, double b) { return std::pow(a, b); }
  static double call(const Function& function, double a, double b) { return function.of(a, b); }
};

/// Numbers that carry their units. The first rule broken is kept in `wrong`.
class AmountArithmetic {
 public:
  std::string wrong;

  static Amount number(double value, const Dimensions& dimensions) { return {value, dimensions}; }
  static Amount negate(const Amount& a) { return {-a.value, a.dimensions}; }
  Amount add(const Amount& a, const Amount& b) { return {a.value + b.value, common(b, a, "added to")}; }
  Amount subtract(const Amount& a, const Amount& b) {
    return {a.value - b.value, common(b, a, "subtracted from")};
  }
  Amount multiply(const Amount& a, const Amount& b) {
    return {a.value * b.value, combined(a.dimensions, b.dimensions, 1)};
  }
  Amount divide(const Amount& a, const Amount& b) {
    if (b.value == 0) refuse("division by zero");
    return {a.value / b.value, combined(a.dimensions, b.dimensions, -1)};
  }
  Amount power(const Amount& a, const Amount& b) {
    if (b.dimensions != Dimensions{})
      refuse(fmt::format("an exponent must be a number, not {}", kind_text(b.dimensions)));
    return {std::pow(a.value, b.value), raised(a.dimensions, b.value)};
  }
  Amount call(const Function& function, const Amount& a, const Amount& b) {
    return {function.of(a.value, b.value), of_function(function, a, b)};
  }

 private:
  static constexpr int kHighestPower = 99;

  void refuse(std::string what) {
    if (wrong.empty()) wrong = std::move(what);
  }

  /// Zero has any unit, and a radian is a number that says so.
  Dimensions common(const Amount& a, const Amount& b, const char* verb) {
    const auto bare_zero = [](const Amount& x) { return x.value == 0 && x.dimensions == Dimensions{}; };
    if (a.dimensions == b.dimensions || bare_zero(b)) return a.dimensions;
    if (bare_zero(a)) return b.dimensions;
    Dimensions first = a.dimensions, second = b.dimensions;
    first[kRadian] = second[kRadian] = 0;
    if (first == second) return a.dimensions[kRadian] != 0 ? a.dimensions : b.dimensions;
    refuse(fmt::format("{} cannot be {} {}", kind_text(a.dimensions), verb, kind_text(b.dimensions)));
    return a.dimensions;
  }

  Dimensions combined(Dimensions a, const Dimensions& b, int sign) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      a[k] += sign * b[k];
      if (std::abs(a[k]) > kHighestPower) {
        refuse("a unit of too high a power");
        a[k] = 0;
      }
    }
    return a;
  }

  Dimensions raised(Dimensions a, double exponent) {
    for (int& power : a) {
      if (power == 0) continue;
      const double raised = power * exponent;
      if (raised != std::round(raised) || std::abs(raised) > kHighestPower) {
        refuse(fmt::format("{} to the power {} has no unit", kind_text(a), exponent));
        return {};
      }
      power = static_cast<int>(raised);
    }
    return a;
  }

  Dimensions of_function(const Function& function, const Amount& a, const Amount& b) {
    constexpr Dimensions kNone{}, kAngle{0, 0, 0, 1, 0};
    const auto needs = [&](bool holds, const char* what) {
      if (!holds) refuse(fmt::format("{} takes {}, not {}", function.name, what, kind_text(a.dimensions)));
    };
    switch (function.units) {
      case UnitRule::keeps:
        return function.arguments == 1 ? a.dimensions : common(b, a, "compared with");
      case UnitRule::root:
        return raised(a.dimensions, 0.5);
      case UnitRule::drops:
        return kNone;
      case UnitRule::pure:
        needs(a.dimensions == kNone, "a number");
        return kNone;
      case UnitRule::takes_angle:
        needs(a.dimensions == kNone || a.dimensions == kAngle, "an angle");
        return kNone;
      case UnitRule::gives_angle:
        needs(a.dimensions == kNone, "a number");
        return kAngle;
      case UnitRule::angle_of_two:
        common(b, a, "compared with");
        return kAngle;
    }
    return kNone;
  }
};

/// A radian beside other units that make a quantity without it is a number: rad*m/s is a velocity.
Dimensions without_idle_radian(const Dimensions& dimensions) {
  Dimensions unturned = dimensions;
  unturned[kRadian] = 0;
  return kind_text(dimensions).rfind("a quantity in", 0) == 0 ? unturned : dimensions;
}

}  // namespace

template <class Number, class Arithmetic>
Number Expression::run(std::span<const Number> of_names, Arithmetic& arithmetic) const {
  std::vector<Number> stack;
  const auto pop = [&] {
    const Number top = stack.back();
    stack.pop_back();
    return top;
  };
  for (const Code& code : codes_) {
    if (code.kind == Kind::number) {
      stack.push_back(arithmetic.number(code.number, code.dimensions));
    } else if (code.kind == Kind::name) {
      stack.push_back(of_names[code.index]);
    } else if (code.kind == Kind::negate) {
      stack.back() = arithmetic.negate(stack.back());
    } else {
      const bool one = code.kind == Kind::call && kFunctions[code.index].arguments == 1;
      const Number b = one ? Number{} : pop(), a = pop();
      switch (code.kind) {
        case Kind::add:
          stack.push_back(arithmetic.add(a, b));
          break;
        case Kind::subtract:
          stack.push_back(arithmetic.subtract(a, b));
          break;
        case Kind::multiply:
          stack.push_back(arithmetic.multiply(a, b));
          break;
        case Kind::divide:
          stack.push_back(arithmetic.divide(a, b));
          break;
        case Kind::power:
          stack.push_back(arithmetic.power(a, b));
          break;
        default:
          stack.push_back(arithmetic.call(kFunctions[code.index], a, b));
      }
    }
  }
  return stack.back();
}

double Expression::value(std::span<const double> of_names) const {
  PlainArithmetic arithmetic;
  return run<double>(of_names, arithmetic);
}

std::variant<Amount, std::string> Expression::amount(std::span<const Amount> of_names) const {
  AmountArithmetic arithmetic;
  Amount result = run<Amount>(of_names, arithmetic);
  if (!arithmetic.wrong.empty()) return arithmetic.wrong;
  if (!std::isfinite(result.value)) return "the result is not a finite number";
  result.dimensions = without_idle_radian(result.dimensions);
  result.value += 0.0;  // no −0
  return result;
}

}  // namespace mpmfast
