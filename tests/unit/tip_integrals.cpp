// Integrals about the tip of a crack, of fields that are known.

#include <doctest/doctest.h>

#include <cmath>

#include "kernels/fracture/kink.hpp"
#include "kernels/fracture/tip_integrals.hpp"

namespace mpmfast {
namespace {

/// A straight crack.
const TipPath& straight() {
  static const TipPath path({{0, 0}, {-1, 0}}, 0.02, 1e-3);
  return path;
}

constexpr double kShear = 3e9, kPoisson = 0.3, kRadius = 0.02;

/// The displacement of Williams' fields with two intensities, m.
Vec<2> displacement(double one, double two, double kappa, const Vec<2>& x) {
  const double r = x.norm(), t = 0.5 * std::atan2(x[1], x[0]);
  const double s = std::sin(t), c = std::cos(t), size = std::sqrt(r / kFullTurn) / (2 * kShear);
  return size * (one * Vec<2>(c * (kappa - 1 + 2 * s * s), s * (kappa + 1 - 2 * c * c)) +
                 two * Vec<2>(s * (kappa + 1 + 2 * c * c), -c * (kappa - 1 - 2 * s * s)));
}

/// All integrals of them, with a stress along the crack beside; slopes by differences, stresses by Hooke.
TipIntegrals integrate(double one, double two, double along, double kappa, const TipPath& path = straight()) {
  TipIntegrals out(path, kRadius, 8 * kShear / (kappa + 1));
  constexpr int kRings = 60, kAngles = 240;
  const double poisson = 0.25 * (3 - kappa);  // of the plane: ε_ij = (σ_ij − this σ_kk δ_ij)/2G
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAngles; ++k) {
      const double r = kRadius * (i + 0.5) / kRings, angle = kFullTurn * ((k + 0.5) / kAngles - 0.5);
      TipSample sample;
      sample.position = r * Vec<2>(std::cos(angle), std::sin(angle));
      sample.displacement = displacement(one, two, kappa, sample.position);
      sample.area = r * kRadius / kRings * kFullTurn / kAngles;
      for (int j = 0; j < 2; ++j) {
        Vec<2> step = Vec<2>::Zero();
        step[j] = 1e-5 * r;
        sample.gradient.col(j) = (displacement(one, two, kappa, sample.position + step) -
                                  displacement(one, two, kappa, sample.position - step)) /
                                 (2 * step[j]);
      }
      sample.gradient(0, 0) += along * (1 - poisson) / (2 * kShear);
      sample.displacement +=
          along / (2 * kShear) * Vec<2>((1 - poisson) * sample.position[0], -poisson * sample.position[1]);
      sample.gradient(1, 1) -= along * poisson / (2 * kShear);
      const Mat<2> strain = 0.5 * (sample.gradient + sample.gradient.transpose());
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
      CHECK(found.stress_intensities()[1] == doctest::Approx(one).epsilon(0.01).scale(1e6));
      CHECK(found.stress_intensities()[0] == doctest::Approx(two).epsilon(0.01).scale(1e6));
      CHECK(found.energy_release_rate() ==
            doctest::Approx((one * one + two * two) / modulus).epsilon(2e-3).scale(0));
    }
  }
}

TEST_CASE("where a side of the crack was not seen, all that is released counts as mode I") {
  constexpr double kModulus = 8e9;
  TipSample ahead, behind;
  ahead.position = {0.7 * kRadius, 0};
  ahead.area = behind.area = 1e-6;
  ahead.energy = 1e3;
  ahead.gradient = ahead.stress = behind.gradient = behind.stress = Mat<2>::Zero();
  behind.energy = 0;
  const auto all_of_mode_one = [&](const TipIntegrals& found) {
    CHECK(found.energy_release_rate() > 0);
    CHECK(found.stress_intensities()[0] == 0);
    CHECK(found.stress_intensities()[1] ==
          doctest::Approx(std::sqrt(kModulus * found.energy_release_rate())).epsilon(1e-12));
  };
  TipIntegrals neither(straight(), kRadius, kModulus);
  neither.add(ahead);
  all_of_mode_one(neither);
  for (const double side : {-1.0, 1.0}) {
    TipIntegrals one(straight(), kRadius, kModulus);
    behind.position = {-0.5 * kRadius, side * 0.1 * kRadius};
    behind.displacement = {1e-6, side * 1e-6};
    one.add(ahead);
    one.add(behind);
    CHECK(one.opening().norm() == 0);
    all_of_mode_one(one);
  }
}

