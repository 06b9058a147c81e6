// Imperfect interfaces (NN chapter 5): bars in series, blocks that swing, a wave that passes.

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Over the time in which the end rests, of interface_bars.yaml.
struct Bars {
  double modulus;  ///< of both and the interface, Pa
  double energy_error;
};

Bars pull_bars(const char* basis, const char* joint, const char* pull, const std::string& contact = "",
               const char* update = "flip") {
  std::vector<Override> sets{{"method.basis", basis},
                             {"method.update", update},
                             {"variables.joint", joint},
                             {"variables.pull", pull},
                             {"output.frames", "0"}};
  if (!contact.empty()) sets.push_back({"contact", contact});
  const Outcome out = run(scene_file("interface_bars.yaml", sets));
  REQUIRE(out.failure == "");
  double sum = 0;
  int rows = 0;
  for (std::size_t k = 0; k < out.history.at("time_s").size(); ++k)
    if (out.history.at("time_s")[k] > 0.055) {
      sum +=
          0.5 * (out.history.at("left.mean_stress_xx_Pa")[k] + out.history.at("right.mean_stress_xx_Pa")[k]);
      ++rows;
    }
  return {sum / rows / (std::stod(pull) * 1e-3 / 0.2), out.summary.energy_error};
}

TEST_CASE("two bars through an interface have the modulus of a series, wherever it lies in a cell") {
  const double series = 1 / (1 / 10e6 + 1 / (100e6 * 0.2));
  for (const char* basis : {"ugimp", "lcpdi"})
    for (const char* joint : {"100 mm", "101.25 mm", "102.5 mm", "103.4 mm"})
      for (const char* pull : {"0.2 mm", "-0.2 mm"}) {
        CAPTURE(std::string(basis));
        CAPTURE(std::string(joint));
        CAPTURE(std::string(pull));
        const Bars bars = pull_bars(basis, joint, pull);
        CHECK(bars.modulus == doctest::Approx(series).epsilon(1e-3).scale(0));  // measured 1e-4 to 4e-4
        CHECK(std::abs(bars.energy_error) < 1e-3);
      }
}

/// Wide supports hold the ends otherwise than at their rows: 1.5 % of the whole, which a bar without
/// interface has too.
TEST_CASE("with splines the bars' interface gives what it should beside bars that are tied") {
  const double springs = 1 / (100e6 * 0.2),
               tied = 1 / pull_bars("bspline2", "101.25 mm", "0.2 mm", "{law: perfect}").modulus;
  for (const char* pull : {"0.2 mm", "-0.2 mm"})
    CHECK(pull_bars("bspline2", "101.25 mm", pull).modulus ==
          doctest::Approx(1 / (tied + springs)).epsilon(0.005));
}

TEST_CASE("an interface of any stiffness has the modulus of a series, with every update") {
  for (double stiffness : {0.3e9, 3e9, 100e9})  // the last: as much as 50 of the cells
    for (const char* update : {"flip", "xpic(5)", "fmpm(3)", "pic"}) {
      CAPTURE(stiffness);
      CAPTURE(std::string(update));
      const std::string springs =
          "{law: interface, normal_stiffness: " + std::to_string(stiffness) + ", shear_stiffness: 0}";
      const Bars bars = pull_bars("ugimp", "101.25 mm", "0.2 mm", springs, update);
      CHECK(bars.modulus == doctest::Approx(1 / (1 / 10e6 + 1 / (stiffness * 0.2))).epsilon(0.002).scale(0));
      CHECK(std::abs(bars.energy_error) < 0.003);
    }
}

TEST_CASE("an interface that only presses, however hard, is a closed crack") {
  for (const char* joint : {"100 mm", "101.25 mm"}) {
    const std::string closed =
        "{law: interface, normal_stiffness: 0, shear_stiffness: 0, compression_stiffness: 1e18}";
    const Bars pressed = pull_bars("ugimp", joint, "-0.2 mm", closed);
    CHECK(pressed.modulus == doctest::Approx(10e6).epsilon(0.002).scale(0));
    CHECK(std::abs(pressed.energy_error) < 2e-3);
    const Bars pulled = pull_bars("ugimp", joint, "0.2 mm", closed);
    CHECK(std::abs(pulled.modulus) < 1e3);
  }
}

