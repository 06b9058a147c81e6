// Cohesive laws in scenes: bars that are pulled apart, in any direction of the glue, there and back; blocks
// that part as they fly through the grid.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of cohesive_bars.yaml.
constexpr double kYoung = 10e6, kLength = 0.03, kCell = 5e-3, kHeight = 0.01, kStrength = 10e3,
                 kToughness = 0.75;
constexpr double kStiffness = 10 * kYoung / kCell;  // what glue has where the scene says nothing

/// Traction of glue that opens for the first time, written out once more.
double traction(const std::string& shape, double opening) {
  const double first = kStrength / kStiffness;
  const double area = shape == "triangular"    ? 0.5
                      : shape == "trapezoidal" ? 0.75
                                               : 1 / 7.0 - 1 / (std::exp(7.0) - 1);
  const double length = (kToughness / kStrength - 0.5 * first) / area, way = (opening - first) / length;
  if (way < 0) return kStiffness * opening;
  if (way > 1) return 0;
  if (shape == "triangular") return kStrength * (1 - way);
  if (shape == "trapezoidal") return kStrength * std::min(1.0, 2 * (1 - way));
  return kStrength * (std::exp(-7 * way) - std::exp(-7.0)) / (1 - std::exp(-7.0));
}

/// What it has lost: the area below the traction less what it would give back.
double lost_at(const std::string& shape, double opening) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += traction(shape, (k + 0.5) * opening / kSteps) * opening / kSteps;
  return sum - 0.5 * traction(shape, opening) * opening;
}

/// Stress of the bars whose end has moved so far: σ = T(u − σL/E).
double stress_at(const std::string& shape, double way) {
  double low = 0, high = way;
  for (int k = 0; k < 60; ++k) {
    const double opening = 0.5 * (low + high);
    (opening + traction(shape, opening) * kLength / kYoung < way ? low : high) = opening;
  }
  return traction(shape, 0.5 * (low + high));
}

/// How far the end has moved: up to speed in the first sixth of the time, at rest in the last.
double way_at(double time, double way) {
  const double ramp = 0.02, speed = way / 0.1, end = 0.12;
  if (time < ramp) return 0.5 * speed * time * time / ramp;
  if (time < end - ramp) return speed * (time - 0.5 * ramp);
  const double left = end - time;
  return way - 0.5 * speed * left * left / ramp;
}

std::vector<double> mean_stress(const History& history) {
  std::vector<double> out;
  for (std::size_t k = 0; k < history.at("time_s").size(); ++k)
    out.push_back(0.5 * (history.at("left.mean_stress_xx_Pa")[k] + history.at("right.mean_stress_xx_Pa")[k]));
  return out;
}

/// Runs cohesive_bars.yaml.
Outcome pull(std::vector<Override> sets) {
  sets.push_back({"output.frames", "0"});
  const Outcome out = run(scene_file("cohesive_bars.yaml", sets));
  REQUIRE(out.failure == "");
  return out;
}

TEST_CASE("bars pulled apart follow each cohesive law to nothing, wherever the glue lies in a cell") {
  for (const char* shape : {"triangular", "exponential", "trapezoidal"})
    for (const char* joint : {"15 mm", "16.25 mm", "17.5 mm"}) {
      if (shape[0] == 'e' && std::string(joint) != "16.25 mm") continue;
      CAPTURE(std::string(shape));
      CAPTURE(std::string(joint));
      const Outcome out = pull({{"contact.shape", shape}, {"variables.joint", joint}});
      const std::vector<double> stress = mean_stress(out.history);
      double most = 0, off = 0;
      for (std::size_t k = 0; k < stress.size(); ++k) {
        const double exact = stress_at(shape, way_at(out.history.at("time_s")[k], 0.22e-3));
        most = std::max(most, stress[k]);
        off = std::max(off, std::abs(stress[k] - exact));
      }
      const double opening = 0.22e-3 - stress_at(shape, 0.22e-3) * kLength / kYoung,
                   exact = lost_at(shape, opening) * kHeight, lost = out.history.at("interface_J").back();
      MESSAGE("peak ", most / kStrength, " off ", off / kStrength, " lost ", lost / exact, " of ",
              exact / (kToughness * kHeight), " balance ", out.summary.energy_error);
      CHECK(most == doctest::Approx(kStrength).epsilon(0.01).scale(0));
      CHECK(off < 0.02 * kStrength);
      CHECK(lost == doctest::Approx(exact).epsilon(0.02).scale(0));
      if (shape[0] == 't') CHECK(lost == doctest::Approx(kToughness * kHeight).epsilon(0.02).scale(0));
      CHECK(std::abs(out.summary.energy_error) < 0.01);
    }
}

