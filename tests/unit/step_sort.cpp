/// When particles are sorted: not before one of them has left its place.

#include "engine/step/passes.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

template <int Dim>
Scene block(const char* basis) {
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
                    {{"method.basis", basis}});
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

}  // namespace
}  // namespace mpmfast
