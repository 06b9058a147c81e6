// A column of dry sand that collapses on a rough floor: its run-out against the experiments of Lube et al.,
// J. Fluid Mech. 508 (2004), r0 (1 + 1.24 a) below an aspect ratio a of 1.7 and r0 (1 + 1.6 sqrt(a)) above.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/output/read_vtu.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Where the foot of the heap is at the end, over r0: all but one in a thousand of the particles lie within.
double foot(double aspect) {
  const std::vector<Override> overrides{
      {"variables.aspect", fmt::format("{}", aspect)},
      {"grid.size.1", fmt::format("{}", std::max(0.15, 0.1 * aspect + 0.05))},
      {"output.frames", "1"}};
  Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  const Scene scene = scene_file("sand_column.yaml", overrides);
  const RunSummary summary = run_scene(scene, options);
  CHECK(std::abs(summary.energy_error) < 0.09);  // -7.5 % at most: noise that no strain sees is rubbed away
  const auto points = VtuReader(options.folder / "particles/000001.vtu").points();
  std::vector<double> radii;
  for (std::size_t p = 0; p < points.size(); p += 3) radii.push_back(points[p]);
  const auto last = radii.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(radii.size()));
  std::nth_element(radii.begin(), last, radii.end());
  return *last / 0.1;
}

TEST_CASE("sand runs out as measured, for three heights") {
  for (const double aspect : {0.5, 1.0, 2.0}) {
    const double measured = aspect < 1.7 ? 1.24 * aspect : 1.6 * std::sqrt(aspect);
    CAPTURE(aspect);
    // Measured 3.7, 10 and 11 % longer.
    CHECK(foot(aspect) - 1 == doctest::Approx(measured).epsilon(0.14));
  }
}

}  // namespace
}  // namespace mpmfast
