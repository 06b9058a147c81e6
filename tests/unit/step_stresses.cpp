// Stresses that a step keeps to itself: whoever reads them between two steps gets those of F, and no run
// depends on who looks.

#include <algorithm>
#include <string>

#include "engine/plan/seed.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two elastic blocks and a metal that meet: a stress that follows from F beside one that has a history.
std::string meeting(int dimension) {
  const std::string materials = R"(
time: {end: 1 s}
materials:
  rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  hooke: {model: linear_elastic, density: 1200 kg/m^3, young: 80 MPa, poisson: 0.3}
  metal: {model: j2_plasticity, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, yield: 100 kPa}
)";
  if (dimension == 2)
    return materials + R"(
space: plane_strain
grid: {origin: [-5 mm, -5 mm], size: [34 mm, 24 mm], cell: 1 mm}
bodies:
  - {name: a, box: {from: [0 mm, 0 mm], to: [6 mm, 8 mm]}, material: rubber, velocity: [8 m/s, 1 m/s]}
  - {name: b, box: {from: [6 mm, 3 mm], to: [13 mm, 9 mm]}, material: metal, velocity: [-9 m/s, -2 m/s]}
  - {name: c, box: {from: [13 mm, 3 mm], to: [18 mm, 7 mm]}, material: hooke, velocity: [-20 m/s, 0 m/s]}
)";
  return materials + R"(
space: 3d
grid: {origin: [-4 mm, -4 mm, -4 mm], size: [20 mm, 14 mm, 14 mm], cell: 1 mm}
bodies:
  - {name: a, box: {from: [0 mm, 0 mm, 0 mm], to: [4 mm, 4 mm, 4 mm]}, material: rubber, velocity: [8 m/s, 1 m/s, 2 m/s]}
  - {name: b, box: {from: [4 mm, 1 mm, 1 mm], to: [7 mm, 5 mm, 4 mm]}, material: metal, velocity: [-9 m/s, -2 m/s, 0 m/s]}
  - {name: c, box: {from: [7 mm, 1 mm, 1 mm], to: [10 mm, 5 mm, 4 mm]}, material: hooke, velocity: [-30 m/s, 0 m/s, 0 m/s]}
)";
}

template <int Dim>
void check_stresses(const char* strain) {
  CAPTURE(std::string(strain));
  const Scene scene = scene_from(meeting(Dim), {{"method.strain", strain}});
  Step<Dim> watched(scene), alone(scene);
  for (int k = 0; k < 20; ++k) {
    const double dt = watched.stable_dt();
    REQUIRE(alone.stable_dt() == dt);
    watched.advance(dt);
    alone.advance(dt, false);
  }
  auto& particles = alone.state().particles;
  const std::vector<double> left = by_id(particles, Quantity::kirchhoff_stress);
  alone.find_stresses();
  const std::vector<double> stress = by_id(particles, Quantity::kirchhoff_stress);
  const bool last = std::string(strain).starts_with("last");  // whose stresses make the next forces
  CHECK((stress == left) == last);
  for (const Quantity q : {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                           Quantity::kirchhoff_stress, Quantity::wave_speed})
    CHECK(by_id(watched.state().particles, q) == by_id(particles, q));
  refresh_stress(alone.state());  // each particle by itself, from F
  CHECK(relative_difference(by_id(particles, Quantity::kirchhoff_stress), stress) < 1e-13);
}

TEST_CASE("stresses between two steps are those of F, and looking at them changes nothing") {
  for (const char* strain : {"first", "last", "average", "average+", "last+"}) {
    check_stresses<2>(strain);
    check_stresses<3>(strain);
  }
}

TEST_CASE(
    "the stress that a body of one particle keeps to itself is found too, wherever it lies among others") {
  std::string bodies = "bodies:\n";
  for (int k = 0; k < 9; ++k)
    bodies += "  - {name: b" + std::to_string(k) + ", box: {from: [" + std::to_string(4 * k) +
              " mm, 0 mm], to: [" + std::to_string(4 * k + 1) +
              " mm, 1 mm]}, material: " + (k % 2 ? "hooke" : "rubber") + ", particles_per_cell: 1}\n";
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {origin: [-4 mm, -4 mm], size: [44 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials:
  rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  hooke: {model: linear_elastic, density: 1200 kg/m^3, young: 80 MPa, poisson: 0.3}
)" + bodies,
                                 {{"method.strain", "first"}});
  Step<2> step(scene);
  step.advance(step.stable_dt(), false);
  auto& particles = step.state().particles;
  REQUIRE(particles.size() == 9);
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.column(Quantity::deformation_gradient, 0)[p] = 1.01 + 0.01 * static_cast<double>(p);
  step.find_stresses();
  const std::vector<double> found = by_id(particles, Quantity::kirchhoff_stress);
  refresh_stress(step.state());
  const std::vector<double> stress = by_id(particles, Quantity::kirchhoff_stress);
  CHECK(*std::min_element(particles.column(Quantity::kirchhoff_stress, 0),
                          particles.column(Quantity::kirchhoff_stress, 0) + particles.size()) > 1e5);
  CHECK(relative_difference(found, stress) < 1e-13);
}

}  // namespace
}  // namespace mpmfast
