// Steps whose particles are split.

#include <omp.h>

#include <set>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// What a body seeded with two particles a side gives, by seeding one and splitting it both ways before the
/// first step: whatever reads the size of a domain must know its share. Ids differ, so sums are compared.
template <int Dim>
void check_like_finer(const std::string& yaml, int steps) {
  CAPTURE(yaml);
  const Scene fine = scene_from(yaml, {{"bodies.0.particles_per_cell", "2"}});
  Scene coarse = scene_from(yaml, {{"bodies.0.particles_per_cell", "1"}, {"method.split", "true"}});
  coarse.method.split_edge = 0.9;  // shorter than scenes may say
  Step<Dim> seeded(fine), split(coarse);
  advance(seeded, steps);
  advance(split, steps);
  REQUIRE(split.state().particles.size() == seeded.state().particles.size());
  REQUIRE(split.splits().splits > 10);
  CHECK(split.splits().held == 0);
  constexpr double kRoundOff = 1e-9;
  const auto same = [&](double a, double b, double scale) { CHECK(std::abs(a - b) <= kRoundOff * scale); };
  const auto &a = split.state().particles, &b = seeded.state().particles;
  const double kinetic = kinetic_energy(b), stored = seeded.stored_energy(), energy = kinetic + stored;
  same(split.state().time, seeded.state().time, seeded.state().time);
  same(kinetic_energy(a), kinetic, energy);
  same(split.stored_energy(), stored, energy);
  for (int d = 0; d < Dim; ++d) {
    std::vector<double> mine, theirs;
    for (std::size_t p = 0; p < a.size(); ++p) {
      mine.push_back(a.column(Quantity::position, d)[p]);
      theirs.push_back(b.column(Quantity::position, d)[p]);
    }
    std::sort(mine.begin(), mine.end());
    std::sort(theirs.begin(), theirs.end());
    CHECK(relative_difference(mine, theirs) < kRoundOff);
  }
  for (std::size_t k = 0; k < seeded.sums().boundary_impulse.size(); ++k)
    CHECK((split.sums().boundary_impulse[k] - seeded.sums().boundary_impulse[k]).norm() <=
          kRoundOff * seeded.sums().boundary_impulse[k].norm());
  same(split.sums().friction_work, seeded.sums().friction_work, energy);
}

const char* const kSplitBlock = R"(
grid: {size: [10 mm, 8 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
)";

/// A falling block on another one, which lies on a wall.
std::string block_on_block(const std::string& contact, const std::string& basis) {
  return std::string("space: plane_strain\n") + kSplitBlock + "contact: {friction: 0.3, tolerance: 1e-13" +
         contact +
         "}\n"
         "bodies:\n"
         "  - {name: a, box: {from: [2 mm, 3 mm], to: [6 mm, 6 mm]}, material: m, velocity: [5 m/s, -20 "
         "m/s]}\n"
         "  - {name: b, box: {from: [1 mm, 1 mm], to: [8 mm, 3 mm]}, material: m}\n"
         "boundaries: {bottom: {wall: sliding, position: 1 mm, at: surface}}\n"
         "method: {basis: " +
         basis + "}\n";
}

// Regressions go to their end: otherwise round-off decides after how many passes one stops. With refit
// normals alone are kept: of the particles of a flat face, which are equally far forward, round-off decides
// which one tells the separations after it.
TEST_CASE("a body whose particles are all split is as one that was seeded so, in contact and at walls") {
  for (const char* basis : {"lcpdi", "qcpdi"})
    for (const char* contact : {"", ", separation: ellipsoid_support", ", refit: 0.3, detection: velocity"})
      check_like_finer<2>(block_on_block(contact, basis), 40);
}

TEST_CASE("rings, plane stress and solids that are split are as those that were seeded so") {
  const char* const body =
      "bodies: [{name: a, box: {from: [0 mm, 1 mm], to: [4 mm, 6 mm]}, material: m, velocity: [0 m/s, -20 "
      "m/s]}]\n"
      "boundaries: {bottom: {wall: sliding, position: 1 mm}}\nmethod: {basis: lcpdi}\n";
  check_like_finer<2>(std::string("space: axisymmetric\n") + kSplitBlock + body, 30);
  check_like_finer<2>(std::string("space: plane_stress\n") + kSplitBlock + body, 30);
  check_like_finer<3>(R"(
space: 3d
grid: {size: [6 mm, 6 mm, 6 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm, 3 mm], to: [4 mm, 4 mm, 5 mm]}, material: m, velocity: [0 m/s, 3 m/s, -20 m/s]}
  - {name: b, box: {from: [1 mm, 1 mm, 1 mm], to: [5 mm, 5 mm, 3 mm]}, material: m}
contact: {friction: 0.3, tolerance: 1e-13}
method: {basis: lcpdi}
)",
                      12);
}

TEST_CASE("heat crosses a body that was split as one that was seeded so") {
  check_like_finer<2>(R"(
space: plane_strain
grid: {size: [10 mm, 8 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 2 kW/m/K, thermal_expansion: 1e-5 K^-1}}
bodies: [{name: a, box: {from: [2 mm, 0 mm], to: [8 mm, 4 mm]}, material: m}]
boundaries: {bottom: wall}
heat: {temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}
method: {basis: lcpdi}
)",
                      30);
}

