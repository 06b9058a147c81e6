#include "engine/contact/penalty/vertex_normals.hpp"

#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

template <int Dim>
std::optional<int> compute_vertex_normals(const SurfaceGeometry<Dim>& geometry,
                                          const std::vector<FacetBounds<Dim>>& bounds,
                                          std::span<const int> cones, int threads,
                                          std::vector<Vec<Dim>>& out) {
  const auto& surfaces = geometry.surfaces();
  const Vec<Dim> folded = Vec<Dim>::Zero();  // stands for a normal that is undefined
  for_each_of(static_cast<std::int64_t>(cones.size()), threads, kSerialFacets, [&](std::int64_t k) {
    const int number = item(cones, k);
    const auto& cone = surfaces.normal_cone(number);
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int j = cone.begin; j < cone.end; ++j) {
      const int f = item(surfaces.cone_facets, j);
      sum += item(bounds, f).known() ? item(bounds, f).normal : geometry.facet_normal(f);
    }
    const double length = sum.norm();
    item(out, number) = length > kLeastNormalSum ? Vec<Dim>(sum / length) : folded;
  });
  for (int number : cones)
    if (item(out, number) == folded) return surfaces.normal_cone(number).point;
  return std::nullopt;
}

template std::optional<int> compute_vertex_normals<2>(const SurfaceGeometry<2>&,
                                                      const std::vector<FacetBounds<2>>&,
                                                      std::span<const int>, int, std::vector<Vec<2>>&);
template std::optional<int> compute_vertex_normals<3>(const SurfaceGeometry<3>&,
                                                      const std::vector<FacetBounds<3>>&,
                                                      std::span<const int>, int, std::vector<Vec<3>>&);

}  // namespace mpmfast::penalty
