/// The normal of widest margin: between the nearest points of two hulls.

#include <doctest/doctest.h>

#include "kernels/contact/margin.hpp"
#include "tests/unit/contact_cloud.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// Points on both sides of a slab of half-width h about the plane through the origin: row-wise in a, a row of
/// b.
template <int Dim>
Cloud<Dim> rows(const Mat<Dim>& r, double half, double from, double to) {
  Cloud<Dim> cloud;
  for (int layer = 0; layer < 2; ++layer)
    for (double t = -1.25; t <= 1.26; t += 0.5)
      for (double u = -1.25; u <= (Dim == 3 ? 1.26 : -1.25); u += 0.5) {
        Vec<Dim> x = Vec<Dim>::Zero();
        x[1] = t;
        if (Dim == 3) x[Dim - 1] = u;
        x[0] = -half - 0.5 * layer;
        cloud.add(r * x, -1.0);
        if (t < from || t > to) continue;
        x[0] = half + 0.5 * layer;
        cloud.add(r * x, 1.0);
      }
  return cloud;
}

}  // namespace

TEST_CASE_TEMPLATE("flat surfaces have their normal to round-off, however little of one the cloud holds", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(1);
  for (const double end : {1.3, 0.3, -0.2, -0.7, -1.2})  // down to one row of b
    for (int k = 0; k < 20; ++k) {
      const Mat<Dim> r = rotation_to<Dim>(random_direction<Dim>(draw), draw);
      const auto cloud = rows<Dim>(r, 0.25, -1.3, end);
      const Vec<Dim> guess = (Vec<Dim>(r.col(0)) + 0.8 * random_direction<Dim>(draw)).normalized();
      const auto found = widest_margin<Dim>(cloud.view(), guess);
      CHECK((found.normal - r.col(0)).norm() < 1e-6);
      CHECK(found.distance == doctest::Approx(0.5).epsilon(1e-9));
      CHECK(found.iterations <= 12);
    }
}

TEST_CASE_TEMPLATE(
    "no plane parts the clouds by more: every pair of points is at least as far apart along it", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  int separable = 0;
  for (int k = 0; k < 300; ++k) {
    Cloud<Dim> cloud;
    const Vec<Dim> n = random_direction<Dim>(draw);
    for (int p = 0; p < 24; ++p) {
      Vec<Dim> x;
      for (int d = 0; d < Dim; ++d) x[d] = uniform(draw, -1, 1);
      const double along = x.dot(n);
      cloud.add(x + 0.1 * (along < 0 ? -1.0 : 1.0) * n, along < 0 ? -1.0 : 1.0);
    }
    const auto found = widest_margin<Dim>(cloud.view(), n);
    if (found.normal.isZero(0)) continue;
    ++separable;
    // The gap along the normal is the hulls' distance; along any other direction it is smaller.
    const auto gap = [&](const Vec<Dim>& m) {
      double front = -1e300, back = 1e300;
      for (int p = 0; p < cloud.count; ++p) {
        double along = 0;
        for (int d = 0; d < Dim; ++d) along += m[d] * cloud.view().xi[d][p];
        if (cloud.view().side[p] < 0)
          front = std::max(front, along);
        else
          back = std::min(back, along);
      }
      return back - front;
    };
    CHECK(gap(found.normal) == doctest::Approx(found.distance).epsilon(1e-6));
    CHECK(found.distance >= gap(n) - 1e-9);
    for (int t = 0; t < 20; ++t)
      CHECK(gap((found.normal + 0.1 * random_direction<Dim>(draw)).normalized()) < found.distance + 1e-9);
  }
  CHECK(separable > 250);
}

TEST_CASE_TEMPLATE("hulls that meet, single points and empty classes", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  Cloud<Dim> cloud;
  CHECK(widest_margin<Dim>(cloud.view(), Vec<Dim>::Unit(0)).normal.isZero(0));
  cloud.add(Vec<Dim>::Zero(), -1.0);
  CHECK(widest_margin<Dim>(cloud.view(), Vec<Dim>::Unit(0)).normal.isZero(0));
  const Vec<Dim> b = random_direction<Dim>(draw);
  cloud.add(b, 1.0);
  CHECK((widest_margin<Dim>(cloud.view(), Vec<Dim>(-b)).normal - b).norm() <
        1e-12);  // even from a wrong guess
  for (int k = 0; k < 40; ++k)
    cloud.add(uniform(draw, 0.5, 1.5) * random_direction<Dim>(draw), 1.0);  // around a
  CHECK(widest_margin<Dim>(cloud.view(), b).normal.isZero(0));
}
