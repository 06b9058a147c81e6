// Plane stress: the stretch along the normal, the stress and the waves of the energy that it leaves.

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "kernels/dimension.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/neo_hookean.hpp"
#include "kernels/materials/out_of_plane.hpp"

using namespace mpmfast;

namespace {

using Draw = std::mt19937_64;

constexpr NeoHookean kSolid{1000, 2450e6, 940e6};
constexpr LinearElastic kLinear{1000, 2500e6, 0.33};
constexpr LogarithmicNeoHookean kLogarithmic{1010, 104.4e6, 26.1e6};

double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

Mat<2> random_deformation(Draw& draw, double size) {
  Mat<2> f;
  do {
    for (int e = 0; e < 4; ++e) f(e / 2, e % 2) = (e % 3 == 0) + uniform(draw, -size, size);
  } while (f.determinant() < 0.3 || f.determinant() > 2);
  return f;
}

struct Rows {
  double f[4];
  explicit Rows(const Mat<2>& m) : f{m(0, 0), m(0, 1), m(1, 0), m(1, 1)} {}
};

/// The plane_stress stretch from far away, by as many rounds as it takes.
template <class Law>
double stretch(const Law& law, const Mat<2>& f) {
  double s = 1;
  for (int k = 0; k < 20; ++k) s = law.out_of_plane_stretch(Rows(f).f, s);
  return s;
}

template <class Law>
double energy(const Law& law, const Mat<2>& f) {
  double full[9];
  embed(Rows(f).f, stretch(law, f), full);
  return law.template energy<3>(full);
}

/// xx, yy, zz, xy, yz, xz.
template <class Law>
std::array<double, 6> stress(const Law& law, const Mat<2>& f, double s) {
  double full[9], tau[6], c2;
  embed(Rows(f).f, s, full);
  law.template stress<3>(full, tau, c2);
  return {tau[0], tau[1], tau[2], tau[3], tau[4], tau[5]};
}

/// Fourth-order central difference.
template <class F>
double derivative(F f, double h) {
  return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
}

/// W(ε) of F(ε) = (I + ε n⊗n) F, twice differentiated.
template <class Law>
double plate_modulus(const Law& law, const Mat<2>& f, const Vec<2>& n) {
  const Mat<2> nn = n * n.transpose();
  return derivative(
      [&](double e) {
        const Mat<2> step = Mat<2>::Identity() + e * nn, g = step * f;
        const auto tau = stress(law, g, stretch(law, g));
        Mat<2> t;
        t << tau[0], tau[3], tau[3], tau[1];
        return t.cwiseProduct(nn * step.inverse()).sum();
      },
      1e-3);
}

/// Uniaxial tension along x to λ: the width μ at which τ_yy vanishes, by bisection, and τ_xx.
template <class Law>
void pull(const Law& law, double length, double& width, double& tau_xx) {
  double low = 0.3, high = 2;
  for (int k = 0; k < 60; ++k) {
    width = 0.5 * (low + high);
    const Mat<2> f = Vec<2>(length, width).asDiagonal();
    const auto tau = stress(law, f, stretch(law, f));
    tau_xx = tau[0];
    (tau[1] > 0 ? high : low) = width;
  }
}

template <class Law>
void check_energy(const Law& law, double modulus) {
  Draw draw(1);
  for (int k = 0; k < 200; ++k) {
    const Mat<2> f = random_deformation(draw, 0.6);
    const auto tau = stress(law, f, stretch(law, f));
    CHECK(std::abs(tau[2]) < 1e-13 * modulus * (1 + f.squaredNorm()));
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        const double slope = derivative(
            [&](double e) {
              Mat<2> step = Mat<2>::Identity();
              step(i, j) = i == j ? std::exp(e) : e;
              return energy(law, Mat<2>(step * f));
            },
            1e-3);
        CHECK(std::abs(tau[i == j ? static_cast<std::size_t>(i) : 3] - slope) < 1e-8 * modulus);
      }
  }
}

// Tolerances as for the full laws (materials_elastic.cpp).
TEST_CASE("plane stress: τ_zz vanishes, and the stress is the derivative of the energy that is left") {
  check_energy(kSolid, kSolid.bulk);
  check_energy(kLogarithmic, kLogarithmic.lambda);
}

TEST_CASE("plane stress, linear elastic: σ_xx = E/(1 − ν²)(ε_xx + ν ε_yy), σ_zz = 0") {
  const double nu = kLinear.poisson;
  const double plate = 2 * kLinear.shear() * (1 + nu) / (1 - nu * nu);
  Mat<2> f;
  f << 1.02, 0.01, 0.03, 0.97;
  const auto tau = stress(kLinear, f, stretch(kLinear, f));
  CHECK(tau[0] == doctest::Approx(plate * (0.02 - nu * 0.03)).epsilon(1e-12));
  CHECK(tau[1] == doctest::Approx(plate * (-0.03 + nu * 0.02)).epsilon(1e-12));
  CHECK(tau[3] == doctest::Approx(2 * kLinear.shear() * 0.02).epsilon(1e-12));
  CHECK(std::abs(tau[2]) < 1e-15 * plate);
  CHECK(kLinear.plate_wave_speed_squared(Rows(f).f, 1.0) * kLinear.density ==
        doctest::Approx(plate).epsilon(1e-14));
}

