/// The cone of Drucker and Prager against closed solutions: triaxial and plane-strain paths, the cut-off,
/// gaps that open and close.

#include <vector>
#include "kernels/materials/drucker_prager.hpp"
#include "tests/unit/material_sample.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr DruckerPrager kSand{1600, 60e6, 30e6, 32 * kDegree, 0, 0, 0};

/// A soil of this cohesion and dilation, its tension at the apex.
DruckerPrager soil(double cohesion, double dilation) {
  DruckerPrager law = kSand;
  law.cohesion = cohesion;
  law.dilation_angle = dilation * kDegree;
  law.tension = law.apex();
  return law;
}

template <int Dim>
Mat<Dim> diagonal(double x, double y, double z = 0) {
  Mat<Dim> l = Mat<Dim>::Zero();
  l(0, 0) = x;
  l(1, 1) = y;
  if constexpr (Dim == 3) l(2, 2) = z;
  return l;
}

template <int Dim>
Sample<Dim, DruckerPrager> pressed(const DruckerPrager& law, double strain) {
  Sample<Dim, DruckerPrager> sample(law);
  for (int k = 0; k < 20; ++k) sample.strain(diagonal<Dim>(-strain, -strain, -strain), 0.05);
  return sample;
}

template <int Dim>
double pressure(const Sample<Dim, DruckerPrager>& sample) {
  return -sample.stress().trace() / 3;
}

}  // namespace

TEST_CASE("in triaxial compression the strength is that of Mohr and Coulomb") {
  for (const double cohesion : {0.0, 5e3}) {
    const DruckerPrager law = soil(cohesion, 0);
    auto sample = pressed<3>(law, 1e-3);
    REQUIRE(sample.state.plastic_strain == 0);
    for (int k = 0; k < 200; ++k) sample.strain(diagonal<3>(0.5, 0.5, -1), 1e-4);
    REQUIRE(sample.state.plastic_strain > 0.01);
    const Mat<3> tau = sample.stress();
    const double tangent = std::tan((45 + 16) * kDegree);
    CHECK(-tau(2, 2) ==
          doctest::Approx(-tau(0, 0) * tangent * tangent + 2 * cohesion * tangent).epsilon(1e-9));
    CHECK(sample.von_mises() == doctest::Approx(law.slope(law.friction_angle) * pressure(sample) +
                                                law.slope(law.friction_angle) * law.apex())
                                    .epsilon(1e-9));
  }
}

TEST_CASE("shear that is held at its volume builds up pressure by its dilation") {
  // ln J_e = ln J - eta x, whatever the path; in small strain 3 G (deps - dx) = M K eta dx while it flows.
  const DruckerPrager law = soil(2e3, 10);
  auto sample = pressed<3>(law, 2e-4);
  double before = 0, strain = 0;
  for (int k = 0; k < 800; ++k) {
    const double plastic = sample.state.plastic_strain;
    sample.strain(diagonal<3>(0.5, 0.5, -1), 2e-6);
    if (plastic > 0) strain += 2e-6, before += sample.state.plastic_strain - plastic;
  }
  REQUIRE(strain > 4e-4);
  const double eta = law.slope(law.dilation_angle), m = law.slope(law.friction_angle);
  const double open = sample.volume() * std::exp(-eta * sample.state.plastic_strain);
  CHECK(pressure(sample) == doctest::Approx(0.5 * law.bulk * (1 - open * open)).epsilon(1e-9));
  CHECK(sample.von_mises() ==
        doctest::Approx(m * pressure(sample) + law.slope(law.friction_angle) * law.apex()).epsilon(1e-9));
  CHECK(before / strain ==
        doctest::Approx(3 * law.shear / (3 * law.shear + m * law.bulk * eta)).epsilon(0.003));
}

TEST_CASE("plane strain at constant volume comes to flow without a deviator along z") {
  for (const double dilation : {0.0, 8.0}) {
    const DruckerPrager law = soil(3e3, dilation);
    auto sample = pressed<2>(law, 1e-3);
    for (int k = 0; k < 4000; ++k) sample.strain(diagonal<2>(1, -1), 5e-6);
    const Mat<3> tau = sample.stress();
    const double p = pressure(sample), q = sample.von_mises();
    CHECK(q == doctest::Approx(law.slope(law.friction_angle) * p + law.slope(law.friction_angle) * law.apex())
                   .epsilon(1e-9));
    // Along z 0 = dx (3/2 s_z/q + eta/3) + ds_z/2G - dp/3K, and dp = K eta dx: s_z decays.
    CHECK(std::abs(tau(2, 2) + p) < 0.005 * q);
    CHECK(tau(0, 0) - tau(1, 1) == doctest::Approx(2 * q / std::sqrt(3.0)).epsilon(1e-4));
  }
}

