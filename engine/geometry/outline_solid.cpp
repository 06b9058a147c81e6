#include "engine/geometry/outline_solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "engine/geometry/polygon.hpp"
#include "engine/geometry/surface.hpp"

namespace mpmfast {

namespace {

using Triangle = std::array<int, 3>;  ///< counter-clockwise seen from outside

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Mesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;

  const Vec3& at(int point) const { return points[static_cast<std::size_t>(point)]; }
  int add(const Vec3& point) {
    points.push_back(point);
    return static_cast<int>(points.size()) - 1;
  }
  /// Two triangles a b c, a c d.
  void add_quad(int a, int b, int c, int d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
};

/// Cuts edges in halves until none is much longer than `spacing`. Both triangles at an edge cut it at the
/// same place, so the surface stays closed.
void refine(Mesh& mesh, double spacing) {
  const double longest = 1.4 * spacing;
  for (bool cut = true; cut;) {
    cut = false;
    std::map<std::pair<int, int>, int> middle;
    const auto middle_of = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto known = middle.find(key);
      if (known != middle.end()) return known->second;
      const Vec3 &x = mesh.at(key.first), &y = mesh.at(key.second);
      int out = -1;
      if (length(minus(y, x)) > longest)
        out = mesh.add({0.5 * (x[0] + y[0]), 0.5 * (x[1] + y[1]), 0.5 * (x[2] + y[2])});
      return middle[key] = out;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      std::array<int, 3> m;  // of the edges t[k] t[k + 1]
      int count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        m[k] = middle_of(t[k], t[(k + 1) % 3]);
        count += m[k] >= 0;
      }
      cut |= count > 0;
      if (count == 0) finer.push_back(t);
      if (count == 3) {
        for (std::size_t k = 0; k < 3; ++k) finer.push_back({t[k], m[k], m[(k + 2) % 3]});
        finer.push_back(m);
      }
      for (std::size_t k = 0; k < 3 && count == 1; ++k)
        if (m[k] >= 0) {
          finer.push_back({t[k], m[k], t[(k + 2) % 3]});
          finer.push_back({m[k], t[(k + 1) % 3], t[(k + 2) % 3]});
        }
      for (std::size_t k = 0; k < 3 && count == 2; ++k)
        if (m[k] < 0) {  // t[k + 2] is between the two cuts
          const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], bc = m[(k + 1) % 3],
                    ca = m[(k + 2) % 3];
          finer.push_back({ca, bc, c});
          finer.push_back({a, b, bc});
          finer.push_back({a, bc, ca});
        }
    }
    mesh.triangles = std::move(finer);
  }
}

/// The triangles of a simple polygon, counter-clockwise: ear after ear.
std::vector<Triangle> ears(const Points2& points) {
  std::vector<int> left;
  for (std::size_t k = 0; k < points.size(); ++k) left.push_back(static_cast<int>(k));
  const auto turn = [&](int a, int b, int c) {
    const auto &p = points[static_cast<std::size_t>(a)], &q = points[static_cast<std::size_t>(b)],
               &r = points[static_cast<std::size_t>(c)];
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  };
  std::vector<Triangle> out;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t k = 0; k < n && ear == n; ++k) {
      const int a = left[(k + n - 1) % n], b = left[k], c = left[(k + 1) % n];
      if (!(turn(a, b, c) > 0)) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](int p) {
        return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
      });
      if (empty) ear = k;
    }
    if (ear == n) ear = 0;  // only round-off can leave none
    out.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  out.push_back({left[0], left[1], left[2]});
  return out;
}

