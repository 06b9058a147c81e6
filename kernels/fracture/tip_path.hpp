#pragma once

/// @file The path of a crack behind its tip.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/constants.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// In axes along the crack at its tip and to its left. The tip is the origin.
class TipPath {
 public:
  /// @param points     of the crack, from its tip on, m; two or more
  /// @param radius     largest distance from the tip that is evaluated, m
  /// @param smoothing  length to each side over which corners are smoothed, m
  TipPath(std::vector<Vec<2>> points, double radius, double smoothing)
      : points_(std::move(points)), step_(radius / kSteps) {
    for (int k = 0; k <= kSteps + 1; ++k)
      directions_[static_cast<std::size_t>(k)] =
          (point(step_ * k - smoothing) - point(step_ * k + smoothing)).normalized();
  }

  /// Direction of the crack where it crosses the circle of radius r around the tip: unit, towards the tip.
  Vec<2> direction(double r) const {
    const auto [k, share] = step_of(r);
    return (1 - share) * directions_[k] + share * directions_[k + 1];
  }
  /// d(direction)/dr, 1/m
  Vec<2> direction_slope(double r) const {
    const auto k = step_of(r).first;
    return (directions_[k + 1] - directions_[k]) / step_;
  }

  /// The closest-point projection on the path.
  struct Projection {
    double behind;  ///< length of the path from the tip to the closest point, m; infinite: ahead of the tip
    double offset;  ///< distance from the path, positive on the left, m
    Vec<2> left;    ///< unit normal of the path at the closest point
  };
  Projection project(const Vec<2>& x) const {
    Projection closest{HUGE_VAL, 0, Vec<2>::Zero()};
    double least = HUGE_VAL, before = 0;
    for (std::size_t k = 1; k < points_.size() && before < 2 * kSteps * step_; ++k) {
      const Vec<2> back = points_[k] - points_[k - 1];
      const double length = back.norm(), share = (x - points_[k - 1]).dot(back) / (length * length);
      const double inside = std::clamp(share, 0.0, 1.0);
      const double distance = (x - points_[k - 1] - inside * back).squaredNorm();
      if (distance < least) {
        const Vec<2> left = Vec<2>(back[1], -back[0]) / length;
        least = distance;
        closest = {k == 1 && share < 0 ? HUGE_VAL : before + inside * length, (x - points_[k - 1]).dot(left),
                   left};
      }
      before += length;
    }
    return closest;
  }

 private:
  static constexpr int kSteps = fracture_constants::kPathSteps;

  /// The step of the table in which a radius lies, and the share of the step.
  std::pair<std::size_t, double> step_of(double r) const {
    const double steps = std::min(r / step_, kSteps + 0.5);
    const auto k = static_cast<std::size_t>(steps);
    return {k, steps - static_cast<double>(k)};
  }
  /// The point of the path at a distance from the tip. The path is continued straight beyond its last point
  /// and, for a negative distance, ahead of the tip.
  Vec<2> point(double r) const {
    if (r <= 0) return Vec<2>(-r, 0);
    std::size_t k = 1;
    while (k + 1 < points_.size() && points_[k].norm() < r) ++k;
    const double from = points_[k - 1].norm(), to = points_[k].norm();
    const double share = to > from ? (r - from) / (to - from) : 1;
    return points_[k - 1] + share * (points_[k] - points_[k - 1]);
  }

  std::vector<Vec<2>> points_;
  double step_;
  std::array<Vec<2>, kSteps + 2> directions_;
};

}  // namespace mpmfast
