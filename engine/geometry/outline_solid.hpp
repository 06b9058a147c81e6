#pragma once

/// @file The surface of a solid shape as triangles.

#include "engine/geometry/outline.hpp"

namespace mpmfast {

/// outline() in 3-D. @param spacing  about the length of an edge, m
Outline solid_outline(const Shape& shape, double spacing);

}  // namespace mpmfast
