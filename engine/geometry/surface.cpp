#include "engine/geometry/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mpmfast {

namespace {

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Bounds bounds_of(const std::vector<Vec3>& points) {
  Bounds box;
  if (points.empty()) return box;
  box = {points[0], points[0]};
  for (const Vec3& point : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.lower[k] = std::min(box.lower[k], point[k]);
      box.upper[k] = std::max(box.upper[k], point[k]);
    }
  }
  return box;
}

std::string text_of(const Vec3& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point[0], point[1], point[2]);
}

/// How often an edge is passed from its lower point to its higher one, less the other way.
struct Edge {
  std::uint32_t from, to;
  int upwards;
};

/// Does the half-line from (y, z) towards +y meet the edge a → b of the plane? +1 where it rises, −1 where it
/// falls. An edge is taken from its lower end whichever way it is passed, so that the two triangles beside it
/// round alike and no line slips between them.
int passes(const Vec3& a, const Vec3& b, double y, double z) {
  const bool rising = a[2] < b[2];
  const Vec3& low = rising ? a : b;
  const Vec3& high = rising ? b : a;
  if (!(low[2] <= z && z < high[2])) return 0;
  const double left_of = (y - low[1]) * (high[2] - low[2]) - (z - low[2]) * (high[1] - low[1]);
  if (!(left_of < 0)) return 0;
  return rising ? 1 : -1;
}

/// Where the line along x through (y, z), which passes the triangle, meets its plane. A plane (nearly) along
/// x is met somewhere in the triangle.
double height_at(const Vec3& a, const Vec3& b, const Vec3& c, double y, double z) {
  const Vec3 normal = cross(minus(b, a), minus(c, a));
  const auto [least, most] = std::minmax({a[0], b[0], c[0]});
  const double x = a[0] - (normal[1] * (y - a[1]) + normal[2] * (z - a[2])) / normal[0];
  return std::isfinite(x) ? std::clamp(x, least, most) : least;
}

}  // namespace

double enclosed_volume(const std::vector<Vec3>& points, const std::vector<Surface::Triangle>& triangles) {
  double six_volumes = 0;
  for (const auto& [i, j, k] : triangles) {  // from one corner of the body, or far from zero all digits go
    const Vec3 a = minus(points[i], points[0]), b = minus(points[j], points[0]),
               c = minus(points[k], points[0]);
    six_volumes += dot(a, cross(b, c));
  }
  return six_volumes / 6;
}

std::string Surface::fault(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return "no triangles";
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  struct {
    std::size_t count = 0;
    Edge first{};
  } open, turned;
  for (std::size_t k = 0; k < edges.size();) {
    const Edge& edge = edges[k];
    std::size_t count = 0;
    int upwards = 0;
    for (; k < edges.size() && edges[k].from == edge.from && edges[k].to == edge.to; ++k, ++count)
      upwards += edges[k].upwards;
    if (upwards == 0) continue;
    auto& kind = count % 2 == 0 ? turned : open;
    if (kind.count++ == 0) kind.first = edge;
  }
  if (open.count > 0)
    return fmt::format("not a closed surface: {} edges have no second triangle, the first from {} to {}",
                       open.count, text_of(points[open.first.from]), text_of(points[open.first.to]));
  if (turned.count > 0)
    return fmt::format("{} edges have triangles that face different ways, the first from {} to {}",
                       turned.count, text_of(points[turned.first.from]), text_of(points[turned.first.to]));
  const Bounds box = bounds_of(points);
  double of_box = 1;
  for (std::size_t k = 0; k < 3; ++k) of_box *= box.upper[k] - box.lower[k];
  constexpr double kLeast = 1e-12;  // of the box around: 1e5 triangles round by less
  if (!(std::abs(enclosed_volume(points, triangles)) > kLeast * of_box) || !std::isfinite(of_box))
    return "the surface encloses no volume";
  return "";
}

Surface::Surface(std::vector<Vec3> points, std::vector<Triangle> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)), bounds_(bounds_of(points_)) {
  sort_into_buckets();
}

