/// The matrix exponential against its definition, its invariants, and rotations that come back.

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/dimension.hpp"
#include "kernels/materials/kinematics.hpp"

using namespace mpmfast;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;
using Draw = std::mt19937_64;

template <int Dim>
Mat<Dim> random_matrix(Draw& draw, double size) {
  std::uniform_real_distribution<double> entry(-size, size);
  Mat<Dim> m;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) m(i, j) = entry(draw);
  return m;
}

template <int Dim>
void to_rows(const Mat<Dim>& m, double (&rows)[Dim * Dim]) {
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) rows[Dim * i + j] = m(i, j);
}
template <int Dim>
Mat<Dim> from_rows(const double (&rows)[Dim * Dim]) {
  Mat<Dim> m;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) m(i, j) = rows[Dim * i + j];
  return m;
}

template <int Dim>
Mat<Dim> found(const Mat<Dim>& m) {
  double a[Dim * Dim], e[Dim * Dim];
  to_rows<Dim>(m, a);
  matrix_exponential<Dim>(a, e);
  return from_rows<Dim>(e);
}

/// The sum of A^n/n!, in extended precision.
template <int Dim>
Mat<Dim> by_definition(const Mat<Dim>& m) {
  using Wide = Eigen::Matrix<long double, Dim, Dim>;
  const Wide a = m.template cast<long double>();
  Wide power = Wide::Identity(), sum = power;
  for (int n = 1; n < 80; ++n) {
    power = power * a / static_cast<long double>(n);
    sum += power;
  }
  return sum.template cast<double>();
}

}  // namespace

TEST_CASE_TEMPLATE("the matrix exponential is the sum of its series, and its determinant e^tr", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(1);
  double error = 0, error_of_volume = 0;
  for (int k = 0; k < 2000; ++k) {
    const Mat<Dim> a = random_matrix<Dim>(draw, k % 2 ? 0.1 : 0.8);
    const Mat<Dim> e = found<Dim>(a), expected = by_definition<Dim>(a);
    error = std::max(error, (e - expected).norm() / expected.norm());
    error_of_volume = std::max(error_of_volume, std::abs(e.determinant() / std::exp(a.trace()) - 1));
  }
  CHECK(error < 2e-15);            // 3e-16 and 7e-16 in 2-D and 3-D
  CHECK(error_of_volume < 1e-14);  // 9e-16 and 3e-15: the determinant's own terms cancel
}

TEST_CASE_TEMPLATE("lanes get the exponentials of one by one, and F advances by them", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  const double dt = 0.3;
  Lanes l[Dim * Dim], f[Dim * Dim];
  Mat<Dim> each[kLanes];
  const Mat<Dim> start = Mat<Dim>::Identity() + random_matrix<Dim>(draw, 0.2);
  for (int i = 0; i < kLanes; ++i) {
    each[i] = random_matrix<Dim>(draw, 1.0);
    for (int e = 0; e < Dim * Dim; ++e) {
      l[e][i] = each[i](e / Dim, e % Dim);
      f[e][i] = start(e / Dim, e % Dim);
    }
  }
  advance_deformation<Dim>(l, dt, kAllTerms, f);
  for (int i = 0; i < kLanes; ++i) {
    const Mat<Dim> expected = by_definition<Dim>(dt * each[i]) * start;
    for (int e = 0; e < Dim * Dim; ++e)
      CHECK(double{f[e][i]} == doctest::Approx(expected(e / Dim, e % Dim)).epsilon(1e-14));
  }
}

TEST_CASE("a full turn in any number of steps ends where it began") {
  for (const int steps : {3, 4, 7, 100, 5000}) {
    const double dt = 1e-6, rate = 2 * 3.14159265358979323846 / (steps * dt);
    const double plane[4] = {0, -rate, rate, 0};
    // About the axis (2, −1, 2)/3.
    const double space[9] = {0,        -2 * rate / 3, -rate / 3, 2 * rate / 3, 0, -2 * rate / 3,
                             rate / 3, 2 * rate / 3,  0};
    double f2[4] = {1.1, 0.2, -0.1, 0.9}, f3[9] = {1.1, 0.2, 0, -0.1, 0.9, 0.3, 0, 0, 1};
    const Mat<2> start2 = from_rows<2>(f2);
    const Mat<3> start3 = from_rows<3>(f3);
    for (int k = 0; k < steps; ++k) {
      advance_deformation<2>(plane, dt, kAllTerms, f2);
      advance_deformation<3>(space, dt, kAllTerms, f3);
    }
    CAPTURE(steps);
    // Each step rounds every entry by a few 1e-16; 3e-13 at most, after 5000.
    const double tolerance = 1e-15 * (5 + 0.2 * steps);
    CHECK((from_rows<2>(f2) - start2).norm() < tolerance);
    CHECK((from_rows<3>(f3) - start3).norm() < tolerance);
  }
}
