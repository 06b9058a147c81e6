#pragma once

/// @file The surface of a solid shape, by triangles.

#include "engine/geometry/outline.hpp"

namespace mpmfast {

/// As outline(), in 3-D.
Outline solid_outline(const Shape& shape, double spacing);

}  // namespace mpmfast
