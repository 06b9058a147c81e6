// What no scene may depend on: where the grid's zero lies, in which units it is written, how long nothing
// happens, and which of two equal bodies is the left one.

#include <fmt/format.h>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kUpdates[] = {"flip", "pic", "xpic(2)", "xpic(5)"};
const char* const kBases[] = {"ugimp", "lcpdi", "qcpdi", "bspline2", "bspline3"};

/// Two disks that hit each other obliquely, with friction; lengths and times in `scale` metres and seconds,
/// zero at `corner` cells from the grid's corner. Similar scenes: the same density, moduli and speeds.
Scene impact(double scale, double corner, const std::string& basis, const std::string& update,
             const std::string& strain = "average") {
  const auto metres = [&](double x) { return fmt::format("{:.17g} m", scale * (x + corner)); };
  const auto place = [&](double x, double y) { return fmt::format("[{}, {}]", metres(x), metres(y)); };
  return scene_from(fmt::format(R"(
space: plane_strain
grid: {{origin: {}, size: [{:.17g} m, {:.17g} m], cell: {:.17g} m}}
time: {{end: {:.17g} s}}
materials: {{m: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}}}
bodies:
  - {{name: a, disk: {{centre: {}, radius: {:.17g} m}}, material: m, velocity: [8 m/s, 1 m/s]}}
  - {{name: b, disk: {{centre: {}, radius: {:.17g} m}}, material: m, velocity: [-8 m/s, 0 m/s]}}
contact: {{law: coulomb, friction: 0.3}}
method: {{basis: {}, update: {}, strain: {}}}
)",
                                place(0, 0), 16 * scale, 12 * scale, scale, 0.05 * scale, place(4.6, 6),
                                2.5 * scale, place(10.2, 6.4), 2.5 * scale, basis, update, strain));
}

struct Compared {
  double velocity, stress;  ///< largest differences over largest values
  double pressure;          ///< largest |stress| of the second, Pa
};

Compared compare(const Scene& one, const Scene& other, int steps) {
  Step<2> a(one), b(other);
  advance(a, steps);
  advance(b, steps);
  const std::vector<double> stress = by_id(b.state().particles, Quantity::kirchhoff_stress);
  double pressure = 0;
  for (const double s : stress) pressure = std::max(pressure, std::abs(s));
  return {relative_difference(by_id(a.state().particles, Quantity::velocity),
                              by_id(b.state().particles, Quantity::velocity)),
          relative_difference(by_id(a.state().particles, Quantity::kirchhoff_stress), stress), pressure};
}

/// Steps until the disks have met.
constexpr int kSteps = 90;

TEST_CASE("an impact is the same in millimetres and in kilometres") {
  for (const char* basis : kBases)
    for (const char* update : kUpdates) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const Compared found = compare(impact(1e-3, 0, basis, update), impact(1e3, 0, basis, update), kSteps);
      CHECK(found.pressure > 5e4);  // they are in contact
      CHECK(found.velocity < 1e-10);
      CHECK(found.stress < 1e-10);
    }
}

TEST_CASE("with one set of touching pairs a step an impact is the same in millimetres and in kilometres") {
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"}) {
    CAPTURE(std::string(basis));
    const Compared found = compare(impact(1e-3, 0, basis, "flip", "average+"),
                                   impact(1e3, 0, basis, "flip", "average+"), kSteps);
    CHECK(found.pressure > 1e5);
    CHECK(found.velocity < 1e-10);
    CHECK(found.stress < 1e-10);
  }
}

TEST_CASE("an impact a million cells from the origin is that at the origin") {
  // A place is known to 1e-10 cells there, and contact makes more of a difference as bodies meet.
  for (const char* basis : kBases) {
    CAPTURE(std::string(basis));
    const Compared found = compare(impact(1, 1e6, basis, "xpic(2)"), impact(1, 0, basis, "xpic(2)"), kSteps);
    CHECK(found.pressure > 1e5);
    CHECK(found.velocity < 1e-6);
    CHECK(found.stress < 1e-6);
  }
}

TEST_CASE("a body at rest does not move by a bit") {
  for (const char* basis : kBases)
    for (const char* update : kUpdates) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}
bodies:
  - {name: a, disk: {centre: [6.3 mm, 5.2 mm], radius: 3 mm}, seeding: lattice, material: m}
  - {name: b, box: {from: [3 mm, 8.2 mm], to: [9 mm, 10 mm]}, material: m}
)",
                                     {{"method.basis", basis}, {"method.update", update}});
      Step<2> step(scene);
      const auto before = by_id(step.state().particles, Quantity::position);
      advance(step, 300);
      CHECK(by_id(step.state().particles, Quantity::position) == before);
    }
}

