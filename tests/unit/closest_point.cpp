// Closest-point projection on facets whose normals vary linearly.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "kernels/contact/closest_point.hpp"

namespace mpmfast {
namespace {

constexpr std::array<bool, 2> kContinues{false, false}, kEnds{true, true};
constexpr std::array<bool, 3> kContinues3{false, false, false};

struct Segment {
  std::array<Vec<2>, 2> point, normal;
};

/// A segment with its material on the left. Its normals are turned from that of the segment by two angles,
/// rad.
Segment segment(double first, double second) {
  const Vec<2> from(1, 2), to(1.5, 2.25);
  const auto normal = [&](double turn) {
    const double angle = std::atan2(from[0] - to[0], to[1] - from[1]) + turn;  // (t_y, −t_x)
    return Vec<2>(std::cos(angle), std::sin(angle));
  };
  return {{from, to}, {normal(first), normal(second)}};
}

TEST_CASE("a point along the normal of a place on a segment is projected onto this place") {
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
      const auto closest = project_onto_facet(x, s.point, s.normal, kContinues, 1.0);
      REQUIRE(closest);
      CHECK(closest->weight[1] == doctest::Approx(beta).epsilon(1e-11).scale(1));
      CHECK(closest->weight[0] == doctest::Approx(1 - beta).epsilon(1e-11).scale(1));
      CHECK(closest->distance == doctest::Approx(distance).epsilon(1e-11));
      CHECK(closest->inside == (height < 0));
      CHECK_FALSE(closest->at_crease);
      CHECK((closest->exit_direction - normal.normalized()).norm() < 1e-11);
      // The reach decides, on either side.
      CHECK(project_onto_facet(x, s.point, s.normal, kContinues, (1 + 1e-9) * distance));
      CHECK_FALSE(project_onto_facet(x, s.point, s.normal, kContinues, (1 - 1e-9) * distance));
      // In a mirror the material is on the left of the reversed segment.
      const auto mirrored = [](const Vec<2>& v) { return Vec<2>(-v[0], v[1]); };
      const auto other = project_onto_facet(mirrored(x), {mirrored(s.point[1]), mirrored(s.point[0])},
                                            {mirrored(s.normal[1]), mirrored(s.normal[0])}, kContinues, 1.0);
      REQUIRE(other);
      CHECK(other->weight[0] == doctest::Approx(beta).epsilon(1e-11).scale(1));
      CHECK(other->inside == closest->inside);
      CHECK((other->exit_direction - mirrored(closest->exit_direction)).norm() < 1e-11);
    }
}

TEST_CASE("a point at the distance of the reach is projected, and a point on a facet is not inside") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, down{Vec<2>(0, -1), Vec<2>(0, -1)};
  for (const double side : {-1.0, 1.0}) {
    const auto closest = project_onto_facet(Vec<2>(0.5, 0.25 * side), points, down, kContinues, 0.25);
    REQUIRE(closest);
    CHECK(closest->distance == 0.25);
    CHECK(closest->inside == (side > 0));
  }
  const auto on = project_onto_facet(Vec<2>(0.5, 0), points, down, kContinues, 0.25);
  REQUIRE(on);
  CHECK(on->distance == 0);
  CHECK_FALSE(on->inside);
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const std::array<Vec<3>, 3> up{Vec<3>::UnitZ(), Vec<3>::UnitZ(), Vec<3>::UnitZ()};
  for (const double side : {-1.0, 1.0}) {
    const auto solid = project_onto_facet(Vec<3>(0.25, 0.5, 0.25 * side), corners, up, kContinues3, 0.25);
    REQUIRE(solid);
    CHECK(solid->distance == 0.25);
    CHECK(solid->inside == (side < 0));
  }
  const auto flat = project_onto_facet(Vec<3>(0.25, 0.5, 0), corners, up, kContinues3, 0.25);
  REQUIRE(flat);
  CHECK(flat->distance == 0);
  CHECK_FALSE(flat->inside);
}

