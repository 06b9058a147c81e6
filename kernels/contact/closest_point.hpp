#pragma once

/// @file Closest-point projection of a point s onto a facet (K24 §3.5, 3.6).
///
/// A facet has corners x_c and unit vectors n_c there, the normals of the surface. Both are interpolated with
/// weights β_c that sum to 1: x(β) = Σ β_c x_c and n(β) = Σ β_c n_c. The closest point x(β) solves
/// s = x(β) + g n(β). Its location is continuous across the facets of a patch, because neighbours share n_c.
/// The line from s to x(β) is parallel to n(β), so a force along it has no moment about x(β).
/// Theory: tools/manual/theory.md, "Penalty contact".

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kernels/constants.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// Result of a projection.
template <int Dim>
struct ClosestPoint {
  double distance;          ///< from s to the closest point, m, ≥ 0
  bool inside;              ///< the closest point is in the facet, and s on the inner side
  bool at_crease;           ///< the closest point is on a crease that s lies beyond
  bool convex;              ///< this crease is convex; false here, for the caller to set
  Vec<Dim> exit_direction;  ///< unit, from s to the closest point: the way out of the body
  double weight[Dim];       ///< β_c of the corners
};

namespace closest_point {

inline double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The projection with given weights.
/// @param to_surface  from s to the closest point, m
/// @param normal      n(β), of any length
/// @return nothing if the distance exceeds `reach`
template <int Dim>
std::optional<ClosestPoint<Dim>> make(const double (&weight)[Dim], bool at_crease, const Vec<Dim>& to_surface,
                                      const Vec<Dim>& normal, double reach) {
  const double distance = to_surface.norm();
  if (!(distance <= reach)) return std::nullopt;
  const Vec<Dim> unit = normal.normalized();
  ClosestPoint<Dim> out;
  out.distance = distance;
  out.inside = !at_crease && to_surface.dot(unit) > 0;
  out.at_crease = at_crease;
  out.convex = false;
  out.exit_direction = at_crease && distance > 0 ? Vec<Dim>(to_surface / distance) : unit;
  std::copy(weight, weight + Dim, out.weight);
  return out;
}

/// Weight of b in the point of the edge from a to b that is closest to s.
inline double weight_on_edge(const Vec<3>& s, const Vec<3>& a, const Vec<3>& b) {
  const Vec<3> edge = b - a;
  return std::clamp((s - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
}

/// Newton's iteration for (β_1, β_2, g) of a triangle, from the projection onto its plane.
/// @return nothing if s is farther than `reach` from the plane, or near where the normals meet
inline std::optional<Vec<3>> solve_on_triangle(const Vec<3>& s, const std::array<Vec<3>, 3>& corner,
                                               const std::array<Vec<3>, 3>& normal, double reach) {
  const Vec<3> u = corner[1] - corner[0], v = corner[2] - corner[0], up = u.cross(v), a = s - corner[0];
  const double squared = up.squaredNorm(), twice_area = std::sqrt(squared), height = a.dot(up) / twice_area;
  if (!(std::abs(height) <= reach)) return std::nullopt;
  Vec<3> unknown(a.cross(v).dot(up) / squared, u.cross(a).dot(up) / squared, height);
  const Vec<3> change_u = normal[1] - normal[0], change_v = normal[2] - normal[0];
  for (int pass = 0; pass < constants::kProjectionIterations; ++pass) {
    const Vec<3> n = normal[0] + unknown[0] * change_u + unknown[1] * change_v;
    const Vec<3> residual = a - unknown[0] * u - unknown[1] * v - unknown[2] * n;
    if (residual.squaredNorm() <= constants::kSquaredResidual * twice_area) break;
    const Vec<3> by_u = u + unknown[2] * change_u, by_v = v + unknown[2] * change_v;
    const double jacobian = by_u.cross(by_v).dot(n);
    if (!(jacobian > constants::kLeastJacobian * twice_area)) return std::nullopt;
    unknown +=
        Vec<3>(residual.cross(by_v).dot(n), by_u.cross(residual).dot(n), by_u.cross(by_v).dot(residual)) /
        jacobian;
  }
  return unknown;
}

/// Weights of the point closest to s on those creases of a triangle that s lies beyond.
/// @param weight      those of the projection onto the unbounded facet
/// @param patch_ends  by corner: the edge opposite it is a crease
/// @return nothing if s lies beyond edges that are no crease: a neighbour has its projection
inline std::optional<std::array<double, 3>> clip_to_creases(const Vec<3>& s,
                                                            const std::array<Vec<3>, 3>& corner,
                                                            const double (&weight)[3],
                                                            const std::array<bool, 3>& patch_ends) {
  std::optional<std::array<double, 3>> clipped;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(weight[k] < -constants::kWeightTolerance) || !patch_ends[k]) continue;
    const std::size_t b = (k + 1) % 3, c = (k + 2) % 3;
    const double on_edge = weight_on_edge(s, corner[b], corner[c]);
    const double distance = (corner[b] + on_edge * (corner[c] - corner[b]) - s).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    clipped.emplace();
    (*clipped)[k] = 0;
    (*clipped)[b] = 1 - on_edge;
    (*clipped)[c] = on_edge;
  }
  return clipped;
}

}  // namespace closest_point

