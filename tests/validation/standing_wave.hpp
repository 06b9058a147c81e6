#pragma once

/// @file The period of a standing wave, for bars, plates and rings alike.

#include <vector>

#include "tests/support.hpp"

namespace mpmfast::test {

/// Period (s) from the zeros of Σ M V_x mode(x) over some periods; starts with V_x = 0.01 m/s times the mode.
/// @param mode  the shape of the wave at a particle's first coordinate (m); axisymmetric: the radius
template <class Mode>
double measured_period(const Scene& scene, int periods, Mode mode) {
  Step<2> step(scene);
  auto& particles = step.state().particles;
  const auto each = [&](auto f) {
    for (std::size_t p = 0; p < particles.size(); ++p)
      f(mode(particles.column(Quantity::position, 0)[p]), particles.column(Quantity::velocity, 0)[p],
        particles.column(Quantity::mass)[p]);
  };
  each([](double m, double& v, double) { v = 0.01 * m; });
  const auto amplitude = [&] {
    double sum = 0;
    each([&](double m, double v, double mass) { sum += mass * m * v; });
    return sum;
  };
  std::vector<double> zeros;
  double before = amplitude(), time_before = 0;
  while (zeros.size() < static_cast<std::size_t>(2 * periods + 1)) {
    step.advance(step.stable_dt());
    const double now = amplitude(), time = step.state().time;
    if (now * before < 0) zeros.push_back(time_before + (time - time_before) * before / (before - now));
    before = now;
    time_before = time;
    REQUIRE(step.state().step < 100000);
  }
  return (zeros.back() - zeros.front()) / periods;
}

}  // namespace mpmfast::test
