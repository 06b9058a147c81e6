#pragma once

/// @file Surfaces at given positions of their boundary points.

#include <Eigen/Geometry>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/penalty/item.hpp"
#include "engine/state/state.hpp"

namespace mpmfast::penalty {

/// Weight of a corner in a point of integration of its facet.
template <int Dim>
double corner_weight(int point, int corner) {
  if (kFacetPoints<Dim> == 1) return 1.0 / Dim;
  return point == corner ? kGaussWeight : 1 - kGaussWeight;
}

/// View of surfaces and of positions by number of the boundary point, m.
template <int Dim>
class SurfaceGeometry {
 public:
  using Facet = typename Surfaces<Dim>::Facet;

  SurfaceGeometry(const Surfaces<Dim>& surfaces, const std::vector<Vec<Dim>>& positions)
      : surfaces_(&surfaces), positions_(&positions) {}

  const Surfaces<Dim>& surfaces() const { return *surfaces_; }
  const Facet& facet(int f) const { return surfaces_->facet(f); }
  const Vec<Dim>& position(int point) const { return item(*positions_, point); }
  const std::vector<Vec<Dim>>& positions() const { return *positions_; }

  /// Position of a point of integration of a facet, m.
  Vec<Dim> integration_point(int f, int point) const {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int c = 0; c < Dim; ++c) sum += corner_weight<Dim>(point, c) * position(item(facet(f).point, c));
    return sum;
  }
  /// Unit normal of a facet, out of the body.
  Vec<Dim> facet_normal(int f) const {
    const auto& corner = facet(f).point;
    const Vec<Dim> edge = position(corner[1]) - position(corner[0]);
    if constexpr (Dim == 2)
      return Vec<2>(edge[1], -edge[0]).normalized();
    else
      return edge.cross(position(corner[2]) - position(corner[0])).normalized();
  }

 private:
  const Surfaces<Dim>* surfaces_;
  const std::vector<Vec<Dim>>* positions_;
};

/// Copies the positions of boundary points from the particles. @param out  by number of the point, m
template <int Dim>
void gather_positions(const State<Dim>& state, std::vector<Vec<Dim>>& out);

}  // namespace mpmfast::penalty
