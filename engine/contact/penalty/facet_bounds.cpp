#include "engine/contact/penalty/facet_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

namespace {

template <int Dim>
FacetBounds<Dim> bounds_of(const SurfaceGeometry<Dim>& geometry, int f) {
  const auto& facet = geometry.facet(f);
  FacetBounds<Dim> out{Vec<Dim>::Zero(), geometry.facet_normal(f), 0, facet.body};
  for (int p : facet.point) out.centre += geometry.position(p);
  out.centre /= Dim;
  for (int p : facet.point)
    out.radius = std::max(out.radius, (geometry.position(p) - out.centre).squaredNorm());
  out.radius = std::sqrt(out.radius);
  return out;
}

}  // namespace

template <int Dim>
void compute_bounds(const SurfaceGeometry<Dim>& geometry, std::span<const int> facets, int threads,
                    std::vector<FacetBounds<Dim>>& out) {
  for_each_of(static_cast<std::int64_t>(facets.size()), threads, kSerialFacets, [&](std::int64_t k) {
    const int f = item(facets, k);
    item(out, f) = bounds_of(geometry, f);
  });
}

template void compute_bounds<2>(const SurfaceGeometry<2>&, std::span<const int>, int,
                                std::vector<FacetBounds<2>>&);
template void compute_bounds<3>(const SurfaceGeometry<3>&, std::span<const int>, int,
                                std::vector<FacetBounds<3>>&);

}  // namespace mpmfast::penalty
