#pragma once

/// @file From what a scene says of a material to its law, and to the particle columns that the law needs.

#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/materials.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// @param cell  edge of a grid cell, m: the length of artificial viscosity
Material make_material(const MaterialSpec& spec, double cell);

/// Columns of evolving state that the materials of a scene need.
std::vector<Quantity> state_columns(const std::vector<MaterialSpec>& materials);

}  // namespace mpmfast
