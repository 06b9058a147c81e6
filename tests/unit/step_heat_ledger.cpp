// Where heat goes that is neither conducted on nor lost: what expansion stores, and what equations of state
// do.

#include <cmath>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("a block that is warmed between walls stores what its heat worked, the square of its strain") {
  // Nothing moves: p = 3 K α ΔT, and −∫ V tr τ α dT = ∫ 9 K α² ΔT dT V = ½ K (3 α ΔT)² V.
  constexpr double kBulk = 80e6, kExpansion = 1e-5, kRise = 100, kVolume = 4e-3 * 4e-3;
  for (const char* model : {"neo_hookean, bulk: 80 MPa, shear: 30 MPa",
                            "j2_plasticity, bulk: 80 MPa, shear: 30 MPa, yield: 50 MPa",
                            "drucker_prager, bulk: 80 MPa, shear: 30 MPa, friction_angle: 30 deg, cohesion: "
                            "50 MPa"}) {
    CAPTURE(std::string(model));
    const Scene scene = scene_from(std::string(R"(
space: plane_strain
grid: {size: [4 mm, 4 mm], cell: 1 mm}
time: {end: 1 s}
heat: {temperature: 310 K}
materials: {m: {density: 1200 kg/m^3, heat_capacity: 50 J/kg/K, thermal_expansion: 1e-5 K^-1, model: )") +
                                   model + R"(}}
bodies: [{name: a, box: {from: [0 mm, 0 mm], to: [4 mm, 4 mm]}, material: m}]
boundaries: {left: wall, right: wall, bottom: wall, top: wall}
)");
    Step<2> step(scene);
    auto& particles = step.state().particles;
    constexpr int kSteps = 50;
    for (int k = 0; k < kSteps; ++k) {
      for (std::size_t p = 0; p < particles.size(); ++p)
        particles.column(Quantity::temperature)[p] += kRise / kSteps;
      step.advance(step.stable_dt());
    }
    step.advance(step.stable_dt());
    const double strain = 3 * kExpansion * kRise, stored = 0.5 * kBulk * strain * strain * kVolume;
    // Sums over steps: within two of them.
    CHECK(step.heat().sums().worked == doctest::Approx(stored).epsilon(2.0 / kSteps).scale(0));
    CHECK(step.stored_energy() == doctest::Approx(stored).epsilon(2.0 / kSteps).scale(0));
  }
}

TEST_CASE("heat that flows into equations of state is in their internal energy, and no energy of motion") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [8 mm, 4 mm], cell: 1 mm}
time: {end: 1 s}
heat: {temperature: 310 K, boundaries: {left: {flux: 1 MW/m^2}}}
materials: {m: {model: mie_gruneisen, density: 1200 kg/m^3, bulk: 80 MPa, gruneisen: 0, hugoniot_slope: 1.4, temperature: 310 K, heat_capacity: 50 J/kg/K, conductivity: 2 kW/m/K}}
bodies: [{name: a, box: {from: [0 mm, 0 mm], to: [6 mm, 4 mm]}, material: m}]
boundaries: {left: wall, right: wall, bottom: wall, top: wall}
)");
  Step<2> step(scene);
  auto& particles = step.state().particles;
  double time = 0;
  for (int k = 0; k < 20; ++k) {
    const double dt = step.stable_dt();
    step.advance(dt);
    time += dt;
  }
  const double fed = 1e6 * 4e-3 * time;
  const double* internal = particles.column(Quantity::internal_energy);
  double held = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    held += particles.column(Quantity::initial_volume)[p] * internal[p];
  CHECK(step.heat().sums().stored == doctest::Approx(fed).epsilon(1e-10).scale(0));
  CHECK(held == doctest::Approx(fed).epsilon(1e-10).scale(0));
  CHECK(std::abs(step.stored_energy()) < 1e-10 * fed);  // without γ heat presses nothing
}

}  // namespace
}  // namespace mpmfast