/// Pulled by 0.1 mm, where the glue has softened to about half; back to an overlap; and apart.
TEST_CASE("glue that softened unloads to the origin, presses as if whole, and takes its toughness in all") {
  for (const char* compression : {"spring", "contact"}) {
    CAPTURE(std::string(compression));
    const Outcome out =
        pull({{"time.end", "240 ms"},
              {"output.history", "1200"},
              {"contact.compression", compression},
              {"boundaries.end.speed",
               "[[0 ms, 0 m/s], [10 ms, 2 mm/s], [50 ms, 2 mm/s], [60 ms, 0 m/s], [70 ms, -2 mm/s], [120 ms, "
               "-2 mm/s], [130 ms, 0 m/s], [140 ms, 2 mm/s], [230 ms, 2 mm/s], [240 ms, 0 m/s]]"}});
    const std::vector<double> stress = mean_stress(out.history);
    const auto at = [&](double time) {
      std::size_t k = 0;
      while (out.history.at("time_s")[k] < time * (1 - 1e-9)) ++k;
      return k;
    };
    const double turned = stress_at("triangular", 0.1e-3), bars = kLength / kYoung,
                 left = turned / (0.1e-3 - turned * bars);
    const std::size_t pulled = at(0.06), half = at(0.09), pressed = at(0.13);  // 0.1, 0.05 and -0.02 mm
    const double unloading = 0.05e-3 / (bars + 1 / left),
                 pressing = -0.02e-3 / (bars + (compression[0] == 's' ? 1 / kStiffness : 0));
    MESSAGE("stress ", stress[pulled] / turned, " ", stress[half] / unloading, " ",
            stress[pressed] / pressing);
    CHECK(stress[pulled] == doctest::Approx(turned).epsilon(0.02).scale(0));
    CHECK(stress[half] == doctest::Approx(unloading).epsilon(0.02).scale(0));
    CHECK(stress[pressed] == doctest::Approx(pressing).epsilon(0.01).scale(0));
    const auto& lost = out.history.at("interface_J");
    CHECK(lost[pressed] == doctest::Approx(lost[pulled]).epsilon(0.005).scale(0));
    CHECK(lost.back() == doctest::Approx(kToughness * kHeight).epsilon(0.02).scale(0));
    CHECK(std::abs(out.summary.energy_error) < 0.01);
  }
}

/// Two stiff blocks of 40 x 4 mm that part at equal and opposite velocities, while both fly. They break the
/// glue at 0.02 mm, a hundredth of a cell: at a tenth, nodes of both have 5 % less of the surface.
struct Parting {
  double lost, left;  ///< J; of the energy of their parting
};

constexpr double kPartingMass = 0.04 * 0.004 * 1000 / 2, kGlued = 0.04;

/// @param more  keys of the contact
Scene two_blocks(double angle, const Vec<2>& flight, const Vec<2>& parting, const std::string& more = "") {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto text = [](double x) { return std::to_string(x); };
  const auto point = [&](double x, double y) {
    return "[" + text(30 + c * x - s * y) + " mm, " + text(30 + s * x + c * y) + " mm]";
  };
  const auto block = [&](double low, double high, double sign) {
    const Vec<2> v =
        flight + 0.5 * sign * Vec<2>(c * parting[0] - s * parting[1], s * parting[0] + c * parting[1]);
    return "polygon: [" + point(-20, low) + ", " + point(20, low) + ", " + point(20, high) + ", " +
           point(-20, high) + "], material: m, seeding: {angle: " + text(angle * 180 / std::numbers::pi) +
           " deg}, velocity: [" + text(v[0]) + " m/s, " + text(v[1]) + " m/s]";
  };
  return scene_from(
      "space: plane_strain\ngrid: {size: [80 mm, 80 mm], cell: 2 mm}\ntime: {end: 1 s, cfl: 0.5}\n"
      "materials: {m: {model: neo_hookean, density: 1 g/cm^3, young: 2 GPa, poisson: 0}}\nbodies:\n"
      "  - {name: lower, " +
      block(-4, 0, -1) + "}\n  - {name: upper, " + block(0, 4, 1) +
      "}\ncontact: {law: cohesive, normal_strength: 20 kPa, shear_strength: 40 kPa, normal_toughness: 0.2 "
      "J/m^2, "
      "shear_toughness: 0.4 J/m^2, initial_stiffness: 5 GPa/m" +
      more + "}\n");
}

