// Cohesive laws in 3-D: two blocks, glued on a face, that are driven apart by their own speed.

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of each block: 12 x 12 x 4 mm; glued on the face of 12 x 12 mm.
constexpr double kSide = 12e-3, kThick = 4e-3, kArea = kSide * kSide, kMass = kArea * kThick * 1000;
/// In opening and in slip. As in cohesive.cpp the glue breaks at 0.02 mm, a hundredth of a cell.
constexpr double kStrength[2] = {20e3, 40e3}, kToughness[2] = {0.2, 0.4};

/// Turns the particles of a new step about a point, all of them as one body.
void turn(Step<3>& step, const Mat<3>& rotation, const Vec<3>& centre) {
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<3> x = centre + rotation * (particles.vector(Quantity::position, p) - centre),
                 v = rotation * particles.vector(Quantity::velocity, p);
    for (int d = 0; d < 3; ++d) {
      particles.column(Quantity::position, d)[p] = x[d];
      particles.column(Quantity::velocity, d)[p] = v[d];
    }
    Mat<3> slope;
    for (int e = 0; e < 9; ++e) slope(e / 3, e % 3) = particles.column(Quantity::deformation_gradient, e)[p];
    slope = rotation * slope;
    for (int e = 0; e < 9; ++e) particles.column(Quantity::deformation_gradient, e)[p] = slope(e / 3, e % 3);
  }
}

struct Parting {
  double lost;      ///< J
  double traction;  ///< largest mean one of the face, Pa
};

/// The upper block leaves the lower one at this velocity, all of it turned. Only the glue brakes them, so
/// that its traction is what their momentum loses.
Parting part(const Mat<3>& rotation, const Vec<3>& velocity) {
  const auto text = [](const Vec<3>& v) {
    return "[" + std::to_string(v[0]) + " m/s, " + std::to_string(v[1]) + " m/s, " + std::to_string(v[2]) +
           " m/s]";
  };
  const Scene scene = scene_from(
      "space: 3d\ngrid: {size: [24 mm, 24 mm, 24 mm], cell: 2 mm}\ntime: {end: 1 s, cfl: 0.5}\n"
      "materials: {m: {model: neo_hookean, density: 1 g/cm^3, young: 2 GPa, poisson: 0}}\nbodies:\n"
      "  - {name: lower, box: {from: [6 mm, 6 mm, 8 mm], to: [18 mm, 18 mm, 12 mm]}, material: m, "
      "velocity: " +
      text(-0.5 * velocity) +
      "}\n"
      "  - {name: upper, box: {from: [6 mm, 6 mm, 12 mm], to: [18 mm, 18 mm, 16 mm]}, material: m, "
      "velocity: " +
      text(0.5 * velocity) +
      "}\n"
      "contact: {law: cohesive, shape: trapezoidal, normal_strength: 20 kPa, shear_strength: 40 kPa, "
      "normal_toughness: 0.2 J/m^2, "
      "shear_toughness: 0.4 J/m^2, initial_stiffness: 5 GPa/m}\n");
  Step<3> step(scene);
  turn(step, rotation, Vec<3>::Constant(12e-3));
  auto& state = step.state();
  const Vec<3> way = rotation * velocity.normalized();
  const auto parting = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      sum += (state.particles.body()[p] == 0 ? -0.5 : 0.5) * state.particles.column(Quantity::mass)[p] *
             state.particles.vector(Quantity::velocity, p).dot(way);
    return sum;
  };
  const double end = 0.03e-3 / (0.4 * velocity.norm());
  double before = parting(), most = 0;
  while (state.time < end) {
    const double dt = step.stable_dt();
    step.advance(dt);
    const double now = parting();
    most = std::max(most, (before - now) / dt / kArea);
    before = now;
  }
  return {step.sums().interface_loss, most};
}

/// Opened, slipped and both, at 45 degrees to the face: with n and t the shares of either in the jump's
/// square T = (n/σ² + t/τ²)^-½ and, as the tractions work by n : t, G = (n/G_Ic + t/G_IIc)^-1.
TEST_CASE(
    "blocks glued on a face have the strength and the toughness of the face in 3-D, however they part") {
  const Mat<3> turned = Eigen::AngleAxisd(0.5, Vec<3>(1, 2, 3).normalized()).toRotationMatrix();
  const Vec<3> ways[] = {{0, 0, 1}, {1, 0, 0}, {0.5, 0.5, std::sqrt(0.5)}};
  for (const Mat<3>& rotation : {Mat<3>(Mat<3>::Identity()), turned})
    for (const Vec<3>& way : ways) {
      CAPTURE(rotation(0, 0));
      CAPTURE(way[2]);
      const double n = way[2] * way[2], t = 1 - n;
      const double strength = 1 / std::hypot(std::sqrt(n) / kStrength[0], std::sqrt(t) / kStrength[1]),
                   energy = kArea / (n / kToughness[0] + t / kToughness[1]);
      const Parting out = part(rotation, std::sqrt(4 * 2.5 * energy / kMass) * way);
      MESSAGE("lost ", out.lost / energy, " strength ", out.traction / strength);
      CHECK(out.lost == doctest::Approx(energy).epsilon(0.01).scale(0));         // measured within 0.87 %
      CHECK(out.traction == doctest::Approx(strength).epsilon(0.005).scale(0));  // 0.37 %
    }
}

}  // namespace
}  // namespace mpmfast
