/// Normals and distances of clouds against plain sums, steps and searches over every pair of points.

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/contact/margin.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::test;

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

template <int Dim>
using Plane = Eigen::Matrix<double, Dim + 1, 1>;
template <int Dim>
using Square = Eigen::Matrix<double, Dim + 1, Dim + 1>;

/// Two classes on either side of a plane, which overlap by some of their points.
template <int Dim>
Cloud<Dim> overlapping(int count, Draw& draw) {
  Cloud<Dim> cloud;
  const Vec<Dim> n = random_direction<Dim>(draw);
  for (int k = 0; k < count; ++k) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = uniform(draw, -1.2, 1.2);
    const double side = k % 2 ? 1 : -1, off = uniform(draw, -0.3, 1);
    cloud.add(x + (side * off - x.dot(n)) * n, k % 11 == 5 ? 0.0 : side);
  }
  return cloud;
}

template <int Dim>
Plane<Dim> point(const Cloud<Dim>& cloud, int k) {
  Plane<Dim> x;
  for (int d = 0; d < Dim; ++d) x[d] = cloud.xi[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)];
  x[Dim] = 1;
  return x;
}

/// The matrix and the right side of one step from a plane, the objective there.
template <int Dim>
struct Iterate {
  Square<Dim> matrix = Square<Dim>::Zero();
  Plane<Dim> right = Plane<Dim>::Zero();
  double objective = 0;

  Iterate(const Cloud<Dim>& cloud, const RegressionRule& rule, const Plane<Dim>& phi) {
    for (int k = 0; k < cloud.count; ++k) {
      const double c = cloud.side[static_cast<std::size_t>(k)];
      if (c == 0) continue;
      const Plane<Dim> x = point(cloud, k);
      const double s = x.dot(phi), q = 1 / (1 + std::exp(-s)), f = 2 * q - 1;
      if (rule.fit == Fit::linear) {
        matrix += x * x.transpose();
        right += (c - s) * x;
      } else if (rule.fit == Fit::least_squares) {
        const double slope = 2 * q * (1 - q);
        matrix += slope * slope * x * x.transpose();
        right += slope * (c - f) * x;
        objective += (c - f) * (c - f);
      } else {
        matrix += q * (1 - q) * x * x.transpose();
        right += (0.5 * (c + 1) - q) * x;
        objective += std::log(1 + std::exp(-c * s));
      }
    }
    for (int i = 0; i <= Dim; ++i) {
      const double penalty = i < Dim ? rule.penalty : rule.offset_penalty;
      matrix(i, i) += penalty;
      right[i] -= penalty * phi[i];
      objective += (rule.fit == Fit::likelihood ? 0.5 : 1) * penalty * phi[i] * phi[i];
    }
  }
  Plane<Dim> change() const { return matrix.inverse() * right; }
};

template <int Dim>
Plane<Dim> plane_of(const Regression<Dim>& found) {
  Plane<Dim> out;
  for (int i = 0; i <= Dim; ++i) out[i] = found.plane[i];
  return out;
}

TEST_CASE_TEMPLATE("one step of a regression is that of its sums, and the last of many has no gradient left",
                   D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  using Outcome = typename Regression<Dim>::Outcome;
  Draw draw(1);
  for (int trial = 0; trial < 90; ++trial) {
    const Cloud<Dim> cloud = overlapping<Dim>(9 + trial % 23, draw);
    RegressionRule rule{.fit = trial % 2 ? Fit::least_squares : Fit::likelihood,
                        .penalty = trial % 3 ? uniform(draw, 0.01, 1) : 1e-7,
                        .offset_penalty = trial % 5 ? uniform(draw, 0, 1) : 0,
                        .tolerance = 2,  // any two normals agree
                        .max_iterations = 1};
    Plane<Dim> start;
    for (int i = 0; i <= Dim; ++i) start[i] = uniform(draw, -1, 1);
    const Regression<Dim> one = fit_normal<Dim>(cloud.view(), rule, start.data());
    const Plane<Dim> expected = start + Iterate<Dim>(cloud, rule, start).change();
    CHECK(one.iterations == 1);
    CHECK(one.outcome == Outcome::converged);
    CHECK((plane_of(one) - expected).norm() < 1e-9 * (1 + expected.norm()));
    CHECK((one.normal - expected.template head<Dim>().normalized()).norm() < 1e-8);

    // Without a start: from twice the linear regression.
    RegressionRule linear = rule;
    linear.fit = Fit::linear;
    const Plane<Dim> fitted = Iterate<Dim>(cloud, linear, Plane<Dim>::Zero()).change();
    const Regression<Dim> straight = fit_normal<Dim>(cloud.view(), linear);
    CHECK(straight.outcome == Outcome::converged);
    CHECK(straight.iterations == 0);
    CHECK((plane_of(straight) - fitted).norm() < 1e-10 * (1 + fitted.norm()));
    const Plane<Dim> second = 2 * fitted + Iterate<Dim>(cloud, rule, 2 * fitted).change();
    const Regression<Dim> from_linear = fit_normal<Dim>(cloud.view(), rule);
    if (from_linear.outcome == Outcome::converged) {
      CHECK((plane_of(from_linear) - second).norm() < 1e-9 * (1 + second.norm()));
      CHECK(from_linear.iterations == 1);
    }

    rule.tolerance = 1e-14;
    rule.max_iterations = 200;
    const Regression<Dim> last = fit_normal<Dim>(cloud.view(), rule);
    if (last.outcome != Outcome::converged) continue;
    const Iterate<Dim> there(cloud, rule, plane_of(last));
    if (rule.fit == Fit::likelihood) CHECK(there.right.norm() < 1e-5);
    CHECK(there.objective <= Iterate<Dim>(cloud, rule, 2 * fitted).objective * (1 + 1e-12));
    const Regression<Dim> again = fit_normal<Dim>(cloud.view(), rule, last.plane);
    CHECK(again.iterations <= last.iterations);
    CHECK((again.normal - last.normal).norm() < 1e-6);
  }
}

