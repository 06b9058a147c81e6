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

/// Two bars of 100 mm together, turned by 30 degrees in the grid, the particles with them; held and pulled
/// along themselves by what of their ends lies in a box. @return 1/E_eff, by the length, 1/Pa
double turned_compliance(const std::string& contact) {
  const double c = std::cos(std::numbers::pi / 6), s = 0.5;
  const auto point = [&](double x, double y) {
    return "[" + std::to_string(25 + c * x - s * y) + " mm, " + std::to_string(25 + s * x + c * y) + " mm]";
  };
  const auto bar = [&](double from, double to) {
    return "polygon: [" + point(from, -10) + ", " + point(to, -10) + ", " + point(to, 10) + ", " +
           point(from, 10) + "], material: rubber, seeding: {angle: 30 deg}}";
  };
  const std::string low = "{box: {from: [0 mm, 0 mm], to: [26 mm, 100 mm]}, direction: ",
                    high = "{box: {from: [108 mm, 0 mm], to: [140 mm, 110 mm]}, direction: ",
                    along = "[0.86602540378, 0.5]", across = "[-0.5, 0.86602540378]";
  const Outcome out = run(scene_file(
      "interface_bars.yaml",
      {{"grid", "{size: [140 mm, 110 mm], cell: 5 mm}"},
       {"materials.rubber.model", "neo_hookean"},
       {"bodies", "[{name: left, " + bar(0, 51) + ", {name: right, " + bar(51, 100) + "]"},
       {"boundaries", "{a: " + low + along + ", speed: 0 m/s}, b: " + low + across +
                          ", speed: 0 m/s}, c: " + high + across + ", speed: 0 m/s}, end: " + high + along +
                          ", speed: [[0 ms, 0 m/s], [25 ms, 4 mm/s], [50 ms, 0 m/s], [80 ms, 0 m/s]]}}"},
       {"output.frames", "0"},
       {"contact", contact}}));
  REQUIRE(out.failure == "");
  CHECK(std::abs(out.summary.energy_error) < 0.003);
  double force = 0;
  int rows = 0;
  for (std::size_t k = 0; k < out.history.at("time_s").size(); ++k)
    if (out.history.at("time_s")[k] > 0.055)
      force += c * out.history.at("end.force_x_N")[k] + s * out.history.at("end.force_y_N")[k], ++rows;
  return 0.1e-3 / 0.1 / (force / rows / 0.02);
}

TEST_CASE("an interface at 30 degrees to the grid gives way by its stiffness, beside bars that are tied") {
  const double tied = turned_compliance("{law: perfect}"),
               joined = turned_compliance(
                   "{law: interface, normal_stiffness: 100 MPa/m, shear_stiffness: 100 MPa/m}");
  MESSAGE("off ", (joined - tied) * 100e6 * 0.1 - 1, " tied ", tied * 10e6);
  CHECK(joined == doctest::Approx(tied + 1 / (100e6 * 0.1)).epsilon(0.005).scale(0));
}

}  // namespace
}  // namespace mpmfast