TEST_CASE("beyond the end of a patch the end is the closest point; within a patch a neighbour has it") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, down{Vec<2>(0, -1), Vec<2>(0, -1)};
  for (const double side : {-1.0, 1.0})  // inside of the body, outside
    for (const bool second : {false, true}) {
      CAPTURE(side);
      CAPTURE(second);
      const Vec<2> x(second ? 1.3 : -0.3, 0.4 * side);
      CHECK_FALSE(project_onto_facet(x, points, down, kContinues, 1.0));
      CHECK_FALSE(project_onto_facet(x, points, down, {second, !second}, 1.0));
      CHECK_FALSE(project_onto_facet(x, points, down, kEnds, 0.49));
      const auto closest = project_onto_facet(x, points, down, {!second, second}, 0.51);
      REQUIRE(closest);
      CHECK(closest->at_crease);
      CHECK_FALSE(closest->inside);
      CHECK_FALSE(closest->convex);
      CHECK(closest->weight[0] == (second ? 0 : 1));
      CHECK(closest->weight[1] == (second ? 1 : 0));
      CHECK(closest->distance == doctest::Approx(0.5).epsilon(1e-15));
      CHECK((closest->exit_direction - Vec<2>(second ? -0.6 : 0.6, -0.8 * side)).norm() < 1e-15);
    }
}

TEST_CASE("no point falls between two segments of a patch, on either side of the surface") {
  const Vec<2> a(0, 0), b(0.5, 0.1), c(0.9, 0.5);
  const auto outward = [](const Vec<2>& way) { return Vec<2>(way[1], -way[0]).normalized(); };
  const Vec<2> at_a = outward(b - a), at_c = outward(c - b), at_b = (at_a + at_c).normalized();
  for (const double height : {-0.2, -0.01, 0.01, 0.2, 0.4}) {
    CAPTURE(height);
    const Vec<2> x = b + height * at_b;
    const auto before = project_onto_facet(x, {a, b}, {at_a, at_b}, kContinues, 1.0),
               after = project_onto_facet(x, {b, c}, {at_b, at_c}, kContinues, 1.0);
    CHECK((before || after));
    for (const auto& closest : {before, after})
      if (closest) CHECK(closest->distance == doctest::Approx(std::abs(height)).epsilon(1e-9));
  }
}

TEST_CASE("a point is projected up to where the normals meet, and not beyond") {
  const std::array<Vec<2>, 2> points{Vec<2>(0, 0), Vec<2>(1, 0)}, spread{Vec<2>(-0.5, -1), Vec<2>(0.5, -1)};
  const auto closest = project_onto_facet(Vec<2>(0.5, 0.9), points, spread, kContinues, 10);
  REQUIRE(closest);
  CHECK(closest->weight[0] == doctest::Approx(0.5));
  CHECK(closest->distance == doctest::Approx(0.9));
  CHECK(closest->inside);
  CHECK_FALSE(project_onto_facet(Vec<2>(0.5, 1.5), points, spread, kContinues, 10));
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const Vec<3> meeting(1.0 / 3, 1.0 / 3, -1);
  const std::array<Vec<3>, 3> normals{corners[0] - meeting, corners[1] - meeting, corners[2] - meeting};
  CHECK(project_onto_facet(Vec<3>(meeting + Vec<3>(0.01, 0, 0.2)), corners, normals, kContinues3, 10));
  CHECK_FALSE(project_onto_facet(Vec<3>(meeting + Vec<3>(0.01, 0, 0)), corners, normals, kContinues3, 10));
}

struct Triangle {
  std::array<Vec<3>, 3> point, normal;
};

