#pragma once

/// @file Which particles pictures show, and how large their domains are drawn.

#include <array>

#include "engine/scene/scene.hpp"
#include "engine/state/particles.hpp"
#include "kernels/basis/domain_limit.hpp"
#include "kernels/constants.hpp"

namespace mpmfast {

/// Cells: half-diagonals of domains are drawn no longer, as shape functions take them.
inline constexpr double kLargestHalfDiagonal = constants::kMostHalfDiagonal;

/// Longest half-diagonal of a domain that is drawn, m.
double largest_half_diagonal(const Scene& scene);

/// The part of space that pictures may show: the grid, and what a particle may pass beyond it before it has
/// left. A particle that was thrown further, in a run that failed, does not widen the frame.
struct Viewed {
  explicit Viewed(const Scene& scene);
  /// @param x  coordinates, m, one for each axis of the scene
  bool holds(const double* x) const;

  std::size_t dimension;
  std::array<double, 3> lower{}, upper{};  ///< m
};

/// The domain of these half-edges as shape functions take it where it is too long or too thin
/// (kernels/basis/domain_limit.hpp).
/// @param half_edges  columns, m
/// @param most        longest half-diagonal, m
Mat<2> with_diagonals_up_to(const Mat<2>& half_edges, double most);

/// Columns: half-edge vectors of a particle's domain as it is drawn, m. A basis whose domains follow F has
/// them cut; with another one a domain that F makes too large is drawn as it was seeded, which is what the
/// shape functions take. NaN where F is no number.
Mat<2> drawn_half_edges(const Particles<2>& particles, const Scene& scene, std::size_t p);

/// Half side of the cube of a particle's volume, m, with the same limit.
double drawn_radius(const Particles<3>& particles, const Scene& scene, std::size_t p);

}  // namespace mpmfast
