#pragma once

/// @file The outline of one grey level of a bitmap.

#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// Closed lines with the grey level on their left. The level's share of the pixels is smoothed over two
/// pixels; the line is where it is one half. Outlines of neighbouring levels follow one line, without a
/// staircase.
/// @param spacing  about the distance of neighbouring points, m
std::vector<std::vector<std::array<double, 2>>> bitmap_loops(const BitmapShape& shape, double spacing);

}  // namespace mpmfast
