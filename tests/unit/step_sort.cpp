/// When particles are sorted: not before one of them has left its place.

#include "engine/step/passes.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

template <int Dim>
Scene block(const char* basis, const char* contact = "none") {
  return scene_from(Dim == 2 ? R"(
space: plane_strain
grid: {size: [20 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, disk: {centre: [9 mm, 8 mm], radius: 5 mm}, material: m}]
)"
                             : R"(
space: 3d
grid: {size: [14 mm, 12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, sphere: {centre: [7 mm, 6 mm, 6 mm], radius: 2 mm}, material: m}]
)",
                    {{"method.basis", basis}, {"contact", contact}});
}

template <int Dim>
void check_strays(const char* basis) {
  CAPTURE(std::string(basis));
  const Scene scene = block<Dim>(basis);
  Step<Dim> step(scene);
  auto& state = step.state();
  const auto passes = make_passes<Dim>(scene.method.basis);
  passes->shape_domains(state);
  passes->sort(state);
  const double cell = state.grid.cell;
  const std::size_t last = state.particles.size() - 1;
  CHECK(passes->near_home(state, 0.75 * cell));
  for (const std::size_t p : {std::size_t{0}, last / 2, last}) {
    for (int d = 0; d < Dim; ++d) {
      double& x = state.particles.column(Quantity::position, d)[p];
      const double home = x;
      for (const double sign : {-1.0, 1.0}) {
        x = home + sign * 0.2 * cell;
        CHECK(passes->near_home(state, 0.75 * cell));
        x = home + sign * 0.9 * cell;
        CHECK(passes->near_home(state, 0));
        x = home + sign * 1.3 * cell;  // wherever in its cell it was, 0.75 more are too far
        CHECK_FALSE(passes->near_home(state, 0.75 * cell));
        x = home + sign * 2.1 * cell;
        CHECK_FALSE(passes->near_home(state, 0));
      }
      x = home;
    }
  }
  CHECK(passes->near_home(state, 0.75 * cell));
}

TEST_CASE("a particle that strays from the cell it was sorted to is noticed, one that comes back is not") {
  for (const char* basis : bases()) {
    check_strays<2>(basis);
    check_strays<3>(basis);
  }
}

/// Bodies alone with contact are sorted sooner: others ask which particles lie in a cell.
template <int Dim>
void check_flight(const char* basis, const char* contact, double cells_a_step) {
  CAPTURE(std::string(basis));
  CAPTURE(std::string(contact));
  CAPTURE(cells_a_step);
  Scene scene = block<Dim>(basis, contact);
  Step<Dim> step(scene);
  auto& state = step.state();
  auto& particles = state.particles;
  const double cell = state.grid.cell, dt = 1e-6, speed = cells_a_step * cell / dt;
  Vec<Dim> velocity = Vec<Dim>::Constant(speed);
  velocity[1] = -velocity[1];
  std::vector<Vec<Dim>> positions(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    positions[particles.id()[p]] = particles.vector(Quantity::position, p);
    for (int d = 0; d < Dim; ++d) particles.column(Quantity::velocity, d)[p] = velocity[d];
  }
  const int steps = static_cast<int>(2.9 / cells_a_step);
  for (int k = 0; k < steps; ++k) step.advance(dt);
  double furthest = 0, deformed = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<Dim> way = particles.vector(Quantity::position, p) - positions[particles.id()[p]];
    furthest = std::max(furthest, (way - steps * dt * velocity).norm() / cell);
    deformed =
        std::max(deformed, (particles.deformation_gradient(p) - particles.initial_deformation(p)).norm());
  }
  CHECK(furthest < 1e-9);  // of rounding, steps of cells
  CHECK(deformed < 1e-9);
}

TEST_CASE("a body in free flight moves as a whole, however far it goes in a step and between two sorts") {
  for (const char* basis : bases())
    for (const char* contact : {"none", "{law: coulomb, friction: 0.3}"})
      for (const double cells : {0.07, 0.24, 0.46, 0.95}) {
        check_flight<2>(basis, contact, cells);
        check_flight<3>(basis, contact, cells);
      }
}

}  // namespace
}  // namespace mpmfast
