// Rings and cylinders against closed solutions.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/validation/standing_wave.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr double kYoung = 10e6, kPoisson = 0.3, kDensity = 1000;
constexpr double kShear = kYoung / (2 * (1 + kPoisson));
constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));
constexpr double kPi = std::numbers::pi;

/// First root of x J0(x) = 2G/(λ + 2G) J1(x), x = kR: a free surface of u = J1(kr).
double breathing_root() {
  double low = 1, high = 3;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    const double g =
        x * std::cyl_bessel_j(0, x) - 2 * kShear / (kLambda + 2 * kShear) * std::cyl_bessel_j(1, x);
    (g > 0 ? low : high) = x;
  }
  return low;
}

/// Error of the period of a solid cylinder between two planes, breathing freely: u = J1(kr), ω = ck.
double cylinder_error(const char* basis, const char* update, const std::string& cell) {
  const std::string text =
      "space: axisymmetric\ngrid: {size: [32 mm, " + cell + "], cell: " + cell +
      "}\ntime: {end: 1 s, cfl: 0.4}\n"
      "materials: {m: {model: linear_elastic, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}\n"
      "bodies: [{name: disk, box: {from: [0, 0], to: [20 mm, " +
      cell + "]}, material: m}]\nboundaries: {bottom: symmetry, top: symmetry}\n";
  const Scene scene = scene_from(text, {{"method.basis", basis}, {"method.update", update}});
  const double k = breathing_root() / 20e-3, c = std::sqrt((kLambda + 2 * kShear) / kDensity);
  return measured_period(scene, 3, [&](double r) { return std::cyl_bessel_j(1, k * r); }) /
             (2 * kPi / (c * k)) -
         1;
}

TEST_CASE("a cylinder breathes with the period of Bessel's equation, in second order of the cell") {
  for (const char* basis : {"linear", "ugimp", "lcpdi"}) {
    CAPTURE(std::string(basis));
    const double coarse = cylinder_error(basis, "flip", "2 mm"), fine = cylinder_error(basis, "flip", "1 mm"),
                 finest = cylinder_error(basis, "flip", "0.5 mm");
    CHECK(std::abs(finest) < 4e-5);  // measured 2e-5
    CHECK(coarse / fine > 3.5);      // measured 4.6 to 4.8, 4.3 to 4.8
    CHECK(fine / finest > 3.5);
  }
}

TEST_CASE("B-splines and filtered updates breathe with the same period") {
  for (const char* basis : {"ugimp", "qcpdi", "bspline2", "bspline3"})
    for (const char* update : {"flip", "xpic(5)", "fmpm(3)"}) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const double error = cylinder_error(basis, update, "1 mm");
      CHECK(std::abs(error) < 1e-3);  // measured 1e-4 to 7e-4
    }
}

TEST_CASE("a thin ring breathes at sqrt(E/rho)/R") {
  const Scene scene = scene_from(R"(
space: axisymmetric
grid: {origin: [15 mm, 0], size: [10 mm, 6 mm], cell: 0.5 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies: [{name: ring, box: {from: [19.5 mm, 2 mm], to: [20.5 mm, 3 mm]}, material: m}]
)");
  const double period = measured_period(scene, 2, [](double) { return 1.0; });
  const double exact = 2 * kPi * 20e-3 / std::sqrt(kYoung / kDensity);
  CHECK(period == doctest::Approx(exact).epsilon(0.001));  // measured 0.02 %
}

/// Errors of the pressure on the bore and of the hoop stress against Lamé's: u = Ar + B/r, with
/// A = G B/((λ + G) b²) where the outside is free; p = 2GB(1/a² − 1/b²), σ_θθ = 2GB(1/b² + 1/r²).
struct LameErrors {
  double pressure, hoop;
};
LameErrors lame_errors(const char* cell) {
  const std::string size = std::string("[16 mm, ") + cell + "]", top = std::string("[20 mm, ") + cell + "]";
  const Scene scene =
      scene_file("thick_ring.yaml", {{"grid.cell", cell}, {"grid.size", size}, {"bodies.0.box.to", top}});
  Step<2> step(scene);
  const double a = 10e-3, b = 20e-3, u = 1e-5;
  const double scale = u / (a / (b * b) * kShear / (kLambda + kShear) + 1 / a);
  const auto advance_to = [&](double time) {
    while (step.state().time < time) step.advance(step.stable_dt());
  };
  advance_to(0.9 * scene.time.end);
  const Vec<2> before = step.sums().boundary_impulse[0];
  const double start = step.state().time;
  advance_to(scene.time.end);
  const double force = (step.sums().boundary_impulse[0] - before)[0] / (step.state().time - start);
  const double pressure = force / (2 * kPi * a * scene.grid.cell);
  LameErrors errors{pressure / (2 * kShear * scale * (1 / (a * a) - 1 / (b * b))) - 1, 0};
  const auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double r = particles.column(Quantity::position, 0)[p];
    const double hoop = 2 * kShear * scale * (1 / (b * b) + 1 / (r * r));
    const double error = particles.column(Quantity::kirchhoff_stress, 2)[p] / hoop - 1;
    errors.hoop += error * error;
  }
  errors.hoop = std::sqrt(errors.hoop / static_cast<double>(particles.size()));
  return errors;
}