/// In uniaxial tension both sides shrink alike, and the axial stress is what one dimension knows.
template <class Law>
void check_tension(const Law& law, double young) {
  for (double length : {0.6, 0.9, 1.3, 1.9}) {
    double width, tau;
    pull(law, length, width, tau);
    const Mat<2> f = Vec<2>(length, width).asDiagonal();
    CHECK(stretch(law, f) == doctest::Approx(width).epsilon(1e-12));
    // dW/d ln λ along the path on which both sides are free.
    const double slope = derivative(
        [&](double e) {
          double w, ignored;
          pull(law, length * std::exp(e), w, ignored);
          return energy(law, Mat<2>(Vec<2>(length * std::exp(e), w).asDiagonal()));
        },
        1e-3);
    CHECK(tau == doctest::Approx(slope).epsilon(1e-8));
  }
  double width, tau;
  pull(law, 1 + 1e-6, width, tau);
  CHECK(tau / 1e-6 == doctest::Approx(young).epsilon(1e-5));  // E (1 + O(ε))
}
TEST_CASE("plane stress: uniaxial tension has Young's modulus at small strain and equal sides at any") {
  check_tension(kSolid, 9 * kSolid.bulk * kSolid.shear / (3 * kSolid.bulk + kSolid.shear));
  const double lambda = kLogarithmic.lambda, mu = kLogarithmic.shear;
  check_tension(kLogarithmic, mu * (3 * lambda + 2 * mu) / (lambda + mu));
}

TEST_CASE("logarithmic neo-Hookean tension: λ(2 ln w + ln l) = μ(1 − w²), τ = μ(l² − w²)") {
  double width, tau;
  pull(kLogarithmic, 1.4, width, tau);
  CHECK(kLogarithmic.lambda * (2 * std::log(width) + std::log(1.4)) ==
        doctest::Approx(kLogarithmic.shear * (1 - width * width)).epsilon(1e-11));
  CHECK(tau == doctest::Approx(kLogarithmic.shear * (1.4 * 1.4 - width * width)).epsilon(1e-11));
}

/// One call from the stretch of a strain that was 2 % away, more than a step of any simulation.
template <class Law>
double worst_residual(const Law& law, double modulus) {
  Draw draw(2);
  double worst = 0;
  for (int k = 0; k < 500; ++k) {
    const Mat<2> f = random_deformation(draw, 0.6);
    Mat<2> change = Mat<2>::Identity();
    for (int e = 0; e < 4; ++e) change(e / 2, e % 2) += uniform(draw, -0.02, 0.02);
    const double s = law.out_of_plane_stretch(Rows(Mat<2>(change * f)).f, stretch(law, f));
    worst = std::max(worst, std::abs(stress(law, Mat<2>(change * f), s)[2]) / modulus);
  }
  return worst;
}
TEST_CASE("plane stress: the rounds of one step reach round-off") {
  CHECK(worst_residual(kSolid, kSolid.bulk) < 5e-15);
  CHECK(worst_residual(kLogarithmic, kLogarithmic.lambda) < 5e-15);
}

template <class Law>
void check_waves(const Law& law) {
  Draw draw(3);
  for (int k = 0; k < 60; ++k) {
    const Mat<2> f = random_deformation(draw, 0.6);
    const double s = stretch(law, f), c2 = law.plate_wave_speed_squared(Rows(f).f, s);
    double fastest = 0, full[9], tau[6], solid;
    for (int n = 0; n < 300; ++n) {
      const double angle = uniform(draw, 0, 3.2);
      const Vec<2> direction(std::cos(angle), std::sin(angle));
      fastest = std::max(fastest, plate_modulus(law, f, direction) / law.density);
    }
    CHECK(fastest <= c2 * (1 + 1e-8));
    CHECK(fastest > c2 * (1 - 1e-3));  // but for the finite sample
    embed(Rows(f).f, s, full);
    law.template stress<3>(full, tau, solid);
    CHECK(c2 < solid);
  }
}
TEST_CASE("plane stress: the stated speed is that of the fastest longitudinal wave in the plane") {
  check_waves(kSolid);
  check_waves(kLogarithmic);
}

TEST_CASE("plane stress: lanes of particles get the stretches of one by one") {
  Draw draw(4);
  Lanes f[4], last;
  double alone[kLanes], speed[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const Mat<2> m = random_deformation(draw, 0.3);
    last[i] = uniform(draw, 0.9, 1.1);
    for (int e = 0; e < 4; ++e) f[e][i] = Rows(m).f[e];
    alone[i] = kSolid.out_of_plane_stretch(Rows(m).f, last[i]);
    speed[i] = kSolid.plate_wave_speed_squared(Rows(m).f, alone[i]);
  }
  const Lanes s = kSolid.out_of_plane_stretch(f, last), c2 = kSolid.plate_wave_speed_squared(f, s);
  for (int i = 0; i < kLanes; ++i) {
    CHECK(s[i] == doctest::Approx(alone[i]).epsilon(1e-13));
    CHECK(c2[i] == doctest::Approx(speed[i]).epsilon(1e-12));
  }
}

}  // namespace
