/// What drives a crack at its tip against sums written out term by term, and paths against circles.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/fracture/kink.hpp"
#include "kernels/fracture/tip_integrals.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::test;

Vec<2> random_vector(Draw& draw) { return {uniform(draw, -1, 1), uniform(draw, -1, 1)}; }
Mat<2> random_tensor(Draw& draw) {
  Mat<2> out;
  out << uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1);
  return out;
}

/// |q| about a tip and its slope: 1 within two fifths of the radius, 0 at the rim, a cubic between.
double plain_weight(double r, double radius) {
  const double share = std::clamp((r - 0.4 * radius) / (0.6 * radius), 0.0, 1.0);
  return 1 - 3 * share * share + 2 * share * share * share;
}

/// q at a place, of a path whose direction at each distance is known.
template <class Along>
Vec<2> plain_q(const Vec<2>& x, double radius, const Along& along) {
  return plain_weight(x.norm(), radius) * along(x.norm());
}

TipSample random_sample(double radius, Draw& draw) {
  TipSample one;
  one.position = uniform(draw, 0.01, 1.2) * radius * random_direction<2>(draw);
  one.area = uniform(draw, 0.1, 2);
  one.displacement = random_vector(draw);
  one.gradient = random_tensor(draw);
  one.stress = random_tensor(draw);
  one.energy = uniform(draw, 0, 2);
  one.density = uniform(draw, 0, 2);
  one.velocity = random_vector(draw);
  one.velocity_gradient = random_tensor(draw);
  one.acceleration = random_vector(draw);
  return one;
}

/// J of one sample: [(σ_ij u_i,k − (W + T) δ_jk) q_k,j + ρ (a_i u_i,k − v_i v_i,k) q_k] A, q_k,j by
/// differences.
template <class Along>
double plain_release(const TipSample& one, double radius, const Along& along) {
  if (one.position.norm() >= radius) return 0;
  const double step = 1e-6 * radius;
  const Vec<2> q = plain_q(one.position, radius, along);
  Mat<2> gradient;
  for (int j = 0; j < 2; ++j)
    gradient.col(j) = (plain_q(Vec<2>(one.position + step * Vec<2>::Unit(j)), radius, along) -
                       plain_q(Vec<2>(one.position - step * Vec<2>::Unit(j)), radius, along)) /
                      (2 * step);
  const double kinetic =
      0.5 * one.density * (one.velocity[0] * one.velocity[0] + one.velocity[1] * one.velocity[1]);
  double sum = 0;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j) {
      double flow = j == k ? -(one.energy + kinetic) : 0;
      for (int i = 0; i < 2; ++i) flow += one.stress(i, j) * one.gradient(i, k);
      sum += flow * gradient(k, j);
    }
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 2; ++i)
      sum += one.density *
             (one.acceleration[i] * one.gradient(i, k) - one.velocity[i] * one.velocity_gradient(i, k)) *
             q[k];
  return one.area * sum;
}

/// Points of a crack that is an arc of a circle to its left, from its end back.
std::vector<Vec<2>> arc(double circle, double length, int points) {
  std::vector<Vec<2>> out;
  for (int k = 0; k < points; ++k) {
    const double angle = length / circle * k / (points - 1);
    out.push_back(circle * Vec<2>(-std::sin(angle), 1 - std::cos(angle)));
  }
  return out;
}

TEST_CASE("the direction of a crack that is an arc is that of its tangent, whatever its radius") {
  for (const double radius : {0.02, 3.0})
    for (const double circle : {2.5 * radius, -4 * radius, 100 * radius}) {
      const TipPath path(arc(circle, 1.5 * radius, 4001), radius, 1e-3 * radius);
      for (const double share : {0.05, 0.3, 0.77, 0.99}) {
        const double r = share * radius, angle = 2 * std::asin(0.5 * r / circle);  // r is a chord
        const Vec<2> tangent(std::cos(angle), -std::sin(angle));
        CHECK((path.direction(r) - tangent).norm() < 2e-4);
        const double turns = 1 / (circle * std::cos(0.5 * angle));
        const Vec<2> bend = turns * Vec<2>(-std::sin(angle), -std::cos(angle));
        CHECK((path.direction_slope(r) - bend).norm() < 0.03 * std::abs(turns) + 1e-3 / radius);
      }
    }
}

TEST_CASE(
    "a straight crack lies along its axis at any distance, with no bend, and goes on where it is unknown") {
  Draw draw(1);
  for (int trial = 0; trial < 20; ++trial) {
    const double radius = std::exp(uniform(draw, -4, 4)), length = uniform(draw, 0.1, 3) * radius;
    const TipPath path({{0, 0}, {-0.4 * length, 0}, {-length, 0}}, radius, 0.05 * radius);
    for (int k = 0; k < 20; ++k) {
      const double r = uniform(draw, 0, 1.2) * radius;
      CHECK((path.direction(r) - Vec<2>(1, 0)).norm() < 1e-14);
      CHECK(path.direction_slope(r).norm() < 1e-12 / radius);
    }
  }
}