TEST_CASE("the cones of extension and of plane strain meet Mohr and Coulomb there") {
  DruckerPrager law = soil(4e3, 0);
  law.cone = DruckerPrager::Cone::extension;
  auto drawn = pressed<3>(law, 1e-3);
  for (int k = 0; k < 200; ++k) drawn.strain(diagonal<3>(-0.5, -0.5, 1), 1e-4);
  const double tangent = std::tan((45 + 16) * kDegree);
  CHECK(
      -drawn.stress()(0, 0) ==
      doctest::Approx(-drawn.stress()(2, 2) * tangent * tangent + 2 * law.cohesion * tangent).epsilon(1e-9));
  law.cone = DruckerPrager::Cone::plane_strain;
  auto flat = pressed<2>(law, 1e-3);
  for (int k = 0; k < 4000; ++k) flat.strain(diagonal<2>(1, -1), 5e-6);
  const Mat<3> tau = flat.stress();
  CHECK(0.5 * (tau(0, 0) - tau(1, 1)) ==
        doctest::Approx(-0.5 * (tau(0, 0) + tau(1, 1)) * std::sin(32 * kDegree) +
                        law.cohesion * std::cos(32 * kDegree))
            .epsilon(1e-3));
}

TEST_CASE("beyond the cut-off nothing is held but the tension, and a gap closes before anything presses") {
  const DruckerPrager clay = soil(5e3, 5);
  Sample<3, DruckerPrager> open(clay);
  for (int k = 0; k < 100; ++k) open.strain(diagonal<3>(1, 1, 1), 1e-3);
  CHECK(pressure(open) == doctest::Approx(-clay.apex()).epsilon(1e-12));
  CHECK(open.von_mises() < 1e-9 * clay.apex());
  const double stored = open.energy();
  CHECK(open.state.dissipated < 1e-6 * stored);

  Sample<3, DruckerPrager> sand(kSand);
  for (int k = 0; k < 50; ++k) sand.strain(diagonal<3>(1, 0.5, 2), 1e-3);
  std::mt19937_64 draw(5);
  for (int k = 0; k < 20; ++k) sand.strain(random_matrix<3>(draw, 1), 1e-3);
  CHECK(sand.stress().norm() == 0);
  CHECK(sand.energy() == doctest::Approx(0).scale(1e-9 * kSand.bulk));
  const double opening = std::log(sand.volume());
  REQUIRE(opening > 0.1);
  for (int k = 0; k < 1000; ++k) sand.strain(diagonal<3>(-1, -1, -1), opening / 3000);
  CHECK(std::abs(pressure(sand)) < 1e-6 * kSand.bulk);
  for (int k = 0; k < 10; ++k) sand.strain(diagonal<3>(-1, -1, -1), 1e-4);
  CHECK(pressure(sand) == doctest::Approx(0.5 * kSand.bulk * (1 - std::exp(-6e-3))).epsilon(1e-4));
}

TEST_CASE(
    "soil that shear closes in one step ends on its cone, however soft its shear is beside its volume") {
  // An open volume is sheared: its dilation takes it back below the cut-off, where pressure makes strength.
  for (const double ratio : {1e-2, 1e-3, 3e-4})
    for (const double open : {0.05, 0.1, 0.3})
      for (const double shear : {0.2, 0.4, 0.8}) {
        CAPTURE(ratio);
        CAPTURE(open);
        CAPTURE(shear);
        DruckerPrager law = soil(0, 30);
        law.shear = ratio * law.bulk;
        Sample<3, DruckerPrager> sample(law);
        sample.strain(diagonal<3>(open / 3, open / 3, open / 3), 1);
        sample.strain(diagonal<3>(-0.5 * shear, -0.5 * shear, shear), 1);
        REQUIRE(sample.state.plastic_strain > 0);
        CHECK(
            sample.von_mises() ==
            doctest::Approx(law.slope(law.friction_angle) * pressure(sample)).epsilon(1e-9).scale(law.shear));
      }
}

TEST_CASE("a lower cut-off takes the tip of the cone") {
  DruckerPrager law = soil(5e3, 0);
  law.tension = 1e3;
  Sample<3, DruckerPrager> sample(law);
  for (int k = 0; k < 100; ++k) sample.strain(diagonal<3>(1, 1, 1), 1e-5);
  for (int k = 0; k < 400; ++k) sample.strain(diagonal<3>(0.5, 0.5, -1), 1e-5);
  CHECK(pressure(sample) == doctest::Approx(-1e3).epsilon(1e-12));
  CHECK(sample.von_mises() ==
        doctest::Approx(law.slope(law.friction_angle) * law.apex() - law.slope(law.friction_angle) * 1e3)
            .epsilon(1e-9));
}

