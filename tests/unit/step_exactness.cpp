// What a step must do to round-off, whatever the scene.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two blocks of one material that fly into each other obliquely, cells not aligned with them.
std::string impact(int dimension) {
  if (dimension == 2)
    return R"(
space: plane_strain
grid: {origin: [-5 mm, -5 mm], size: [34 mm, 24 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm], to: [6.3 mm, 8.2 mm]}, material: m, velocity: [8 m/s, 1 m/s]}
  - {name: b, box: {from: [6.3 mm, 3.7 mm], to: [13.3 mm, 9.7 mm]}, material: m, velocity: [-9 m/s, -2 m/s]}
)";
  return R"(
space: 3d
grid: {origin: [-4 mm, -4 mm, -4 mm], size: [20 mm, 14 mm, 14 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm, 0.4 mm], to: [4.3 mm, 4.2 mm, 4.4 mm]}, material: m, velocity: [8 m/s, 1 m/s, 2 m/s]}
  - {name: b, box: {from: [4.3 mm, 1.7 mm, 1.2 mm], to: [9.3 mm, 5.7 mm, 4.2 mm]}, material: m, velocity: [-9 m/s, -2 m/s, 0 m/s]}
)";
}

template <int Dim>
void check_momentum(const std::vector<Override>& overrides) {
  const Scene scene = scene_from(impact(Dim), overrides);
  Step<Dim> step(scene);
  const Vec<Dim> before = momentum(step.state().particles);
  double scale = 0;
  for (std::size_t p = 0; p < step.state().particles.size(); ++p)
    scale += step.state().particles.column(Quantity::mass)[p] * 10;
  advance(step, sanitized() ? 15 : 150);
  CHECK(step.contact_counters().nodes_peak > 0);
  // Round-off of some 1e5 additions a step, growing as a random walk over 150 steps.
  CHECK((momentum(step.state().particles) - before).norm() < 1e-13 * scale);
}

template <int Dim>
void check_all_momenta() {
  for (const char* update : {"flip", "pic", "xpic(3)", "fmpm(3)"})
    for (const char* contact : {"{law: coulomb, friction: 0.3}", "{law: stick, normal: average_gradient}",
                                "{law: frictionless, normal: smoothed_logistic_regression}"})
      for (const char* basis : {"ugimp", "lcpdi", "qcpdi"}) {
        CAPTURE(std::string(update));
        CAPTURE(std::string(contact));
        CAPTURE(std::string(basis));
        check_momentum<Dim>({{"method.update", update}, {"contact", contact}, {"method.basis", basis}});
      }
}

TEST_CASE("momentum is conserved to round-off through an impact with B-splines and APIC") {
  for (const char* basis : {"bspline2", "bspline3"})
    for (const char* update : {"xpic(3)", "apic"}) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const std::vector<Override> overrides{{"method.update", update},
                                            {"method.basis", basis},
                                            {"method.deformation_terms", "exponential"},
                                            {"contact", "{law: coulomb, friction: 0.3}"}};
      check_momentum<2>(overrides);
      check_momentum<3>(overrides);
    }
}

TEST_CASE("momentum is conserved to round-off through an impact of two fields (2-D)") {
  check_all_momenta<2>();
}
TEST_CASE("momentum is conserved to round-off through an impact of two fields (3-D)") {
  check_all_momenta<3>();
}