/// Two stiff blocks of 40 x 2 cells, one on the other, turned about the origin, that start apart at equal and
/// opposite velocities. No cell gives way: D h/E = 1e-3.
std::string blocks(double angle, double along, double across) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto place = [&](double x, double y) {
    return "[" + std::to_string(60 + c * x - s * y) + " mm, " + std::to_string(60 + s * x + c * y) + " mm]";
  };
  const auto block = [&](double low, double high, double sign) {
    const double vx = sign * (c * along - s * across), vy = sign * (s * along + c * across);
    return "polygon: [" + place(-40, low) + ", " + place(40, low) + ", " + place(40, high) + ", " +
           place(-40, high) +
           "], material: m, seeding: {angle: " + std::to_string(angle * 180 / std::numbers::pi) +
           " deg}, velocity: [" + std::to_string(vx) + " m/s, " + std::to_string(vy) + " m/s]";
  };
  return "space: plane_strain\ngrid: {size: [120 mm, 120 mm], cell: 2 mm}\ntime: {end: 1 s, cfl: 0.5}\n"
         "materials: {m: {model: neo_hookean, density: 1 g/cm^3, young: 2 GPa, poisson: 0}}\nbodies:\n"
         "  - {name: lower, " +
         block(-4, 0, -0.5) + "}\n  - {name: upper, " + block(0, 4, 0.5) +
         "}\n"
         "contact: {law: interface, normal_stiffness: 1 GPa/m, shear_stiffness: 0.5 GPa/m}\n";
}

/// Periods of the relative velocity of the two along a direction, s; and how much energy is left.
struct Swing {
  double period, energy;
};

Swing swing(const std::string& yaml, const Vec<2>& direction, int periods) {
  const Scene scene = scene_from(yaml);
  Step<2> step(scene);
  auto& state = step.state();
  const auto relative = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      sum += (state.particles.body()[p] == 0 ? -1 : 1) *
             state.particles.vector(Quantity::velocity, p).dot(direction);
    return sum;
  };
  const double start = kinetic_energy(state.particles);
  double before = relative(), first = 0, last = 0;
  for (int zeros = 0; zeros <= 2 * periods;) {
    const double dt = step.stable_dt();
    step.advance(dt);
    const double now = relative();
    if (now * before < 0) {
      last = state.time - dt * now / (now - before);
      if (zeros++ == 0) first = last;
    }
    before = now;
    REQUIRE(state.step < 40000);
  }
  CHECK(momentum(state.particles).norm() < 1e-9);  // of 0.16 kg m/s
  return {(last - first) / periods, (kinetic_energy(state.particles) + step.stored_energy()) / start};
}

TEST_CASE(
    "two stiff blocks on an interface swing as two masses on a spring, along it and across, at any angle") {
  const double mass = 0.08 * 0.004 * 1000;  // kg a metre, each
  for (double angle : {0.0, std::numbers::pi / 6}) {
    CAPTURE(angle);
    const Vec<2> tangent(std::cos(angle), std::sin(angle)), normal(-tangent[1], tangent[0]);
    const double opening = 2 * std::numbers::pi / std::sqrt(1e9 * 0.08 * 2 / mass);
    const Swing across = swing(blocks(angle, 0, 0.2), normal, 3);
    CHECK(across.period == doctest::Approx(opening).epsilon(0.01).scale(0));
    CHECK(across.energy == doctest::Approx(1).epsilon(0.01));
    // Both blocks turn a little too: the slip of their surfaces is that of their middles and of the turns.
    const double inertia = mass * (0.08 * 0.08 + 0.004 * 0.004) / 12;
    const double sliding =
        2 * std::numbers::pi / std::sqrt(0.5e9 * 0.08 * (2 / mass + 0.004 * 0.004 / (2 * inertia)));
    const Swing along = swing(blocks(angle, 0.2, 0), tangent, 3);
    CHECK(along.period == doctest::Approx(sliding).epsilon(0.01).scale(0));
    CHECK(along.energy == doctest::Approx(1).epsilon(0.01));
  }
}

TEST_CASE("springs turn with the bodies that they join: blocks that swing and spin keep their energy") {
  const Scene scene = scene_from(blocks(0, 0, 2));
  Step<2> step(scene);
  auto& state = step.state();
  const double speed = 200;  // 1/s; a quarter of a turn, in which the blocks part and meet some twenty times
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    const Vec<2> arm = state.particles.vector(Quantity::position, p) - Vec<2>(0.06, 0.06);
    state.particles.column(Quantity::velocity, 0)[p] -= speed * arm[1];
    state.particles.column(Quantity::velocity, 1)[p] += speed * arm[0];
  }
  const double start = kinetic_energy(state.particles);  // 0.32 J of 7.2 are those of the swing
  while (state.time < 0.5 * std::numbers::pi / speed) step.advance(step.stable_dt());
  CHECK(kinetic_energy(state.particles) + step.stored_energy() == doctest::Approx(start).epsilon(0.003));
}

