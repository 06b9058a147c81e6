// What output says of planes that stretch along their normal.

#include <doctest/doctest.h>

#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"
#include "output_fixture.hpp"

namespace mpmfast {
namespace {

TEST_CASE("volumes and Cauchy stresses know the stretch out of the plane") {
  Particles<2> particles;
  particles.allocate(
      2, {Quantity::position, Quantity::velocity, Quantity::deformation_gradient, Quantity::kirchhoff_stress,
          Quantity::mass, Quantity::initial_volume, Quantity::out_of_plane_stretch});
  for (std::size_t p = 0; p < 2; ++p) {
    particles.id()[p] = static_cast<std::uint32_t>(p);
    particles.body()[p] = 0;
    particles.column(Quantity::mass)[p] = 1;
    particles.column(Quantity::initial_volume)[p] = 2;
    particles.column(Quantity::deformation_gradient, 0)[p] = 1.5;
    particles.column(Quantity::deformation_gradient, 3)[p] = 2;
    particles.column(Quantity::out_of_plane_stretch)[p] = p == 0 ? 0.5 : 1;
    particles.column(Quantity::kirchhoff_stress, 2)[p] = 6;
  }
  CHECK(volume_ratio(particles, 0) == 1.5);
  CHECK(volume_ratio(particles, 1) == 3);
  CHECK(cauchy_stress(particles, 0).component[2] == 4);
  CHECK(cauchy_stress(particles, 1).component[2] == 2);
  HistoryRow row;
  fill_particle_sums(particles, output_test::small_scene(Space::plane_stress), row);
  CHECK(row.bodies[0].mean_stress[2] == doctest::Approx(24.0 / 9).epsilon(1e-15));

  const std::string before = checksum(particles);
  particles.column(Quantity::out_of_plane_stretch)[1] = 1.1;
  CHECK(checksum(particles) != before);
}

}  // namespace
}  // namespace mpmfast
