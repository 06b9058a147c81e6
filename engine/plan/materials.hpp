#pragma once

/// @file From what a scene says of a material to its law, and to the particle columns that the law needs.

#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/materials.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// @param cell  edge of a grid cell, m: the length of artificial viscosity
/// @param heat  the scene has temperatures
Material make_material(const MaterialSpec& spec, double cell, bool heat);

/// c, J/(kg K): of a law that has a temperature its own, else what the scene says beside; 0: nothing.
double heat_capacity_of(const MaterialSpec& spec);

/// What conduction knows of a body, in a scene with heat.
BodyHeat body_heat(const Scene& scene, const BodySpec& body);

/// Columns of evolving state that the materials of a scene need.
std::vector<Quantity> state_columns(const std::vector<MaterialSpec>& materials);

}  // namespace mpmfast