TEST_CASE_TEMPLATE(
    "steps of a regression never end higher than they were, each halved until it does not rise", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  int halved = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const Cloud<Dim> cloud = overlapping<Dim>(12, draw);
    Plane<Dim> start;
    for (int i = 0; i <= Dim; ++i) start[i] = uniform(draw, -6, 6);
    // As the kernel is said to do it: from the best plane so far, half the step where the objective rises.
    for (const int allowed : {1, 2, 3, 5}) {
      const RegressionRule rule{.fit = trial % 2 ? Fit::least_squares : Fit::likelihood,
                                .penalty = 0.01,
                                .offset_penalty = 0.02,
                                .tolerance = 1e-9,
                                .max_iterations = allowed};
      Plane<Dim> best = start, phi = start;
      double least = HUGE_VAL;
      bool agrees = false;
      for (int k = 0; k < allowed && !agrees; ++k) {
        const Iterate<Dim> step(cloud, rule, phi);
        if (step.objective > least) {
          phi = 0.5 * (phi + best);
          ++halved;
          continue;
        }
        least = step.objective;
        best = phi;
        phi += step.change();
        const double cosine =
            phi.template head<Dim>().normalized().dot(best.template head<Dim>().normalized());
        agrees = 1 - cosine < rule.tolerance;
      }
      if (agrees) continue;
      double plane[Dim + 1];
      for (int i = 0; i <= Dim; ++i) plane[i] = start[i];
      bool converged = true;
      CHECK(detail::minimise<Dim>(cloud.view(), rule, plane, converged) == allowed);
      CHECK(!converged);
      for (int i = 0; i <= Dim; ++i) CHECK(std::abs(plane[i] - best[i]) < 1e-6 * (1 + best.norm()));
    }
  }
  CHECK(halved > 20);
}

TEST_CASE_TEMPLATE("classes that are exchanged turn the normal, and clouds that are turned turn it too", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  for (int trial = 0; trial < 60; ++trial) {
    const Cloud<Dim> cloud = overlapping<Dim>(10 + trial % 17, draw);
    const Mat<Dim> r = rotation_to<Dim>(random_direction<Dim>(draw), draw);
    Cloud<Dim> exchanged, rotated;
    for (int k = 0; k < cloud.count; ++k) {
      const Vec<Dim> x = point(cloud, k).template head<Dim>();
      exchanged.add(x, -cloud.side[static_cast<std::size_t>(k)]);
      rotated.add(r * x, cloud.side[static_cast<std::size_t>(k)]);
    }
    const RegressionRule rule{.fit = static_cast<Fit>(trial % 3), .penalty = 0.1, .offset_penalty = 0.2};
    const auto one = fit_normal<Dim>(cloud.view(), rule), other = fit_normal<Dim>(exchanged.view(), rule),
               far = fit_normal<Dim>(rotated.view(), rule);
    CHECK((one.normal + other.normal).norm() < 1e-9);
    CHECK((r * one.normal - far.normal).norm() < 1e-8);
    CHECK(one.iterations == other.iterations);
    CHECK(one.outcome == other.outcome);
  }
}

