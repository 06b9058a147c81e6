// Pressures on surfaces of bodies against closed solutions at rest, and the balance of energy as they act.
//
// A load that grows as a smooth step over several periods of the slowest wave leaves next to no motion
// behind. Displacements are means over some periods after the step.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr double kYoung = 10e6, kPoisson = 0.3, kDensity = 1000, kPressure = 1e3;
constexpr double kShear = kYoung / (2 * (1 + kPoisson));
constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));

/// The table of a load that grows to kPressure as a smooth step over the time `rise`, s.
std::string smooth_step(double rise) {
  std::string text = "[";
  for (int k = 0; k <= 100; ++k) {
    const double share = 0.01 * k;
    text += fmt::format("{}[{}, {}]", k == 0 ? "" : ", ", share * rise,
                        kPressure * share * share * (3 - 2 * share));
  }
  return text + "]";
}

/// A scene of one body that carries kPressure on a part of its surface.
struct LoadedBody {
  const char* space;
  std::string grid, body, boundaries;
  std::string part;  ///< `where`, `along`
  const char* basis;
  double rise, rest;  ///< s, until the load is whole, and from then on

  Scene scene() const {
    return scene_from(fmt::format(
        "space: {}\ngrid: {}\ntime: {{end: {}, cfl: 0.4}}\n"
        "materials: {{m: {{model: neo_hookean, density: {}, young: {}, poisson: {}}}}}\n"
        "bodies: [{{name: body, material: m, {}}}]\nboundaries: {}\n"
        "loads: {{pressure: [{{body: body, value: {}, {}}}]}}\nmethod: {{basis: {}, update: flip}}\n",
        space, grid, rise + rest, kDensity, kYoung, kPoisson, body, boundaries, smooth_step(rise), part,
        basis));
  }
};

struct Settled {
  double displacement;  ///< its error, over the closed solution
  double energy;        ///< what the balance lacks at the end, over the work of the load
};

/// Settles a body. Its displacement is the amplitude of u(X) over that of a closed solution, by least squares
/// over the particles, as a mean over
/// the time from `rise` on.
template <int Dim, class Solution>
Settled settle(const Scene& scene, double rise, Solution solution) {
  Step<Dim> step(scene);
  const auto start = by_id(step.state().particles, Quantity::position);
  const auto at_start = [&](std::size_t p) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = start[p * Dim + static_cast<std::size_t>(d)];
    return x;
  };
  double sum = 0, time = 0, norm = 0;
  for (std::size_t p = 0; p * Dim < start.size(); ++p) norm += solution(at_start(p)).squaredNorm();
  const auto& particles = step.state().particles;
  while (step.state().time < scene.time.end) {
    const double dt = step.stable_dt();
    step.advance(dt);
    if (step.state().time < rise) continue;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec<Dim> from = at_start(particles.id()[p]);
      sum += (particles.vector(Quantity::position, p) - from).dot(solution(from)) / norm * dt;
    }
    time += dt;
  }
  const double work = step.sums().body_force_work;
  return {sum / time - 1, (kinetic_energy(particles) + step.stored_energy()) / work - 1};
}

/// u_r = Ar + B/r of a thick ring in plane strain with the pressure p on its bore (Lamé).
double lame(double r) {
  constexpr double a = 10e-3, b = 20e-3, share = kPressure * a * a / (b * b - a * a);
  return share / (2 * (kLambda + kShear)) * r + share * b * b / (2 * kShear) / r;
}

TEST_CASE("a thick ring under pressure on its bore widens as Lamé's, in the plane") {
  constexpr double rise = 4e-3;
  const Scene scene = scene_file("pressed_ring.yaml", {{"loads.pressure.0.value", smooth_step(rise)}});
  const Settled settled =
      settle<2>(scene, rise, [](const Vec<2>& x) -> Vec<2> { return lame(x.norm()) / x.norm() * x; });
  CHECK(std::abs(settled.displacement) < 0.005);  // measured 0.10 %
  CHECK(std::abs(settled.energy) < 0.001);        // measured 0.02 %
}

