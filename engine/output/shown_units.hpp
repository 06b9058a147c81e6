#pragma once

/// @file The units that people are shown. Files keep SI in the names of their columns; that a plane a metre
/// thick gives masses, forces and energies of a metre of it must be said beside the numbers.

#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Are masses, forces and energies those of a metre of a plane? Not where the scene states a thickness other
/// than 1 m, in axisymmetric scenes (the full turn) and in 3-D.
bool is_per_metre(const Scene& scene);

/// "J/m" for "J", "N m/m" for "N m", "kg m/s per m" for "kg m/s"; a unit that does not grow with the
/// thickness stays as it is.
std::string unit_per_metre(const std::string& unit);

/// One of these two.
inline std::string shown_unit(const Scene& scene, const std::string& unit) {
  return is_per_metre(scene) ? unit_per_metre(unit) : unit;
}

/// Of numbers of several runs side by side, given which are those of a metre: empty where that makes them of
/// different units.
std::string shown_unit(const std::vector<bool>& per_metre, const std::string& unit);

}  // namespace mpmfast
