#pragma once

/// @file Phase 2, classify: unit normals of vertex normal cones (K24 §3.5), the mean of the facet normals
/// there.

#include <optional>
#include <span>
#include <vector>

#include "engine/contact/penalty/facet_bounds.hpp"

namespace mpmfast::penalty {

/// Computes the normals of some cones.
/// @param bounds  by facet; facets without known bounds are asked for their normal
/// @param cones   by rising number
/// @param out     by cone; others stay
/// @return the point of a cone where the surface is folded onto itself; nothing if none is
template <int Dim>
std::optional<int> compute_vertex_normals(const SurfaceGeometry<Dim>& geometry,
                                          const std::vector<FacetBounds<Dim>>& bounds,
                                          std::span<const int> cones, int threads,
                                          std::vector<Vec<Dim>>& out);

}  // namespace mpmfast::penalty
