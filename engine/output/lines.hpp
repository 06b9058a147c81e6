#pragma once

/// @file Polylines in the plane that pictures show.

#include <string_view>
#include <vector>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// Polylines, m.
using Polylines = std::vector<std::vector<Vec<2>>>;

/// What a particle file calls the points of its lines, one after the other, and how many each has.
inline constexpr std::string_view kLinePoints = "crack_points", kLineLengths = "crack_lengths";

}  // namespace mpmfast