Mesh prism(Points2 base, double lower, double upper) {
  double twice = 0;
  for (std::size_t i = 0, j = base.size() - 1; i < base.size(); j = i++)
    twice += base[j][0] * base[i][1] - base[i][0] * base[j][1];
  if (twice < 0) std::reverse(base.begin(), base.end());
  Mesh mesh;
  const int n = static_cast<int>(base.size());
  for (const double z : {lower, upper})
    for (const auto& p : base) mesh.add({p[0], p[1], z});
  for (int k = 0; k < n; ++k) mesh.add_quad(k, (k + 1) % n, n + (k + 1) % n, n + k);
  for (const Triangle& t : ears(base)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  return mesh;
}

/// The faces of an icosahedron, cut into n² triangles each, blown up to a unit sphere.
Mesh ball(long n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vec3> corner{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr std::array<Triangle, 20> kFaces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
  Mesh mesh;
  std::map<std::array<long, 3>, int> known;  // neighbouring faces share the points of their edge
  const auto point = [&](Vec3 x) {
    const double size = length(x);
    for (double& c : x) c /= size;
    const std::array<long, 3> key{std::lround(x[0] * 1e9), std::lround(x[1] * 1e9), std::lround(x[2] * 1e9)};
    const auto found = known.find(key);
    return found != known.end() ? found->second : known[key] = mesh.add(x);
  };
  for (const Triangle& face : kFaces) {
    const auto at = [&](long i, long j) {
      const Vec3 &a = corner[static_cast<std::size_t>(face[0])],
                 &b = corner[static_cast<std::size_t>(face[1])],
                 &c = corner[static_cast<std::size_t>(face[2])];
      Vec3 x;
      for (std::size_t d = 0; d < 3; ++d)
        x[d] = (static_cast<double>(n - i - j) * a[d] + static_cast<double>(i) * b[d] +
                static_cast<double>(j) * c[d]) /
               static_cast<double>(n);
      return point(x);
    };
    for (long i = 0; i < n; ++i)
      for (long j = 0; i + j < n; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return mesh;
}

struct Solid {
  double spacing;

  long count(double path, long least = 1) const { return std::max(std::lround(path / spacing), least); }

  Mesh operator()(const BoxShape& box) const {
    const Vec3 &a = box.lower, &b = box.upper;
    Mesh mesh = prism({{a[0], a[1]}, {b[0], a[1]}, {b[0], b[1]}, {a[0], b[1]}}, a[2], b[2]);
    refine(mesh, spacing);
    return mesh;
  }
  Mesh operator()(const EllipsoidShape& shape) const {
    constexpr double kEdge = 1.1071487177940904;  // of the icosahedron, on the unit sphere
    const double largest = std::max({shape.radii[0], shape.radii[1], shape.radii[2]});
    Mesh mesh = ball(count(kEdge * largest, 2));
    const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
    for (Vec3& p : mesh.points) {
      const double x = shape.radii[0] * p[0], y = shape.radii[1] * p[1];
      p = {shape.centre[0] + cosine * x - sine * y, shape.centre[1] + sine * x + cosine * y,
           shape.centre[2] + shape.radii[2] * p[2]};
    }
    return mesh;
  }
  /// Its section, a rectangle, is turned about the axis.
  Mesh operator()(const RingShape& ring) const {
    std::vector<std::array<double, 2>> section;  // radius and height, counter-clockwise
    const double half = ring.half_length;
    const std::vector<std::array<double, 2>> corners{
        {ring.inner, -half}, {ring.outer, -half}, {ring.outer, half}, {ring.inner, half}};
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
    const long around = count(2 * std::numbers::pi * ring.outer, 8);
    Mesh mesh;
    std::vector<std::vector<int>> at;  // by point of the section, by turn
    for (const auto& p : section) {
      std::vector<int> row;
      for (long j = 0; j < around; ++j) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(around);
        if (p[0] == 0 && j > 0)
          row.push_back(row.front());
        else
          row.push_back(mesh.add({ring.centre[0] + p[0] * std::cos(angle),
                                  ring.centre[1] + p[0] * std::sin(angle), ring.centre[2] + p[1]}));
      }
      at.push_back(std::move(row));
    }
    const std::size_t n = section.size();
    for (std::size_t i = 0; i + (hollow ? 0 : 1) < n; ++i)
      for (std::size_t j = 0; j < static_cast<std::size_t>(around); ++j) {
        const auto &here = at[i], &next = at[(i + 1) % n];
        const std::size_t on = (j + 1) % static_cast<std::size_t>(around);
        const Triangle first{here[j], here[on], next[on]}, second{here[j], next[on], next[j]};
        for (const Triangle& t : {first, second})
          if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
      }
    return mesh;
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

Vec3 normal_of(const Mesh& mesh, const Triangle& t) {
  Vec3 n = cross(minus(mesh.at(t[1]), mesh.at(t[0])), minus(mesh.at(t[2]), mesh.at(t[0])));
  const double size = length(n);
  for (double& c : n) c /= size > 0 ? size : 1;
  return n;
}

/// Joints of all edges, and the pieces that smooth ones hold together.
void join(const Mesh& mesh, Outline& out) {
  struct Side {
    std::size_t facet, opposite;
  };
  std::map<std::pair<int, int>, std::vector<Side>> edges;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = mesh.triangles[f];
      edges[std::minmax(t[(k + 1) % 3], t[(k + 2) % 3])].push_back({f, k});
    }
  std::vector<std::vector<std::size_t>> beside(mesh.triangles.size());
  for (const auto& [edge, sides] : edges) {
    Joint joint = Joint::convex;  // also where more than two meet
    if (sides.size() == 2) {
      const Triangle &a = mesh.triangles[sides[0].facet], &b = mesh.triangles[sides[1].facet];
      const Vec3 na = normal_of(mesh, a), nb = normal_of(mesh, b);
      const double turning = std::atan2(length(cross(na, nb)), dot(na, nb));
      const bool out_of_a = dot(na, minus(mesh.at(b[sides[1].opposite]), mesh.at(edge.first))) <= 0;
      joint = turning <= kCrease ? Joint::smooth : out_of_a ? Joint::convex : Joint::reentrant;
      if (joint == Joint::smooth) {
        beside[sides[0].facet].push_back(sides[1].facet);
        beside[sides[1].facet].push_back(sides[0].facet);
      }
    }
    for (const Side& side : sides) out.facets[side.facet].joint[side.opposite] = joint;
  }
  for (auto& facet : out.facets) facet.piece = -1;
  for (std::size_t f = 0; f < out.facets.size(); ++f) {
    if (out.facets[f].piece >= 0) continue;
    std::vector<std::size_t> reached{f};
    out.facets[f].piece = out.pieces;
    while (!reached.empty()) {
      const std::size_t one = reached.back();
      reached.pop_back();
      for (const std::size_t next : beside[one]) {
        if (out.facets[next].piece >= 0) continue;
        out.facets[next].piece = out.pieces;
        reached.push_back(next);
      }
    }
    ++out.pieces;
  }
}

}  // namespace

Outline solid_outline(const Shape& shape, double spacing) {
  const Mesh mesh = std::visit(Solid{spacing}, shape);
  Outline out;
  out.points = mesh.points;
  for (const Triangle& t : mesh.triangles) out.facets.push_back({{t[0], t[1], t[2]}, {}, 0});
  join(mesh, out);
  return out;
}

}  // namespace mpmfast
