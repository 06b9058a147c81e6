#include "engine/contact/impulses/node_motion.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using namespace mpmfast;

/// A node as small bodies beside a large one make it: the others of a lump are what they are, however heavy
/// the field is that they meet.
TEST_CASE("light fields keep their digits in a lump beside a heavy one") {
  const double heavy = 1.0;
  for (const double light : {1e-3, 1e-6, 1e-12, 1e-17, 1e-30}) {
    CAPTURE(light);
    NodeMotion<2> motion;
    motion.push(0, light, {2 * light, 0});
    motion.push(1, heavy, {0, 3 * heavy});
    motion.push(2, light, {0, 4 * light});
    // The others of the heavy one: 2 light masses that move at (1, 2).
    CHECK((motion.relative_velocity(1, -1) - Vec<2>(1, -1)).norm() < 1e-14);
    CHECK(motion.inverse_mass_of(1, -1) * 2 * light == doctest::Approx(1).epsilon(1e-14));
    // Of a light one: the heavy one, all but.
    const double all = heavy + light;
    CHECK((motion.relative_velocity(0, -1) + Vec<2>(2, -(3 * heavy + 4 * light) / all)).norm() < 1e-14);
    CHECK(motion.inverse_mass_of(0, -1) == doctest::Approx(1 / all).epsilon(1e-14));
    CHECK((motion.relative_velocity(0, 1) - Vec<2>(-2, 3)).norm() < 1e-14);
  }
}

}  // namespace
