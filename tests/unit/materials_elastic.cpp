/// Stress against the derivative of the stored energy, objectivity, and the wave speed of the elastic laws.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/dimension.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/neo_hookean.hpp"

using namespace mpmfast;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;
using Draw = std::mt19937_64;

constexpr NeoHookean kSolid{1000, 2450e6, 940e6};
constexpr LinearElastic kLinear{1000, 2500e6, 0.33};
constexpr LogarithmicNeoHookean kLogarithmic{1010, 104.4e6, 26.1e6};

double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

/// Any deformation with J between 0.3 and 2.
template <int Dim>
Mat<Dim> random_deformation(Draw& draw) {
  Mat<Dim> f;
  do {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f(i, j) = (i == j) + uniform(draw, -0.8, 0.8);
  } while (f.determinant() < 0.3 || f.determinant() > 2);
  return f;
}

template <int Dim>
Vec<Dim> random_direction(Draw& draw) {
  std::normal_distribution<double> gauss;
  Vec<Dim> n;
  for (int d = 0; d < Dim; ++d) n[d] = gauss(draw);
  return n.normalized();
}

template <int Dim>
Mat<Dim> random_rotation(Draw& draw) {
  const double angle = uniform(draw, -3, 3);
  if constexpr (Dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, random_direction<3>(draw)).toRotationMatrix();
}

template <int Dim>
struct Rows {
  double f[Dim * Dim];
  explicit Rows(const Mat<Dim>& m) {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f[Dim * i + j] = m(i, j);
  }
};

template <int Dim, class Law>
double energy(const Law& law, const Mat<Dim>& f) {
  return law.template energy<Dim>(Rows<Dim>(f).f);
}

/// The 3×3 Kirchhoff stress (zz included in 2-D), and c².
template <int Dim, class Law>
Mat<3> stress(const Law& law, const Mat<Dim>& f, double* wave_speed_squared = nullptr) {
  double tau[kSymmetric<Dim>], c2;
  law.template stress<Dim>(Rows<Dim>(f).f, tau, c2);
  if (wave_speed_squared) *wave_speed_squared = c2;
  Mat<3> t = Vec<3>(tau[0], tau[1], tau[2]).asDiagonal();
  t(0, 1) = t(1, 0) = tau[3];
  if constexpr (Dim == 3) {
    t(1, 2) = t(2, 1) = tau[4];
    t(0, 2) = t(2, 0) = tau[5];
  }
  return t;
}

/// Fourth-order central difference.
template <class F>
double derivative(F f, double h) {
  return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
}

template <int Dim>
Mat<Dim> unit_matrix(int i, int j) {
  Mat<Dim> m = Mat<Dim>::Zero();
  m(i, j) = 1;
  return m;
}

/// ρc²/ρ0 of a wave along n with polarisation m, d²W/dε² for F(ε) = (I + ε m⊗n) F, from the stress:
/// dW/dε = τ : (m⊗n)(I + ε m⊗n)⁻¹.
template <int Dim, class Law>
double acoustic(const Law& law, const Mat<Dim>& f, const Vec<Dim>& m, const Vec<Dim>& n) {
  const Mat<Dim> mn = m * n.transpose();
  return derivative(
      [&](double e) {
        const Mat<Dim> step = Mat<Dim>::Identity() + e * mn;
        const Mat<Dim> tau = stress<Dim>(law, Mat<Dim>(step * f)).template topLeftCorner<Dim, Dim>();
        return tau.cwiseProduct(mn * step.inverse()).sum();
      },
      1e-3);
}

}  // namespace

// W of one term is about 1e9 J/m³; a difference of step 1e-3 leaves 1e-13·1e9/1e-3 = 0.1 Pa of round-off and
// 1e-12·(fifth derivative) of truncation: 1e-8 of the moduli is ample for both.
template <int Dim, class Law>
void check_stress(const Law& law, double modulus) {
  Draw draw(1);
  for (int k = 0; k < 200; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    const Mat<3> tau = stress<Dim>(law, f);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        // exp(ε e_i⊗e_j) is I + ε e_i⊗e_j off the diagonal, and e^ε on it.
        const double slope = derivative(
            [&](double e) {
              Mat<Dim> step = Mat<Dim>::Identity();
              step(i, j) = i == j ? std::exp(e) : e;
              return energy<Dim>(law, Mat<Dim>(step * f));
            },
            1e-3);
        CHECK(std::abs(tau(i, j) - slope) < 1e-8 * (modulus + tau.norm()));
      }
  }
}
TEST_CASE_TEMPLATE("neo-Hookean: the Kirchhoff stress is the derivative of W along exp(ε e) F", D, TwoD,
                   ThreeD) {
  check_stress<D::value>(kSolid, kSolid.bulk);
  check_stress<D::value>(kLogarithmic, kLogarithmic.lambda);
}

