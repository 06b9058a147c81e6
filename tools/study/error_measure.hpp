#pragma once

/// @file How far a curve is from its reference, as one number.

#include <array>
#include <limits>
#include <optional>

#include "engine/scene/keys/names.hpp"
#include "table.hpp"

namespace mpmfast {

enum class Compare { maximum, root_mean_square, final_value, crossing };
inline constexpr std::array<Keyword<Compare>, 4> kCompares{{
    {Compare::maximum, "max", "largest difference from the reference in the window"},
    {Compare::root_mean_square, "rms", "root of the mean squared difference in the window"},
    {Compare::final_value, "final", "the last value, against `expected` or the reference"},
    {Compare::crossing, "crossing", "where the quantity first passes `above` or `below`"},
}};

enum class Relative { pointwise, maximum, absolute };
inline constexpr std::array<Keyword<Relative>, 3> kRelatives{{
    {Relative::pointwise, "pointwise", "to the reference at the same place (default)"},
    {Relative::maximum, "maximum", "to the largest value of the reference in the window"},
    {Relative::absolute, "no", "the difference itself"},
}};

struct ErrorRule {
  Compare compare = Compare::maximum;
  Relative relative = Relative::pointwise;
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
  bool below = false;                                           ///< crossing: passes downwards
  double threshold = std::numeric_limits<double>::quiet_NaN();  ///< crossing
  double expected = std::numeric_limits<double>::quiet_NaN();   ///< final, crossing; else the reference's
};

struct Measured {
  double error = std::numeric_limits<double>::quiet_NaN();
  double value = std::numeric_limits<double>::quiet_NaN();  ///< final, crossing: what was found
};

/// x increases. Points that the reference does not reach are left out; nothing to compare gives not a number.
/// A crossing is linear between its two points.
Measured measure_error(const ErrorRule& rule, const Curve& curve, const Curve& reference);

}  // namespace mpmfast