TEST_CASE("a thick tube under pressure on its bore widens as Lamé's, about an axis") {
  const LoadedBody tube{"axisymmetric",
                        "{origin: [8 mm, 0 mm], size: [16 mm, 1 mm], cell: 1 mm}",
                        "box: {from: [10 mm, 0 mm], to: [20 mm, 1 mm]}",
                        "{bottom: symmetry, top: symmetry}",
                        "where: {box: {from: [5 mm, -5 mm], to: [15 mm, 5 mm]}}",
                        "ugimp",
                        4e-3,
                        1.3e-3};
  const Settled settled = settle<2>(tube.scene(), tube.rise, [](const Vec<2>& x) -> Vec<2> {
    return {lame(x[0]), 0};
  });
  CHECK(std::abs(settled.displacement) < 0.005);
  CHECK(std::abs(settled.energy) < 0.001);
}

/// The shortening of a bar of 40 mm that stands on a plane and is free at its sides, over that of one
/// dimension.
template <int Dim>
Settled press_bar(const LoadedBody& bar, int axis, double modulus) {
  return settle<Dim>(bar.scene(), bar.rise, [&](const Vec<Dim>& x) -> Vec<Dim> {
    Vec<Dim> u = Vec<Dim>::Zero();
    u[axis] = -kPressure / modulus * x[axis];
    return u;
  });
}

TEST_CASE("a bar under pressure on its end shortens by p L over the modulus of plane strain") {
  const LoadedBody bar{"plane_strain",
                       "{origin: [0, -8 mm], size: [48 mm, 16 mm], cell: 2 mm}",
                       "box: {from: [0, -4 mm], to: [40 mm, 4 mm]}",
                       "{left: symmetry}",
                       "along: x, where: {box: {from: [30 mm, -20 mm], to: [60 mm, 20 mm]}}",
                       "ugimp",
                       10e-3,
                       4.6e-3};
  const Settled settled = press_bar<2>(bar, 0, kYoung / (1 - kPoisson * kPoisson));
  CHECK(std::abs(settled.displacement) < 0.002);
  CHECK(std::abs(settled.energy) < 0.001);
}

TEST_CASE("a cylinder about an axis under pressure on its end shortens by p L/E") {
  const LoadedBody bar{"axisymmetric",
                       "{size: [12 mm, 48 mm], cell: 1 mm}",
                       "box: {from: [0, 0], to: [8 mm, 40 mm]}",
                       "{bottom: symmetry}",
                       "along: y, where: {box: {from: [-10 mm, 30 mm], to: [20 mm, 60 mm]}}",
                       "ugimp",
                       10e-3,
                       4.8e-3};
  const Settled settled = press_bar<2>(bar, 1, kYoung);
  CHECK(std::abs(settled.displacement) < 0.002);
  CHECK(std::abs(settled.energy) < 0.001);
}

TEST_CASE("a bar in three dimensions under pressure on its end shortens by p L/E") {
  const LoadedBody bar{"3d",
                       "{origin: [0, -4 mm, -4 mm], size: [48 mm, 8 mm, 8 mm], cell: 2 mm}",
                       "box: {from: [0, -2 mm, -2 mm], to: [40 mm, 2 mm, 2 mm]}",
                       "{left: symmetry}",
                       "along: x, where: {box: {from: [30 mm, -20 mm, -20 mm], to: [60 mm, 20 mm, 20 mm]}}",
                       "ugimp",
                       10e-3,
                       4.8e-3};
  const Settled settled = press_bar<3>(bar, 0, kYoung);
  CHECK(std::abs(settled.displacement) < 0.002);
  CHECK(std::abs(settled.energy) < 0.001);
}

}  // namespace
}  // namespace mpmfast
