#pragma once

/// @file Where the plane of a wall lies among the rows of nodes.

#include <cmath>

#include "engine/scene/scene.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

inline constexpr double kRowTolerance = 1e-6;  ///< cells: a wall this close to a row of nodes lies on it

struct WallRow {
  int row;     ///< the first one at or beyond the plane
  double cut;  ///< cells from the last row inside to the plane; 1: it lies on a row
};

/// @param plane  cells from the grid's origin
inline WallRow wall_row(double plane, bool upper) {
  const int row =
      static_cast<int>(upper ? std::ceil(plane - kRowTolerance) : std::floor(plane + kRowTolerance));
  const double beyond = std::abs(row - plane);
  return {row, beyond < 2 * kRowTolerance ? 1 : 1 - beyond};
}

/// The least distance, in cells, of a plane from the last row inside. A thinner sliver of material is
/// strained as one of this thickness is: it would need a smaller time step, the more so where supports are
/// wide. Columns pressed at CFL 0.5 and 0.9 swing with less (0.01; splines 0.05) and have too little stress
/// with more.
inline double thinnest_cut(BasisKind basis) { return facts(basis).grid_reach > 1 ? 0.15 : 0.05; }

}  // namespace mpmfast