TEST_CASE("what one tip has seen of its crack is nothing to the next tip") {
  constexpr double kModulus = 8e9;
  TipSample right, left, ahead;
  right.gradient = right.stress = Mat<2>::Zero();
  right.area = 1e-6;
  right.energy = 0;
  left = ahead = right;
  right.position = {-0.5 * kRadius, -0.1 * kRadius};
  right.displacement = {0, -1e-6};
  left.position = {-0.5 * kRadius, 0.1 * kRadius};
  left.displacement = {0, 1e-6};
  ahead.position = {0.7 * kRadius, 0};
  ahead.displacement = {0, 0};
  ahead.energy = 1e3;
  struct {  // side by side in memory, with a number that is none of theirs
    TipIntegrals tip{straight(), kRadius, kModulus};
    double beside;
  } each[2];
  each[0].beside = each[1].beside = 1;
  for (auto& one : each) {
    one.tip.add(ahead);
    one.tip.add(right);
  }
  each[1].tip.add(left);
  for (auto& one : each) {
    REQUIRE(one.tip.energy_release_rate() > 0);
    const double all = std::sqrt(kModulus * one.tip.energy_release_rate());
    CHECK(one.tip.stress_intensities()[1] == doctest::Approx(all).epsilon(1e-12));
    CHECK(one.tip.stress_intensities()[0] == 0);
  }
}

TEST_CASE("a stress along the crack changes none of them") {
  const double kappa = 3 - 4 * kPoisson;
  const TipIntegrals without = integrate(1e6, 0.3e6, 0, kappa), with = integrate(1e6, 0.3e6, 5e6, kappa);
  CHECK(with.stress_intensities()[1] ==
        doctest::Approx(without.stress_intensities()[1]).epsilon(2e-3).scale(0));
  CHECK(with.stress_intensities()[0] ==
        doctest::Approx(without.stress_intensities()[0]).epsilon(2e-3).scale(1e6));
  CHECK(with.energy_release_rate() == doctest::Approx(without.energy_release_rate()).epsilon(2e-3).scale(0));
}

/// Places all over the disk, with their shares of it.
template <class F>
void for_each_position(const F& f) {
  constexpr int kRings = 80, kAngles = 160;
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAngles; ++k) {
      const double r = kRadius * (i + 0.5) / kRings, angle = kFullTurn * ((k + 0.5) / kAngles - 0.5);
      f(Vec<2>(r * std::cos(angle), r * std::sin(angle)), r * kRadius / kRings * kFullTurn / kAngles);
    }
}

/// Hooke's law of plane strain.
void load(TipSample& sample) {
  const Mat<2> strain = 0.5 * (sample.gradient + sample.gradient.transpose());
  sample.stress = 2 * kShear * (strain + kPoisson / (1 - 2 * kPoisson) * strain.trace() * Mat<2>::Identity());
  sample.energy = 0.5 * sample.stress.cwiseProduct(strain).sum();
}

/// u = (1, 2) x sin(k x − ω t) of both waves along x, where there is no crack.
TEST_CASE("a wave that passes drives no crack: its inertia takes what its stresses bring") {
  constexpr double kDensity = 1200, kWave = 300, kSize = 1e-6;
  const double fast = std::sqrt(2 * kShear * (1 - kPoisson) / (1 - 2 * kPoisson) / kDensity),
               slow = std::sqrt(kShear / kDensity);
  for (const double phase : {0.3, 1.2}) {
    TipIntegrals moving(straight(), kRadius, 1), still(straight(), kRadius, 1);
    for_each_position([&](const Vec<2>& x, double area) {
      TipSample sample{x, area, {}, {}, {}, 0};
      sample.displacement = sample.velocity = sample.acceleration = Vec<2>::Zero();
      sample.gradient = sample.velocity_gradient = Mat<2>::Zero();
      const double speeds[] = {fast, slow};
      for (int d = 0; d < 2; ++d) {
        const double at = kWave * x[0] - phase, rate = kWave * speeds[d], size = (1 + d) * kSize;
        sample.displacement[d] = size * std::sin(at);
        sample.gradient(d, 0) = size * kWave * std::cos(at);
        sample.velocity[d] = -size * rate * std::cos(at);
        sample.velocity_gradient(d, 0) = size * rate * kWave * std::sin(at);
        sample.acceleration[d] = -size * rate * rate * std::sin(at);
      }
      load(sample);
      still.add(sample);
      sample.density = kDensity;
      moving.add(sample);
    });
    CHECK(std::abs(still.energy_release_rate()) > 0.01);
    CHECK(std::abs(moving.energy_release_rate()) < 1e-3 * std::abs(still.energy_release_rate()));
  }
}

