// Faces that hold a temperature, wherever they cut the cells.

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A slab between walls at x, mm, that are kept at 400 and at 300 K.
Scene slab(double from, double to, const std::string& basis) {
  const auto mm = [](double x) { return std::to_string(x) + " mm"; };
  const std::string left = mm(from), right = mm(to);
  return scene_from(R"(
space: plane_strain
grid: {size: [14 mm, 3 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 20 kW/m/K}}
heat: {temperature: 350 K, boundaries: {left: {temperature: 400 K}, right: {temperature: 300 K}}}
bodies: [{name: slab, box: {from: [)" +
                        left + ", 0], to: [" + right + R"(, 3 mm]}, material: m}]
boundaries: {bottom: wall, top: wall, left: {wall: sliding, position: )" +
                        left + "}, right: {wall: sliding, position: " + right + "}}\n",
                    {{"method.basis", basis}});
}

TEST_CASE("a straight line of temperatures goes on through held faces, wherever they cut the cells") {
  for (const char* basis : bases())
    for (const double cut : {0.0, 0.2, 0.5, 0.8}) {
      CAPTURE(std::string(basis));
      CAPTURE(cut);
      const double from = 2 + cut, to = 12 - 0.7 * cut;
      const Scene scene = slab(from, to, basis);
      const auto line = [&](double x) { return 400 - 100 * (1e3 * x - from) / (to - from); };
      Step<2> step(scene);
      auto& particles = step.state().particles;
      for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.column(Quantity::temperature)[p] = line(particles.column(Quantity::position, 0)[p]);
        particles.column(Quantity::temperature_slope, 0)[p] = -1e5 / (to - from);
      }
      step.advance(step.stable_dt());
      const auto& state = step.state();
      int beyond = 0;
      for (const auto& block : state.tiling.node_blocks)
        for (int local = 0; local < kTileNodes<2>; ++local) {
          const int slot = block.begin * kTileNodes<2> + local;
          if (!(state.nodes.column(Nodal::mass)[slot] > 1e-9)) continue;
          const double x = 1e-3 * state.tiling.node(block, local)[0];
          CHECK(step.heat().temperature(state, slot) == doctest::Approx(line(x)).epsilon(1e-10).scale(0));
          beyond += line(x) > 400.001 || line(x) < 299.999;
        }
      CHECK((beyond > 0 || cut == 0));
    }
}

/// By conduction and through the faces, in whose cells the slab ends. (Linear functions: while a particle
/// lies in those.)
TEST_CASE("a slab between held faces comes to rest with a straight line of temperatures, wherever they cut") {
  for (const char* basis : bases())
    for (const double cut : {0.0, 0.2, 0.45, 0.8, 0.95}) {
      if (sanitized() && cut != 0.45) continue;
      if (basis == std::string("linear") && cut > 0.5) continue;
      CAPTURE(std::string(basis));
      CAPTURE(cut);
      const double from = 2 + cut, to = from + 9.5;
      const Scene scene = slab(from, to, basis);
      const auto line = [&](double x) { return 400 - 100 * (1e3 * x - from) / (to - from); };
      Step<2> step(scene);
      const auto worst = [&] {
        const auto& particles = step.state().particles;
        double most = 0;
        for (std::size_t p = 0; p < particles.size(); ++p)
          most = std::max(most, std::abs(particles.column(Quantity::temperature)[p] -
                                         line(particles.column(Quantity::position, 0)[p])));
        return most;
      };
      REQUIRE(worst() > 40);
      for (int k = 0; k < 1500; ++k) step.advance(step.stable_dt());
      CHECK(worst() < 1e-6);
    }
}

}  // namespace
}  // namespace mpmfast
