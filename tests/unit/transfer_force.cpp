/// The force that is projected with the masses against the force of a pass of its own.

#include <random>

#include "engine/step/passes.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;
using Draw = std::mt19937_64;

double number(Draw& draw) { return std::uniform_real_distribution<double>(-1, 1)(draw); }

template <int Dim>
void check_force(const char* basis) {
  CAPTURE(std::string(basis));
  const Scene scene = scene_from(Dim == 2 ? R"(
space: plane_strain
grid: {size: [20 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, disk: {centre: [9 mm, 8 mm], radius: 5 mm}, material: m, velocity: [3 m/s, 4 m/s]}]
)"
                                          : R"(
space: 3d
grid: {size: [12 mm, 12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: b, sphere: {centre: [6 mm, 6 mm, 6 mm], radius: 3 mm}, material: m,
     velocity: [3 m/s, 4 m/s, 5 m/s]}
)",
                                 {{"method.basis", basis}});
  Step<Dim> step(scene);
  auto& state = step.state();
  const auto passes = make_passes<Dim>(scene.method.basis);
  passes->sort(state);
  Draw draw(3);
  for (int c = 0; c < kSymmetric<Dim>; ++c)
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      state.particles.column(Quantity::kirchhoff_stress, c)[p] = number(draw);
  const auto clear = [&] {
    for (Nodal q : {Nodal::mass, Nodal::momentum, Nodal::force})
      for (int d = 0; d < Nodes<Dim>::components(q); ++d)
        std::fill_n(state.nodes.column(q, d), state.tiling.slots(), 0.0);
  };
  const auto rows = [&] {
    std::vector<std::vector<double>> all;
    for (Nodal q : {Nodal::mass, Nodal::momentum, Nodal::force})
      for (int d = 0; d < Nodes<Dim>::components(q); ++d)
        all.emplace_back(state.nodes.column(q, d), state.nodes.column(q, d) + state.tiling.slots());
    return all;
  };
  clear();
  REQUIRE(passes->project(state, false));
  passes->strain_and_force(state, 0, 1);
  const auto apart = rows();
  clear();
  REQUIRE(passes->project(state, true));
  const auto together = rows();
  for (std::size_t q = 0; q < apart.size(); ++q) CHECK(relative_difference(together[q], apart[q]) < 1e-13);
}

TEST_CASE("the force that is projected with mass and momentum is that of a pass of its own") {
  for (const char* basis : bases()) {
    check_force<2>(basis);
    check_force<3>(basis);
  }
}

}  // namespace
}  // namespace mpmfast
