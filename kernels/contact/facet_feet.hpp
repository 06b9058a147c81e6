#pragma once

/// @file Where a point lies over or under a facet of a surface (K24 §3.5, 3.6). Theory:
/// tools/manual/theory.md, "Penalty contact".

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// Where a point is over or under a facet.
template <int Dim>
struct Foot {
  double distance;    ///< m, ≥ 0
  bool below;         ///< the facet's foot lies within it, and the point on the inner side
  bool clipped;       ///< the foot is at a crease: the nearest of the piece
  bool convex;        ///< this crease sticks out
  Vec<Dim> exit;      ///< unit, from the point to its foot: the way out of what is below
  double share[Dim];  ///< of the facet's points in the foot
};

/// Foot of s on a segment of which normals turn from end to end: s = x(β) + g n(β), with x and n linear in β.
/// So a point that slides from a segment to the next sees no jump, and what presses it lies in line with its
/// foot. Nothing where there is no foot, or one beyond `reach`.
/// @param ends  the piece ends at each of its ends: further out, the end itself is the nearest
inline std::optional<Foot<2>> foot_on(const Vec<2>& s, const std::array<Vec<2>, 2>& x,
                                      const std::array<Vec<2>, 2>& n, const std::array<bool, 2>& ends,
                                      double reach) {
  constexpr double kRoundOff = 1e-9;  // of β: no point falls between two segments
  const auto cross = [](const Vec<2>& u, const Vec<2>& v) { return u[0] * v[1] - u[1] * v[0]; };
  const Vec<2> a = s - x[0], t = x[1] - x[0], m = n[1] - n[0];
  // (a − β t) × (n1 + β m) = 0
  const double c0 = cross(a, n[0]), c1 = cross(a, m) - cross(t, n[0]), c2 = -cross(t, m);
  const double root = c1 * c1 - 4 * c2 * c0;
  if (!(c1 > 0) || !(root >= 0)) return std::nullopt;  // beyond the point where the normals meet
  double beta = -2 * c0 / (c1 + std::sqrt(root));
  const bool before = beta<-kRoundOff, after = beta> 1 + kRoundOff;
  if ((before && !ends[0]) || (after && !ends[1])) return std::nullopt;
  beta = std::clamp(beta, 0.0, 1.0);
  Foot<2> foot;
  foot.share[0] = 1 - beta;
  foot.share[1] = beta;
  foot.clipped = before || after;
  foot.convex = false;
  const Vec<2> way = x[0] + beta * t - s;
  foot.distance = way.norm();
  if (!(foot.distance <= reach)) return std::nullopt;
  const Vec<2> normal = (n[0] + beta * m).normalized();
  foot.below = !foot.clipped && way.dot(normal) > 0;
  foot.exit = foot.clipped && foot.distance > 0 ? Vec<2>(way / foot.distance) : normal;
  return foot;
}

namespace detail {

/// Share of the end b in the point of a b that is nearest to s.
inline double along_edge(const Vec<3>& s, const Vec<3>& a, const Vec<3>& b) {
  const Vec<3> edge = b - a;
  return std::clamp((s - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
}

}  // namespace detail

/// The same on a triangle, whose normals turn from corner to corner: Newton for β and g from the foot on its
/// plane.
/// @param ends  the piece ends at the edge opposite each corner
inline std::optional<Foot<3>> foot_on(const Vec<3>& s, const std::array<Vec<3>, 3>& x,
                                      const std::array<Vec<3>, 3>& n, const std::array<bool, 3>& ends,
                                      double reach) {
  constexpr double kRoundOff = 1e-9;
  constexpr int kPasses = 8;
  const Vec<3> u = x[1] - x[0], v = x[2] - x[0], up = u.cross(v), a = s - x[0];
  const double twice = up.squaredNorm(), size = std::sqrt(twice), height = a.dot(up) / size;
  if (!(std::abs(height) <= reach)) return std::nullopt;
  Vec<3> unknown(a.cross(v).dot(up) / twice, u.cross(a).dot(up) / twice, height);  // β_1, β_2, g
  const Vec<3> turn_u = n[1] - n[0], turn_v = n[2] - n[0];
  for (int pass = 0; pass < kPasses; ++pass) {
    const Vec<3> normal = n[0] + unknown[0] * turn_u + unknown[1] * turn_v;
    const Vec<3> rest = a - unknown[0] * u - unknown[1] * v - unknown[2] * normal;
    if (rest.squaredNorm() <= 1e-26 * size) break;
    const Vec<3> by_u = u + unknown[2] * turn_u, by_v = v + unknown[2] * turn_v;
    const double whole = by_u.cross(by_v).dot(normal);
    if (!(whole > 1e-3 * size)) return std::nullopt;  // near where the normals meet
    unknown +=
        Vec<3>(rest.cross(by_v).dot(normal), by_u.cross(rest).dot(normal), by_u.cross(by_v).dot(rest)) /
        whole;
  }
  Foot<3> foot;
  foot.share[1] = unknown[0];
  foot.share[2] = unknown[1];
  foot.share[0] = 1 - unknown[0] - unknown[1];
  foot.clipped = foot.convex = false;
  bool beyond = false;
  double nearest = std::numeric_limits<double>::infinity();
  double clipped[3];
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(foot.share[k] < -kRoundOff)) continue;
    beyond = true;
    if (!ends[k]) continue;  // a neighbour has it
    const std::size_t b = (k + 1) % 3, c = (k + 2) % 3;
    const double share = detail::along_edge(s, x[b], x[c]);
    const double distance = (x[b] + share * (x[c] - x[b]) - s).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    foot.clipped = true;
    clipped[k] = 0;
    clipped[b] = 1 - share;
    clipped[c] = share;
  }
  if (beyond && !foot.clipped) return std::nullopt;
  if (foot.clipped) std::copy(clipped, clipped + 3, foot.share);
  Vec<3> way = -s, normal = Vec<3>::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    way += foot.share[k] * x[k];
    normal += foot.share[k] * n[k];
  }
  foot.distance = way.norm();
  if (!(foot.distance <= reach)) return std::nullopt;
  normal.normalize();
  foot.below = !foot.clipped && way.dot(normal) > 0;
  foot.exit = foot.clipped && foot.distance > 0 ? Vec<3>(way / foot.distance) : normal;
  return foot;
}

}  // namespace mpmfast
