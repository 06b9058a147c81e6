#include "engine/geometry/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/outline_bitmap.hpp"
#include "engine/geometry/outline_solid.hpp"

namespace mpmfast {

namespace {

using Point = std::array<double, 2>;
using Loop = std::vector<Point>;  ///< counter-clockwise about the material

/// Least segments of a quarter of an ellipse, –: the coarsest outline is an octagon.
constexpr long kLeastPerQuarter = 2;

double length(const Point& a, const Point& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

double signed_area(const Loop& loop) {
  double twice = 0;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
    twice += loop[j][0] * loop[i][1] - loop[i][0] * loop[j][1];
  return 0.5 * twice;
}

/// Divides the edges of a polygon into equal segments of about `spacing`.
Loop divide_edges(Loop corners, double spacing) {
  if (signed_area(corners) < 0) std::reverse(corners.begin(), corners.end());
  Loop loop;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const long count = std::max(std::lround(length(a, b) / spacing), 1L);
    for (long k = 0; k < count; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(count);
      loop.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
    }
  }
  return loop;
}

/// Equidistant points of an ellipse, equally many in each quarter.
Loop ellipse(const EllipsoidShape& shape, double spacing) {
  constexpr long kSteps = 4096;  // per quarter, for the arc length: a circle has it to 1e-8
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto at = [&](double t) { return Point{shape.radii[0] * std::cos(t), shape.radii[1] * std::sin(t)}; };
  std::vector<double> path{0};
  for (long k = 1; k <= kSteps; ++k)
    path.push_back(path.back() + length(at(kQuarter * static_cast<double>(k - 1) / kSteps),
                                        at(kQuarter * static_cast<double>(k) / kSteps)));
  const long quarter = std::max(std::lround(path.back() / spacing), kLeastPerQuarter);
  std::vector<double> angle;  // parameters of the points in the first quarter
  for (long k = 0; k < quarter; ++k) {
    const double wanted = path.back() * static_cast<double>(k) / static_cast<double>(quarter);
    const auto next =
        std::max<std::ptrdiff_t>(std::upper_bound(path.begin(), path.end(), wanted) - path.begin(), 1);
    const auto before = static_cast<std::size_t>(next - 1);
    const double share = (wanted - path[before]) / (path[before + 1] - path[before]);
    angle.push_back(shape.radii[0] == shape.radii[1]
                        ? kQuarter * static_cast<double>(k) / static_cast<double>(quarter)
                        : kQuarter * (static_cast<double>(before) + share) / kSteps);
  }
  const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
  Loop loop;
  for (int q = 0; q < 4; ++q)
    for (long k = 0; k < quarter; ++k) {
      // Quarters are mirrored, so that the outline has the symmetry of the shape.
      const bool back = q % 2 == 1;
      if (back && k == 0) {
        loop.push_back(at(kQuarter * q));
      } else {
        const double t = angle[static_cast<std::size_t>(back ? quarter - k : k)];
        loop.push_back(at(q == 0   ? t
                          : q == 1 ? 2 * kQuarter - t
                          : q == 2 ? 2 * kQuarter + t
                                   : 4 * kQuarter - t));
      }
    }
  for (Point& p : loop)
    p = {shape.centre[0] + cosine * p[0] - sine * p[1], shape.centre[1] + sine * p[0] + cosine * p[1]};
  return loop;
}

Loop circle(const Vec3& centre, double radius, double spacing) {
  return ellipse(EllipsoidShape{centre, {radius, radius, 0}, 0}, spacing);
}

/// Makes the loops of a plane shape.
struct Loops {
  double spacing;  ///< m

  std::vector<Loop> operator()(const BoxShape& box) const {
    const Vec3 &a = box.lower, &b = box.upper;
    return {divide_edges({{a[0], a[1]}, {b[0], a[1]}, {b[0], b[1]}, {a[0], b[1]}}, spacing)};
  }
  std::vector<Loop> operator()(const EllipsoidShape& shape) const { return {ellipse(shape, spacing)}; }
  std::vector<Loop> operator()(const RingShape& ring) const {
    std::vector<Loop> loops{circle(ring.centre, ring.outer, spacing)};
    if (ring.inner > 0) {
      loops.push_back(circle(ring.centre, ring.inner, spacing));
      std::reverse(loops.back().begin(), loops.back().end());
    }
    return loops;
  }
  std::vector<Loop> operator()(const PolygonShape& polygon) const {
    return {divide_edges(polygon.points, spacing)};
  }
  std::vector<Loop> operator()(const BitmapShape& bitmap) const { return bitmap_loops(bitmap, spacing); }
  std::vector<Loop> operator()(const StlShape&) const { return {}; }
};

/// The joint at b between the segments from a and to c.
Joint joint_at(const Point& a, const Point& b, const Point& c) {
  const double u = b[0] - a[0], v = b[1] - a[1], x = c[0] - b[0], y = c[1] - b[1];
  const double turning = std::atan2(u * y - v * x, u * x + v * y);
  return std::abs(turning) <= kCrease ? Joint::smooth : turning > 0 ? Joint::convex : Joint::reentrant;
}

/// Appends a loop. Facets begin behind a crease, where there is one, so that no patch is in two parts.
void add_loop(const Loop& loop, Outline& out) {
  const std::size_t n = loop.size();
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < n; ++i)
    joints.push_back(joint_at(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]));
  const auto crease = std::find_if(joints.begin(), joints.end(), [](Joint j) { return j != Joint::smooth; });
  const auto first = static_cast<std::size_t>(crease - joints.begin()) % n;
  const int base = static_cast<int>(out.points.size());
  for (const Point& p : loop) out.points.push_back({p[0], p[1], 0});
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (k + first) % n, j = (i + 1) % n;
    if (k > 0 && joints[i] != Joint::smooth) ++out.patches;
    out.facets.push_back(
        {{base + static_cast<int>(i), base + static_cast<int>(j), -1}, {joints[i], joints[j]}, out.patches});
  }
  ++out.patches;
}

}  // namespace

double plane_area(const Outline& outline) {
  double twice = 0;
  for (const Outline::Facet& facet : outline.facets) {
    const Vec3 &a = outline.points[static_cast<std::size_t>(facet.point[0])],
               &b = outline.points[static_cast<std::size_t>(facet.point[1])];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return 0.5 * twice;
}

Outline outline(const Shape& shape, double spacing, int dimension) {
  if (dimension == 3) return solid_outline(shape, spacing);
  Outline out;
  for (const Loop& loop : std::visit(Loops{spacing}, shape)) add_loop(loop, out);
  return out;
}

}  // namespace mpmfast