template <int Dim>
void check_perfect(std::vector<Override> overrides, const std::string& more) {
  const std::string scene = impact(Dim) + more;
  overrides.push_back({"contact", "none"});
  const Scene one_scene = scene_from(scene, overrides);
  overrides.back().second = "{law: perfect}";
  const Scene two_scene = scene_from(scene, overrides);
  Step<Dim> one(one_scene), two(two_scene);
  REQUIRE(one.plan().fields.size() == 1);
  REQUIRE(two.plan().fields.size() == 2);
  const int steps = sanitized() ? 40 : 200;
  advance(one, steps);
  advance(two, steps);
  for (Quantity q : {Quantity::position, Quantity::velocity, Quantity::deformation_gradient})
    CHECK(relative_difference(by_id(two.state().particles, q), by_id(one.state().particles, q)) < 1e-12);
  // A stress far below the modulus shows the round-off of F enlarged by their ratio: measure against the
  // modulus.
  const auto a = by_id(two.state().particles, Quantity::kirchhoff_stress);
  const auto b = by_id(one.state().particles, Quantity::kirchhoff_stress);
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference = std::max(difference, std::abs(a[i] - b[i]));
  CHECK(difference < 1e-12 * 80e6);
}

template <int Dim>
void check_all_perfect(const std::string& more) {
  // Two terms: a particle about to leave a uGIMP node is there with round-off alone, which the inverse form
  // enlarges. The smooth bases of the next case have none of that.
  for (const char* update : {"flip", "pic"})
    for (const char* strain : {"first", "last", "average", "last+", "average+"}) {
      CAPTURE(std::string(update));
      CAPTURE(std::string(strain));
      check_perfect<Dim>(
          {{"method.update", update}, {"method.strain", strain}, {"method.deformation_terms", "2"}}, more);
    }
}

TEST_CASE("a perfect interface reproduces one field to round-off over 200 steps of an impact (2-D)") {
  check_all_perfect<2>("");
}
TEST_CASE("a perfect interface reproduces one field to round-off over 200 steps of an impact (3-D)") {
  check_all_perfect<3>("");
}
TEST_CASE("a perfect interface reproduces one field to round-off with smooth bases, APIC, other forms of F") {
  for (const char* basis : {"lcpdi", "qcpdi", "bspline2", "bspline3"})
    for (const char* update : {"flip", "apic"}) {
      if (update == std::string("apic") && std::string(basis).substr(0, 7) != "bspline") continue;
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      for (const char* terms : {"exponential", "inverse"}) {
        CAPTURE(std::string(terms));
        const std::vector<Override> overrides{
            {"method.basis", basis}, {"method.update", update}, {"method.deformation_terms", terms}};
        check_perfect<2>(overrides, "");
        check_perfect<3>(overrides, "");
      }
      check_perfect<2>({{"method.basis", basis}, {"method.update", update}, {"method.strain", "average+"}},
                       "");
    }
}
/// None, at nodes, and along a plane that cuts cells.
const char* const kPressed[] = {
    "", "boundaries: {left: {piston: 20 m/s, direction: right, position: 1 mm}, bottom: fixed}\n",
    "boundaries: {left: {piston: 20 m/s, direction: right, position: 0.6 mm, at: plane}, bottom: fixed}\n"};

TEST_CASE("a perfect interface reproduces one field to round-off with FMPM of every order") {
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"})
    for (const char* update : {"fmpm(2)", "fmpm(3)", "fmpm(5)", "fmpm(10)"})
      for (const char* boundaries : kPressed) {
        CAPTURE(std::string(basis));
        CAPTURE(std::string(update));
        CAPTURE(std::string(boundaries));
        std::vector<Override> overrides{
            {"method.basis", basis}, {"method.update", update}, {"method.deformation_terms", "2"}};
        check_perfect<2>(overrides, boundaries);
        if (boundaries == kPressed[0]) check_perfect<3>(overrides, "");
        overrides.push_back({"method.every", "3"});
        check_perfect<2>(overrides, boundaries);
      }
}
TEST_CASE("a perfect interface reproduces one field to round-off between a floor and a piston") {
  check_all_perfect<2>(
      "boundaries: {left: {piston: 20 m/s, direction: right, position: 1 mm}, bottom: fixed}\n");
}

