// Affine transfers: angular momentum through whole steps, and slopes of linear fields.

#include <Eigen/Geometry>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A free body, not aligned with the cells, far from the ends of its grid.
std::string free_body(int dimension) {
  if (dimension == 2)
    return R"(
space: plane_strain
grid: {origin: [-8 mm, -8 mm], size: [16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [-3.3 mm, -2.1 mm], to: [2.7 mm, 1.9 mm]}, material: m}]
)";
  return R"(
space: 3d
grid: {origin: [-6 mm, -6 mm, -6 mm], size: [12 mm, 12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [-2.3 mm, -1.1 mm, -1.6 mm], to: [1.7 mm, 1.9 mm, 1.4 mm]}, material: m}]
)";
}

/// Velocity v = L x + v0 of every particle, with its slopes.
template <int Dim>
void set_motion(Particles<Dim>& particles, const Mat<Dim>& gradient, const Vec<Dim>& shift) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<Dim> v = gradient * particles.vector(Quantity::position, p) + shift;
    for (int i = 0; i < Dim; ++i) {
      particles.column(Quantity::velocity, i)[p] = v[i];
      for (int j = 0; j < Dim; ++j)
        particles.column(Quantity::velocity_slopes, Dim * i + j)[p] = gradient(i, j);
    }
  }
}

template <int Dim>
Mat<Dim> some_gradient(double rate) {
  Mat<Dim> l = Mat<Dim>::Zero();
  l(0, 1) = -rate;
  l(1, 0) = 1.1 * rate;
  l(0, 0) = 0.2 * rate;
  if (Dim == 3) {
    l(Dim - 1, 0) = -0.6 * rate;
    l(0, Dim - 1) = 0.5 * rate;
    l(1, Dim - 1) = 0.3 * rate;
  }
  return l;
}

/// Σ M (x × V + kSpread Δx² Σ_d e_d × C e_d); in 2-D its z component.
template <int Dim>
Eigen::Vector3d angular_momentum(const Particles<Dim>& particles, double spread) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = x, own = x;
    for (int i = 0; i < Dim; ++i) {
      x[i] = particles.column(Quantity::position, i)[p];
      v[i] = particles.column(Quantity::velocity, i)[p];
    }
    for (int d = 0; d < Dim; ++d) {
      Eigen::Vector3d slope = Eigen::Vector3d::Zero();
      for (int i = 0; i < Dim; ++i) slope[i] = particles.column(Quantity::velocity_slopes, Dim * i + d)[p];
      own += Eigen::Vector3d(Eigen::Vector3d::Unit(d)).cross(slope);
    }
    sum += particles.column(Quantity::mass)[p] * (x.cross(v) + spread * own);
  }
  return sum;
}

template <int Dim>
void check_angular_momentum(const char* basis, double moment) {
  CAPTURE(std::string(basis));
  const Scene scene = scene_from(free_body(Dim), {{"method.basis", basis}, {"method.update", "apic"}});
  Step<Dim> step(scene);
  set_motion<Dim>(step.state().particles, some_gradient<Dim>(8000), Vec<Dim>::Constant(3));
  const double spread = moment * scene.grid.cell * scene.grid.cell;
  const Eigen::Vector3d before = angular_momentum(step.state().particles, spread);
  const Vec<Dim> momentum_before = momentum(step.state().particles);
  advance(step, 200);
  CHECK(step.state().time * 8000 > 1);  // it turned by more than a radian
  const Eigen::Vector3d after = angular_momentum(step.state().particles, spread);
  // Round-off of some 1e5 additions a step over 200 steps: measured below 1e-14.
  CHECK((after - before).norm() < 1e-13 * before.norm());
  CHECK((momentum(step.state().particles) - momentum_before).norm() < 1e-13 * before.norm() / 1e-3);
}

TEST_CASE("APIC conserves linear and angular momentum of a free body that turns and vibrates") {
  check_angular_momentum<2>("bspline2", 0.25);
  check_angular_momentum<2>("bspline3", 1.0 / 3.0);
  check_angular_momentum<3>("bspline2", 0.25);
  check_angular_momentum<3>("bspline3", 1.0 / 3.0);
}

template <int Dim>
void check_linear_field(const char* basis) {
  CAPTURE(std::string(basis));
  const Scene scene = scene_from(free_body(Dim), {{"method.basis", basis}, {"method.update", "apic"}});
  Step<Dim> step(scene);
  set_motion<Dim>(step.state().particles, some_gradient<Dim>(8000), Vec<Dim>::Constant(3));
  const auto velocities = by_id(step.state().particles, Quantity::velocity);
  const auto slopes = by_id(step.state().particles, Quantity::velocity_slopes);
  step.advance(1e-15);  // too short for forces to act
  CHECK(relative_difference(by_id(step.state().particles, Quantity::velocity), velocities) < 1e-13);
  CHECK(relative_difference(by_id(step.state().particles, Quantity::velocity_slopes), slopes) < 1e-12);
}

TEST_CASE("APIC carries a velocity that is linear in space to the grid and back unchanged") {
  check_linear_field<2>("bspline2");
  check_linear_field<2>("bspline3");
  check_linear_field<3>("bspline2");
  check_linear_field<3>("bspline3");
}

}  // namespace
}  // namespace mpmfast
