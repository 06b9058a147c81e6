// What is left of F in laws that flow, and J that goes on by its own rate.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "kernels/materials/laws.hpp"
#include "kernels/transfer/strain_chunk.hpp"
#include "tests/unit/material_sample.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// kLanes particles of a fluid (Mie and Grüneisen without shear) as a pass sees them.
template <int Dim>
struct FluidChunk {
  MieGruneisen law;
  double deformation[Dim * Dim][kLanes]{}, stress[kSymmetric<Dim>][kLanes]{}, wave_speed[kLanes]{};
  double volume_ratio[kLanes]{}, dissipated[kLanes]{}, internal_energy[kLanes]{}, temperature[kLanes]{};
  ParticleView<Dim> view{};
  StrainWorkspace<Dim> workspace{};

  FluidChunk() {
    law.density = 1000;
    law.volume.bulk = 1e6;
    for (int e = 0; e < Dim * Dim; ++e) view.deformation[e] = deformation[e];
    for (int s = 0; s < kSymmetric<Dim>; ++s) view.stress[s] = stress[s];
    view.wave_speed = wave_speed;
    view.state.volume_ratio = volume_ratio;
    view.state.dissipated = dissipated;
    view.state.internal_energy = internal_energy;
    view.state.temperature = temperature;
    for (int k = 0; k < kLanes; ++k) {
      volume_ratio[k] = 1;
      for (int d = 0; d < Dim; ++d) deformation[(Dim + 1) * d][k] = 1;
    }
  }
  bool strain(const Mat<Dim>& gradient, double dt) {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        for (int k = 0; k < kLanes; ++k) workspace.gradient[4 * j + i][k] = gradient(i, j);
    return strain_chunk<Dim>(view, law, 0, kLanes, dt, 2, workspace, stress_columns(view, 0));
  }
  Mat<Dim> f(int k) const {
    Mat<Dim> out;
    for (int e = 0; e < Dim * Dim; ++e) out(e / Dim, e % Dim) = deformation[e][k];
    return out;
  }
};

Mat<2> turned(double angle) {
  Mat<2> r;
  r << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return r;
}

TEST_CASE("J of a fluid keeps its digits over a million steps of shear, where det F has none") {
  // Simple shear at 30 degrees to the axes, γ = 10^-3 a step: Δt L is nilpotent, so that J stays 1.
  Mat<2> shear;
  shear << 0, 1e-3, 0, 0;
  const Mat<2> gradient = turned(std::numbers::pi / 6) * shear * turned(-std::numbers::pi / 6);
  FluidChunk<2> fluid;
  double f[4] = {1, 0, 0, 1}, l[4], a[4];
  for (int e = 0; e < 4; ++e) l[e] = gradient(e / 2, e % 2);
  deformation_increment<2>(l, 1.0, 2, a);
  for (int step = 0; step < 1'000'000; ++step) {
    fluid.strain(gradient, 1.0);
    deform<2>(a, f);
  }
  // Each step rounds by some 1e-16, the same way as the increments are the same.
  CHECK(std::abs(fluid.volume_ratio[0] - 1) < 3e-10);
  CHECK(std::abs(determinant<2>(f) - 1) > 1e-9);  // of γ = 1000
  CHECK((fluid.f(0) - std::sqrt(fluid.volume_ratio[0]) * Mat<2>::Identity()).norm() < 1e-15);
}

TEST_CASE("J of a fluid that turns a million steps errs by what two terms of the exponential leave out") {
  // det(I + a) = (1 − ½ω²)² + ω² = 1 + ¼ω⁴ for a turn by ω a step.
  constexpr double kTurn = 1e-3;
  Mat<2> gradient;
  gradient << 0, -kTurn, kTurn, 0;
  FluidChunk<2> fluid;
  for (int step = 0; step < 1'000'000; ++step) fluid.strain(gradient, 1.0);
  CHECK(fluid.volume_ratio[0] - 1 == doctest::Approx(1e6 * 0.25 * std::pow(kTurn, 4)).epsilon(0.01));
}

TEST_CASE_TEMPLATE("J by its rate is det F where F keeps its shape", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  std::mt19937_64 draw(3);
  FluidChunk<Dim> fluid;
  Mat<Dim> f = Mat<Dim>::Identity();
  for (int step = 0; step < 50; ++step) {
    const Mat<Dim> gradient = random_matrix<Dim>(draw, 1);
    CHECK(fluid.strain(gradient, 2e-2));
    const Mat<Dim> a = 2e-2 * gradient;
    f = ((Mat<Dim>::Identity() + a + 0.5 * a * a) * f).eval();
  }
  CHECK(fluid.volume_ratio[0] == doctest::Approx(f.determinant()).epsilon(1e-12));
  CHECK(fluid.f(0).determinant() == doctest::Approx(f.determinant()).epsilon(1e-12));
}

TEST_CASE("a step that turns a fluid inside out is told") {
  FluidChunk<2> fluid;
  Mat<2> gradient = Mat<2>::Zero();
  gradient(0, 0) = -1.5;  // to one term, I + a has −0.5
  gradient(0, 1) = 1;
  for (int d = 0; d < 2; ++d)
    for (int k = 0; k < kLanes; ++k) fluid.workspace.gradient[4 * d][k] = gradient(0, d);
  CHECK(!strain_chunk<2>(fluid.view, fluid.law, 0, kLanes, 1.0, 1, fluid.workspace,
                         stress_columns(fluid.view, 0)));
}

