#pragma once

/// @file What the parameters of laws measure, and the limits that they must keep: laws describe their own
/// (`describe`), and the reader of scenes asks them.

#include <limits>

namespace mpmfast {

/// What a number measures.
enum class Measure {
  number,
  length,
  time,
  mass,
  velocity,
  acceleration,
  density,
  pressure,
  angle,
  angular_velocity,
  viscosity,
  temperature,
  heat_capacity,
  rate,
  interface_stiffness,
  conductivity,
  heat_flux,
  conductance,
  expansion,
  surface_energy
};
inline constexpr int kMeasures = 20;

/// The interval a number must lie in, and its name in messages.
struct Limit {
  const char* description;  ///< "positive"
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false, upper_open = false;
  bool moves = false;  ///< the bounds follow from another key

  bool holds(double value) const {
    return (lower_open ? value > lower : value >= lower) && (upper_open ? value < upper : value <= upper);
  }
  bool same(const Limit& other) const {
    return lower == other.lower && upper == other.upper && lower_open == other.lower_open &&
           upper_open == other.upper_open;
  }
};
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr Limit kAny{"finite"};
inline constexpr Limit kPositive{"positive", 0, kInfinity, true};
inline constexpr Limit kNotNegative{"zero or more", 0};

/// A word that a parameter may be; a parameter that is a choice has an array of them.
template <class E>
struct Keyword {
  E value;
  const char* name;
  const char* description;  ///< one line for `mpmfast list`
};

/// A parameter that is one number.
struct Number {
  Measure measure = Measure::number;
  Limit limit = kAny;
};

/// A parameter that is a curve of one quantity over another, by points.
struct Points {
  Measure along, value;
};

}  // namespace mpmfast