TEST_CASE("between its steps the direction of a crack is a straight line whose slope is the bend") {
  Draw draw(2);
  for (int trial = 0; trial < 20; ++trial) {
    const double radius = std::exp(uniform(draw, -4, 4)), step = radius / 64;
    const TipPath path(
        {{0, 0}, radius * Vec<2>(-0.3, 0.05), radius * Vec<2>(-0.7, 0.3), radius * Vec<2>(-2, 0.4)}, radius,
        uniform(draw, 0.02, 0.2) * radius);
    for (int k = 0; k < 64; ++k) {
      const double from = (k + 0.1) * step, to = (k + 0.8) * step;
      const Vec<2> slope = (path.direction(to) - path.direction(from)) / (to - from);
      CHECK((path.direction_slope(from) - slope).norm() < 1e-9 / radius);
      CHECK((path.direction_slope(to) - slope).norm() < 1e-9 / radius);
      if (k > 0) CHECK((path.direction(k * step) - path.direction(k * step * (1 - 1e-9))).norm() < 1e-6);
      CHECK(std::abs(path.direction(k * step).norm() - 1) < 1e-6);
    }
  }
}

TEST_CASE("a corner of a crack turns its direction over twice the blur, from one side to the other") {
  const double radius = 1, blur = 0.1, corner = 0.5, angle = 0.4;
  const Vec<2> back(-std::cos(angle), std::sin(angle));
  const TipPath path({{0, 0}, {-corner, 0}, Vec<2>(-corner, 0) + 2 * back}, radius, blur);
  CHECK((path.direction(0.35) - Vec<2>(1, 0)).norm() < 1e-12);
  CHECK((path.direction(0.05) - Vec<2>(1, 0)).norm() < 1e-12);
  for (const double r : {0.65, 0.8, 1.0}) CHECK((path.direction(r) + back).norm() < 2e-2);
  // Half way: from where it is half a blur behind the corner on one side to as much on the other.
  const Vec<2> half = (Vec<2>(1, 0) - back).normalized();
  CHECK((path.direction(corner) - half).norm() < 2e-2);
}

TEST_CASE("beside a crack the nearest of its points is found, how far back it lies, and on which side") {
  Draw draw(3);
  for (int trial = 0; trial < 60; ++trial) {
    const double size = std::exp(uniform(draw, -3, 3));
    std::vector<Vec<2>> points{Vec<2>::Zero()};
    double heading = 0;
    for (int k = 0; k < 1 + trial % 4; ++k) {
      points.push_back(points.back() +
                       size * uniform(draw, 0.2, 0.6) * Vec<2>(-std::cos(heading), std::sin(heading)));
      heading += uniform(draw, -0.6, 0.6);
    }
    const TipPath path(points, 2 * size, 0.05 * size);
    for (int k = 0; k < 10; ++k) {
      const Vec<2> x = points[points.size() / 2] + 0.5 * size * random_vector(draw);
      double least = HUGE_VAL, behind = 0, before = 0;
      Vec<2> foot = Vec<2>::Zero(), way = foot;
      constexpr int kParts = 400;
      for (std::size_t n = 1; n < points.size(); ++n) {
        const Vec<2> piece = points[n] - points[n - 1];
        for (int part = 0; part <= kParts; ++part) {
          const Vec<2> at = points[n - 1] + part / double(kParts) * piece;
          if ((x - at).norm() >= least) continue;
          least = (x - at).norm();
          foot = at;
          way = piece.normalized();
          behind = before + part / double(kParts) * piece.norm();
        }
        before += piece.norm();
      }
      const auto found = path.project(x);
      const Vec<2> left(way[1], -way[0]);  // of one who looks towards the end
      if (behind == 0) {
        if ((x - points[0]).dot(points[1] - points[0]) < 0) CHECK(found.behind == HUGE_VAL);
        continue;
      }
      CHECK(std::abs(found.behind - behind) < 4e-3 * size);
      if (std::abs((x - foot).dot(way)) > 2e-3 * size) continue;  // beyond a corner two pieces are as near
      CHECK((found.left - left).norm() < 1e-9);
      CHECK(std::abs(found.offset - (x - foot).dot(left)) < 1e-9 * size);
    }
  }
}

