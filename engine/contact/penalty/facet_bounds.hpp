#pragma once

/// @file Bounding spheres of facets.

#include <span>
#include <vector>

#include "engine/contact/penalty/surface_geometry.hpp"

namespace mpmfast::penalty {

/// Bounding sphere of a facet about its centroid, and its unit normal.
template <int Dim>
struct FacetBounds {
  Vec<Dim> centre, normal;
  double radius;  ///< distance of the farthest corner from the centre, m
  int body = -1;  ///< −1: the bounds are not known

  bool known() const { return body >= 0; }
};

/// Computes the bounds of some facets. @param out  by facet; others stay
template <int Dim>
void compute_bounds(const SurfaceGeometry<Dim>& geometry, std::span<const int> facets, int threads,
                    std::vector<FacetBounds<Dim>>& out);

}  // namespace mpmfast::penalty