/// F = V R.
template <int Dim>
struct Polar {
  Vec<Dim> stretch;  ///< principal, rising
  Mat<Dim> turn;     ///< R

  explicit Polar(const Mat<Dim>& f) {
    double a[Dim * Dim], v[Dim * Dim];
    Mat<Dim> axes, left;
    for (int e = 0; e < Dim * Dim; ++e) a[e] = f(e / Dim, e % Dim);
    turn_to_principal_axes<Dim>(a, v);
    for (int e = 0; e < Dim * Dim; ++e) left(e / Dim, e % Dim) = a[e], axes(e / Dim, e % Dim) = v[e];
    stretch = left.colwise().norm();
    turn = left * stretch.cwiseInverse().asDiagonal() * axes.transpose();
    std::sort(stretch.data(), stretch.data() + Dim);
  }
};

template <int Dim>
Mat<Dim> bounded(const Mat<Dim>& f, double limit, double volume, int lane = 0) {
  Lanes all[Dim * Dim];
  for (int e = 0; e < Dim * Dim; ++e) {
    all[e] = broadcast<Lanes>(e % (Dim + 1) == 0 ? 1.0 : 0.0);
    all[e][lane] = f(e / Dim, e % Dim);
  }
  Lanes j = broadcast<Lanes>(1.0);
  j[lane] = volume;
  limit_shape<Dim>(limit, j, kLanes, all);
  Mat<Dim> out;
  for (int e = 0; e < Dim * Dim; ++e) out(e / Dim, e % Dim) = all[e][lane];
  for (int e = 0; e < Dim * Dim; ++e)
    for (int k = 0; k < kLanes; ++k)
      if (k != lane) CHECK(double{all[e][k]} == (e % (Dim + 1) == 0 ? 1.0 : 0.0));
  return out;
}

TEST_CASE_TEMPLATE("principal axes: columns become orthogonal by a rotation", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  std::mt19937_64 draw(4);
  for (int repeat = 0; repeat < 100; ++repeat) {
    Mat<Dim> f = random_matrix<Dim>(draw, 1);
    if (repeat % 2) f.col(0) *= 1e-6;
    double a[Dim * Dim], v[Dim * Dim];
    for (int e = 0; e < Dim * Dim; ++e) a[e] = f(e / Dim, e % Dim);
    turn_to_principal_axes<Dim>(a, v);
    Mat<Dim> turned, axes;
    for (int e = 0; e < Dim * Dim; ++e) turned(e / Dim, e % Dim) = a[e], axes(e / Dim, e % Dim) = v[e];
    CHECK((axes.transpose() * axes - Mat<Dim>::Identity()).norm() < 1e-14);
    CHECK(axes.determinant() == doctest::Approx(1).epsilon(1e-13));
    CHECK((f * axes - turned).norm() < 1e-14);
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < j; ++k)
        CHECK(std::abs(turned.col(j).dot(turned.col(k))) <=
              1e-14 * turned.col(j).norm() * turned.col(k).norm());
  }
}

TEST_CASE_TEMPLATE("F keeps its stretches up to the limit, its rotation and J", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  std::mt19937_64 draw(5);
  constexpr double kLimit = 4;
  int cut = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    const Mat<Dim> f = Mat<Dim>::Identity() + random_matrix<Dim>(draw, 3);
    const double j = f.determinant();
    if (j < 0.05) continue;
    const Mat<Dim> g = bounded<Dim>(f, kLimit, j, repeat % kLanes);
    const double root = std::pow(std::min(j, std::pow(constants::kMostOpening, Dim)), 1.0 / Dim);
    const Polar<Dim> before(f), after(g);
    CHECK(std::pow(std::abs(g.determinant()), 1.0 / Dim) == doctest::Approx(root).epsilon(1e-6));
    CHECK(after.stretch[Dim - 1] <= kLimit * root * (1 + 1e-9));
    CHECK(after.stretch[0] >= root / std::pow(kLimit, Dim - 1) * (1 - 1e-9));
    CHECK((before.turn - after.turn).norm() < 1e-9);
    const double of_volume = std::pow(j, 1.0 / Dim), widest = before.stretch[Dim - 1] / of_volume;
    if (widest < kLimit * (1 - 1e-9) && j < std::pow(constants::kMostOpening, Dim) && Dim == 2) CHECK(g == f);
    cut += widest > kLimit;
  }
  CHECK(cut > 10);
}

TEST_CASE("material that has come apart fills at most twice its length, and closes to what it was") {
  const Mat<2> open = 30 * Mat<2>::Identity();
  CHECK((bounded<2>(open, constants::kShapeOfSoils, 900) - constants::kMostOpening * Mat<2>::Identity())
            .norm() < 1e-9);
  // While J falls back to 1, F follows it again.
  CHECK((bounded<2>(constants::kMostOpening * Mat<2>::Identity(), constants::kShapeOfSoils, 1) -
         Mat<2>::Identity())
            .norm() < 1e-9);
}

TEST_CASE("which laws forget: fluids all shape, soils and metals most, elastic shear nothing") {
  MieGruneisen fluid, solid;
  solid.shear = 1e9;
  CHECK(fluid.shape_limit() == constants::kShapeOfFluids);
  CHECK(solid.shape_limit() == constants::kWholeShape);
  CHECK(ElasticPlastic{}.shape_limit() == constants::kShapeOfMetals);
  CHECK(MieGruneisenJohnsonCook{}.shape_limit() == constants::kShapeOfMetals);
  CHECK(DruckerPrager::shape_limit() == constants::kShapeOfSoils);
}

}  // namespace
}  // namespace mpmfast