TEST_CASE("a thick tube widened at its bore has Lamé's pressure and hoop stress") {
  const LameErrors coarse = lame_errors("1 mm"), fine = lame_errors("0.5 mm");
  // Measured 0.04 and 0.13 %: what has not come to rest.
  CHECK(std::abs(coarse.pressure) < 0.002);
  CHECK(std::abs(fine.pressure) < 0.002);
  // Root mean square of the hoop stress, 1.8 and 0.9 %: each cell has one radial strain.
  CHECK(coarse.hoop < 0.02);
  CHECK(fine.hoop < 0.55 * coarse.hoop);
}

/// What a cylinder that swings between long and thick has lost of its energy after five periods: FLIP's
/// usual loss.
double energy_lost(const char* cell) {
  const Scene scene = scene_from(std::string(R"(
space: axisymmetric
time: {end: 3 ms}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies: [{name: bar, box: {from: [0, 6 mm], to: [10 mm, 26 mm]}, material: m}]
grid: {size: [16 mm, 32 mm], cell: )") +
                                 cell + "}\n");
  Step<2> step(scene);
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<2> x = particles.vector(Quantity::position, p);
    particles.column(Quantity::velocity, 0)[p] = -250 * x[0];
    particles.column(Quantity::velocity, 1)[p] = 500 * (x[1] - 16e-3);
  }
  const double before = kinetic_energy(particles) + step.stored_energy();
  double least = before;
  while (step.state().time < scene.time.end) {
    step.advance(step.stable_dt());
    least = std::min(least, kinetic_energy(particles));
  }
  CHECK(least < 0.1 * before);  // it did swing
  return 1 - (kinetic_energy(particles) + step.stored_energy()) / before;
}

TEST_CASE("the energy of a swinging cylinder closes in second order of the cell") {
  const double coarse = energy_lost("1 mm"), fine = energy_lost("0.5 mm");
  CHECK(std::abs(fine) < 0.02);  // measured 0.016 (a plane bar: 0.014)
  CHECK(coarse > 3.5 * fine);    // measured 4.8
}

TEST_CASE("a ball's bounce about its axis gives the plane its change of momentum, and Hertz's force") {
  const Outcome outcome = run(scene_file("sphere_axis.yaml", {{"output.frames", "0"}}));
  REQUIRE(outcome.failure == "");
  const auto &time = outcome.history.at("time_s"), &force = outcome.history.at("plane.force_y_N");
  const auto& speed = outcome.history.at("ball.vy");
  double impulse = 0;
  for (std::size_t k = 1; k < time.size(); ++k) impulse -= force[k] * (time[k] - time[k - 1]);
  const double mass = outcome.history.at("ball.mass_kg").front();
  // Of whole rings: the ball's mass is that of a sphere but for its steps, 0.04 %.
  CHECK(mass == doctest::Approx(1200 * 4.0 / 3 * kPi * 216e-9).epsilon(0.001));
  // The history has nine digits: measured 5e-9.
  CHECK(impulse == doctest::Approx(mass * (speed.back() - speed.front())).epsilon(1e-7));
  CHECK(speed.back() > 4.9);                              // of 5; measured 4.95
  CHECK(std::abs(outcome.summary.energy_error) < 0.012);  // measured -0.9 %
  const double largest = -*std::min_element(force.begin(), force.end());
  CHECK(largest == doctest::Approx(80.8).epsilon(0.2));  // measured +17 %; with half the cell +12 %
}

}  // namespace
}  // namespace mpmfast
