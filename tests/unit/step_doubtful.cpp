// Which normals that fell back are doubtful.

#include "tests/overlapping.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

ContactCounters counters_of(const Scene& scene, int steps = 40) {
  Step<2> step(scene);
  advance(step, steps);
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

TEST_CASE("surfaces that bounce touch, though they overlap at the start of no step") {
  for (const char* keys : {"{normal: smoothed_max_margin}",
                           "{normal: smoothed_max_margin, warm_start: false, persistent: false}"}) {
    CAPTURE(std::string(keys));
    const ContactCounters all =
        counters_of(scene_file("starters/impact.yaml", {{"grid.cell", "0.5 mm"}, {"contact", keys}}), 400);
    CHECK(all.touching > 200);
    CHECK(all.touching < all.regressions);
  }
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
