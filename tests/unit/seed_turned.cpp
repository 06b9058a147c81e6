// Bodies whose particles lie at an angle.

#include <algorithm>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("springs between blocks of turned particles are at rest where nothing has moved") {
  // F is R there, which is no displacement.
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [24 mm, 24 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {law: interface, normal_stiffness: 50 GPa/m, shear_stiffness: 20 GPa/m}
bodies:
  - {name: a, polygon: [[12 mm, 4 mm], [20 mm, 12 mm], [16 mm, 16 mm], [8 mm, 8 mm]], material: m, seeding: {angle: 45 deg}}
  - {name: b, polygon: [[8 mm, 8 mm], [16 mm, 16 mm], [12 mm, 20 mm], [4 mm, 12 mm]], material: m, seeding: {angle: 45 deg}}
)");
  Step<2> step(scene);
  advance(step, 10);
  double fastest = 0;
  const auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p)
    fastest = std::max(fastest, particles.vector(Quantity::velocity, p).norm());
  CHECK(fastest < 1e-9);  // m/s; round-off, where waves run at 340 m/s
}

}  // namespace
}  // namespace mpmfast
