// Cracks along cohesive lines: a double cantilever beam, and a fibre that is pulled out.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of dcb_cohesive.yaml: plane strain, for a metre of depth.
constexpr double kToughness = 200, kStrength = 12e6, kArm = 3e-3, kModulus = 3e9 / (1 - 0.3 * 0.3),
                 kMiddle = 6.25e-3;

/// Load of a beam whose crack grows at this opening: from P = √(G E'H³/12)/a and d = 8 P a³/(E'H³), without
/// a.
double beam_load(double opening) {
  return std::sqrt(8 / opening) * std::pow(kToughness / 12, 0.75) *
         std::pow(kModulus * kArm * kArm * kArm, 0.25);
}

/// Where the surfaces are so far apart that the glue is gone, 2G/σ: linear between columns of particles.
double tip_of(const State<2>& state, const std::vector<Vec<2>>& start) {
  const auto& particles = state.particles;
  std::vector<std::pair<double, double>> parted;  // x at the start, opening
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<2> from = start[particles.id()[p]];
    if (std::abs(from[1] - kMiddle) > 0.2e-3) continue;  // the row next to the line
    const double moved = particles.column(Quantity::position, 1)[p] - from[1];
    parted.push_back({from[0], from[1] > kMiddle ? moved : -moved});
  }
  std::sort(parted.begin(), parted.end());
  double before = 0, at = 0;
  for (std::size_t k = 0; k + 1 < parted.size(); k += 2) {
    const double opening = parted[k].second + parted[k + 1].second, x = parted[k].first;
    const double gone = 2 * kToughness / kStrength;
    if (opening < gone) return k > 0 ? at + (x - at) * (before - gone) / (before - opening) : x;
    before = opening, at = x;
  }
  return at;
}

TEST_CASE("slow: a double cantilever beam has the load of beam theory, and loses toughness times area") {
  const Scene scene = scene_file("dcb_cohesive.yaml", {});
  Step<2> step(scene);
  auto& state = step.state();
  std::vector<Vec<2>> start(state.particles.size());
  for (std::size_t p = 0; p < start.size(); ++p)
    start[state.particles.id()[p]] = state.particles.vector(Quantity::position, p);
  const double speed = 2.4e-3 / 2.75e-3, ramp = 0.5e-3, interval = 0.5e-3, first = step.stable_dt();
  double impulse = 0, tip = 0, lost = 0;
  for (int k = 1; k <= 6; ++k) {
    while (state.time < k * interval * (1 - 1e-12)) step.advance(step.dt_towards(k * interval, first));
    const double now = step.sums().boundary_impulse[0][1], load = (now - impulse) / interval;
    impulse = now;
    // The mean of the load over the interval, beside that of P ~ 1/√d.
    const auto opening = [&](double t) { return speed * (t - 0.5 * ramp); };
    const double before = opening((k - 1) * interval), after = opening(k * interval);
    const double exact = beam_load(std::pow(0.5 * (std::sqrt(before) + std::sqrt(after)), 2));
    const double tip_now = tip_of(state, start), lost_now = step.sums().interface_loss;
    MESSAGE("interval ", k, " load ", load / exact, " tip ", 1e3 * tip_now, " lost ",
            (lost_now - lost) / (kToughness * (tip_now - tip)));
    if (k > 3) {  // it grows since 1.25 ms
      CHECK(load == doctest::Approx(exact).epsilon(0.03).scale(0));
      CHECK(kinetic_energy(state.particles) < 0.01 * step.stored_energy());
    }
    if (k == 3) tip = tip_now, lost = lost_now;
    if (k == 6) {
      CHECK(tip_now - tip > 5e-3);
      CHECK(lost_now - lost == doctest::Approx(kToughness * (tip_now - tip)).epsilon(0.02).scale(0));
    }
  }
  const double balance = kinetic_energy(state.particles) + step.stored_energy() + step.sums().interface_loss +
                         step.sums().friction_work - step.sums().boundary_work;
  MESSAGE("balance ", balance / step.sums().boundary_work);
  CHECK(std::abs(balance) < 0.01 * step.sums().boundary_work);
}

/// Of fibre_pullout.yaml: E t = 6 MN/m, G = 1 J/m², τ_c = 1.4 MPa, friction 0.1 MPa on each side of 20 mm, 5
/// mm free.
TEST_CASE("slow: a fibre is pulled out by the force of shear lag, and then of friction") {
  constexpr double kStretch = 6e6, kGlue = 1, kShear = 1.4e6, kFrictionStress = 0.1e6, kLength = 20e-3,
                   kFree = 5e-3;
  const Outcome out = run(scene_file("fibre_pullout.yaml", {{"output.frames", "0"}}));
  REQUIRE(out.failure == "");
  const auto &time = out.history.at("time_s"), &force = out.history.at("pull.force_x_N");
  const auto mean_force = [&](double from, double to) {
    double sum = 0;
    int rows = 0;
    for (std::size_t k = 0; k < time.size(); ++k)
      if (time[k] > from && time[k] <= to) sum += force[k], ++rows;
    return sum / rows;
  };
  const double speed = 60e-6 / 1050e-6, front = 2 * std::sqrt(kStretch * kGlue);
  // Where the glue ends the fibre has slipped by 2G/τ_c and pulls with `front`; friction adds 2τ d on the way
  // d to there: u = 2G/τ_c + ∫ P/Et, P = front + 2τd outside.
  for (double t = 0.46e-3; t < 0.67e-3; t += 0.04e-3) {
    const double way = speed * (t - 250e-6);
    double low = front, high = 2 * front;
    for (int k = 0; k < 60; ++k) {
      const double load = 0.5 * (low + high), debonded = (load - front) / (2 * kFrictionStress);
      const double stretch = (0.5 * (front + load) * debonded + load * kFree) / kStretch;
      (2 * kGlue / kShear + stretch < way ? low : high) = load;
    }
    MESSAGE("at ", 1e6 * way, " um ", mean_force(t - 20e-6, t + 20e-6) / low, " debonded ",
            (low - front) / (2 * kFrictionStress));
    CHECK(mean_force(t - 20e-6, t + 20e-6) == doctest::Approx(low).epsilon(0.03).scale(0));
  }
  MESSAGE("friction ", mean_force(1.05e-3, 1.4e-3) / (2 * kFrictionStress * kLength), " lost ",
          out.history.at("interface_J").back() / (2 * kGlue * kLength), " balance ",
          out.summary.energy_error);
  CHECK(mean_force(1.05e-3, 1.4e-3) == doctest::Approx(2 * kFrictionStress * kLength).epsilon(0.03).scale(0));
  CHECK(out.history.at("interface_J").back() == doctest::Approx(2 * kGlue * kLength).epsilon(0.03).scale(0));
  CHECK(std::abs(out.summary.energy_error) < 0.01);
}

}  // namespace
}  // namespace mpmfast