TEST_CASE("J of samples of any fields is the sum of its terms, on a straight crack and on an arc") {
  Draw draw(4);
  for (int trial = 0; trial < 40; ++trial) {
    const double radius = std::exp(uniform(draw, -3, 3)), circle = 3 * radius;
    const bool bends = trial % 2;
    const TipPath path(
        bends ? arc(circle, 2 * radius, 2001) : std::vector<Vec<2>>{Vec<2>(0, 0), Vec<2>(-3 * radius, 0)},
        radius, 1e-3 * radius);
    const auto along = [&](double r) {
      const double angle = bends ? 2 * std::asin(0.5 * r / circle) : 0;
      return Vec<2>(std::cos(angle), -std::sin(angle));
    };
    for (int k = 0; k < 10; ++k) {
      const TipSample one = random_sample(radius, draw);
      TipIntegrals found(path, radius, 1);
      found.add(one);
      const double expected = plain_release(one, radius, along), size = 10 * (1 + 1 / radius);
      CHECK(std::abs(found.energy_release_rate() - expected) < (bends ? 2e-3 : 1e-7) * size);
      TipTraction pull{one.position, random_vector(draw), random_tensor(draw)};
      TipIntegrals drawn(path, radius, 1);
      drawn.add(pull);
      double sum = 0;
      const Vec<2> q = plain_q(pull.position, radius, along);
      for (int i = 0; i < 2; ++i)
        for (int n = 0; n < 2; ++n) sum -= pull.force[i] * pull.gradient_jump(i, n) * q[n];
      CHECK(std::abs(drawn.energy_release_rate() - sum) < (bends ? 1e-3 : 1e-12) * size);
    }
  }
  // At the tip itself q is the crack's direction, and has no slope.
  TipSample at = random_sample(1, draw);
  at.position.setZero();
  const TipPath path({{0, 0}, {-1, 0}}, 1, 0.1);
  TipIntegrals middle(path, 1, 1);
  middle.add(at);
  const Vec<2> pull =
      at.gradient.transpose() * at.acceleration - at.velocity_gradient.transpose() * at.velocity;
  CHECK(middle.energy_release_rate() == doctest::Approx(at.area * at.density * pull[0]).epsilon(1e-12));
}

TEST_CASE("the sides of a crack are looked at a part of the radius behind its tip, and close beside it") {
  Draw draw(5);
  for (int trial = 0; trial < 40; ++trial) {
    const double radius = std::exp(uniform(draw, -3, 3));
    const TipPath path({{0, 0}, {-3 * radius, 0}}, radius, 0.01 * radius);
    const double reach = trial % 2 ? uniform(draw, 0.2, 1) * radius : HUGE_VAL,
                 beside = trial % 3 ? 0 : uniform(draw, 0.1, 0.3) * radius;
    const double longest = std::min(0.7 * radius, reach), widest = std::max(0.18 * radius, beside),
                 shortest = longest * 0.25 / 0.7;
    TipIntegrals found(path, radius, 4, reach, beside);
    Vec<2> sum[2] = {Vec<2>::Zero(), Vec<2>::Zero()};
    double area[2] = {0, 0};
    for (int k = 0; k < 60; ++k) {
      TipSample one = random_sample(radius, draw);
      one.position = Vec<2>(-uniform(draw, -0.1, 0.9), uniform(draw, -0.4, 0.4)) * radius;
      one.stress = 0.1 * one.stress;
      found.add(one);
      const double behind = -one.position[0], offset = one.position[1];
      if (one.position.norm() >= radius || behind < shortest || behind > longest || std::abs(offset) > widest)
        continue;
      sum[offset > 0] += one.area * (one.displacement - offset * one.gradient.col(1));
      area[offset > 0] += one.area;
    }
    const bool both = area[0] > 0 && area[1] > 0;
    const Vec<2> apart = both ? Vec<2>(sum[1] / area[1] - sum[0] / area[0]) : Vec<2>::Zero();
    CHECK((found.opening() - apart).norm() < 1e-12);
    const double size = std::sqrt(4 * std::max(0.0, found.energy_release_rate()));
    const Vec<2> expected = !(found.energy_release_rate() > 0) ? Vec<2>(Vec<2>::Zero())
                            : both                             ? Vec<2>(size * apart.normalized())
                                                               : Vec<2>(0, size);
    CHECK((found.stress_intensities() - expected).norm() < 1e-11 * (1 + size));
  }
}

TEST_CASE("a crack kinks to where its hoop stress is largest of all angles, and that is K_I there") {
  Draw draw(6);
  for (int trial = 0; trial < 100; ++trial) {
    const double one = trial % 10 == 0 ? 0 : uniform(draw, 0, 2),
                 two = trial % 7 == 0 ? 0 : uniform(draw, -2, 2);
    const auto hoop = [&](double angle) {  // √(2πr) σ_θθ of Williams' fields
      return 0.25 * (one * (3 * std::cos(0.5 * angle) + std::cos(1.5 * angle)) -
                     3 * two * (std::sin(0.5 * angle) + std::sin(1.5 * angle)));
    };
    double best = 0, most = -HUGE_VAL;
    for (int k = -3000; k <= 3000; ++k) {
      const double angle = 0.5 * kFullTurn * k / 3000;
      CHECK(hoop_intensity(one, two, angle) == doctest::Approx(hoop(angle)).epsilon(1e-10).scale(1));
      if (hoop(angle) > most) most = hoop(angle), best = angle;
    }
    if (one == 0 && two == 0)
      CHECK(kink_angle(one, two) == 0);
    else
      CHECK(std::abs(kink_angle(one, two) - best) < 2e-3);
  }
}

}  // namespace