/// A strip, one particle a cell along it and several across, drawn by its ends.
std::string drawn(const std::string& more = "") {
  return R"(
space: plane_strain
grid: {size: [36 mm, 56 mm], cell: 1 mm}
time: {end: 0.6 ms}
materials:
  rubber: {model: logarithmic_neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
  grip: {model: rigid}
bodies:
  - {name: strip, box: {from: [14 mm, 3 mm], to: [22 mm, 53 mm]}, material: rubber, particles_per_cell: [1, 8]}
  - {name: l, box: {from: [12 mm, 2 mm], to: [14 mm, 54 mm]}, material: grip, velocity: [-20 m/s, 0]}
  - {name: r, box: {from: [22 mm, 2 mm], to: [24 mm, 54 mm]}, material: grip, velocity: [20 m/s, 0]}
contact: {law: perfect}
method: {basis: lcpdi, split: {edge: 1.25}}
output: {frames: 4, history: 20, picture: stress_xx}
)" + more;
}

std::set<std::uint32_t> ids_of(const Particles<2>& particles) {
  return {particles.id().data(), particles.id().data() + particles.size()};
}

TEST_CASE("a strip that is drawn gets particles as it needs them, of sizes that fill it") {
  const Scene scene = scene_from(drawn());
  Step<2> step(scene);
  const auto& particles = step.state().particles;
  const std::size_t seeded = particles.size();
  double mass = 0, longest = 0;
  for (std::size_t p = 0; p < seeded; ++p) mass += particles.column(Quantity::mass)[p];
  while (step.state().time < scene.time.end) {
    advance(step, 1);
    for (std::size_t p = 0; p < particles.size(); ++p)
      for (int k = 0; k < 2; ++k) longest = std::max(longest, 2 * half_edge(step.state(), p, k).norm());
  }
  CHECK(step.splits().splits + seeded == particles.size());
  CHECK(particles.size() > seeded + 1000);
  CHECK(step.splits().held == 0);
  CHECK(longest > 1.25e-3);
  CHECK(longest < 1.5e-3);  // a quarter of a cell more, by which it may grow between two looks
  double now = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) now += particles.column(Quantity::mass)[p];
  CHECK(now == doctest::Approx(mass).epsilon(1e-13));
  CHECK(ids_of(particles).size() == particles.size());
  CHECK(*ids_of(particles).rbegin() + 1 == particles.size());
}

TEST_CASE(
    "particles are split alike on any number of threads, also where they become enough for more of them" *
    doctest::skip(sanitized())) {
  const Scene scene = scene_from(drawn());
  const Outcome one = run(scene, 1), two = run(scene, 2), four = run(scene, 4);
  REQUIRE(one.failure.empty());
  REQUIRE(one.summary.splits);
  CHECK(one.summary.splits->splits > 1000);
  CHECK(four.summary.threads == 4);
  CHECK(two.summary.checksum == one.summary.checksum);
  CHECK(four.summary.checksum == one.summary.checksum);
  CHECK(two.history == one.history);
  CHECK(four.history == one.history);
}

TEST_CASE("domains are looked at in the first step, then whenever particles have gone an eighth of a cell") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [20 mm, 8 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 10 Pa, shear: 4 Pa}}
bodies: [{name: a, box: {from: [2 mm, 2 mm], to: [6 mm, 5 mm]}, material: m, particles_per_cell: 1, velocity: [50 m/s, 0]}]
method: {basis: lcpdi, split: true}
)");
  Step<2> step(scene);
  auto& particles = step.state().particles;
  const auto stretch = [&](std::size_t p) { particles.column(Quantity::deformation_gradient, 0)[p] = 1.7; };
  const double dt = 0.03e-3 / 50;  // 0.03 cells; the material is so soft that nothing else moves
  stretch(0);
  step.advance(dt);
  CHECK(step.splits().splits == 1);
  for (std::size_t expected : {2U, 3U}) {
    // Longer by hand. It has gone 0.12 cells before the fifth step from a look.
    const double* const along = particles.column(Quantity::deformation_gradient, 0);
    const auto whole = static_cast<std::size_t>(
        std::find_if(along, along + particles.size(), [](double f) { return f < 1.5; }) - along);
    REQUIRE(whole < particles.size());
    stretch(whole);
    for (int k = 1; k <= 4; ++k) {
      CAPTURE(k);
      step.advance(dt);
      CHECK(step.splits().splits == expected - 1);
    }
    step.advance(dt);
    CHECK(step.splits().splits == expected);
  }
  CHECK(particles.size() == 12 + 3);
}

TEST_CASE("grains that part by their law, rigid bodies and scenes that do not ask are not split") {
  const char* const bodies = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials:
  soil: {model: drucker_prager, density: 1.8 g/cm^3, young: 5 MPa, poisson: 0.3, friction_angle: 32 deg}
  rubber: {model: neo_hookean, density: 1 g/cm^3, bulk: 2 GPa, shear: 1 GPa}
  tool: {model: rigid}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm], to: [2 mm, 2 mm]}, material: soil}
  - {name: b, box: {from: [4 mm, 1 mm], to: [5 mm, 2 mm]}, material: rubber}
  - {name: c, box: {from: [7 mm, 1 mm], to: [8 mm, 2 mm]}, material: tool}
)";
  const Plan plan = make_plan(scene_from(std::string(bodies) + "method: {basis: lcpdi, split: true}\n"));
  CHECK(plan.body_splits == std::vector<bool>{false, true, false});
  CHECK(plan.split_edge == 1.5);
  const Plan other = make_plan(scene_from(std::string(bodies) + "method: {basis: lcpdi}\n"));
  CHECK(other.body_splits.empty());
  const auto& columns = other.particle_columns;
  CHECK(std::find(columns.begin(), columns.end(), Quantity::domain_share) == columns.end());
}

}  // namespace
}  // namespace mpmfast