/// Projection onto a segment: β solves the quadratic (s − x(β)) × n(β) = 0.
/// @param corner      ends of the segment, m; the material lies on its left
/// @param normal      unit normals of the surface at the ends
/// @param patch_ends  by end: the patch ends there, and beyond it the end itself is the closest point
/// @param reach       largest distance that counts, m
/// @return nothing where the segment has no closest point within reach
inline std::optional<ClosestPoint<2>> project_onto_facet(const Vec<2>& s, const std::array<Vec<2>, 2>& corner,
                                                         const std::array<Vec<2>, 2>& normal,
                                                         const std::array<bool, 2>& patch_ends,
                                                         double reach) {
  using closest_point::cross;
  using constants::kWeightTolerance;
  const Vec<2> a = s - corner[0], t = corner[1] - corner[0], m = normal[1] - normal[0];
  // (a − β t) × (n_0 + β m) = c0 + c1 β + c2 β²
  const double c0 = cross(a, normal[0]), c1 = cross(a, m) - cross(t, normal[0]), c2 = -cross(t, m);
  const double discriminant = c1 * c1 - 4 * c2 * c0;
  if (!(c1 > 0) || !(discriminant >= 0)) return std::nullopt;  // beyond the point where the normals meet
  double beta = -2 * c0 / (c1 + std::sqrt(discriminant));
  const bool before = beta < -kWeightTolerance;
  const bool after = beta > 1 + kWeightTolerance;
  if ((before && !patch_ends[0]) || (after && !patch_ends[1])) return std::nullopt;
  beta = std::clamp(beta, 0.0, 1.0);
  const double weight[] = {1 - beta, beta};
  const Vec<2> to_surface = corner[0] + beta * t - s;
  return closest_point::make<2>(weight, before || after, to_surface, normal[0] + beta * m, reach);
}

/// Projection onto a triangle that turns counter-clockwise seen from outside.
/// @param patch_ends  by corner: the patch ends at the edge opposite it, and beyond this edge its closest
///                    point counts; otherwise as for a segment
inline std::optional<ClosestPoint<3>> project_onto_facet(const Vec<3>& s, const std::array<Vec<3>, 3>& corner,
                                                         const std::array<Vec<3>, 3>& normal,
                                                         const std::array<bool, 3>& patch_ends,
                                                         double reach) {
  const auto solved = closest_point::solve_on_triangle(s, corner, normal, reach);
  if (!solved) return std::nullopt;
  double weight[] = {1 - (*solved)[0] - (*solved)[1], (*solved)[0], (*solved)[1]};
  const auto outside = [](double one) { return one < -constants::kWeightTolerance; };
  const bool at_crease = std::any_of(weight, weight + 3, outside);
  if (at_crease) {
    const auto clipped = closest_point::clip_to_creases(s, corner, weight, patch_ends);
    if (!clipped) return std::nullopt;
    std::copy(clipped->begin(), clipped->end(), weight);
  }
  Vec<3> to_surface = -s, n = Vec<3>::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    to_surface += weight[k] * corner[k];
    n += weight[k] * normal[k];
  }
  return closest_point::make<3>(weight, at_crease, to_surface, n, reach);
}

/// The crease that a closest point with `at_crease` lies on: the number of an end of a segment, or of the
/// corner opposite an edge of a triangle. At a corner of two creases the first counts.
template <int Dim>
std::size_t crease_of(const ClosestPoint<Dim>& found) {
  std::size_t k = 0;
  while (k + 1 < Dim && (Dim == 2 ? !(found.weight[k] > 0) : found.weight[k] != 0)) ++k;
  return k;
}

}  // namespace mpmfast
