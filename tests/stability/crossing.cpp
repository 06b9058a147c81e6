// Ways that cross the segments of a crack, or not: in optimised builds too, which may fuse products.

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "engine/geometry/crossing.hpp"

namespace mpmfast {
namespace {

TEST_CASE("a way crosses a segment to its left or to its right") {
  CHECK(crossing({1, -1}, {1, 1}, {0, 0}, {2, 0}) == 1);
  CHECK(crossing({1, 1}, {1, -1}, {0, 0}, {2, 0}) == -1);
  CHECK(crossing({1, -1}, {1, 1}, {2, 0}, {0, 0}) == -1);
  CHECK(crossing({3, -1}, {3, 1}, {0, 0}, {2, 0}) == 0);
  CHECK(crossing({1, 1}, {1, 2}, {0, 0}, {2, 0}) == 0);
}

TEST_CASE("what lies on a crack is on one side of it, whoever looks at it from where") {
  CHECK(crossing({1, -1}, {1, 0}, {0, 0}, {2, 0}) == 1);
  CHECK(crossing({1, 1}, {1, 0}, {0, 0}, {2, 0}) == 0);
  CHECK(crossing({0.3, -1}, {1, 0}, {0, 0}, {2, 0}) == 1);
  CHECK(crossing({1, 0}, {1, -1}, {0, 0}, {2, 0}) == -1);
}

TEST_CASE("a way through a corner of a line crosses it once, and one along its prolongation not") {
  const Point2 a{0, 0}, b{1, 0}, c{2, 0}, up{1.5, 1};
  for (const Point2& p : {Point2{1, -1}, Point2{0.5, -1}, Point2{1.4, -0.25}}) {
    const Point2 n{2 - p[0], -p[1]};  // the other side of b
    CHECK(crossing(p, n, a, b) + crossing(p, n, b, c) == 1);
  }
  for (const Point2& p : {Point2{1.5, -0.2}, Point2{1.2, -1}}) {
    const Point2 n{2 - p[0], -p[1]};
    CHECK(crossing(p, n, a, b) + crossing(p, n, b, up) == 1);
  }
  CHECK(crossing({2.5, 0}, {3, 0}, a, c) == 0);
}

/// However a polygon is cut into segments, a way crosses it as often inwards as outwards, and once where one
/// end is inside.
TEST_CASE("of a way's ends the sides follow from what it crosses") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2, 2);
  constexpr int kCorners = 12;
  std::vector<Point2> ring;
  for (int k = 0; k <= kCorners; ++k)
    ring.push_back(
        {std::cos(2 * M_PI * (k % kCorners) / kCorners), std::sin(2 * M_PI * (k % kCorners) / kCorners)});
  const auto inside = [&](const Point2& x) {
    bool left = true;
    for (std::size_t k = 1; k < ring.size(); ++k) left &= is_left(ring[k - 1], ring[k], x);
    return left;
  };
  for (int k = 0; k < 10000; ++k) {
    Point2 p{place(random), place(random)}, n{place(random), place(random)};
    if (k % 3 == 0) n = ring[static_cast<std::size_t>(k) % kCorners];  // through corners
    int ways = 0;
    for (std::size_t s = 1; s < ring.size(); ++s) ways += crossing(p, n, ring[s - 1], ring[s]);
    CHECK(ways == inside(n) - inside(p));
  }
}

TEST_CASE("a line that crosses or touches itself is found") {
  CHECK(!crosses_itself({{0, 0}, {1, 0}, {2, 1}, {2, 3}}));
  CHECK(crosses_itself({{0, 0}, {2, 0}, {2, 2}, {1, -1}}));
  CHECK(crosses_itself({{0, 0}, {2, 0}, {2, 2}, {1, 0}}));  // touches
  CHECK(crosses_itself({{0, 0}, {2, 0}, {1, 0}}));          // back over itself
  CHECK(crosses_itself({{0, 0}, {1, 0}, {-1, 0}}));         // and past where it began
  CHECK(crosses_itself({{0, 0}, {1, 0}, {1, 1}, {0, 0}}));  // closed
}

}  // namespace
}  // namespace mpmfast
