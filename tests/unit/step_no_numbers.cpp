// What a step says of particles that are no numbers any more.

#include <limits>
#include <set>

#include "engine/errors.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kBlock = R"(
space: plane_strain
grid: {size: [10 mm, 8 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: block, box: {from: [2 mm, 2 mm], to: [7 mm, 6 mm]}, material: m}]
)";

std::string told(Step<2>& step, double dt) {
  try {
    step.advance(dt);
  } catch (const RunFailure& failure) {
    return failure.what();
  }
  return "";
}

TEST_CASE("a particle that is no number is told of with how many others there are") {
  // Of n particles without a number n − 1 are others, whatever else they have spoilt in the step.
  const Scene scene = scene_from(kBlock);
  Step<2> step(scene);
  const double dt = step.stable_dt();
  auto& particles = step.state().particles;
  particles.column(Quantity::velocity, 0)[17] = std::numeric_limits<double>::quiet_NaN();
  const std::string text = told(step, dt);
  CAPTURE(text);
  std::set<std::uint32_t> broken;
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (const Quantity q : particles.quantities())
      for (int k = 0; k < Particles<2>::components(q); ++k)
        if (!std::isfinite(particles.column(q, k)[p])) broken.insert(particles.id()[p]);
  REQUIRE(broken.size() > 1);
  CHECK(text.find(", nor are " + std::to_string(broken.size() - 1) + " particles around it") !=
        std::string::npos);
}

}  // namespace
}  // namespace mpmfast