Parting part(double angle, const Vec<2>& flight, const Vec<2>& parting) {
  const Scene scene = two_blocks(angle, flight, parting);
  Step<2> step(scene);
  auto& state = step.state();
  const double end = 0.05e-3 / (0.3 * parting.norm());
  while (state.time < end) step.advance(step.stable_dt());
  Vec<2> relative = Vec<2>::Zero();
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    relative += (state.particles.body()[p] == 0 ? -1 : 1) * state.particles.column(Quantity::mass)[p] *
                state.particles.vector(Quantity::velocity, p) / (2 * kPartingMass);
  return {step.sums().interface_loss, 0.5 * kPartingMass * relative.squaredNorm()};
}

/// At 45 degrees the jump goes straight on, so λ² has shares of 1/20² : 1/40² by opening and slip, and G_I =
/// G_II: G_I (1/0.2 + 1/0.4) = 1.
TEST_CASE(
    "blocks that part in any direction lose the toughness of that mix, flying through cells or at rest") {
  const Vec<2> ways[] = {{0, 1}, {1, 0}, {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2}};
  const double toughness[] = {0.2, 0.4, 2 / (1 / 0.2 + 1 / 0.4)};
  for (double angle : {0.0, std::numbers::pi / 6})
    for (int k = 0; k < 3; ++k) {
      CAPTURE(angle);
      CAPTURE(k);
      const double energy = toughness[k] * kGlued, speed = std::sqrt(2 * 2.5 * energy / kPartingMass);
      const Parting still = part(angle, {0, 0}, speed * ways[k]);
      const Parting moving = part(angle, Vec<2>(60, 35), speed * ways[k]);  // some five cells
      MESSAGE("lost ", still.lost / energy, " left ", still.left / (1.5 * energy), "  moving ",
              moving.lost / energy, " ", moving.left / (1.5 * energy));
      CHECK(still.lost == doctest::Approx(energy).epsilon(0.01).scale(0));
      CHECK(still.left ==
            doctest::Approx(1.5 * energy).epsilon(0.015).scale(0));  // some swings in the blocks
      CHECK(moving.lost == doctest::Approx(still.lost).epsilon(0.01).scale(0));
      CHECK(moving.left == doctest::Approx(still.left).epsilon(0.01).scale(0));
    }
}

/// The crack ends in the middle of the blocks, which fly on unharmed by some six cells, along the grid and
/// across.
TEST_CASE("a crack moves with its bodies: a node off its end is broken or whole as the material there") {
  for (double angle : {0.0, std::numbers::pi / 6})
    for (const Vec<2>& flight : {Vec<2>(60, 35), Vec<2>(60, 0), Vec<2>(-50, 40)}) {
      CAPTURE(angle);
      CAPTURE(flight[0]);
      const Scene scene =
          two_blocks(angle, flight, Vec<2>::Zero(), ", crack: {from: [0 mm, 0 mm], to: [31 mm, 80 mm]}");
      Step<2> step(scene);
      const auto& state = step.state();
      while (state.time < 0.2e-3) step.advance(step.stable_dt());
      const auto& list = step.contact_list();
      const Vec<2> tangent(std::cos(angle), std::sin(angle));
      int broken = 0, whole = 0, wrong = 0;
      for (const auto& node : list.nodes)
        for (int e = node.pair_begin; e < node.pair_end; ++e) {
          const Vec<2> point = node.index.cast<double>() * state.grid.cell - state.time * flight;
          const double from_end = (point - Vec<2>(0.031, 0.03)).dot(tangent) / state.grid.cell;
          const bool is_broken = list.pairs.bond[e].is_broken();
          (is_broken ? broken : whole) += 1;
          if (std::abs(from_end) > 1.1 && is_broken != (from_end < 0)) ++wrong;
        }
      MESSAGE("broken ", broken, " whole ", whole, " wrong ", wrong, " lost ", step.sums().interface_loss);
      CHECK(broken > 8);
      CHECK(whole > 8);
      CHECK(wrong == 0);
    }
}

}  // namespace
}  // namespace mpmfast
