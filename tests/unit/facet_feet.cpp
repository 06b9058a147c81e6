// Where points lie over and under facets whose normals turn.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "kernels/contact/facet_feet.hpp"

namespace mpmfast {
namespace {

constexpr std::array<bool, 2> kGoesOn{false, false}, kEnds{true, true};
constexpr std::array<bool, 3> kGoesOn3{false, false, false};

struct Segment {
  std::array<Vec<2>, 2> point, normal;
};

/// The material on its left; its normals are turned by these angles from that of the segment, rad.
Segment segment(double first, double second) {
  const Vec<2> from(1, 2), to(1.5, 2.25);
  const auto normal = [&](double turn) {
    const double angle = std::atan2(from[0] - to[0], to[1] - from[1]) + turn;  // (t_y, −t_x)
    return Vec<2>(std::cos(angle), std::sin(angle));
  };
  return {{from, to}, {normal(first), normal(second)}};
}

TEST_CASE("the foot of a point that was put over or under a place of a segment is that place") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (const auto& [first, second] : {std::pair{0.0, 0.0}, {-0.3, 0.3}, {0.3, -0.2}, {0.2, 0.2}})
    for (int trial = 0; trial < 200; ++trial) {
      const Segment s = segment(first, second);
      const double beta = share(random), height = (trial % 2 ? 1 : -1) * (0.01 + 0.2 * share(random));
      CAPTURE(first);
      CAPTURE(height);
      const Vec<2> normal = (1 - beta) * s.normal[0] + beta * s.normal[1],
                   place = (1 - beta) * s.point[0] + beta * s.point[1], x = place + height * normal;
      const double distance = std::abs(height) * normal.norm();
      const auto foot = foot_on(x, s.point, s.normal, kGoesOn, 1.0);
      REQUIRE(foot);
      CHECK(foot->share[1] == doctest::Approx(beta).epsilon(1e-11).scale(1));
      CHECK(foot->share[0] == doctest::Approx(1 - beta).epsilon(1e-11).scale(1));
      CHECK(foot->distance == doctest::Approx(distance).epsilon(1e-11));
      CHECK(foot->below == (height < 0));
      CHECK_FALSE(foot->clipped);
      CHECK((foot->exit - normal.normalized()).norm() < 1e-11);
      // Seen from as far away as that, and no nearer, on either side.
      CHECK(foot_on(x, s.point, s.normal, kGoesOn, (1 + 1e-9) * distance));
      CHECK_FALSE(foot_on(x, s.point, s.normal, kGoesOn, (1 - 1e-9) * distance));
      // In a mirror the material lies on the left of the segment from its other end.
      const auto mirrored = [](const Vec<2>& v) { return Vec<2>(-v[0], v[1]); };
      const auto other = foot_on(mirrored(x), {mirrored(s.point[1]), mirrored(s.point[0])},
                                 {mirrored(s.normal[1]), mirrored(s.normal[0])}, kGoesOn, 1.0);
      REQUIRE(other);
      CHECK(other->share[0] == doctest::Approx(beta).epsilon(1e-11).scale(1));
      CHECK(other->below == foot->below);
      CHECK((other->exit - mirrored(foot->exit)).norm() < 1e-11);
    }
}

TEST_CASE("at a distance that is the reach itself a foot is found, and a point on a facet is not below it") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, down{Vec<2>(0, -1), Vec<2>(0, -1)};
  for (const double side : {-1.0, 1.0}) {
    const auto foot = foot_on(Vec<2>(0.5, 0.25 * side), points, down, kGoesOn, 0.25);
    REQUIRE(foot);
    CHECK(foot->distance == 0.25);
    CHECK(foot->below == (side > 0));
  }
  const auto on = foot_on(Vec<2>(0.5, 0), points, down, kGoesOn, 0.25);
  REQUIRE(on);
  CHECK(on->distance == 0);
  CHECK_FALSE(on->below);
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const std::array<Vec<3>, 3> up{Vec<3>::UnitZ(), Vec<3>::UnitZ(), Vec<3>::UnitZ()};
  for (const double side : {-1.0, 1.0}) {
    const auto solid = foot_on(Vec<3>(0.25, 0.5, 0.25 * side), corners, up, kGoesOn3, 0.25);
    REQUIRE(solid);
    CHECK(solid->distance == 0.25);
    CHECK(solid->below == (side < 0));
  }
  const auto flat = foot_on(Vec<3>(0.25, 0.5, 0), corners, up, kGoesOn3, 0.25);
  REQUIRE(flat);
  CHECK(flat->distance == 0);
  CHECK_FALSE(flat->below);
}

