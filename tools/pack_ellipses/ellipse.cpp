#include "tools/pack_ellipses/ellipse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mpmfast {
namespace {

struct Point {
  double x, y;
};

constexpr int kBoundary = 96;
using Boundary = std::array<Point, kBoundary>;

/// Points on the ellipse, with the rational form of the circle instead of sines.
Boundary boundary_points(const Ellipse& e) {
  Boundary points;
  constexpr int kQuarter = kBoundary / 4;
  for (int i = 0; i < kQuarter; ++i) {
    // t from 0 to √2 − 1 spans an eighth of the turn; both eighths of a quarter are mirror images.
    const double share = 2.0 * i / kQuarter, t = 0.41421356237309503 * std::min(share, 2 - share);
    double u = (1 - t * t) / (1 + t * t), v = 2 * t / (1 + t * t);
    if (share > 1) std::swap(u, v);
    for (int turn = 0; turn < 4; ++turn) {
      const double p = e.major * u, q = e.minor * v;
      points[static_cast<std::size_t>(turn * kQuarter + i)] = {e.x + e.cosine * p - e.sine * q,
                                                               e.y + e.sine * p + e.cosine * q};
      const double next = -v;
      v = u;
      u = next;
    }
  }
  return points;
}

double squared_distance(const Point& p, const Point& from, const Point& to) {
  const double ex = to.x - from.x, ey = to.y - from.y, dx = p.x - from.x, dy = p.y - from.y;
  const double along = std::clamp((dx * ex + dy * ey) / (ex * ex + ey * ey), 0.0, 1.0);
  const double rx = dx - along * ex, ry = dy - along * ey;
  return rx * rx + ry * ry;
}

}  // namespace

double Ellipse::half_width() const {
  return std::sqrt(major * major * cosine * cosine + minor * minor * sine * sine);
}

double Ellipse::half_height() const {
  return std::sqrt(major * major * sine * sine + minor * minor * cosine * cosine);
}

bool Ellipse::contains(double px, double py) const {
  const double dx = px - x, dy = py - y;
  const double u = (cosine * dx + sine * dy) / major, v = (cosine * dy - sine * dx) / minor;
  return u * u + v * v <= 1;
}

/// Stretch the plane so that a is the unit circle about 0; then b is (z − d)ᵀ M (z − d) < 1. With the
/// eigenvalues mᵢ of M and d along its axes, the two are apart iff some λ > 0 makes
///   g(λ) = λ Σ mᵢ dᵢ² / (λ + mᵢ) − λ − 1
/// positive (the pencil λA + B then has a degenerate member that separates them). g is concave and g′ convex,
/// so Newton on g′ = 0 from λ = 0 climbs to the maximum from the left.
bool disjoint(const Ellipse& a, const Ellipse& b) {
  const auto to_circle = [&](double x, double y) {
    return Point{(a.cosine * x + a.sine * y) / a.major, (a.cosine * y - a.sine * x) / a.minor};
  };
  const Point d = to_circle(b.x - a.x, b.y - a.y);
  const Point p = to_circle(b.major * b.cosine, b.major * b.sine);
  const Point q = to_circle(-b.minor * b.sine, b.minor * b.cosine);
  // M⁻¹ = p pᵀ + q qᵀ.
  const double xx = p.x * p.x + q.x * q.x, xy = p.x * p.y + q.x * q.y, yy = p.y * p.y + q.y * q.y;
  const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy), radius = std::sqrt(half * half + xy * xy);
  const double m1 = 1 / (mean + radius), m2 = 1 / (mean - radius);
  const double length2 = d.x * d.x + d.y * d.y;
  // Share of d along the longer axis of M⁻¹, from its value dᵀ M⁻¹ d.
  const double form = xx * d.x * d.x + 2 * xy * d.x * d.y + yy * d.y * d.y;
  const double first = radius > 1e-12 * mean
                           ? std::clamp((form - (mean - radius) * length2) / (2 * radius), 0.0, length2)
                           : length2;
  const double w1 = m1 * first, w2 = m2 * (length2 - first);

  double lambda = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double r1 = 1 / (lambda + m1), r2 = 1 / (lambda + m2);
    if (lambda * (w1 * r1 + w2 * r2) - lambda - 1 > 0) return true;
    const double slope = w1 * m1 * r1 * r1 + w2 * m2 * r2 * r2 - 1;
    if (slope <= 0) return false;
    const double curvature = -2 * (w1 * m1 * r1 * r1 * r1 + w2 * m2 * r2 * r2 * r2);
    const double step = -slope / curvature;
    if (step <= 1e-12 * lambda) return false;
    lambda += step;
  }
  return false;
}

double gap(const Ellipse& a, const Ellipse& b) {
  const Boundary pa = boundary_points(a), pb = boundary_points(b);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kBoundary; ++i)
    for (std::size_t j = 0; j < kBoundary; ++j) {
      least = std::min(least, squared_distance(pa[i], pb[j], pb[(j + 1) % kBoundary]));
      least = std::min(least, squared_distance(pb[i], pa[j], pa[(j + 1) % kBoundary]));
    }
  return std::sqrt(least);
}

}  // namespace mpmfast
