#pragma once

/// @file Direction of a crack under mixed load: normal to the largest hoop stress around its tip (Erdogan and
/// Sih 1963).

#include <cmath>

namespace mpmfast {

/// Angle from the direction of the crack, positive to the left, rad: tan(θ/2) = −2 K_II/(K_I + √(K_I² + 8
/// K_II²)).
/// @param mode_i   K_I, not negative
/// @param mode_ii  K_II, in the same unit
inline double kink_angle(double mode_i, double mode_ii) {
  const double sum = mode_i + std::sqrt(mode_i * mode_i + 8 * mode_ii * mode_ii);
  return sum > 0 ? -2 * std::atan(2 * mode_ii / sum) : 0;
}

/// √(2πr) σ_θθ at an angle, in the unit of the intensities: K_I of a crack that continues in that direction.
inline double hoop_intensity(double mode_i, double mode_ii, double angle) {
  const double c = std::cos(0.5 * angle);
  return c * (mode_i * c * c - 1.5 * mode_ii * std::sin(angle));
}

}  // namespace mpmfast
