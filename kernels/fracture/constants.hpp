#pragma once

/// @file Numerical constants of the integrals at a crack tip. Lengths are relative to the radius of the
/// domain.

namespace mpmfast::fracture_constants {

/// Radius within which the weight |q| of the domain integral is 1; 0 to 1. Cells cannot resolve the stress
/// close to the tip, so its gradient is not weighted there.
inline constexpr double kPlateau = 0.4;
/// Length behind the tip to which the opening is measured, at most; 0 to 1.
inline constexpr double kOpeningLength = 0.7;
/// Length behind the tip from which the opening is measured, relative to that length; 0 to 1.
inline constexpr double kOpeningStart = 0.25 / kOpeningLength;
/// Distance from the crack within which particles tell the displacement of its sides, at least; 0 to 1.
inline constexpr double kOpeningWidth = 0.18;
/// Steps over the radius in which the direction of the crack path is tabulated.
inline constexpr int kPathSteps = 64;

}  // namespace mpmfast::fracture_constants
