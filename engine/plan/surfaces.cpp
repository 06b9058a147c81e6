#include "engine/plan/surfaces.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace mpmfast {

std::vector<Outline> outlines(const Scene& scene, const Plan& plan) {
  std::vector<Outline> out;
  if (!plan.penalty) return out;
  const double spacing = scene.grid.cell / scene.contact.springs.per_cell;
  for (const BodySpec& body : scene.bodies) out.push_back(outline(body.shape, spacing, scene.dimension()));
  return out;
}

namespace {

template <int Dim>
double undeformed_area(const std::array<Vec<Dim>, Dim>& corner, double thickness) {
  if constexpr (Dim == 2)
    return (corner[1] - corner[0]).norm() * thickness;
  else
    return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
}

}  // namespace

template <int Dim>
void add_surface(const Outline& outline, std::uint32_t first_id, double thickness, Surfaces<Dim>& out) {
  const int body = static_cast<int>(out.bodies.size()), first = static_cast<int>(out.points());
  const int first_patch = out.facets.empty() ? 0 : out.facets.back().patch + 1;
  out.bodies.push_back({first_id, first, static_cast<int>(outline.points.size())});
  out.point_body.resize(out.points() + outline.points.size(), body);
  for (const Outline::Facet& facet : outline.facets) {
    typename Surfaces<Dim>::Facet added{};
    std::array<Vec<Dim>, Dim> corner;
    for (std::size_t k = 0; k < Dim; ++k) {
      added.point[k] = first + facet.point[k];
      added.joint[k] = facet.joint[k];
      const Vec3& x = outline.points[static_cast<std::size_t>(facet.point[k])];
      for (std::size_t d = 0; d < Dim; ++d) corner[k][static_cast<int>(d)] = x[d];
    }
    added.body = body;
    added.patch = first_patch + facet.patch;
    added.area = undeformed_area<Dim>(corner, thickness);
    out.facets.push_back(added);
  }
}

namespace {

/// A corner of a facet.
struct Corner {
  int facet;
  std::size_t at;  ///< which of the facet's corners
};

/// Do two facets at a point have a smooth joint there?
template <int Dim>
bool smooth_between(const Surfaces<Dim>& surfaces, const Corner& a, const Corner& b) {
  const auto &facet_a = surfaces.facet(a.facet), &facet_b = surfaces.facet(b.facet);
  if constexpr (Dim == 2) {
    return facet_a.joint[a.at] == Joint::smooth && facet_b.joint[b.at] == Joint::smooth;
  } else {
    for (std::size_t k = 1; k < 3; ++k) {  // the two edges of a at the point
      const std::size_t end = (a.at + k) % 3, opposite = 3 - a.at - end;
      if (facet_a.joint[opposite] != Joint::smooth) continue;
      if (std::find(facet_b.point.begin(), facet_b.point.end(), facet_a.point[end]) != facet_b.point.end())
        return true;
    }
    return false;
  }
}

/// Takes the last of `corners`, and all that smooth joints connect to it.
template <int Dim>
std::vector<Corner> take_smooth_part(const Surfaces<Dim>& surfaces, std::vector<Corner>& corners) {
  std::vector<Corner> part{corners.back()};
  corners.pop_back();
  for (std::size_t k = 0; k < part.size(); ++k)
    for (std::size_t j = 0; j < corners.size();)
      if (smooth_between(surfaces, part[k], corners[j])) {
        part.push_back(corners[j]);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        ++j;
      }
  return part;
}

/// Builds the normal cones of a point from the corners there.
template <int Dim>
void add_normal_cones(std::vector<Corner> corners, int point, Surfaces<Dim>& surfaces) {
  while (!corners.empty()) {
    const int begin = static_cast<int>(surfaces.cone_facets.size());
    for (const Corner& corner : take_smooth_part(surfaces, corners)) {
      surfaces.facets[static_cast<std::size_t>(corner.facet)].normal_cone[corner.at] =
          static_cast<int>(surfaces.normal_cones.size());
      surfaces.cone_facets.push_back(corner.facet);
    }
    surfaces.normal_cones.push_back({point, begin, static_cast<int>(surfaces.cone_facets.size())});
  }
}

}  // namespace

template <int Dim>
void connect_facets(Surfaces<Dim>& surfaces) {
  std::vector<std::vector<Corner>> corners(surfaces.points());
  for (std::size_t f = 0; f < surfaces.facets.size(); ++f)
    for (std::size_t k = 0; k < Dim; ++k)
      corners[static_cast<std::size_t>(surfaces.facets[f].point[k])].push_back({static_cast<int>(f), k});
  for (std::size_t p = 0; p < corners.size(); ++p)
    add_normal_cones(std::move(corners[p]), static_cast<int>(p), surfaces);
}

template <int Dim>
std::vector<double> tributary_areas(const Surfaces<Dim>& surfaces) {
  std::vector<double> area(surfaces.points(), 0.0);
  for (const auto& facet : surfaces.facets)
    for (int point : facet.point) area[static_cast<std::size_t>(point)] += facet.area / Dim;
  return area;
}

template void add_surface<2>(const Outline&, std::uint32_t, double, Surfaces<2>&);
template void add_surface<3>(const Outline&, std::uint32_t, double, Surfaces<3>&);
template void connect_facets<2>(Surfaces<2>&);
template void connect_facets<3>(Surfaces<3>&);
template std::vector<double> tributary_areas<2>(const Surfaces<2>&);
template std::vector<double> tributary_areas<3>(const Surfaces<3>&);

}  // namespace mpmfast
