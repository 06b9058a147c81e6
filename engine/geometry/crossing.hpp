#pragma once

/// @file Lines in the plane that cross: which side of a crack is a point on, seen from another?

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/simd/lanes.hpp"

namespace mpmfast {

using Point2 = std::array<double, 2>;

/// u × v, zero where both products are the same number: no compiler may round them apart by fusing one with
/// the difference.
template <class U, class V>
inline auto turn(U u_x, U u_y, V v_x, V v_y) {
  auto ahead = u_x * v_y;
  auto back = u_y * v_x;
#if __has_builtin(__builtin_assoc_barrier)
  ahead = __builtin_assoc_barrier(ahead);
  back = __builtin_assoc_barrier(back);
#endif
  return ahead - back;
}

/// Twice the area of the triangle a, b, c: positive where c lies on the left of a → b.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
  return turn(b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
}

/// Of a point on the line a → b.
inline bool is_left_of_own(const Point2& a, const Point2& b) {
  return a[1] != b[1] ? b[1] < a[1] : b[0] > a[0];
}

/// Is a point on the left of a → b? One on the line itself counts as if it lay a little to the right of where
/// it is, and hardly above: the same whatever segment asks.
inline bool is_left(const Point2& a, const Point2& b, const Point2& x) {
  const double side = turn(a, b, x);
  return side != 0 ? side > 0 : is_left_of_own(a, b);
}

/// The straight lines from one point to many ends. Which of them cross a segment a → b, and to which side?
/// Where an end lies on the line a b, or a line meets an end of the segment, the end is shifted as in
/// is_left. A line through a corner of a polyline thus crosses one segment, never none or two, whatever the
/// round-off. Results have a bit for each end, in the order in which they were added.
class LineCrossings {
 public:
  static constexpr int kMost = 40;  ///< ends
  using Bits = std::uint64_t;

  void start(const Point2& from) {
    from_ = from;
    count_ = 0;
  }
  void add(const Point2& to) {
    assert(count_ < kMost);
    x_[count_] = to[0];
    y_[count_++] = to[1];
  }

  /// Is x on the left of the line?
  Bits point_is_left(const Point2& x) const {
    const bool on = x[1] != from_[1] ? x[1] > from_[1] : x[0] <= from_[0];
    const double along = x[0] - from_[0], up = x[1] - from_[1];
    return bits([&](Lanes to_x, Lanes to_y) { return turn(to_x - from_[0], to_y - from_[1], along, up); },
                on);
  }
  /// The ends of the lines, relative to a segment.
  struct Ends {
    Bits other_side;  ///< not on the side of a b where the lines start
    Bits left;        ///< on the left of a b
  };
  Ends ends(const Point2& a, const Point2& b) const {
    const double along = b[0] - a[0], up = b[1] - a[1];
    const Bits left =
        bits([&](Lanes x, Lanes y) { return turn(along, up, x - a[0], y - a[1]); }, is_left_of_own(a, b));
    return {is_left(a, b, from_) ? ~left & all() : left, left};
  }

 private:
  Bits all() const { return (Bits{1} << count_) - 1; }
  /// Where a value is positive, or zero and zeros count.
  template <class F>
  Bits bits(const F& value, bool zeros) const {
    const double least = zeros ? 0 : std::numeric_limits<double>::denorm_min();
    Bits sum = 0;
    for (int k = 0; k < count_; k += kLanes)
      sum |= Bits{bits_of(value(load_lanes(x_ + k), load_lanes(y_ + k)) >= least)} << k;
    return sum & all();
  }

  Point2 from_{};
  int count_ = 0;
  alignas(64) double x_[kMost] = {}, y_[kMost] = {};
};

/// Does the line from p to n cross the segment a → b? +1: to its left, −1: to its right, 0: no.
inline int crossing(const Point2& p, const Point2& n, const Point2& a, const Point2& b) {
  LineCrossings line;
  line.start(p);
  line.add(n);
  if (line.point_is_left(a) == line.point_is_left(b)) return 0;
  const auto [other_side, left] = line.ends(a, b);
  return other_side == 0 ? 0 : left != 0 ? 1 : -1;
}

/// Has an open polyline two segments that cross, or touch elsewhere than neighbours do?
bool crosses_itself(const std::vector<Point2>& points);

}  // namespace mpmfast