TEST_CASE("a body at rest whose domains lie at an angle moves by round-off alone") {
  // R R^T is 1 to round-off, which is a stress of 1e-16 of the modulus.
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}
bodies: [{name: a, disk: {centre: [6.3 mm, 5.2 mm], radius: 3 mm}, material: m}]
)");
  Step<2> step(scene);
  const auto before = by_id(step.state().particles, Quantity::position);
  advance(step, 300);
  const auto after = by_id(step.state().particles, Quantity::position);
  double moved = 0;
  for (std::size_t k = 0; k < before.size(); ++k) moved = std::max(moved, std::abs(after[k] - before[k]));
  CHECK(moved < 1e-15);  // m; cells of 1e-3 m
}

TEST_CASE("slow: a body at rest does not move by a bit in a million steps") {
  const Scene scene = scene_file("hard/rest.yaml", {{"time.end", "1 s"}});
  Step<2> step(scene);
  const auto before = by_id(step.state().particles, Quantity::position);
  advance(step, 1000000);
  CHECK(by_id(step.state().particles, Quantity::position) == before);
}

TEST_CASE("a free disk that spins keeps its energy where strain comes first") {
  // Two turns at R/h = 3, centred on a grid point, where it is worst: measured +4.4, +3.8, +0.7 % (+0.4 to
  // +2.1 % elsewhere); the averaged strain loses 46 %. On a lattice: conforming particles gain 12, 3.4, 0.3
  // %, rings 10, 5.3, 0.2 %.
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"}) {
    CAPTURE(std::string(basis));
    const std::vector<Override> first{{"bodies.0.seeding", "lattice"},
                                      {"method.strain", "first"},
                                      {"method.basis", basis},
                                      {"output.picture", "none"}};
    const Outcome outcome = run(scene_file("hard/spin.yaml", first));
    CHECK(std::abs(outcome.summary.energy_error) < 0.05);
  }
}

TEST_CASE("a free disk that spins keeps its energy with the default strain, however it is seeded") {
  // Two turns at R/h = 3: measured -0.08 to +0.03 %.
  for (const char* seeding : {"lattice", "rings", "conforming"})
    for (const char* basis : {"ugimp", "lcpdi", "bspline2"}) {
      CAPTURE(std::string(seeding));
      CAPTURE(std::string(basis));
      const Outcome outcome = run(
          scene_file("hard/spin.yaml",
                     {{"bodies.0.seeding", seeding}, {"method.basis", basis}, {"output.picture", "none"}}));
      CHECK(std::abs(outcome.summary.energy_error) < 0.0015);
    }
}

TEST_CASE("equal disks that meet head on stay mirror images") {
  for (const char* basis : kBases)
    for (const char* update : kUpdates) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const Scene scene = scene_from(R"(
space: plane_strain
grid: {origin: [-8 mm, -6 mm], size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}
bodies:
  - {name: a, disk: {centre: [-3 mm, 0 mm], radius: 2.5 mm}, material: m, velocity: [8 m/s, 0 m/s]}
  - {name: b, disk: {centre: [3 mm, 0 mm], radius: 2.5 mm}, material: m, velocity: [-8 m/s, 0 m/s]}
contact: {law: coulomb, friction: 0.3}
)",
                                     {{"method.basis", basis}, {"method.update", update}});
      Step<2> step(scene);
      advance(step, kSteps);
      const auto& particles = step.state().particles;
      const double momentum_of_one = 0.5 * kinetic_energy(particles) / 8;  // its order of magnitude
      CHECK(momentum(particles).norm() < 1e-12 * std::max(momentum_of_one, 1e-6));
      // Particle by particle: the mirror image of one of a is one of b.
      std::map<std::pair<long, long>, double> speed;
      const auto key = [](double x, double y) {
        return std::pair{std::lround(x * 1e9), std::lround(y * 1e9)};
      };
      std::size_t matched = 0;
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const auto x = particles.vector(Quantity::position, p), v = particles.vector(Quantity::velocity, p);
        if (particles.body()[p] == 0) speed[key(-x[0], x[1])] = -v[0];
      }
      for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.body()[p] != 1) continue;
        const auto x = particles.vector(Quantity::position, p), v = particles.vector(Quantity::velocity, p);
        const auto found = speed.find(key(x[0], x[1]));
        if (found != speed.end() && std::abs(found->second - v[0]) < 1e-8) ++matched;
      }
      // A place may round to another nanometre.
      CHECK(matched > 0.98 * static_cast<double>(speed.size()));
    }
}

}  // namespace
}  // namespace mpmfast
