#pragma once

/// @file The functions that an expression knows, and what each does to units.

#include <algorithm>
#include <array>
#include <cmath>

namespace mpmfast {

/// What a function takes and gives.
enum class UnitRule {
  keeps,         ///< any unit, and gives it
  root,          ///< half the powers
  drops,         ///< any unit, gives a number
  pure,          ///< a number, gives a number
  takes_angle,   ///< an angle or a number, gives a number
  gives_angle,   ///< a number, gives an angle
  angle_of_two,  ///< two of one unit, gives an angle
};

struct Function {
  const char* name;
  int arguments;
  double (*of)(double, double);
  UnitRule units;
};

inline constexpr std::array<Function, 14> kFunctions{{
    {"abs", 1, [](double x, double) { return std::abs(x); }, UnitRule::keeps},
    {"sqrt", 1, [](double x, double) { return std::sqrt(x); }, UnitRule::root},
    {"exp", 1, [](double x, double) { return std::exp(x); }, UnitRule::pure},
    {"log", 1, [](double x, double) { return std::log(x); }, UnitRule::pure},
    {"sin", 1, [](double x, double) { return std::sin(x); }, UnitRule::takes_angle},
    {"cos", 1, [](double x, double) { return std::cos(x); }, UnitRule::takes_angle},
    {"tan", 1, [](double x, double) { return std::tan(x); }, UnitRule::takes_angle},
    {"atan", 1, [](double x, double) { return std::atan(x); }, UnitRule::gives_angle},
    {"atan2", 2, [](double y, double x) { return std::atan2(y, x); }, UnitRule::angle_of_two},
    {"erf", 1, [](double x, double) { return std::erf(x); }, UnitRule::pure},
    {"step", 1, [](double x, double) { return x > 0 ? 1.0 : 0.0; }, UnitRule::drops},
    {"hypot", 2, [](double x, double y) { return std::hypot(x, y); }, UnitRule::keeps},
    {"min", 2, [](double x, double y) { return std::min(x, y); }, UnitRule::keeps},
    {"max", 2, [](double x, double y) { return std::max(x, y); }, UnitRule::keeps},
}};

}  // namespace mpmfast