TEST_CASE("an interface without end of stiffness is a tie, and one without stiffness nothing") {
  const auto end = [](const std::string& contact) {
    const std::string yaml = blocks(0.3, 0.2, -0.1);
    const Scene scene = scene_from(yaml.substr(0, yaml.find("contact:")) + "contact: {" + contact + "}\n");
    Step<2> step(scene);
    advance(step, 60);
    return by_id(step.state().particles, Quantity::velocity);
  };
  CHECK(relative_difference(end("law: interface, normal_stiffness: 1e20, shear_stiffness: 1e20"),
                            end("law: perfect")) == 0);
  CHECK(relative_difference(end("law: interface, normal_stiffness: 0, shear_stiffness: 0"),
                            end("law: ignore")) < 1e-12);
}

TEST_CASE("three blocks that meet at a point keep their energy on springs of any stiffness") {
  for (const char* stiffness : {"100e9", "1e12", "70e12"}) {  // 0.1, 1 and 95 times the modulus over a cell
    CAPTURE(std::string(stiffness));
    const std::string springs = std::string("{law: interface, normal_stiffness: ") + stiffness +
                                ", shear_stiffness: " + stiffness + "}";
    const Outcome out = run(scene_file("three_materials.yaml",
                                       {{"contact", springs}, {"output.frames", "0"}, {"time.end", "1 ms"}}));
    REQUIRE(out.failure == "");
    CHECK(std::abs(out.summary.energy_error) < 0.01);
  }
}

/// Of what a sine of this frequency is behind the interface over what it is before: 1/(1 + iωZ/2D), Z = ρc.
std::complex<double> transmitted(double frequency) {
  const double omega = 2 * std::numbers::pi * frequency;
  std::string table;
  for (int k = 0; k <= 800; ++k) {
    const double t = k * 8e-3 / 800, rise = std::min(1.0, t / 0.5e-3);
    table += (k ? ", [" : "[") + std::to_string(1e3 * t) + " ms, " +
             std::to_string(rise * rise * (3 - 2 * rise) * std::sin(omega * t)) + " mm/s]";
  }
  const auto wave = [&](const char* law) {
    const Scene scene = scene_file("interface_wave.yaml", {{"variables.joint", "200.3 mm"},
                                                           {"variables.end", "450 mm"},
                                                           {"boundaries.drive.speed", "[" + table + "]"},
                                                           {"contact", law}});
    Step<2> step(scene);
    auto& state = step.state();
    std::complex<double> sum = 0;
    double weight = 0;
    const double period = 1 / frequency, begin = 3.3e-3, end = begin + 2 * period;
    while (state.time < end) {
      const double dt = step.stable_dt();
      step.advance(dt);
      if (state.time < begin) continue;
      double v = 0;
      int count = 0;
      for (std::size_t p = 0; p < state.particles.size(); ++p)
        if (std::abs(state.particles.column(Quantity::position, 0)[p] - 0.2105) < 0.5e-3) {
          v += state.particles.column(Quantity::velocity, 0)[p];
          ++count;
        }
      sum += dt * v / count * std::polar(1.0, -omega * state.time);
      weight += dt;
    }
    return sum / weight;
  };
  return wave("{law: interface, normal_stiffness: 300 MPa/m, shear_stiffness: 0}") / wave("{law: perfect}");
}

TEST_CASE("a wave passes a linear interface with the amplitude and phase of the closed solution") {
  const double impedance = 1000 * 100;
  for (double frequency : {800.0, 1600.0, 3200.0}) {
    CAPTURE(frequency);
    const std::complex<double> exact =
        1.0 / std::complex<double>(1, 2 * std::numbers::pi * frequency * impedance / (2 * 300e6));
    const std::complex<double> found = transmitted(frequency);
    CHECK(std::abs(found) == doctest::Approx(std::abs(exact)).epsilon(0.01).scale(0));
    CHECK(std::abs(std::arg(found / exact)) < 0.02 * std::abs(std::arg(exact)));
  }
}

}  // namespace
}  // namespace mpmfast