Surface Surface::placed(double scale, const Vec3& axis, double angle, const Vec3& translate) const {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  std::vector<Vec3> points = points_;
  for (Vec3& point : points) {
    const Vec3 across = cross(axis, point);
    const double along = dot(axis, point);
    for (std::size_t k = 0; k < 3; ++k) {  // Rodrigues; without an angle the point is kept to the bit
      const double turned =
          angle == 0 ? point[k] : cosine * point[k] + sine * across[k] + (1 - cosine) * along * axis[k];
      point[k] = scale * turned + translate[k];
    }
  }
  return Surface(std::move(points), triangles_);
}

std::size_t Surface::bucket_at(double y, double z) const {
  const auto along = [&](std::size_t axis, double at) {
    const double lower = bounds_.lower[axis], extent = bounds_.upper[axis] - lower;
    const auto count = static_cast<double>(buckets_[axis - 1]);
    const double share = extent > 0 ? (at - lower) / extent * count : 0;
    return share > 0 ? static_cast<std::size_t>(std::min(share, count - 1)) : 0;  // 0 for not a number too
  };
  return along(2, z) * buckets_[0] + along(1, y);
}

void Surface::sort_into_buckets() {
  const auto for_each_listing = [&](const auto& f) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Vec3 &a = points_[triangles_[t][0]], &b = points_[triangles_[t][1]],
                 &c = points_[triangles_[t][2]];
      const auto [low_y, high_y] = std::minmax({a[1], b[1], c[1]});
      const auto [low_z, high_z] = std::minmax({a[2], b[2], c[2]});
      const std::size_t first = bucket_at(low_y, low_z), last = bucket_at(high_y, high_z);
      f(t, first, last);
    }
  };
  const auto columns = [&](std::size_t first, std::size_t last) {
    return last % buckets_[0] - first % buckets_[0] + 1;
  };
  // About as many buckets as triangles, fewer where long triangles would be listed in very many.
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles_.size()))) + 1;
  buckets_ = {side, side};
  for (;; buckets_ = {(buckets_[0] + 1) / 2, (buckets_[1] + 1) / 2}) {
    std::size_t listings = 0;
    for_each_listing([&](std::size_t, std::size_t first, std::size_t last) {
      listings += columns(first, last) * (last / buckets_[0] - first / buckets_[0] + 1);
    });
    if (listings <= 16 * triangles_.size() || buckets_[0] == 1) break;
  }
  first_.assign(buckets_[0] * buckets_[1] + 1, 0);
  const auto for_each_bucket = [&](const auto& f) {
    for_each_listing([&](std::size_t t, std::size_t first, std::size_t last) {
      for (std::size_t row = first; row <= last; row += buckets_[0])
        for (std::size_t k = 0; k < columns(first, last); ++k) f(t, row + k);
    });
  };
  for_each_bucket([&](std::size_t, std::size_t bucket) { ++first_[bucket + 1]; });
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  listed_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each_bucket(
      [&](std::size_t t, std::size_t bucket) { listed_[next[bucket]++] = static_cast<std::uint32_t>(t); });
}

void Surface::crossings(double y, double z, std::vector<Crossing>& out) const {
  out.clear();
  if (!(y >= bounds_.lower[1] && y <= bounds_.upper[1] && z >= bounds_.lower[2] && z <= bounds_.upper[2]))
    return;
  const std::size_t bucket = bucket_at(y, z);
  for (std::size_t k = first_[bucket]; k < first_[bucket + 1]; ++k) {
    const Triangle& t = triangles_[listed_[k]];
    const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    // The winding of the triangle's outline, seen against x, round the line: over a closed surface every edge
    // counts once each way, so all windings sum to zero whatever was rounded.
    const int winding = passes(a, b, y, z) + passes(b, c, y, z) + passes(c, a, y, z);
    if (winding != 0) out.push_back({height_at(a, b, c, y, z), -winding});
  }
  std::sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
}

bool wound_round(std::span<const Crossing> crossings, double x) {
  int winding = 0;
  for (const Crossing& crossing : crossings) {
    if (crossing.x > x) break;
    winding += crossing.winding;
  }
  return winding != 0;
}

}  // namespace mpmfast