/// A triangle whose normals differ from that of its plane, by `lean` and by a constant vector.
Triangle triangle(double lean) {
  Triangle t{{Vec<3>(0.1, 0.2, 0.3), Vec<3>(1.1, 0.3, 0.2), Vec<3>(0.4, 0.9, 0.6)}, {}};
  const Vec<3> up = (t.point[1] - t.point[0]).cross(t.point[2] - t.point[0]).normalized(),
               middle = (t.point[0] + t.point[1] + t.point[2]) / 3;
  for (std::size_t k = 0; k < 3; ++k)
    t.normal[k] = (up + lean * (t.point[k] - middle) + Vec<3>(0.02, -0.01, 0.03)).normalized();
  return t;
}

TEST_CASE("a point along the normal of a place on a triangle is projected onto this place") {
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
      const auto closest = project_onto_facet(x, t.point, t.normal, kContinues3, 1.0);
      REQUIRE(closest);
      for (int k = 0; k < 3; ++k)
        CHECK(closest->weight[k] == doctest::Approx(beta[k]).epsilon(1e-9).scale(1));
      CHECK(closest->distance == doctest::Approx(distance).epsilon(1e-9));
      CHECK(closest->inside == (height < 0));
      CHECK_FALSE(closest->at_crease);
      CHECK((closest->exit_direction - normal.normalized()).norm() < 1e-9);
      CHECK(project_onto_facet(x, t.point, t.normal, kContinues3, (1 + 1e-8) * distance));
      CHECK_FALSE(project_onto_facet(x, t.point, t.normal, kContinues3, (1 - 1e-8) * distance));
      // Corners in cyclic order, and in a mirror, where two are exchanged.
      const auto turned = project_onto_facet(x, {t.point[1], t.point[2], t.point[0]},
                                             {t.normal[1], t.normal[2], t.normal[0]}, kContinues3, 1.0);
      REQUIRE(turned);
      for (int k = 0; k < 3; ++k)
        CHECK(turned->weight[k] == doctest::Approx(beta[(k + 1) % 3]).epsilon(1e-9).scale(1));
      const auto mirrored = [](const Vec<3>& v) { return Vec<3>(v[0], v[1], -v[2]); };
      const auto other = project_onto_facet(
          mirrored(x), {mirrored(t.point[0]), mirrored(t.point[2]), mirrored(t.point[1])},
          {mirrored(t.normal[0]), mirrored(t.normal[2]), mirrored(t.normal[1])}, kContinues3, 1.0);
      REQUIRE(other);
      CHECK(other->inside == closest->inside);
      CHECK((other->exit_direction - mirrored(closest->exit_direction)).norm() < 1e-9);
      CHECK(other->weight[1] == doctest::Approx(beta[2]).epsilon(1e-9).scale(1));
    }
}

TEST_CASE("beyond edges where the patch ends, the closest point is on the nearest of them") {
  const std::array<Vec<3>, 3> corners{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)};
  const std::array<Vec<3>, 3> up{Vec<3>::UnitZ(), Vec<3>::UnitZ(), Vec<3>::UnitZ()};
  struct Case {
    Vec<3> x, weight;
    std::array<bool, 3> ends;  ///< edges that x lies beyond
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
      CHECK_FALSE(project_onto_facet(x, corners, up, kContinues3, 10));
      const auto closest = project_onto_facet(x, corners, up, one.ends, 10);
      REQUIRE(closest);
      Vec<3> way = -x;
      for (std::size_t k = 0; k < 3; ++k) way += one.weight[static_cast<int>(k)] * corners[k];
      CHECK(closest->at_crease);
      CHECK_FALSE(closest->inside);
      for (int k = 0; k < 3; ++k)
        CHECK(closest->weight[k] == doctest::Approx(one.weight[k]).epsilon(1e-14).scale(1));
      CHECK(closest->distance == doctest::Approx(way.norm()).epsilon(1e-14));
      CHECK((closest->exit_direction - way.normalized()).norm() < 1e-14);
      CHECK_FALSE(project_onto_facet(x, corners, up, one.ends, 0.99 * way.norm()));
    }
}

}  // namespace
}  // namespace mpmfast
