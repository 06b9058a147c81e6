// Which normals that fell back are doubtful.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two disks that share a part of their area: the hulls of their clouds meet.
const char* const kOverlapping = R"(
space: plane_strain
grid: {size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 500 us}
materials: {rubber: {model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}
bodies:
  - {name: left, disk: {centre: [5.2 mm, 6 mm], radius: 3 mm}, material: rubber, velocity: [5 m/s, 0 m/s]}
  - {name: right, disk: {centre: [10.6 mm, 6 mm], radius: 3 mm}, material: rubber, velocity: [-5 m/s, 0 m/s]}
contact: {law: frictionless}
)";

ContactCounters counters_of(const Scene& scene) {
  Step<2> step(scene);
  advance(step, 40);
  return step.contact_counters();
}

TEST_CASE("a normal falls back once, and is doubtful where its surfaces touch and its neighbours differ") {
  const ContactCounters averaged = counters_of(scene_from(kOverlapping));
  CHECK(averaged.fallbacks > 100);
  CHECK(averaged.fallbacks <= averaged.touching);
  CHECK(averaged.touching <= averaged.regressions);
  CHECK(averaged.doubtful > 10);
  CHECK(averaged.doubtful < averaged.fallbacks / 2);  // most agree with those around
  const ContactCounters single = counters_of(scene_from(kOverlapping, {{"contact.normal", "max_margin"}}));
  CHECK(single.fallbacks > 100);
  CHECK(single.doubtful == single.fallbacks);  // nothing around is asked
}

// The block's support ends at nodes within the plane, to round-off: their clouds hold the plane alone.
TEST_CASE("fallbacks of surfaces that do not touch are not doubtful") {
  for (const char* normal : {"smoothed_max_margin", "max_margin"}) {
    CAPTURE(std::string(normal));
    const ContactCounters all = counters_of(scene_file("incline.yaml", {{"contact.normal", normal}}));
    CHECK(all.fallbacks > 100);
    CHECK(all.fallbacks <= all.regressions);
    CHECK(all.touching > 100);
    CHECK(all.doubtful == 0);
  }
}

}  // namespace
}  // namespace mpmfast