TEST_CASE(
    "beyond the end of a piece the end is the nearest; where the piece goes on a neighbour has the foot") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, down{Vec<2>(0, -1), Vec<2>(0, -1)};
  for (const double side : {-1.0, 1.0})  // inside of the body, outside
    for (const bool second : {false, true}) {
      CAPTURE(side);
      CAPTURE(second);
      const Vec<2> x(second ? 1.3 : -0.3, 0.4 * side);
      CHECK_FALSE(foot_on(x, points, down, kGoesOn, 1.0));
      CHECK_FALSE(foot_on(x, points, down, {second, !second}, 1.0));
      CHECK_FALSE(foot_on(x, points, down, kEnds, 0.49));
      const auto foot = foot_on(x, points, down, {!second, second}, 0.51);
      REQUIRE(foot);
      CHECK(foot->clipped);
      CHECK_FALSE(foot->below);
      CHECK_FALSE(foot->convex);
      CHECK(foot->share[0] == (second ? 0 : 1));
      CHECK(foot->share[1] == (second ? 1 : 0));
      CHECK(foot->distance == doctest::Approx(0.5).epsilon(1e-15));
      CHECK((foot->exit - Vec<2>(second ? -0.6 : 0.6, -0.8 * side)).norm() < 1e-15);
    }
}

TEST_CASE("no point falls between two segments of a piece, on either side of the surface") {
  const Vec<2> a(0, 0), b(0.5, 0.1), c(0.9, 0.5);
  const auto outward = [](const Vec<2>& way) { return Vec<2>(way[1], -way[0]).normalized(); };
  const Vec<2> at_a = outward(b - a), at_c = outward(c - b), at_b = (at_a + at_c).normalized();
  for (const double height : {-0.2, -0.01, 0.01, 0.2, 0.4}) {
    CAPTURE(height);
    const Vec<2> x = b + height * at_b;
    const auto before = foot_on(x, {a, b}, {at_a, at_b}, kGoesOn, 1.0),
               after = foot_on(x, {b, c}, {at_b, at_c}, kGoesOn, 1.0);
    CHECK((before || after));
    for (const auto& foot : {before, after})
      if (foot) CHECK(foot->distance == doctest::Approx(std::abs(height)).epsilon(1e-9));
  }
}

TEST_CASE("a point has a foot up to where the normals meet, and none beyond") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, spread{Vec<2>(-0.5, -1), Vec<2>(0.5, -1)};
  const auto foot = foot_on(Vec<2>(0.5, 0.9), points, spread, kGoesOn, 10);
  REQUIRE(foot);
  CHECK(foot->share[0] == doctest::Approx(0.5));
  CHECK(foot->distance == doctest::Approx(0.9));
  CHECK(foot->below);
  CHECK_FALSE(foot_on(Vec<2>(0.5, 1.5), points, spread, kGoesOn, 10));
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const Vec<3> meeting(1.0 / 3, 1.0 / 3, -1);
  const std::array<Vec<3>, 3> normals{corners[0] - meeting, corners[1] - meeting, corners[2] - meeting};
  CHECK(foot_on(Vec<3>(meeting + Vec<3>(0.01, 0, 0.2)), corners, normals, kGoesOn3, 10));
  CHECK_FALSE(foot_on(Vec<3>(meeting + Vec<3>(0.01, 0, 0)), corners, normals, kGoesOn3, 10));
}

struct Triangle {
  std::array<Vec<3>, 3> point, normal;
};

/// Its normals lean by so much from that of its plane, each to a side of its own.
Triangle triangle(double lean) {
  Triangle t{{Vec<3>(0.1, 0.2, 0.3), Vec<3>(1.1, 0.3, 0.2), Vec<3>(0.4, 0.9, 0.6)}, {}};
  const Vec<3> up = (t.point[1] - t.point[0]).cross(t.point[2] - t.point[0]).normalized(),
               middle = (t.point[0] + t.point[1] + t.point[2]) / 3;
  for (std::size_t k = 0; k < 3; ++k)
    t.normal[k] = (up + lean * (t.point[k] - middle) + Vec<3>(0.02, -0.01, 0.03)).normalized();
  return t;
}

