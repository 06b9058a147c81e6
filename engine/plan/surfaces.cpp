#include "engine/plan/surfaces.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <utility>

namespace mpmfast {

std::vector<Outline> outlines(const Scene& scene, const Plan& plan) {
  std::vector<Outline> out;
  if (!plan.penalty) return out;
  const double spacing = scene.grid.cell / scene.contact.springs.per_cell;
  for (const BodySpec& body : scene.bodies) out.push_back(outline(body.shape, spacing, scene.dimension()));
  return out;
}

template <int Dim>
void add_surface(const Outline& outline, std::uint32_t first_id, double thickness, Surfaces<Dim>& out) {
  const int body = static_cast<int>(out.bodies.size()), first = static_cast<int>(out.points());
  const int piece = out.facets.empty() ? 0 : out.facets.back().piece + 1;
  out.bodies.push_back({first_id, first, static_cast<int>(outline.points.size())});
  out.point_body.resize(out.points() + outline.points.size(), body);
  for (const Outline::Facet& facet : outline.facets) {
    typename Surfaces<Dim>::Facet f{};
    std::array<Vec<Dim>, Dim> x;
    for (std::size_t k = 0; k < Dim; ++k) {
      f.point[k] = first + facet.point[k];
      f.joint[k] = facet.joint[k];
      for (int d = 0; d < Dim; ++d)
        x[k][d] = outline.points[static_cast<std::size_t>(facet.point[k])][static_cast<std::size_t>(d)];
    }
    f.body = body;
    f.piece = piece + facet.piece;
    if constexpr (Dim == 2)
      f.area = (x[1] - x[0]).norm() * thickness;
    else
      f.area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    out.facets.push_back(f);
  }
}

namespace {

/// The corner of a facet that lies at a point.
struct Corner {
  int facet;
  std::size_t at;
};

/// Do two facets at a point go over into each other there?
template <int Dim>
bool smooth_between(const Surfaces<Dim>& s, const Corner& a, const Corner& b) {
  const auto& fa = s.facets[static_cast<std::size_t>(a.facet)];
  const auto& fb = s.facets[static_cast<std::size_t>(b.facet)];
  if constexpr (Dim == 2) {
    return fa.joint[a.at] == Joint::smooth && fb.joint[b.at] == Joint::smooth;
  } else {
    for (std::size_t k = 1; k < 3; ++k) {  // a's edge from the point to each of its two others
      const std::size_t end = (a.at + k) % 3, opposite = 3 - a.at - end;
      if (fa.joint[opposite] != Joint::smooth) continue;
      if (std::find(fb.point.begin(), fb.point.end(), fa.point[end]) != fb.point.end()) return true;
    }
    return false;
  }
}

/// Parts the corners at a point into wedges.
template <int Dim>
void add_wedges(std::vector<Corner> corners, int point, Surfaces<Dim>& s) {
  while (!corners.empty()) {
    std::vector<Corner> wedge{corners.back()};
    corners.pop_back();
    for (std::size_t k = 0; k < wedge.size(); ++k)
      for (std::size_t j = 0; j < corners.size();)
        if (smooth_between(s, wedge[k], corners[j])) {
          wedge.push_back(corners[j]);
          corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(j));
        } else {
          ++j;
        }
    const int begin = static_cast<int>(s.wedge_facets.size());
    for (const Corner& corner : wedge) {
      s.facets[static_cast<std::size_t>(corner.facet)].wedge[corner.at] = static_cast<int>(s.wedges.size());
      s.wedge_facets.push_back(corner.facet);
    }
    s.wedges.push_back({point, begin, static_cast<int>(s.wedge_facets.size())});
  }
}

}  // namespace

template <int Dim>
void join(Surfaces<Dim>& surfaces) {
  std::vector<std::vector<Corner>> corners(surfaces.points());
  for (std::size_t f = 0; f < surfaces.facets.size(); ++f)
    for (std::size_t k = 0; k < Dim; ++k)
      corners[static_cast<std::size_t>(surfaces.facets[f].point[k])].push_back({static_cast<int>(f), k});
  for (std::size_t p = 0; p < corners.size(); ++p)
    add_wedges(std::move(corners[p]), static_cast<int>(p), surfaces);
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
template void join<2>(Surfaces<2>&);
template void join<3>(Surfaces<3>&);
template std::vector<double> tributary_areas<2>(const Surfaces<2>&);
template std::vector<double> tributary_areas<3>(const Surfaces<3>&);

}  // namespace mpmfast