TEST_CASE("neo-Hookean: plane strain is the 3-D law with F_zz = 1, out-of-plane stress included") {
  Draw draw(2);
  for (int k = 0; k < 100; ++k) {
    const Mat<2> f = random_deformation<2>(draw);
    Mat<3> g = Mat<3>::Identity();
    g.topLeftCorner<2, 2>() = f;
    CHECK((stress<2>(kSolid, f) - stress<3>(kSolid, g)).norm() <
          1e-13 * (kSolid.bulk + stress<3>(kSolid, g).norm()));
    CHECK(energy<2>(kSolid, f) == doctest::Approx(energy<3>(kSolid, g)).epsilon(1e-12));
  }
}

TEST_CASE_TEMPLATE("neo-Hookean is objective: W(RF) = W(F), τ(RF) = R τ Rᵀ", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  for (int k = 0; k < 200; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw), r = random_rotation<Dim>(draw);
    Mat<3> turn = Mat<3>::Identity();
    turn.topLeftCorner<Dim, Dim>() = r;
    const Mat<3> tau = stress<Dim>(kSolid, f), turned = stress<Dim>(kSolid, Mat<Dim>(r * f));
    CHECK((turned - turn * tau * turn.transpose()).norm() < 1e-12 * (kSolid.bulk + tau.norm()));
    CHECK(std::abs(energy<Dim>(kSolid, Mat<Dim>(r * f)) - energy<Dim>(kSolid, f)) < 1e-12 * kSolid.bulk);
  }
}

TEST_CASE_TEMPLATE("undeformed: no stress, no energy, c² = (K + 4G/3)/ρ or (λ + 2G)/ρ", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  const Mat<Dim> identity = Mat<Dim>::Identity();
  double c2;
  CHECK(stress<Dim>(kSolid, identity, &c2).norm() < 1e-15 * kSolid.bulk);
  CHECK(std::abs(energy<Dim>(kSolid, identity)) < 1e-15 * kSolid.bulk);
  CHECK(c2 >= (kSolid.bulk + 4.0 / 3.0 * kSolid.shear) / kSolid.density * (1 - 1e-14));
  CHECK(stress<Dim>(kLogarithmic, identity, &c2).norm() < 1e-15 * kLogarithmic.lambda);
  CHECK(std::abs(energy<Dim>(kLogarithmic, identity)) < 1e-15 * kLogarithmic.lambda);
  CHECK(c2 == doctest::Approx((104.4e6 + 2 * 26.1e6) / 1010).epsilon(1e-14));
  CHECK(stress<Dim>(kLinear, identity, &c2).norm() == 0);
  CHECK(energy<Dim>(kLinear, identity) == 0);
  CHECK(c2 == doctest::Approx((kLinear.lambda() + 2 * kLinear.shear()) / kLinear.density).epsilon(1e-14));
}

TEST_CASE_TEMPLATE("linear elastic: P = ∂W/∂F", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(4);
  for (int k = 0; k < 50; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    const Mat<3> p = stress<Dim>(kLinear, f);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        const double slope = derivative(
            [&](double e) { return energy<Dim>(kLinear, Mat<Dim>(f + e * unit_matrix<Dim>(i, j))); }, 1e-3);
        CHECK(std::abs(p(i, j) - slope) < 1e-9 * kLinear.lambda());
      }
  }
}

TEST_CASE_TEMPLATE("neo-Hookean: the stress at small strain is Hooke's", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(5);
  const double sum = 3 * kSolid.bulk + kSolid.shear;  // E = 9KG/(3K + G), ν = (3K − 2G)/(2(3K + G))
  const LinearElastic hooke{kSolid.density, 9 * kSolid.bulk * kSolid.shear / sum,
                            (1.5 * kSolid.bulk - kSolid.shear) / sum};
  for (int k = 0; k < 20; ++k) {
    const Mat<Dim> h = random_deformation<Dim>(draw) * 1e-6, f = Mat<Dim>::Identity() + h;
    CHECK((stress<Dim>(kSolid, f) - stress<Dim>(hooke, f)).norm() < 1e-4 * stress<Dim>(hooke, f).norm());
  }
}

