#pragma once

/// @file The outline of one grey level of a bitmap.

#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// Closed lines with the level on their left, at even distances of about `spacing` (m): where the level's
/// share of the pixels around, softened over two of them, is one half. So outlines of neighbouring levels
/// follow one line, and have no staircase.
std::vector<std::vector<std::array<double, 2>>> bitmap_loops(const BitmapShape& shape, double spacing);

}  // namespace mpmfast
