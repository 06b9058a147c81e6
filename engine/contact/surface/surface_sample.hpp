#pragma once

/// @file Points of the surface between two bodies, found from the cloud of particles around a contact node.
///
/// A plane normal to n lies midway between the two bodies. It is cut by lines that run along the axis nearest
/// to n, three to five to the side of a cell (three or four in space), so that the cuts are about
/// constants::contact::kPointSpacing apart at most. A node takes the cuts within half a cell of itself, so
/// that neighbouring nodes share the surface among themselves. Around each cut the particles straight ahead
/// give the gap there.

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/constants.hpp"
#include "engine/contact/geometry/cloud_fit.hpp"

namespace mpmfast {

/// A point of the surface, and the gap there.
template <int Dim>
struct SampledPoint {
  Vec<Dim> offset;    ///< from the node, cells
  double separation;  ///< m, negative: overlap
};

template <int Dim>
struct SurfaceSample {
  static constexpr int kMostAcross = Dim == 2 ? 5 : 4, kMost = power(kMostAcross, Dim - 1);  ///< lines_for

  std::array<SampledPoint<Dim>, kMost> points;
  int count = 0;
};

/// A pair whose surface is sampled.
template <int Dim>
struct SampledPair {
  const CloudColumns<Dim>& cloud;
  std::pair<int, int> own, other;  ///< the particles of fields a and b in the cloud
  bool meets_rigid;                ///< field b is a rigid body
  Vec<Dim> normal;                 ///< unit, from a to b
  double cell;                     ///< m
};

/// Unit vectors along a surface.
template <int Dim>
std::array<Vec<Dim>, Dim - 1> tangents_of(const Vec<Dim>& normal) {
  if constexpr (Dim == 2) {
    return {Vec<2>(-normal[1], normal[0])};
  } else {
    int least = 0;
    for (int d = 1; d < 3; ++d)
      if (std::abs(normal[d]) < std::abs(normal[least])) least = d;
    const Vec<3> first = (Vec<3>::Unit(least) - normal[least] * normal).normalized();
    const Vec<3> second{normal[1] * first[2] - normal[2] * first[1],
                        normal[2] * first[0] - normal[0] * first[2],
                        normal[0] * first[1] - normal[1] * first[0]};
    return {first, second};
  }
}

/// How far the particles ahead of and behind x reach along n, cells.
/// @param beyond  how far their domains are widened along the surface, cells
template <Extent E, int Dim>
SupportSearch::Found reach_at(const CloudColumns<Dim>& particles, const Vec<Dim>& n, const Vec<Dim>& x,
                              double beyond) {
  const std::array<Vec<Dim>, Dim - 1> tangents = tangents_of<Dim>(n);
  SupportSearch furthest;
  for (int k = 0; k < particles.count; k += kLanes) {
    Lanes shape[shape_size<Dim>(E)], from[Dim];
    for (int e = 0; e < shape_size<Dim>(E); ++e) shape[e] = load_lanes(particles.shape[e] + k);
    Lanes ahead = extent_along<E, Dim>(shape, n);
    for (int d = 0; d < Dim; ++d) {
      const Lanes xi = load_lanes(particles.xi[d] + k);
      ahead += xi * n[d];
      from[d] = xi - x[d];
    }
    IntLanes covers = lanes_before(particles.count - k);
    for (const Vec<Dim>& t : tangents) {
      Lanes aside = from[0] * t[0];
      for (int d = 1; d < Dim; ++d) aside += from[d] * t[d];
      covers &= magnitude(aside) <= extent_along<E, Dim>(shape, t) + beyond;
    }
    furthest.take(ahead, covers);
  }
  return furthest.found();
}

/// The axis nearest to a normal, and the lines along it that a node takes.
struct Lines {
  int axis;
  int across;  ///< to the side of a cell
};

template <int Dim>
Lines lines_for(const Vec<Dim>& normal) {
  using constants::contact::kNearerAxis, constants::contact::kPointSpacing;
  int axis = 0;
  for (int d = 1; d < Dim; ++d)
    if (std::abs(normal[d]) > kNearerAxis * std::abs(normal[axis])) axis = d;
  // The largest stretch, where all axes are as near as kNearerAxis lets them be, fits in a sample.
  constexpr double kMost = SurfaceSample<Dim>::kMostAcross * kPointSpacing, kSquare = kMost * kMost;
  static_assert((Dim == 2 ? kSquare : kSquare * kSquare) >= 1 + (Dim - 1) * kNearerAxis * kNearerAxis);
  const double tilt = std::abs(normal[axis]);  // a cell of the grid has the area 1/tilt of the surface
  const double stretch = Dim == 2 ? 1 / tilt : 1 / std::sqrt(tilt);
  return {axis, static_cast<int>(std::ceil(stretch / kPointSpacing))};
}

/// The points of a pair's surface that belong to its node.
template <Extent E, int Dim>
SurfaceSample<Dim> sample_surface(const SampledPair<Dim>& pair) {
  using constants::contact::kBeyondEdge, constants::contact::kFarPoint, constants::contact::kFarOffset;
  SurfaceSample<Dim> sample;
  const Vec<Dim>& n = pair.normal;
  if (n.isZero(0)) return sample;
  const Vec<Dim> back = -n;
  const CloudColumns<Dim> own = pair.cloud.part(pair.own.first, pair.own.second - pair.own.first),
                          other = pair.cloud.part(pair.other.first, pair.other.second - pair.other.first);
  const auto front = reach_along<E>(own, n), rear = reach_along<E>(other, back);
  if (front.at < 0 || rear.at < 0 || -front.value - rear.value > kFarPoint) return sample;
  const auto [axis, across] = lines_for<Dim>(n);
  for (int line = 0; line < power(across, Dim - 1); ++line) {
    Vec<Dim> x = Vec<Dim>::Zero();
    double rest = 0.5 * (front.value - rear.value);
    for (int d = 0, digits = line; d < Dim; ++d) {
      if (d == axis) continue;
      x[d] = (digits % across + 0.5) / across - 0.5;
      digits /= across;
      rest -= n[d] * x[d];
    }
    x[axis] = rest / n[axis];
    if (!(x[axis] >= -0.5 && x[axis] < 0.5)) continue;  // another node's
    const auto ahead = reach_at<E>(own, n, x, kBeyondEdge);
    const auto behind = reach_at<E>(other, back, x, pair.meets_rigid ? 0 : kBeyondEdge);
    const double gap = -ahead.value - behind.value;
    if (ahead.at < 0 || behind.at < 0 || !(gap <= kFarPoint)) continue;
    x += (0.5 * (ahead.value - behind.value) - x.dot(n)) * n;
    if (!(x.array().abs() <= kFarOffset).all()) continue;
    sample.points[static_cast<std::size_t>(sample.count++)] = {x, gap * pair.cell};
  }
  return sample;
}

}  // namespace mpmfast