// The widest margin.

/// The nearest points of two segments, or of a point and a triangle, come from every choice of edges: the
/// least of |Σ shares| with shares of each class that sum to one, by the plane through the chosen points.
template <int Dim>
double plain_distance(const std::vector<Vec<Dim>>& a, const std::vector<Vec<Dim>>& b, Vec<Dim>& apart) {
  double least = HUGE_VAL;
  const auto offer = [&](const Vec<Dim>& x) {
    if (x.norm() < least) least = x.norm(), apart = x;
  };
  // Point to the hull of up to three points.
  const auto to_points = [&](const Vec<Dim>& x, const std::vector<Vec<Dim>>& of, double sign) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      offer(sign * (of[i] - x));
      for (std::size_t j = i + 1; j < of.size(); ++j) {
        const Vec<Dim> edge = of[j] - of[i];
        const double share = (x - of[i]).dot(edge) / edge.squaredNorm();
        if (share >= 0 && share <= 1) offer(sign * (of[i] + share * edge - x));
        if constexpr (Dim == 3) {
          for (std::size_t k = j + 1; k < of.size(); ++k) {
            const Vec<3> third = of[k] - of[i], up = edge.cross(third), from = x - of[i];
            const double u = from.cross(third).dot(up) / up.squaredNorm(),
                         v = edge.cross(from).dot(up) / up.squaredNorm();
            if (u >= 0 && v >= 0 && u + v <= 1) offer(sign * (of[i] + u * edge + v * third - x));
          }
        }
      }
    }
  };
  for (const auto& x : a) to_points(x, b, 1);
  for (const auto& x : b) to_points(x, a, -1);
  if constexpr (Dim == 3) {  // edge to edge
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = i + 1; j < a.size(); ++j)
        for (std::size_t k = 0; k < b.size(); ++k)
          for (std::size_t l = k + 1; l < b.size(); ++l) {
            const Vec<3> u = a[j] - a[i], v = b[l] - b[k], w = b[k] - a[i];
            const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), whole = uu * vv - uv * uv;
            const double s = (w.dot(u) * vv - w.dot(v) * uv) / whole,
                         t = (w.dot(u) * uv - w.dot(v) * uu) / whole;
            if (s >= 0 && s <= 1 && t >= 0 && t <= 1) offer(w + t * v - s * u);
          }
  }
  return least;
}

TEST_CASE_TEMPLATE(
    "the widest margin lies between the nearest points of all edges and triangles of two clouds", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(4);
  for (int trial = 0; trial < 120; ++trial) {
    const Vec<Dim> n = random_direction<Dim>(draw);
    const double gap = uniform(draw, 0.06, 0.6);
    const int count = 1 + trial % 7;
    std::vector<Vec<Dim>> class_of[2];
    Cloud<Dim> cloud;
    for (int k = 0; k < 2 * count; ++k) {
      Vec<Dim> x;
      for (int d = 0; d < Dim; ++d) x[d] = uniform(draw, -1.5, 1.5);
      const bool b = k % 2;
      x += ((b ? 1 : -1) * (0.5 * gap + uniform(draw, 0, 1)) - x.dot(n)) * n;
      class_of[b].push_back(x);
      cloud.add(x, b ? 1.0 : -1.0);
    }
    Vec<Dim> apart;
    const double distance = plain_distance<Dim>(class_of[0], class_of[1], apart);
    const Vec<Dim> guess = 3 * (n + 0.9 * random_direction<Dim>(draw));
    const auto found = widest_margin<Dim>(cloud.view(), guess);
    CHECK(found.distance == doctest::Approx(distance).epsilon(1e-8));
    CHECK((found.normal - apart / distance).norm() < 2e-5);
    CHECK(found.iterations <= 14);
    // Hulls nearer than the smallest distance count as meeting.
    CHECK((widest_margin<Dim>(cloud.view(), guess, 0.999 * distance).normal - found.normal).norm() < 2e-5);
    CHECK(widest_margin<Dim>(cloud.view(), guess, 1.001 * distance).normal.isZero(0));
    Cloud<Dim> moved;  // one of the other class inside the hull of a
    for (int k = 0; k < cloud.count; ++k) {
      const Vec<Dim> x = point(cloud, k).template head<Dim>();
      moved.add(x, cloud.side[static_cast<std::size_t>(k)]);
    }
    Vec<Dim> middle = Vec<Dim>::Zero();
    for (const auto& x : class_of[0]) middle += x / count;
    moved.add(middle, 1.0);
    CHECK(widest_margin<Dim>(moved.view(), guess).normal.isZero(0));
  }
}