template <int Dim>
void check_translation(const char* basis, const char* update) {
  CAPTURE(std::string(basis));
  CAPTURE(std::string(update));
  std::string yaml = Dim == 2 ? R"(
space: plane_strain
grid: {size: [30 mm, 20 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [3.3 mm, 3.2 mm], to: [9.3 mm, 8.2 mm]}, material: m, velocity: [60 m/s, 35 m/s]}]
)"
                              : R"(
space: 3d
grid: {size: [20 mm, 16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [3.3 mm, 3.2 mm, 3.1 mm], to: [6.3 mm, 6.2 mm, 6.1 mm]}, material: m, velocity: [60 m/s, 35 m/s, 45 m/s]}]
)";
  const Scene scene = scene_from(yaml, {{"method.basis", basis}, {"method.update", update}});
  Step<Dim> step(scene);
  const auto start = by_id(step.state().particles, Quantity::position);
  const auto velocity = by_id(step.state().particles, Quantity::velocity);
  advance(step, 100);
  const double time = step.state().time;
  auto expected = start;
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += time * velocity[i];
  CHECK(time * 60 > 4e-3);  // several cells
  CHECK(relative_difference(by_id(step.state().particles, Quantity::position), expected) < 1e-12);
  CHECK(relative_difference(by_id(step.state().particles, Quantity::velocity), velocity) < 1e-12);
  const auto f = by_id(step.state().particles, Quantity::deformation_gradient);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const std::size_t entry = i % (Dim * Dim);
    REQUIRE(std::abs(f[i] - (entry % (Dim + 1) == 0 ? 1.0 : 0.0)) < 1e-12);
  }
}

template <int Dim>
void check_all_translations() {
  for (const char* basis : bases())
    for (const char* update : {"flip", "pic", "xpic(4)", "fmpm(4)"}) check_translation<Dim>(basis, update);
  for (const char* basis : apic_bases()) check_translation<Dim>(basis, "apic");
}

TEST_CASE("a translating block keeps its shape and velocity (2-D)") { check_all_translations<2>(); }
TEST_CASE("a translating block keeps its shape and velocity (3-D)") { check_all_translations<3>(); }

/// A body after 0.9 ms under a body force with a ramp of 0.4 ms, and how far it fell.
std::pair<double, double> velocity_and_fall(const char* position) {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [20 mm, 30 mm], cell: 1 mm}
time: {end: 1 s, max_step: 2 us}
materials: {m: {model: linear_elastic, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies: [{name: a, box: {from: [5 mm, 12.4 mm], to: [9 mm, 16.4 mm]}, material: m}]
gravity: {acceleration: [0 m/s^2, -9810 m/s^2], ramp: 400 us}
)",
                                 {{"method.position", position}});
  Step<2> step(scene);
  const double y0 = step.state().particles.vector(Quantity::position, 0)[1];
  while (step.state().time < 0.9e-3) step.advance(2e-6);
  CHECK(step.state().time == doctest::Approx(0.9e-3));
  return {step.state().particles.vector(Quantity::velocity, 0)[1],
          y0 - step.state().particles.vector(Quantity::position, 0)[1]};
}

TEST_CASE("a body under a ramped body force falls as the closed solution") {
  const double t = 0.9e-3, ramp = 400e-6, g = 9810;
  // v = g t²/(2r) on the ramp, then g (t − r/2); the midpoint rule is exact for both, the end velocity takes
  // positions v Δt/2 ahead.
  const double fallen = g * (ramp * ramp / 6 + ramp / 2 * (t - ramp) + (t - ramp) * (t - ramp) / 2);
  const double speed = g * (t - ramp / 2);
  for (const auto& [position, ahead] : {std::pair{"grid", 0.0}, std::pair{"grid_end", 1e-6 * speed}}) {
    const auto [velocity, fall] = velocity_and_fall(position);
    CHECK(velocity == doctest::Approx(-speed).epsilon(1e-10));
    CHECK(fall == doctest::Approx(fallen + ahead).epsilon(2e-6));
  }
}

}  // namespace
}  // namespace mpmfast
