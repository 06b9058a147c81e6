#include "engine/geometry/outline_solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "engine/geometry/solid_mesh.hpp"
#include "engine/geometry/surface.hpp"

namespace mpmfast {

namespace solid_mesh {

namespace {

/// Length of an edge of the icosahedron along the unit sphere, rad.
constexpr double kIcosahedronEdge = 1.1071487177940904;

/// Least divisions of such an edge, –. Undivided faces of an icosahedron meet in creases.
constexpr long kLeastDivisions = 2;

/// Least facets around a ring, –: the coarsest section is an octagon.
constexpr long kLeastTurns = 8;

/// The surface that a section makes when it turns about an axis through `centre`. Points on the axis are one.
/// @param closed  the section closes; otherwise it begins and ends on the axis
Mesh revolve(const Points2& section, bool closed, const Vec3& centre, long turns) {
  Mesh mesh;
  std::vector<std::vector<int>> at;  // by point of the section, by turn
  for (const auto& p : section) {
    std::vector<int> row;
    for (long j = 0; j < turns; ++j) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(turns);
      if (p[0] == 0 && j > 0)
        row.push_back(row.front());
      else
        row.push_back(mesh.add(
            {centre[0] + p[0] * std::cos(angle), centre[1] + p[0] * std::sin(angle), centre[2] + p[1]}));
    }
    at.push_back(std::move(row));
  }
  const std::size_t n = section.size();
  for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(turns); ++j) {
      const auto &here = at[i], &next = at[(i + 1) % n];
      const std::size_t on = (j + 1) % static_cast<std::size_t>(turns);
      const Triangle first{here[j], here[on], next[on]}, second{here[j], next[on], next[j]};
      for (const Triangle& t : {first, second})
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
    }
  return mesh;
}

/// Makes the mesh of a shape.
struct MeshOf {
  double spacing;  ///< m

  /// Number of facets along a path, m.
  long count(double path, long least = 1) const { return std::max(std::lround(path / spacing), least); }

  /// Points of the section of a ring as radius and height, m: a rectangle, counter-clockwise. Without a hole
  /// the side on the axis is left out.
  Points2 section_of(const RingShape& ring) const {
    Points2 section;
    const double half = ring.half_length;
    const Points2 corners{{ring.inner, -half}, {ring.outer, -half}, {ring.outer, half}, {ring.inner, half}};
    const bool hollow = ring.inner > 0;
    for (std::size_t k = 0; k < (hollow ? 4u : 3u); ++k) {
      const auto &a = corners[k], &b = corners[(k + 1) % 4];
      const long n = count(std::hypot(b[0] - a[0], b[1] - a[1]));
      for (long i = 0; i < n; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(n);
        section.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
      }
    }
    if (!hollow) section.push_back(corners[3]);
    return section;
  }