TEST_CASE_TEMPLATE("work is stored or dissipated, to the second order of the step", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  const DruckerPrager law = soil(4e3, 6);
  double miss[2], done = 0;
  for (int fine = 0; fine < 2; ++fine) {
    auto sample = pressed<Dim>(law, 1e-3);
    const double stored = sample.energy();
    const int steps = fine ? 800 : 200;
    double work = 0;
    for (int k = 0; k < steps; ++k) {
      const double turn = 2.5 * k / steps;
      Mat<Dim> l = diagonal<Dim>(std::cos(turn), -std::cos(turn) - 0.1);
      l(0, 1) = 0.6 * std::sin(turn);
      work += sample.strain(l, 0.02 / steps);
    }
    miss[fine] = std::abs(work - (sample.energy() - stored) - sample.state.dissipated);
    done = sample.state.dissipated;
    CHECK(done > 0);
  }
  CHECK(miss[0] < 0.01 * done);
  CHECK(miss[1] < miss[0] / 3);  // the corner of first yield is of the first order
}

TEST_CASE_TEMPLATE("within the cone the stress is the slope of the energy", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  const DruckerPrager law = soil(50e6, 5);  // never yields here
  std::mt19937_64 draw(4);
  auto sample = pressed<Dim>(law, 2e-2);
  sample.strain(random_matrix<Dim>(draw, 1), 1e-2);
  REQUIRE(sample.state.plastic_strain == 0);
  const Mat<3> tau = sample.stress();
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      Mat<Dim> unit = Mat<Dim>::Zero();
      unit(i, j) = 1;
      const double step = 1e-5;
      auto more = sample, less = sample;
      more.strain(unit, step);
      less.strain(unit, -step);
      CHECK(std::abs((more.energy() - less.energy()) / (2 * step) - tau(i, j)) < 1e-6 * law.shear);
    }
}

TEST_CASE("where soil bears tension its waves are as fast as its tangent says") {
  DruckerPrager clay{1600, 10e6, 1e6, 5 * kDegree, 0, 1e6, 0};
  clay.tension = clay.apex();
  Sample<3, DruckerPrager> sample(clay);
  for (int k = 0; k < 100; ++k) sample.strain(diagonal<3>(0.2, 0.2, 0.2), 1e-2 / 1.2);
  REQUIRE(pressure(sample) > -clay.tension);
  auto more = sample;
  more.strain(diagonal<3>(1, 0, 0), 1e-6);
  const double tangent = (more.tau[0] - sample.tau[0]) / 1e-6 - sample.tau[0];  // dτ_nn − τ_nn
  CHECK(sample.c2 * clay.density >= tangent * (1 - 1e-4));
  CHECK(sample.c2 * clay.density < 1.1 * tangent);
}

TEST_CASE("lanes of soil get the results of one by one, whatever their neighbours do") {
  const DruckerPrager law = soil(1e3, 8);
  std::mt19937_64 draw(9);
  std::vector<Sample<2, DruckerPrager>> each(kLanes, Sample<2, DruckerPrager>(law));
  Lanes f[4] = {broadcast<Lanes>(1), broadcast<Lanes>(0), broadcast<Lanes>(0), broadcast<Lanes>(1)}, tau[4],
        c2;
  auto state = resting_state<2, Lanes>(293);
  for (int k = 0; k < 20; ++k) {
    Lanes l[4], a[4];
    for (int i = 0; i < kLanes; ++i) {
      const Mat<2> gradient = random_matrix<2>(draw, i == 0 ? 1e-5 : 1.0);
      each[static_cast<std::size_t>(i)].strain(gradient, 2e-3);
      for (int c = 0; c < 4; ++c) l[c][i] = gradient(c / 2, c % 2);
    }
    const Lanes before = determinant<2>(f);
    deformation_increment<2>(l, 2e-3, 2, a);
    deform<2>(a, f);
    law.advance<2>(StrainStep<2, Lanes>{a, f, before, determinant<2>(f), l[0] + l[3], 2e-3}, state, tau, c2);
  }
  for (int i = 0; i < kLanes; ++i) {
    const auto& one = each[static_cast<std::size_t>(i)];
    for (int c = 0; c < 4; ++c) CHECK(std::abs(tau[c][i] - one.tau[c]) < 1e-9 * law.bulk);
    CHECK(double{state.plastic_strain[i]} == doctest::Approx(one.state.plastic_strain).epsilon(1e-10));
    CHECK(double{c2[i]} == doctest::Approx(one.c2).epsilon(1e-10));
  }
}