// Separations.

/// Half the extent of a domain, from its half-edges E.
template <Extent E, int Dim>
double plain_extent(const Mat<Dim>& edges, const Vec<Dim>& n) {
  if (E == Extent::radial) return 1 / (edges.inverse() * n).norm();
  const Vec<Dim> along = edges.transpose() * n;
  return E == Extent::ellipsoid ? along.norm() : along.cwiseAbs().sum();
}

template <Extent E, int Dim>
void check_extent() {
  Draw draw(5);
  for (int count = 0; count <= 20; ++count) {
    std::vector<double> xi[Dim], shape[shape_size<Dim>(E)];
    CloudColumns<Dim> columns{};
    const auto capacity = static_cast<std::size_t>(padded_count(count) + kLanes);
    for (auto& column : xi) column.assign(capacity, 1e3);  // what follows the particles is far away
    for (auto& column : shape) column.assign(capacity, 1);
    const Vec<Dim> n = random_direction<Dim>(draw);
    double most = -HUGE_VAL;
    int at = -1;
    for (int k = 0; k < count; ++k) {
      Mat<Dim> edges;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) edges(i, j) = (i == j ? 1 : 0) + uniform(draw, -0.4, 0.4);
      Lanes rows[Dim * Dim], packed[shape_size<Dim>(E)];
      for (int e = 0; e < Dim * Dim; ++e) rows[e] = broadcast<Lanes>(edges(e / Dim, e % Dim));
      domain_shape<E, Dim>(rows, packed);
      double ahead = plain_extent<E, Dim>(edges, n);
      const Lanes found = extent_along<E, Dim>(packed, n);
      for (int lane = 0; lane < kLanes; ++lane) CHECK(found[lane] == doctest::Approx(ahead).epsilon(1e-11));
      for (int e = 0; e < shape_size<Dim>(E); ++e) shape[e][static_cast<std::size_t>(k)] = packed[e][0];
      for (int d = 0; d < Dim; ++d) {
        xi[d][static_cast<std::size_t>(k)] = uniform(draw, -1, 1);
        ahead += n[d] * xi[d][static_cast<std::size_t>(k)];
      }
      if (ahead > most) most = ahead, at = k;
    }
    for (int d = 0; d < Dim; ++d) columns.xi[d] = xi[d].data();
    for (int e = 0; e < shape_size<Dim>(E); ++e) columns.shape[e] = shape[e].data();
    columns.count = count;
    const SupportSearch::Found found = reach_along<E, Dim>(columns, n);
    CHECK(found.at == at);
    if (count > 0) CHECK(found.value == doctest::Approx(most).epsilon(1e-11));
    if (count == 0) CHECK(found.value == -HUGE_VAL);
  }
}

TEST_CASE(
    "particles reach as far along a direction as their domains do, and the foremost of any number is found") {
  check_extent<Extent::radial, 2>();
  check_extent<Extent::radial, 3>();
  check_extent<Extent::ellipsoid, 2>();
  check_extent<Extent::ellipsoid, 3>();
  check_extent<Extent::parallelepiped, 2>();
  check_extent<Extent::parallelepiped, 3>();
}

TEST_CASE("separations from mean positions are those of their formulas, odd beyond the node") {
  Draw draw(6);
  const auto odd = [](double u, double power) { return u < 0 ? -std::pow(-u, power) : std::pow(u, power); };
  for (int trial = 0; trial < 300; ++trial) {
    const double a = uniform(draw, -1.6, 0.6), b = uniform(draw, -0.6, 1.6), c = uniform(draw, 0, 1.5);
    CHECK(position_offset(a, b, c) == doctest::Approx(b - a - c).epsilon(1e-13));
    const double surface_a = 1 - 2 * odd(-a / 1.25, 0.58), surface_b = 2 * odd(b / 1.25, 0.58) - 1;
    CHECK(std::abs(position_power(a, b) - (surface_b - surface_a)) < 1e-12);
    const auto far = [&](double u, bool one) {
      if (one) return u > 0.5 ? u - 0.5 : odd(2 * u, 0.5387) - 1;
      return u > 0.75 ? u - 0.25 : 1.5 * odd(4 * u / 3, 0.5546) - 1;
    };
    CHECK(std::abs(position_piecewise(a, b, 1) - far(b, true) - far(-a, true)) < 1e-12);
    CHECK(std::abs(position_piecewise(a, b, 2) - far(b, false) - far(-a, false)) < 1e-12);
  }
}

}  // namespace