/// What flows through each circle about a tip is the same vector, along the crack in mode I: what falls of
/// |q| and what turns of its direction make up for each other.
TEST_CASE("J is the same where the path of the crack bends in the disk") {
  const double kappa = 3 - 4 * kPoisson;
  for (const double bend : {0.008, -0.004}) {
    const TipPath bent({{0, 0}, {-0.009, 0}, {-0.015, bend}, {-0.05, bend}}, kRadius, 3e-3);
    CHECK((bent.direction(0.014) - Vec<2>(1, 0)).norm() > 0.25);
    CHECK(integrate(1e6, 0, 0, kappa, bent).energy_release_rate() ==
          doctest::Approx(1e12 / (8 * kShear / (kappa + 1))).epsilon(0.01).scale(0));
  }
}

TEST_CASE("where the path is, and which side of it") {
  const TipPath bent({{0, 0}, {-0.006, 0}, {-0.006, -0.1}}, kRadius, 1e-3);
  CHECK((bent.direction(0.003) - Vec<2>(1, 0)).norm() < 1e-12);
  CHECK((bent.direction(0.015) - Vec<2>(0, 1)).norm() < 0.05);
  CHECK(bent.direction_slope(0.003).norm() < 1e-9);
  const TipPath::Projection before = bent.project({-0.002, 1e-3}), behind = bent.project({-0.007, -0.004}),
                            ahead = bent.project({0.002, 1e-3});
  CHECK(before.behind == doctest::Approx(0.002));
  CHECK(before.offset == doctest::Approx(1e-3));
  CHECK(behind.behind == doctest::Approx(0.01));
  CHECK(behind.offset == doctest::Approx(1e-3));
  CHECK(std::isinf(ahead.behind));
}

/// Halves that are stretched and pressed along a line which carries a shear: there is no tip, and what the
/// stresses bring is the work of the shear along the line.
TEST_CASE("what sides that rub do on each other is no part of J") {
  constexpr double kStretch = 1e-3, kTraction = 5e6;
  TipIntegrals all(straight(), kRadius, 1), stresses(straight(), kRadius, 1);
  for_each_position([&](const Vec<2>& x, double area) {
    TipSample sample{x, area, {}, {}, {}, 0};
    sample.gradient = Mat<2>::Zero();
    sample.gradient(0, 0) = x[1] > 0 ? kStretch : -kStretch;
    sample.gradient(1, 1) = -kPoisson / (1 - kPoisson) * sample.gradient(0, 0);
    sample.gradient(0, 1) = kTraction / kShear;
    load(sample);
    all.add(sample);
    stresses.add(sample);
  });
  constexpr int kPieces = 1000;
  for (int k = 0; k < kPieces; ++k) {
    const double length = 2 * kRadius / kPieces;
    TipTraction one{{-kRadius + (k + 0.5) * length, 0}, {-kTraction * length, 0}, Mat<2>::Zero()};
    one.gradient_jump(0, 0) = 2 * kStretch;
    all.add(one);
  }
  CHECK(std::abs(stresses.energy_release_rate()) > 100);
  CHECK(std::abs(all.energy_release_rate()) < 1e-3 * std::abs(stresses.energy_release_rate()));
}

/// Erdogan and Sih 1963: σ_θθ ∝ cos(θ/2) (K_I cos²(θ/2) − 3/2 K_II sin θ) is largest.
TEST_CASE("a crack kinks to where the hoop stress is largest") {
  CHECK(kink_angle(1, 0) == 0);
  CHECK(kink_angle(0, 1) == doctest::Approx(-std::acos(1 / 3.0)));
  for (const auto& [one, two] : {std::pair{1.0, 0.4}, {1.0, -0.4}, {0.2, 1.0}, {1.0, 1e-9}}) {
    const double angle = kink_angle(one, two), most = hoop_intensity(one, two, angle);
    CHECK(angle * two < 0);
    for (double other = -2; other < 2; other += 0.01) CHECK(hoop_intensity(one, two, other) <= most + 1e-12);
  }
}

}  // namespace
}  // namespace mpmfast
