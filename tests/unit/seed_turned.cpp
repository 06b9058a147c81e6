// Bodies whose particles lie at an angle.

#include <algorithm>
#include <cmath>

#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/read_frame.hpp"
#include "tests/support.hpp"
#include "tools/report/frame_survey.hpp"

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

/// A scene of the space with one body that says nothing of its seeding.
SeedingKind seeding_of(const std::string& space, const std::string& shape, const std::string& more = "",
                       const char* material = "neo_hookean, bulk: 8 MPa, shear: 3 MPa") {
  const bool solid = space == "3d";
  const Scene scene =
      scene_from("space: " + space + "\ngrid: {size: " + (solid ? "[8 mm, 8 mm, 8 mm]" : "[8 mm, 8 mm]") +
                 ", cell: 1 mm}\ntime: {end: 1 s}\nmaterials: {m: {density: 1000 kg/m^3, model: " + material +
                 "}}\nbodies: [{" + shape + ", material: m" + more + "}]\n");
  return scene.bodies[0].seeding.kind;
}

TEST_CASE("particles follow the outline by default where a scene in the plane lets them") {
  const std::string disk = "disk: {centre: [4 mm, 4 mm], radius: 2 mm}";
  const std::string polygon = "polygon: [[2 mm, 2 mm], [6 mm, 3 mm], [3 mm, 6 mm]]";
  CHECK(seeding_of("plane_strain", disk) == SeedingKind::conforming);
  CHECK(seeding_of("plane_stress", polygon) == SeedingKind::conforming);
  CHECK(seeding_of("plane_strain", polygon, ", particles_per_cell: [3, 3]") == SeedingKind::conforming);
  CHECK(seeding_of("plane_strain", polygon, ", particles_per_cell: [2, 3]") == SeedingKind::lattice);
  CHECK(seeding_of("plane_strain", disk, ", seeding: lattice") == SeedingKind::lattice);
  CHECK(seeding_of("plane_strain", disk, ", seeding: rings") == SeedingKind::rings);
  CHECK(seeding_of("plane_strain", disk, "", "linear_elastic, young: 8 MPa, poisson: 0.3") ==
        SeedingKind::lattice);
  CHECK(seeding_of("plane_strain", "box: {from: [2 mm, 2 mm], to: [5 mm, 4 mm]}") == SeedingKind::lattice);
  CHECK(seeding_of("axisymmetric", disk) == SeedingKind::lattice);
  CHECK(seeding_of("3d", "sphere: {centre: [4 mm, 4 mm, 4 mm], radius: 2 mm}") == SeedingKind::lattice);
}

TEST_CASE("files hold F of the body without the angle of domains, and give domains back with it") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [8 mm, 8 mm], radius: 4 mm}, material: m, rotation: {about: [8 mm, 8 mm], speed: 3000 rad/s}}
)");
  Step<2> step(scene);
  const Folder folder;
  ParticleSeries<2> series(folder / "", scene);
  series.append(step.state().particles, 0);
  advance(step, 40);
  series.append(step.state().particles, 1e-6);
  const auto& particles = step.state().particles;
  const auto first = VtuReader(folder / "particles/000000.vtu");
  const std::vector<double> unstrained = first.values(*first.find("deformation_gradient"));
  for (std::size_t i = 0; i < unstrained.size(); ++i)
    CHECK(std::abs(unstrained[i] - (i % 9 % 4 == 0)) < 1e-15);
  const auto path = folder / "particles/000001.vtu";
  const FrameFile file(path);
  const Particles<2> read = read_frame<2>(file.reader(), path, scene);
  const std::vector<std::uint32_t> order = order_by_id(particles);
  const auto fields = gradient_fields();
  double strained = 0, turned = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Mat<2> f = particles.deformation_gradient(order[i]);
    REQUIRE((read.deformation_gradient(i) - f).norm() < 1e-14);
    strained = std::max(strained, (f.transpose() * f - Mat<2>::Identity()).norm());
    turned = std::max(turned, std::abs(f(0, 1)));
  }
  CHECK(strained > 1e-3);
  CHECK(turned > 0.9);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::vector<double> values = fields[k].values(file);
    for (std::size_t i = 0; i < order.size(); ++i)
      REQUIRE(std::abs(values[i] - particles.deformation_gradient(order[i])(k / 2, k % 2)) < 1e-14);
  }
}

}  // namespace
}  // namespace mpmfast
