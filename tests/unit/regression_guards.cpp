/// Clouds that have no proper plane: the regression must say so, and never return anything but a unit vector
/// or zero.

#include <doctest/doctest.h>

#include "kernels/contact/regression.hpp"
#include "tests/unit/contact_cloud.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// Fits, and checks what holds for any cloud.
template <int Dim>
Regression<Dim> fit(const Cloud<Dim>& cloud, double penalty = 1e-7) {
  const auto found = fit_normal<Dim>(cloud.view(), {.penalty = penalty});
  if (found.outcome == Regression<Dim>::Outcome::failed) {
    CHECK(found.normal == Vec<Dim>::Zero());
  } else {
    CHECK(found.normal.norm() == doctest::Approx(1).epsilon(1e-14));
  }
  CHECK(found.iterations <= RegressionRule{}.max_iterations);
  return found;
}

}  // namespace

TEST_CASE_TEMPLATE("an empty class fails", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  using Outcome = typename Regression<Dim>::Outcome;
  Draw draw(1);
  Cloud<Dim> cloud;
  CHECK(fit(cloud).outcome == Outcome::failed);
  for (int k = 0; k < 9; ++k) {
    cloud.add(random_direction<Dim>(draw), -1.0);
    CHECK(fit(cloud).outcome == Outcome::failed);
  }
  for (auto& c : cloud.side) c = -c;
  CHECK(fit(cloud).outcome == Outcome::failed);
}

TEST_CASE_TEMPLATE("one particle against one gives the line between them", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  for (const double penalty : {0.0, 1e-7, 1.0})
    for (int k = 0; k < 50; ++k) {
      const Vec<Dim> a = random_direction<Dim>(draw), b = random_direction<Dim>(draw);
      Cloud<Dim> cloud;
      cloud.add(a, -1.0);
      cloud.add(b, 1.0);
      CHECK(angle_between<Dim>(fit(cloud, penalty).normal, b - a) < 1e-5);
    }
}

TEST_CASE_TEMPLATE("collinear clouds give their line", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  for (const double penalty : {0.0, 1e-7, 1e-2})
    for (int k = 0; k < 50; ++k) {
      const Vec<Dim> n = random_direction<Dim>(draw), origin = 0.3 * random_direction<Dim>(draw);
      Cloud<Dim> cloud;
      for (int p = -4; p < 4; ++p) cloud.add(origin + 0.25 * (p + 0.5) * n, p < 0 ? -1.0 : 1.0);
      CHECK(angle_between<Dim>(fit(cloud, penalty).normal, n) < 1e-5);
    }
}

TEST_CASE("clouds of one point each way, without a penalty, fall back to the centroids") {
  Cloud<2> cloud;
  cloud.add({0.5, 0.25}, -1.0);
  cloud.add({-0.5, 0.5}, 1.0);
  const auto found = fit(cloud, 0.0);
  CHECK(found.outcome == Regression<2>::Outcome::centroid_fallback);
  CHECK((found.normal - Vec<2>(-1.0, 0.25).normalized()).norm() < 1e-15);
}

TEST_CASE_TEMPLATE("a single particle against many gives a plane that parts them", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(4);
  for (int k = 0; k < 100; ++k) {
    const Vec<Dim> n = random_direction<Dim>(draw);
    Cloud<Dim> cloud;
    cloud.add(0.5 * n, 1.0);
    while (cloud.count < 15) {
      const Vec<Dim> x = random_direction<Dim>(draw) * uniform(draw, 0.2, 1.2);
      if (x.dot(n) < 0) cloud.add(x, -1.0);
    }
    const auto found = fit(cloud);
    CHECK(found.normal.dot(n) > 0);
  }
}

TEST_CASE_TEMPLATE("coincident points fail, coincident classes too", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  using Outcome = typename Regression<Dim>::Outcome;
  Draw draw(5);
  for (const double size : {0.0, 1.0, 1e6}) {
    const Vec<Dim> x = size * random_direction<Dim>(draw);
    Cloud<Dim> one_place, two_by_two;
    for (int k = 0; k < 6; ++k) one_place.add(x, k % 2 ? 1.0 : -1.0);
    CHECK(fit(one_place).outcome == Outcome::failed);
    for (int k = 0; k < 6; ++k) {
      const Vec<Dim> y = size * random_direction<Dim>(draw);
      two_by_two.add(y, -1.0);
      two_by_two.add(y, 1.0);
    }
    CHECK(fit(two_by_two).outcome == Outcome::failed);
  }
}

TEST_CASE_TEMPLATE("a ring around a core gives a unit vector towards its centroid or fails", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(6);
  for (int k = 0; k < 100; ++k) {
    Cloud<Dim> cloud;
    for (int p = 0; p < 20; ++p)
      cloud.add(random_direction<Dim>(draw) * (p % 2 ? 1.0 : 0.3), p % 2 ? 1.0 : -1.0);
    Vec<Dim> towards = Vec<Dim>::Zero();
    for (std::size_t p = 0; p < 20; ++p)
      for (std::size_t d = 0; d < Dim; ++d)
        towards[static_cast<int>(d)] += cloud.side[p] * cloud.xi[d][p] / 10.0;
    CHECK(fit(cloud).normal.dot(towards) >= 0);
  }
}

TEST_CASE_TEMPLATE("separable, distant, huge and tiny clouds stay finite and part the classes", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(7);
  for (const double penalty : {0.0, 1e-7, 1.0})
    for (const double scale : {1e-6, 1.0, 1e3, 1e6})
      for (int k = 0; k < 20; ++k) {
        const Mat<Dim> r = rotation_to<Dim>(random_direction<Dim>(draw), draw);
        Cloud<Dim> cloud = touching_blocks<Dim>(r, 0.1, 0.2, 1.25, draw);
        for (auto& column : cloud.xi)
          for (auto& x : column) x *= scale;
        const auto found = fit(cloud, penalty);
        CHECK(found.outcome != Regression<Dim>::Outcome::failed);
        CHECK(found.normal.dot(r.col(0)) > 0.8);
      }
}

TEST_CASE("random clouds of every size never give anything but a unit vector or failure") {
  Draw draw(8);
  for (int k = 0; k < 20000; ++k) {
    Cloud<2> cloud;
    const int count = static_cast<int>(uniform(draw, 0, 12));
    // Coordinates on a coarse lattice: many coincide, many clouds are collinear.
    for (int p = 0; p < count; ++p)
      cloud.add({std::floor(uniform(draw, -2, 2)), std::floor(uniform(draw, -2, 2))},
                uniform(draw, -1, 1) < 0 ? -1 : 1);
    fit(cloud, k % 2 ? 1e-7 : 0.0);
  }
}

TEST_CASE("coordinates that are not numbers fail") {
  Cloud<2> cloud;
  cloud.add({0.0, std::nan("")}, -1.0);
  cloud.add({1.0, 0.0}, 1.0);
  CHECK(fit(cloud).outcome == Regression<2>::Outcome::failed);
}
