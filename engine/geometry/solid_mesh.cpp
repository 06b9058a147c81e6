#include "engine/geometry/solid_mesh.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace mpmfast::solid_mesh {

namespace {

/// Longest edge that refine() leaves, spacings: about √2, so that edges are between 0.7 and 1.4 spacings.
constexpr double kLongestEdge = 1.4;

/// Inverse distance by which points of the unit sphere are distinguished, –. Range: above the number of
/// points along an edge, below 1e15.
constexpr double kPointsApart = 1e9;

/// Midpoints of the edges that are too long, by their ends. Both triangles at an edge get the same point.
class Midpoints {
 public:
  Midpoints(Mesh& mesh, double longest) : mesh_(mesh), longest_(longest) {}

  /// @return −1 where the edge is short enough
  int of(int a, int b) {
    const auto key = std::minmax(a, b);
    const auto known = middle_.find(key);
    if (known != middle_.end()) return known->second;
    const Vec3 &x = mesh_.at(key.first), &y = mesh_.at(key.second);
    int out = -1;
    if (length(minus(y, x)) > longest_)
      out = mesh_.add({0.5 * (x[0] + y[0]), 0.5 * (x[1] + y[1]), 0.5 * (x[2] + y[2])});
    return middle_[key] = out;
  }

 private:
  Mesh& mesh_;
  double longest_;
  std::map<std::pair<int, int>, int> middle_;
};

/// Divides a triangle. @param middle  of the edges t[k] t[k + 1]; −1: not divided
void divide(const Triangle& t, const std::array<int, 3>& middle, std::vector<Triangle>& out) {
  const auto count = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
  if (count == 0) out.push_back(t);
  if (count == 3) {
    for (std::size_t k = 0; k < 3; ++k) out.push_back({t[k], middle[k], middle[(k + 2) % 3]});
    out.push_back(middle);
  }
  for (std::size_t k = 0; k < 3 && count == 1; ++k)
    if (middle[k] >= 0) {
      out.push_back({t[k], middle[k], t[(k + 2) % 3]});
      out.push_back({middle[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  for (std::size_t k = 0; k < 3 && count == 2; ++k)
    if (middle[k] < 0) {  // t[k + 2] is between the divided edges
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const int bc = middle[(k + 1) % 3], ca = middle[(k + 2) % 3];
      out.push_back({ca, bc, c});
      out.push_back({a, b, bc});
      out.push_back({a, bc, ca});
    }
}

/// Triangulates a simple polygon, counter-clockwise, by clipping ears.
std::vector<Triangle> clip_ears(const Points2& points) {
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
    if (ear == n) ear = 0;  // without an ear only by round-off
    out.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  out.push_back({left[0], left[1], left[2]});
  return out;
}

}  // namespace

void refine(Mesh& mesh, double spacing) {
  for (bool divided = true; divided;) {
    divided = false;
    Midpoints midpoints(mesh, kLongestEdge * spacing);
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      std::array<int, 3> middle;
      for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = midpoints.of(t[k], t[(k + 1) % 3]);
        divided |= middle[k] >= 0;
      }
      divide(t, middle, finer);
    }
    mesh.triangles = std::move(finer);
  }
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
  for (const Triangle& t : clip_ears(base)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  return mesh;
}

Mesh unit_sphere(long n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vec3> corner{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr std::array<Triangle, 20> kFaces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
  Mesh mesh;
  std::map<std::array<long, 3>, int> known;  // adjacent faces share the points of their edge
  const auto point = [&](Vec3 x) {
    const double size = length(x);
    for (double& c : x) c /= size;
    const std::array<long, 3> key{std::lround(x[0] * kPointsApart), std::lround(x[1] * kPointsApart),
                                  std::lround(x[2] * kPointsApart)};
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

}  // namespace mpmfast::solid_mesh
