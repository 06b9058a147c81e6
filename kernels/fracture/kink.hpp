#pragma once

/// @file Where a crack under mixed load goes: at right angles to the largest hoop stress about its tip
/// (Erdogan and Sih 1963).

#include <cmath>

namespace mpmfast {

/// From straight on, positive to the left, rad. @param one,two  K_I, not negative, and K_II
inline double kink_angle(double one, double two) {
  const double sum = one + std::sqrt(one * one + 8 * two * two);
  return sum > 0 ? -2 * std::atan(2 * two / sum) : 0;
}

/// K_I of the crack if it went on at that angle: √(2πr) times the hoop stress there.
inline double hoop_intensity(double one, double two, double angle) {
  const double c = std::cos(0.5 * angle);
  return c * (one * c * c - 1.5 * two * std::sin(angle));
}

}  // namespace mpmfast