TEST_CASE("the foot of a point that was put over or under a place of a triangle is that place") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (const double lean : {0.0, 0.4, -0.4})
    for (int trial = 0; trial < 200; ++trial) {
      const Triangle t = triangle(lean);
      double one = share(random), two = share(random);
      if (one + two > 1) one = 1 - one, two = 1 - two;
      const double beta[] = {1 - one - two, one, two};
      const double height = (trial % 2 ? 1 : -1) * (0.01 + 0.3 * share(random));
      CAPTURE(lean);
      CAPTURE(height);
      Vec<3> normal = Vec<3>::Zero(), x = Vec<3>::Zero();
      for (std::size_t k = 0; k < 3; ++k) normal += beta[k] * t.normal[k];
      for (std::size_t k = 0; k < 3; ++k) x += beta[k] * t.point[k];
      x += height * normal;
      const double distance = std::abs(height) * normal.norm();
      const auto foot = foot_on(x, t.point, t.normal, kGoesOn3, 1.0);
      REQUIRE(foot);
      for (int k = 0; k < 3; ++k) CHECK(foot->share[k] == doctest::Approx(beta[k]).epsilon(1e-9).scale(1));
      CHECK(foot->distance == doctest::Approx(distance).epsilon(1e-9));
      CHECK(foot->below == (height < 0));
      CHECK_FALSE(foot->clipped);
      CHECK((foot->exit - normal.normalized()).norm() < 1e-9);
      CHECK(foot_on(x, t.point, t.normal, kGoesOn3, (1 + 1e-8) * distance));
      CHECK_FALSE(foot_on(x, t.point, t.normal, kGoesOn3, (1 - 1e-8) * distance));
      // Corners in turn, and in a mirror, where two change places.
      const auto turned = foot_on(x, {t.point[1], t.point[2], t.point[0]},
                                  {t.normal[1], t.normal[2], t.normal[0]}, kGoesOn3, 1.0);
      REQUIRE(turned);
      for (int k = 0; k < 3; ++k)
        CHECK(turned->share[k] == doctest::Approx(beta[(k + 1) % 3]).epsilon(1e-9).scale(1));
      const auto mirrored = [](const Vec<3>& v) { return Vec<3>(v[0], v[1], -v[2]); };
      const auto other =
          foot_on(mirrored(x), {mirrored(t.point[0]), mirrored(t.point[2]), mirrored(t.point[1])},
                  {mirrored(t.normal[0]), mirrored(t.normal[2]), mirrored(t.normal[1])}, kGoesOn3, 1.0);
      REQUIRE(other);
      CHECK(other->below == foot->below);
      CHECK((other->exit - mirrored(foot->exit)).norm() < 1e-9);
      CHECK(other->share[1] == doctest::Approx(beta[2]).epsilon(1e-9).scale(1));
    }
}

TEST_CASE("beyond an edge or a corner where the piece ends, the nearest of these is the foot") {
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const std::array<Vec<3>, 3> up{Vec<3>::UnitZ(), Vec<3>::UnitZ(), Vec<3>::UnitZ()};
  struct Case {
    Vec<3> x, share;
    std::array<bool, 3> ends;  ///< all that it lies beyond
  };
  const Case cases[] = {{{0.25, -0.3, 0}, {0.75, 0.25, 0}, {false, false, true}},
                        {{-0.3, 0.25, 0}, {0.75, 0, 0.25}, {false, true, false}},
                        {{0.75, 0.75, 0}, {0, 0.5, 0.5}, {true, false, false}},
                        {{-0.3, -0.4, 0}, {1, 0, 0}, {false, true, true}},
                        {{1.4, -0.3, 0}, {0, 1, 0}, {true, false, true}},
                        {{-0.2, 1.5, 0}, {0, 0, 1}, {true, true, false}}};
  for (const Case& one : cases)
    for (const double height : {-0.2, 0.0, 0.2}) {
      CAPTURE(one.x[0]);
      CAPTURE(one.x[1]);
      CAPTURE(height);
      const Vec<3> x = one.x + height * Vec<3>::UnitZ();
      CHECK_FALSE(foot_on(x, corners, up, kGoesOn3, 10));
      const auto foot = foot_on(x, corners, up, one.ends, 10);
      REQUIRE(foot);
      Vec<3> way = -x;
      for (std::size_t k = 0; k < 3; ++k) way += one.share[static_cast<int>(k)] * corners[k];
      CHECK(foot->clipped);
      CHECK_FALSE(foot->below);
      for (int k = 0; k < 3; ++k)
        CHECK(foot->share[k] == doctest::Approx(one.share[k]).epsilon(1e-14).scale(1));
      CHECK(foot->distance == doctest::Approx(way.norm()).epsilon(1e-14));
      CHECK((foot->exit - way.normalized()).norm() < 1e-14);
      CHECK_FALSE(foot_on(x, corners, up, one.ends, 0.99 * way.norm()));
    }
}

}  // namespace
}  // namespace mpmfast