TEST_CASE_TEMPLATE("neo-Hookean: no longitudinal wave outruns the stated speed", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(6);
  for (int k = 0; k < 100; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    double c2, fastest = 0, c2_logarithmic, fastest_logarithmic = 0;
    stress<Dim>(kSolid, f, &c2);
    stress<Dim>(kLogarithmic, f, &c2_logarithmic);
    for (int s = 0; s < 300; ++s) {
      const Vec<Dim> n = random_direction<Dim>(draw);
      fastest = std::max(fastest, acoustic<Dim>(kSolid, f, n, n) / kSolid.density);
      fastest_logarithmic =
          std::max(fastest_logarithmic, acoustic<Dim>(kLogarithmic, f, n, n) / kLogarithmic.density);
    }
    CHECK(fastest <= c2 * (1 + 1e-8));
    CHECK(fastest_logarithmic <= c2_logarithmic * (1 + 1e-8));
    if (Dim == 2) CHECK(fastest > c2 * (1 - 1e-3));  // exact in 2-D, but for the finite sample
    if (Dim == 2) CHECK(fastest_logarithmic > c2_logarithmic * (1 - 1e-3));
  }
}

TEST_CASE_TEMPLATE("at small strain the stated speed is the fastest wave's, in 3-D a bound close to it", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(7);
  const Mat<Dim> h = (random_deformation<Dim>(draw) - Mat<Dim>::Identity()) * 1e-8;
  double c2;
  stress<Dim>(kSolid, Mat<Dim>(Mat<Dim>::Identity() + h), &c2);
  double fastest = 0;
  for (int s = 0; s < 100; ++s) {
    const Vec<Dim> n = random_direction<Dim>(draw);
    fastest =
        std::max(fastest, acoustic<Dim>(kSolid, Mat<Dim>(Mat<Dim>::Identity() + h), n, n) / kSolid.density);
  }
  CHECK(c2 > fastest * (1 - 1e-6));
  CHECK(c2 < fastest * (1 + (Dim == 2 ? 1e-6 : 0.025)));  // the bound in 3-D leaves 2 % at these moduli
}

TEST_CASE_TEMPLATE("lanes of particles get the stresses of one by one", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(8);
  Lanes f[Dim * Dim], tau[kSymmetric<Dim>], c2;
  Mat<Dim> each[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    each[i] = random_deformation<Dim>(draw);
    for (int e = 0; e < Dim * Dim; ++e) f[e][i] = Rows<Dim>(each[i]).f[e];
  }
  kSolid.stress<Dim>(f, tau, c2);
  const Lanes w = kSolid.energy<Dim>(f);
  for (int i = 0; i < kLanes; ++i) {
    double alone[kSymmetric<Dim>], speed;
    kSolid.stress<Dim>(Rows<Dim>(each[i]).f, alone, speed);
    for (int s = 0; s < kSymmetric<Dim>; ++s)
      CHECK(std::abs(tau[s][i] - alone[s]) < 1e-13 * (kSolid.bulk + std::abs(alone[s])));
    CHECK(double{c2[i]} == doctest::Approx(speed).epsilon(1e-13));
    CHECK(std::abs(w[i] - energy<Dim>(kSolid, each[i])) < 1e-13 * kSolid.bulk);
  }
}

TEST_CASE_TEMPLATE("the deformation gradient advances by the exponential's first terms", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(9);
  const Mat<Dim> f = random_deformation<Dim>(draw), l = random_deformation<Dim>(draw);
  const double dt = 0.01;
  const Mat<Dim> one = Mat<Dim>::Identity() + dt * l, two = one + 0.5 * dt * dt * l * l;
  for (int terms = 1; terms <= 2; ++terms) {
    Rows<Dim> rows(f);
    advance_deformation<Dim>(Rows<Dim>(l).f, dt, terms, rows.f);
    const Mat<Dim> expected = (terms == 1 ? one : two) * f;
    for (int e = 0; e < Dim * Dim; ++e)
      CHECK(rows.f[e] == doctest::Approx(Rows<Dim>(expected).f[e]).epsilon(1e-14));
  }
}
