// Interfaces in other directions than along the grid and across the load: bars in shear, and cut at 30
// degrees.

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// The mean of a stress of both bars over the time in which the end rests, of interface_bars.yaml, by the
/// strain.
struct Bars {
  double modulus;  ///< Pa
  double energy_error;
};

Bars run_bars(const char* stress, std::vector<Override> sets) {
  sets.push_back({"output.frames", "0"});
  const Outcome out = run(scene_file("interface_bars.yaml", sets));
  REQUIRE(out.failure == "");
  double sum = 0;
  int rows = 0;
  for (std::size_t k = 0; k < out.history.at("time_s").size(); ++k)
    if (out.history.at("time_s")[k] > 0.055) {
      for (const char* bar : {"left", "right"})
        sum += 0.5 * out.history.at(std::string(bar) + ".mean_stress_" + stress + "_Pa")[k];
      ++rows;
    }
  return {sum / rows / (0.2e-3 / 0.2), out.summary.energy_error};
}

/// Nothing moves along the bars, whose sides are free, so that their shear is the same all over.
TEST_CASE(
    "two bars in series have the modulus of the series in shear too, wherever the joint lies in a cell") {
  const double series = 1 / (1 / 5e6 + 1 / (100e6 * 0.2));
  for (const char* joint : {"100 mm", "101.25 mm", "102.5 mm"}) {
    CAPTURE(std::string(joint));
    const Bars bars = run_bars(
        "xy", {{"variables.joint", joint},
               {"grid.origin", "[-5 mm, -5 mm]"},
               {"grid.size", "[210 mm, 20 mm]"},
               {"boundaries",
                "{hold: {box: {from: [-5 mm, -5 mm], to: [205 mm, 15 mm]}, direction: x, speed: 0 m/s}, "
                "foot: {box: {from: [-6 mm, -5 mm], to: [1 mm, 15 mm]}, direction: y, speed: 0 m/s}, "
                "end: {box: {from: [199 mm, -5 mm], to: [206 mm, 15 mm]}, direction: y, speed: "
                "[[0 ms, 0 m/s], [25 ms, 8 mm/s], [50 ms, 0 m/s], [80 ms, 0 m/s]]}}"}});
    MESSAGE("off ", bars.modulus / series - 1, " ", bars.energy_error);
    CHECK(bars.modulus == doctest::Approx(series).epsilon(0.005).scale(0));
    CHECK(std::abs(bars.energy_error) < 0.003);
  }
}

/// Of the same stiffness in all directions, so that the cut moves along the bars: by σ cos 30°/D.
TEST_CASE("a cut at 30 degrees gives way along the bars by its traction over its stiffness") {
  for (const char* at : {"100", "101.25"}) {
    const double middle = std::stod(at), lean = 20 * std::tan(std::numbers::pi / 6) / 2;
    const auto cut = [&](double x, int y) {
      return "[" + std::to_string(x) + " mm, " + std::to_string(y) + " mm]";
    };
    const std::string low = cut(middle - lean, 0), high = cut(middle + lean, 20);
    const Bars bars = run_bars(
        "xx", {{"grid.size", "[210 mm, 20 mm]"},
               {"boundaries.end.box.to", "[206 mm, 20 mm]"},
               {"bodies", "[{name: left, polygon: [[0 mm, 0 mm], " + low + ", " + high +
                              ", [0 mm, 20 mm]], material: rubber}, {name: right, polygon: [" + low +
                              ", [200 mm, 0 mm], [200 mm, 20 mm], " + high + "], material: rubber}]"}});
    const double series = 1 / (1 / 10e6 + std::cos(std::numbers::pi / 6) / (100e6 * 0.2));
    MESSAGE("off ", bars.modulus / series - 1, " ", bars.energy_error);
    CHECK(bars.modulus == doctest::Approx(series).epsilon(0.005).scale(0));
    CHECK(std::abs(bars.energy_error) < 0.003);
  }
}

}  // namespace
}  // namespace mpmfast
