#pragma once

/// @file A crack behind one of its ends.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// In axes out of the crack at its end and to the left of that: the end is the origin.
class TipPath {
 public:
  /// @param points  of the crack from its end on, m; two or more
  /// @param radius  how far from the end it is asked, m
  /// @param blur    over which corners count as bends, m
  TipPath(std::vector<Vec<2>> points, double radius, double blur)
      : points_(std::move(points)), step_(radius / kSteps) {
    for (int k = 0; k <= kSteps + 1; ++k)
      along_[static_cast<std::size_t>(k)] = (at(step_ * k - blur) - at(step_ * k + blur)).normalized();
  }

  /// Unit vector towards the end, of the crack where it is so far from it.
  Vec<2> along(double r) const {
    const auto [k, share] = place(r);
    return (1 - share) * along_[k] + share * along_[k + 1];
  }
  /// d(along)/dr, 1/m
  Vec<2> bend(double r) const {
    const auto k = place(r).first;
    return (along_[k + 1] - along_[k]) / step_;
  }

  struct Beside {
    double behind;  ///< from the end back along the crack to what is nearest, m; infinite: that is the end
    double offset;  ///< from there, positive on the left, m
    Vec<2> left;    ///< unit normal there
  };
  Beside beside(const Vec<2>& x) const {
    Beside nearest{HUGE_VAL, 0, Vec<2>::Zero()};
    double least = HUGE_VAL, before = 0;
    for (std::size_t k = 1; k < points_.size() && before < 2 * kSteps * step_; ++k) {
      const Vec<2> way = points_[k] - points_[k - 1];
      const double length = way.norm(), share = (x - points_[k - 1]).dot(way) / (length * length);
      const double held = std::clamp(share, 0.0, 1.0);
      const double far = (x - points_[k - 1] - held * way).squaredNorm();
      if (far < least) {
        const Vec<2> left = Vec<2>(way[1], -way[0]) / length;  // of the way back
        least = far;
        nearest = {k == 1 && share < 0 ? HUGE_VAL : before + held * length, (x - points_[k - 1]).dot(left),
                   left};
      }
      before += length;
    }
    return nearest;
  }

 private:
  static constexpr int kSteps = 64;

  std::pair<std::size_t, double> place(double r) const {
    const double at = std::min(r / step_, kSteps + 0.5);
    const auto k = static_cast<std::size_t>(at);
    return {k, at - static_cast<double>(k)};
  }
  /// Where the crack is so far from its end; straight on beyond what is known of it, and ahead.
  Vec<2> at(double r) const {
    if (r <= 0) return Vec<2>(-r, 0);
    std::size_t k = 1;
    while (k + 1 < points_.size() && points_[k].norm() < r) ++k;
    const double from = points_[k - 1].norm(), to = points_[k].norm();
    const double share = to > from ? (r - from) / (to - from) : 1;
    return points_[k - 1] + share * (points_[k] - points_[k - 1]);
  }

  std::vector<Vec<2>> points_;
  double step_;
  std::array<Vec<2>, kSteps + 2> along_;
};

}  // namespace mpmfast
