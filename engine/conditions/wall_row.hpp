#pragma once

/// @file Where the plane of a wall lies among the rows of nodes.

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/constants.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/scene.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

struct WallRow {
  int row;     ///< the first one at or beyond the plane
  double cut;  ///< cells from the last row inside to the plane; 1: it lies on a row
};

/// @param plane  cells from the grid's origin
inline WallRow wall_row(double plane, bool upper) {
  using constants::conditions::kRowTolerance;
  const int row =
      static_cast<int>(upper ? std::ceil(plane - kRowTolerance) : std::floor(plane + kRowTolerance));
  const double beyond = std::abs(row - plane);
  return {row, beyond < 2 * kRowTolerance ? 1 : 1 - beyond};
}

struct Interval {
  double lower, upper;
};

/// What the walls leave along an axis at a time, in cells from the grid's origin.
inline Interval space_between_walls(const Scene& scene, int axis, double time) {
  Interval space{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const BoundarySpec& b : scene.boundaries) {
    const auto* wall = std::get_if<WallSpec>(&b.condition);
    if (!wall || wall->axis != axis) continue;
    const double plane = wall->position + integral_to(wall->speed, time);
    const double cells = (plane - scene.grid.origin[static_cast<std::size_t>(axis)]) / scene.grid.cell;
    if (wall->upper)
      space.upper = std::min(space.upper, cells);
    else
      space.lower = std::max(space.lower, cells);
  }
  return space;
}

/// The least distance of a plane from the last row inside, cells.
inline double thinnest_cut(BasisKind basis) {
  return facts(basis).grid_reach > 1 ? constants::conditions::kThinnestCutWide
                                     : constants::conditions::kThinnestCut;
}

}  // namespace mpmfast
