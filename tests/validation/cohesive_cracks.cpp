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

TEST_CASE(
    "slow: a double cantilever beam has the load of beam theory as its crack grows, and loses toughness "
    "times area") {
  const Scene scene = scene_file("dcb_cohesive.yaml", {});
  Step<2> step(scene);
  auto& state = step.state();
  std::vector<Vec<2>> start(state.particles.size());
  for (std::size_t p = 0; p < start.size(); ++p)
    start[state.particles.id()[p]] = state.particles.vector(Quantity::position, p);
  const double speed = 2.4e-3 / 2.75e-3, ramp = 0.5e-3, interval = 0.1e-3;
  const auto opening_at = [&](double t) {
    return t < ramp ? 0.5 * speed * t * t / ramp : speed * (t - 0.5 * ramp);
  };
  double impulse = 0, first_tip = 0, first_lost = 0;
  for (int k = 1; k <= 30; ++k) {
    while (state.time < k * interval * (1 - 1e-12))
      step.advance(step.dt_towards(k * interval, step.stable_dt()));
    const double now = step.sums().boundary_impulse[0][1], load = (now - impulse) / interval;
    impulse = now;
    const double opening = opening_at((k - 0.5) * interval), tip = tip_of(state, start);
    const double lost = step.sums().interface_loss;
    MESSAGE("row ", k, " opening ", 1e3 * opening, " load ", load, " of ", beam_load(opening), " tip ", 1e3 * tip,
            " lost ", lost, " kinetic ", kinetic_energy(state.particles), " stored ", step.stored_energy(),
            " work ", step.sums().boundary_work);
    if (k == 15) first_tip = tip, first_lost = lost;
    if (k == 30) {
      const double grown = tip - first_tip;
      MESSAGE("lost over area ", (lost - first_lost) / (kToughness * grown));
    }
  }
}

}  // namespace
}  // namespace mpmfast
