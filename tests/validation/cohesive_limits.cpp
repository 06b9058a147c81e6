// The two ends of cohesive laws: glue that is never worn beside bodies that are tied, and glue of hardly any
// strength beside contact with friction.

#include <cmath>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of cohesive_bars.yaml.
constexpr double kYoung = 10e6, kCell = 5e-3, kLength = 0.03;

/// The modulus of its bars, pulled by a thousandth, over the last fifth of the time.
double modulus(const char* joint, const std::string& contact) {
  const Outcome out = run(scene_file(
      "cohesive_bars.yaml",
      {{"contact", contact},
       {"variables.joint", joint},
       {"time.end", "30 ms"},
       {"boundaries.end.speed", "[[0 ms, 0 m/s], [10 ms, 3 mm/s], [20 ms, 0 m/s], [30 ms, 0 m/s]]"},
       {"output.frames", "0"}}));
  REQUIRE(out.failure == "");
  double sum = 0;
  int rows = 0;
  for (std::size_t k = 0; k < out.history.at("time_s").size(); ++k)
    if (out.history.at("time_s")[k] > 0.022) {
      for (const char* bar : {"left", "right"})
        sum += 0.5 * out.history.at(std::string(bar) + ".mean_stress_xx_Pa")[k];
      ++rows;
    }
  return sum / rows / (0.03e-3 / kLength);
}

/// Glue that is never worn. @param stiffness  in units of the modulus over a cell
std::string strong(double stiffness) {
  return "{law: cohesive, normal_strength: 1e20, shear_strength: 1e20, normal_toughness: 1e40, "
         "shear_toughness: 1e40, initial_stiffness: " +
         std::to_string(stiffness * kYoung / kCell) + "}";
}

/// It is never a tie: what is stiffer than a hundred cells' moduli is taken to be as stiff as these. The bars
/// are six cells long.
TEST_CASE("endlessly stiff and strong glue is a tie that gives way by a hundredth of a cell") {
  const char* inside = "16.25 mm";
  const double tied = modulus(inside, "{law: perfect}");
  const auto gives = [&](double stiffness) { return (tied / modulus(inside, strong(stiffness)) - 1) * 6; };
  const double ten = gives(10), most = gives(100);
  MESSAGE("gives ", 10 * ten, " ", 100 * most, " of a cell's modulus");
  CHECK(ten == doctest::Approx(1 / 10.0).epsilon(0.005).scale(0));    // measured 0.15 %
  CHECK(most == doctest::Approx(1 / 100.0).epsilon(0.005).scale(0));  // 0.18 %
  CHECK(gives(1e12) == most);
  // On a row of nodes, where both bodies have but half of their cells' mass.
  const double row = (modulus("15 mm", "{law: perfect}") / modulus("15 mm", strong(1e12)) - 1) * 6;
  MESSAGE("on a row ", 100 * row);
  CHECK(row == doctest::Approx(1 / 100.0).epsilon(0.08).scale(0));  // 5.3 %
}

/// Two blocks of 20 x 4 cells, one on the other, turned about the middle, after 200 steps in which waves
/// cross each some twenty times. @param speed  of the upper one relative to the lower, along the face and
/// across
struct End {
  std::vector<double> velocities;
  double energy;  ///< with what went into friction, of that at the start
};

End end_of(double angle, const Vec<2>& speed, const std::string& contact) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto pair = [](double x, double y, const char* unit) {
    return "[" + std::to_string(x) + unit + ", " + std::to_string(y) + unit + "]";
  };
  const auto point = [&](double x, double y) { return pair(30 + c * x - s * y, 30 + s * x + c * y, " mm"); };
  const auto block = [&](double low, double high, double sign) {
    return "polygon: [" + point(-20, low) + ", " + point(20, low) + ", " + point(20, high) + ", " +
           point(-20, high) + "], material: m, seeding: {angle: " + std::to_string(angle) +
           " rad}, velocity: " +
           pair(sign * (c * speed[0] - s * speed[1]), sign * (s * speed[0] + c * speed[1]), " m/s") + "}\n";
  };
  const Scene scene = scene_from(
      "space: plane_strain\ngrid: {size: [60 mm, 60 mm], cell: 2 mm}\ntime: {end: 1 s, cfl: 0.5}\n"
      "materials: {m: {model: neo_hookean, density: 1 g/cm^3, young: 2 GPa, poisson: 0}}\nbodies:\n"
      "  - {name: lower, " +
      block(-8, 0, -0.5) + "  - {name: upper, " + block(0, 8, 0.5) + "contact: {" + contact + "}\n");
  Step<2> step(scene);
  const double start = kinetic_energy(step.state().particles);
  advance(step, 200);
  const double end =
      kinetic_energy(step.state().particles) + step.stored_energy() + step.sums().friction_work;
  return {by_id(step.state().particles, Quantity::velocity), end / start};
}

/// It breaks at 5 nm, a hundredth of what the blocks do in a step.
const std::string kWeak =
    "law: cohesive, friction: 0.3, normal_strength: 1e-3, shear_strength: 1e-3, normal_toughness: 2.5e-12, "
    "shear_toughness: 2.5e-12";

/// Measured: 1.2e-12 and 1.1e-10 of the energy; sliding 1.6e-5 and 5e-9. Turned 0.84 and 0.03 %, sliding 0.51
/// and 0.052 %: nodes that have hardly any of the surface follow those around a step late, as whole bonds.
TEST_CASE("glue of hardly any strength is contact with friction: blocks that part, and that slide pressed") {
  struct Case {
    double angle;
    Vec<2> speed;
    double most_off, most_lost;
  };
  for (const Case& one : {Case{0, {0, 1}, 1e-11, 1e-9}, Case{0.3, {0, 1}, 0.01, 4e-4},
                          Case{0, {1, -0.3}, 3e-5, 1e-8}, Case{0.3, {1, -0.3}, 0.006, 6e-4}}) {
    CAPTURE(one.angle);
    CAPTURE(one.speed[1]);
    const End glued = end_of(one.angle, one.speed, kWeak + ", compression: contact"),
              free = end_of(one.angle, one.speed, "law: coulomb, friction: 0.3");
    const double off = relative_difference(glued.velocities, free.velocities);
    MESSAGE("off ", off, " energy ", glued.energy - free.energy);
    CHECK(off < one.most_off);
    CHECK(std::abs(glued.energy - free.energy) < one.most_lost);
  }
}

/// Before anything has moved, springs hold nothing: half a step of the blow in them had made 0.28 of the
/// energy out of nothing.
TEST_CASE("blocks that leave glue of hardly any strength at the first step take along what they had") {
  const End glued = end_of(0, {0, 1}, kWeak), free = end_of(0, {0, 1}, "law: coulomb, friction: 0.3");
  CHECK(relative_difference(glued.velocities, free.velocities) < 1e-11);  // measured 1.2e-12
  CHECK(std::abs(glued.energy - free.energy) < 1e-9);                     // measured 1e-10
}

}  // namespace
}  // namespace mpmfast
