// An elastic bar held sideways (uniaxial strain): c = sqrt((λ + 2G)/ρ), against its wave speed and lowest
// frequency.

#include <numbers>

#include "tests/validation/standing_wave.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// 100 cells long, one cell high between symmetry planes. λ + 2G = 13.46 MPa, ρ 1000: c = 116.0 m/s.
const char* const kBar = R"(
space: plane_strain
grid: {size: [140 mm, 1 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: linear_elastic, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies: [{name: bar, box: {from: [0 mm, 0 mm], to: [100 mm, 1 mm]}, material: m}]
boundaries: {left: wall, bottom: symmetry, top: symmetry}
)";

double bar_speed() {
  const double young = 10e6, poisson = 0.3;
  return std::sqrt(young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)) / 1000);
}

/// Period of the lowest mode, velocity ∝ sin(πx/2L), over five periods.
double bar_period(const Scene& scene) {
  return measured_period(scene, 5, [](double x) { return std::sin(std::numbers::pi * x / 0.2); });
}

TEST_CASE("a standing wave in an elastic bar has the frequency c/4L within 1 %") {
  const double period = 4 * 0.1 / bar_speed();
  for (const BasisFacts& facts : kBasisFacts)
    for (const char* update : {"flip", "xpic(5)", "fmpm(5)", "apic"}) {
      if (update == std::string("apic") && facts.spread == 0) continue;
      const std::string basis = facts.keyword;
      CAPTURE(basis);
      CAPTURE(std::string(update));
      const double measured =
          bar_period(scene_from(kBar, {{"method.basis", basis}, {"method.update", update}}));
      CHECK(measured == doctest::Approx(period).epsilon(0.01));
    }
}

TEST_CASE("a standing wave keeps its frequency under every strain update and in a neo-Hookean bar") {
  const double period = 4 * 0.1 / bar_speed();
  for (const char* strain : {"first", "last", "average"}) {
    CAPTURE(std::string(strain));
    CHECK(bar_period(scene_from(kBar, {{"method.strain", strain}})) == doctest::Approx(period).epsilon(0.01));
  }
  const std::string same_modulus =
      "{m: {model: neo_hookean, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}";
  CHECK(bar_period(scene_from(kBar, {{"materials", same_modulus}})) == doctest::Approx(period).epsilon(0.01));
}

/// Where the velocity falls to half the piston's.
double front(const Particles<2>& particles, double speed) {
  std::map<double, double> profile;  // the lower of the two rows of particles
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (particles.column(Quantity::position, 1)[p] < 0.5e-3)
      profile[particles.column(Quantity::position, 0)[p]] = particles.column(Quantity::velocity, 0)[p];
  double x_before = 0, v_before = speed;
  for (const auto& [x, v] : profile) {
    if (v < 0.5 * speed && v_before >= 0.5 * speed)
      return x_before + (x - x_before) * (v_before - 0.5 * speed) / (v_before - v);
    x_before = x;
    v_before = v;
  }
  return x_before;
}

TEST_CASE("a pushed bar's front runs at the wave speed within 1 %, and the piston feels rho c v") {
  const double speed = 0.01, c = bar_speed();
  for (const char* update : {"pic", "xpic(5)"}) {
    CAPTURE(std::string(update));
    const Scene scene = scene_from(
        kBar, {{"method.update", update}, {"boundaries.left", "{piston: 0.01 m/s, direction: right}"}});
    Step<2> step(scene);
    while (step.state().time < 0.3 * 0.1 / c) step.advance(step.stable_dt());
    const double early = front(step.state().particles, speed), early_time = step.state().time;
    const Vec<2> early_impulse = step.sums().boundary_impulse[0];
    while (step.state().time < 0.8 * 0.1 / c) step.advance(step.stable_dt());
    const double late = front(step.state().particles, speed), span = step.state().time - early_time;
    CHECK((late - early) / span == doctest::Approx(c).epsilon(0.01));
    // Force on the material per metre of thickness: ρ c v times 1 mm.
    const double force = (step.sums().boundary_impulse[0] - early_impulse)[0] / span;
    CHECK(force == doctest::Approx(1000 * c * speed * 1e-3).epsilon(0.01));
  }
}

/// Of the mean velocity over some periods against d'Alembert, as the root of the mean square over the
/// amplitude.
double error_of_periods(int periods, const std::vector<Override>& overrides) {
  const double length = 0.1, amplitude = 0.01, c = bar_speed();
  const Scene scene = scene_file("bar.yaml", overrides);
  Step<2> step(scene);
  double squares = 0;
  int count = 0;
  while (step.state().time < periods * 4 * length / c) {
    step.advance(step.stable_dt());
    const auto& particles = step.state().particles;
    double mean = 0;
    for (std::size_t p = 0; p < particles.size(); ++p)
      mean += particles.column(Quantity::velocity, 0)[p] / static_cast<double>(particles.size());
    const double angle = std::numbers::pi * c * step.state().time / (2 * length);
    const double difference = mean / amplitude - 2 / std::numbers::pi * std::asin(std::cos(angle));
    squares += difference * difference;
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST_CASE("the bar of configs/bar.yaml comes back after a period as d'Alembert says") {
  for (const char* update : {"flip", "fmpm(5)"}) {
    CAPTURE(std::string(update));
    CHECK(error_of_periods(1, {{"method.update", update}}) <
          0.01);  // measured over three periods: 0.7 and 0.4 %
  }
}

TEST_CASE("extended splines do not carry the bar's mass beyond its free end, which cuts a cell") {
  const std::vector<Override> splines{{"method.basis", "bspline2"}, {"grid.cell", "2 mm"}};
  std::vector<Override> extended = splines;
  extended.push_back({"method.extension", "{occupation: 0.6}"});
  const double error = error_of_periods(3, extended);  // 2.3 %; 5.0
  CHECK(error < 0.6 * error_of_periods(3, splines));
  CHECK(error < 0.025);
}

}  // namespace
}  // namespace mpmfast
