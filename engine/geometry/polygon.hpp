#pragma once

/// @file Tests on closed polygons given by their corners.

#include <array>
#include <string>
#include <vector>

namespace mpmfast {

using Points2 = std::vector<std::array<double, 2>>;

/// Why these corners are no simple polygon; empty when they are one.
std::string polygon_fault(const Points2& points);

/// Even-odd rule. Of two polygons that share an edge exactly one holds a point on it.
bool polygon_contains(const Points2& points, double x, double y);

}  // namespace mpmfast
