// How F advances by the inverse form, (I − Δt L)⁻¹.

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/out_of_plane.hpp"

namespace mpmfast {
namespace {

template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>;

template <int Dim>
Matrix<Dim> increment(const Matrix<Dim>& l, double dt) {
  double in[Dim * Dim], out[Dim * Dim];
  Eigen::Map<Matrix<Dim>>{in} = l;
  deformation_increment<Dim>(in, dt, kInverse, out);
  return Eigen::Map<Matrix<Dim>>{out};
}

template <int Dim>
void check_inverse() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  for (int n = 0; n < 50; ++n) {
    const Matrix<Dim> x = Matrix<Dim>::NullaryExpr([&] { return number(random); });
    const Matrix<Dim> identity = Matrix<Dim>::Identity();
    const Matrix<Dim> expected = (identity - x).inverse() - identity;
    CHECK((increment<Dim>(x / 0.25, 0.25) - expected).cwiseAbs().maxCoeff() < 1e-14);
  }
  CHECK(increment<Dim>(Matrix<Dim>::Zero(), 1).cwiseAbs().maxCoeff() == 0);
}

TEST_CASE("the inverse increment is (I - dt L)^-1 - I, and none of no gradient") {
  check_inverse<2>();
  check_inverse<3>();
  CHECK(stretch_increment(0.5, 0.25, kInverse) == doctest::Approx(1 / (1 - 0.125) - 1).epsilon(1e-15));
}

TEST_CASE("a turn by chords, with the gradient at its end, is a rotation: no length changes") {
  // x_end = R x_begin moves by v dt = (I − R⁻¹) x_end.
  const double angle = 0.3, dt = 0.1;
  const Matrix<2> turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Matrix<2> gradient = (Matrix<2>::Identity() - turn.transpose()) / dt;
  const Matrix<2> f = Matrix<2>::Identity() + increment<2>(gradient, dt);
  CHECK((f - turn).cwiseAbs().maxCoeff() < 1e-15);
}

}  // namespace
}  // namespace mpmfast
