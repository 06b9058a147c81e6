#pragma once

/// @file Polylines in the plane that pictures show.

#include <vector>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// Polylines, m.
using Polylines = std::vector<std::vector<Vec<2>>>;

}  // namespace mpmfast