  Mesh operator()(const BoxShape& box) const {
    const Vec3 &a = box.lower, &b = box.upper;
    Mesh mesh = prism({{a[0], a[1]}, {b[0], a[1]}, {b[0], b[1]}, {a[0], b[1]}}, a[2], b[2]);
    refine(mesh, spacing);
    return mesh;
  }
  Mesh operator()(const EllipsoidShape& shape) const {
    const double largest = std::max({shape.radii[0], shape.radii[1], shape.radii[2]});
    Mesh mesh = unit_sphere(count(kIcosahedronEdge * largest, kLeastDivisions));
    const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
    for (Vec3& p : mesh.points) {
      const double x = shape.radii[0] * p[0], y = shape.radii[1] * p[1];
      p = {shape.centre[0] + cosine * x - sine * y, shape.centre[1] + sine * x + cosine * y,
           shape.centre[2] + shape.radii[2] * p[2]};
    }
    return mesh;
  }
  /// A surface of revolution.
  Mesh operator()(const RingShape& ring) const {
    const long turns = count(2 * std::numbers::pi * ring.outer, kLeastTurns);
    return revolve(section_of(ring), ring.inner > 0, ring.centre, turns);
  }
  Mesh operator()(const PolygonShape& polygon) const {
    Mesh mesh = prism(polygon.points, polygon.z_lower, polygon.z_upper);
    refine(mesh, spacing);
    return mesh;
  }
  Mesh operator()(const BitmapShape&) const { return {}; }
  Mesh operator()(const StlShape& stl) const {
    Mesh mesh;
    mesh.points = stl.surface->points();
    for (const auto& t : stl.surface->triangles())
      mesh.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
    if (enclosed_volume(stl.surface->points(), stl.surface->triangles()) < 0)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    refine(mesh, spacing);
    return mesh;
  }
};

/// A facet at an edge.
struct EdgeSide {
  std::size_t facet, opposite;  ///< opposite: which of its corners is not on the edge
};

/// The facets at each edge, by the numbers of its ends.
std::map<std::pair<int, int>, std::vector<EdgeSide>> edges_of(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::vector<EdgeSide>> edges;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = mesh.triangles[f];
      edges[std::minmax(t[(k + 1) % 3], t[(k + 2) % 3])].push_back({f, k});
    }
  return edges;
}

/// The joint of the facets at an edge: convex also where more than two meet.
Joint joint_at(const Mesh& mesh, int end, const std::vector<EdgeSide>& sides) {
  if (sides.size() != 2) return Joint::convex;
  const Triangle &a = mesh.triangles[sides[0].facet], &b = mesh.triangles[sides[1].facet];
  const Vec3 na = mesh.normal(a), nb = mesh.normal(b);
  const double turning = std::atan2(length(cross(na, nb)), dot(na, nb));
  if (turning <= kCrease) return Joint::smooth;
  const bool b_is_below = dot(na, minus(mesh.at(b[sides[1].opposite]), mesh.at(end))) <= 0;
  return b_is_below ? Joint::convex : Joint::reentrant;
}

/// Numbers the patches: facets connected by smooth joints.
/// @param adjacent  by facet, those beyond a smooth joint
void number_patches(const std::vector<std::vector<std::size_t>>& adjacent, Outline& out) {
  for (auto& facet : out.facets) facet.patch = -1;
  for (std::size_t f = 0; f < out.facets.size(); ++f) {
    if (out.facets[f].patch >= 0) continue;
    std::vector<std::size_t> reached{f};
    out.facets[f].patch = out.patches;
    while (!reached.empty()) {
      const std::size_t one = reached.back();
      reached.pop_back();
      for (const std::size_t next : adjacent[one]) {
        if (out.facets[next].patch >= 0) continue;
        out.facets[next].patch = out.patches;
        reached.push_back(next);
      }
    }
    ++out.patches;
  }
}

/// Sets the joints of all facets and their patches.
void connect(const Mesh& mesh, Outline& out) {
  std::vector<std::vector<std::size_t>> adjacent(mesh.triangles.size());
  for (const auto& [edge, sides] : edges_of(mesh)) {
    const Joint joint = joint_at(mesh, edge.first, sides);
    for (const EdgeSide& side : sides) out.facets[side.facet].joint[side.opposite] = joint;
    if (joint != Joint::smooth) continue;
    adjacent[sides[0].facet].push_back(sides[1].facet);
    adjacent[sides[1].facet].push_back(sides[0].facet);
  }
  number_patches(adjacent, out);
}

}  // namespace

}  // namespace solid_mesh

Outline solid_outline(const Shape& shape, double spacing) {
  const solid_mesh::Mesh mesh = std::visit(solid_mesh::MeshOf{spacing}, shape);
  Outline out;
  out.points = mesh.points;
  for (const auto& t : mesh.triangles) out.facets.push_back({{t[0], t[1], t[2]}, {}, 0});
  solid_mesh::connect(mesh, out);
  return out;
}

}  // namespace mpmfast
