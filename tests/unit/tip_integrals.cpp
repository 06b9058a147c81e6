// Integrals about the tip of a crack, of fields that are known.

#include <doctest/doctest.h>

#include <cmath>

#include "kernels/fracture/tip_integrals.hpp"

namespace mpmfast {
namespace {

constexpr double kShear = 3e9, kPoisson = 0.3, kRadius = 0.02;

/// The displacement of Williams' fields with two intensities, m.
Vec<2> displacement(double one, double two, double kappa, const Vec<2>& x) {
  const double r = x.norm(), t = 0.5 * std::atan2(x[1], x[0]);
  const double s = std::sin(t), c = std::cos(t), size = std::sqrt(r / kFullTurn) / (2 * kShear);
  return size * (one * Vec<2>(c * (kappa - 1 + 2 * s * s), s * (kappa + 1 - 2 * c * c)) +
                 two * Vec<2>(s * (kappa + 1 + 2 * c * c), -c * (kappa - 1 - 2 * s * s)));
}

/// All integrals of them, with a stress along the crack beside; slopes by differences, stresses by Hooke.
TipIntegrals integrate(double one, double two, double along, double kappa) {
  TipIntegrals out(kRadius, 8 * kShear / (kappa + 1));
  constexpr int kRings = 60, kAngles = 240;
  const double poisson = 0.25 * (3 - kappa);  // of the plane: ε_ij = (σ_ij − this σ_kk δ_ij)/2G
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAngles; ++k) {
      const double r = kRadius * (i + 0.5) / kRings, angle = kFullTurn * ((k + 0.5) / kAngles - 0.5);
      TipSample sample;
      sample.place = r * Vec<2>(std::cos(angle), std::sin(angle));
      sample.moved = displacement(one, two, kappa, sample.place);
      sample.area = r * kRadius / kRings * kFullTurn / kAngles;
      for (int j = 0; j < 2; ++j) {
        Vec<2> step = Vec<2>::Zero();
        step[j] = 1e-5 * r;
        sample.slope.col(j) = (displacement(one, two, kappa, sample.place + step) -
                               displacement(one, two, kappa, sample.place - step)) /
                              (2 * step[j]);
      }
      sample.slope(0, 0) += along * (1 - poisson) / (2 * kShear);
      sample.moved +=
          along / (2 * kShear) * Vec<2>((1 - poisson) * sample.place[0], -poisson * sample.place[1]);
      sample.slope(1, 1) -= along * poisson / (2 * kShear);
      const Mat<2> strain = 0.5 * (sample.slope + sample.slope.transpose());
      const double trace = strain.trace() / (1 - 2 * poisson);
      sample.stress = 2 * kShear * (strain + poisson * trace * Mat<2>::Identity());
      sample.energy = 0.5 * sample.stress.cwiseProduct(strain).sum();
      out.add(sample);
    }
  return out;
}

TEST_CASE(
    "the integrals have the intensities of Williams' fields, in each mode, and J is the sum of their squares "
    "over E'") {
  for (const double kappa : {3 - 4 * kPoisson, (3 - kPoisson) / (1 + kPoisson)}) {
    const double modulus = 8 * kShear / (kappa + 1);
    for (const auto& [one, two] : {std::pair{1e6, 0.0}, {0.0, 1e6}, {2e6, -0.7e6}}) {
      const TipIntegrals found = integrate(one, two, 0, kappa);
      CHECK(found.intensities()[1] == doctest::Approx(one).epsilon(0.01).scale(1e6));
      CHECK(found.intensities()[0] == doctest::Approx(two).epsilon(0.01).scale(1e6));
      CHECK(found.release() == doctest::Approx((one * one + two * two) / modulus).epsilon(2e-3).scale(0));
    }
  }
}

TEST_CASE("a stress along the crack changes none of them") {
  const double kappa = 3 - 4 * kPoisson;
  const TipIntegrals without = integrate(1e6, 0.3e6, 0, kappa), with = integrate(1e6, 0.3e6, 5e6, kappa);
  CHECK(with.intensities()[1] == doctest::Approx(without.intensities()[1]).epsilon(2e-3).scale(0));
  CHECK(with.intensities()[0] == doctest::Approx(without.intensities()[0]).epsilon(2e-3).scale(1e6));
  CHECK(with.release() == doctest::Approx(without.release()).epsilon(2e-3).scale(0));
}

}  // namespace
}  // namespace mpmfast
