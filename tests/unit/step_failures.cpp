// Which particle a step that fails blames, and for what.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two blocks that rest, whose particles have no domains.
const char* const kAtRest = R"(
space: plane_strain
grid: {size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: left, box: {from: [2 mm, 2 mm], to: [6 mm, 10 mm]}, material: m}
  - {name: right, box: {from: [10 mm, 2 mm], to: [14 mm, 10 mm]}, material: m}
method: {basis: bspline2}
)";

/// What is said of a time step that is too short, of a quarter of the first, or of one that is no number.
struct Blamed {
  std::string message;
  bool has_position = false;

  Blamed(const Step<2>& step, double dt) {
    try {
      step.fail_collapsed(dt, 0.25);
    } catch (const RunFailure& failure) {
      message = failure.what();
      has_position = failure.position().has_value();
    }
  }
  bool says(const std::string& part) const { return message.find(part) != std::string::npos; }
  bool names(std::uint32_t id) const { return says(": particle " + std::to_string(id) + " of body '"); }
};

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

void set_velocity(Particles<2>& particles, std::size_t p, const Vec<2>& velocity) {
  for (int d = 0; d < 2; ++d) particles.column(Quantity::velocity, d)[p] = velocity[d];
}

TEST_CASE("a time step that collapses is blamed on the fastest, of equal ones on that of the least number") {
  const Scene scene = scene_from(kAtRest);
  Step<2> step(scene);
  auto& particles = step.state().particles;
  for (const bool swapped : {false, true}) {
    CAPTURE(swapped);
    if (swapped) std::swap(particles.id()[3], particles.id()[90]);
    set_velocity(particles, 3, {-30, 40});
    set_velocity(particles, 90, {50, 0});
    set_velocity(particles, 7, {0, -49});
    const Blamed equal(step, 1e-9);
    CHECK(equal.names(std::min(particles.id()[3], particles.id()[90])));
    CHECK(equal.says("the time step collapsed to 1e-09 s, 0.25 of the first (time.collapse): "));
    CHECK(equal.says("it moves at 50 m/s, J = 1"));
    CHECK(equal.has_position);
  }
  // Waves count as well as speed, and a speed that is no number is passed over.
  particles.column(Quantity::wave_speed)[50] += 60;
  CHECK(Blamed(step, 1e-9).names(particles.id()[50]));
  CHECK(Blamed(step, 1e-9).says("it moves at 0 m/s"));
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (p != 20) set_velocity(particles, p, {kNoNumber, 0});
  CHECK(Blamed(step, 1e-9).names(particles.id()[20]));
}

TEST_CASE("where no particle has a speed, a time step that collapses has no place") {
  const Scene scene = scene_from(kAtRest);
  Step<2> step(scene);
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) set_velocity(particles, p, {0, kNoNumber});
  const Blamed none(step, 1e-9);
  CHECK(none.message == "step 0, time 0 s: the time step collapsed to 1e-09 s, 0.25 of the first");
  CHECK_FALSE(none.has_position);
}

TEST_CASE(
    "a time step that is no number is blamed on what is wrong, and on no particle where all are right") {
  const Scene scene = scene_from(kAtRest);
  const auto blamed = [&](const auto& spoil) {
    Step<2> step(scene);
    spoil(step.state().particles);
    return Blamed(step, kNoNumber);
  };
  const Blamed none = blamed([](auto&) {});
  CHECK(none.message == "step 0, time 0 s: a speed is no number any more");
  CHECK_FALSE(none.has_position);
  // The least volume, zero and negative ones.
  for (const double least : {0.0, -2.0}) {
    CAPTURE(least);
    std::uint32_t id = 0;
    const Blamed inverted = blamed([&](auto& particles) {
      particles.column(Quantity::deformation_gradient, 0)[12] = least;
      if (least < 0) particles.column(Quantity::deformation_gradient, 3)[40] = -1;
      id = particles.id()[12];
    });
    CHECK(inverted.names(id));
    CHECK(inverted.says("its volume became zero or negative (J = " + std::string(least < 0 ? "-2)" : "0)")));
  }
  // Beside each face of the grid, a cell away: outside from there on.
  for (int axis = 0; axis < 2; ++axis)
    for (const bool upper : {false, true})
      for (const bool outside : {false, true}) {
        CAPTURE(axis);
        CAPTURE(upper);
        CAPTURE(outside);
        const auto d = static_cast<std::size_t>(axis);
        const double cell = scene.grid.cell, low = scene.grid.origin[d],
                     face = upper ? low + scene.grid.size[d] + cell : low - cell,
                     inwards = upper ? -1e-6 : 1e-6;
        std::uint32_t id = 0;
        const Blamed left = blamed([&](auto& particles) {
          for (const std::size_t p : {std::size_t{5}, std::size_t{60}}) {
            particles.column(Quantity::position, axis)[p] = outside ? face : face + inwards;
            set_velocity(particles, p, {-24, 32});
          }
          id = std::min(particles.id()[5], particles.id()[60]);
        });
        CHECK(left.has_position == outside);
        CHECK(left.says("a speed is no number any more") == !outside);
        if (outside) CHECK(left.names(id));
        CHECK(left.says("it left the grid at 40 m/s") == outside);
      }
}

TEST_CASE("a number that is none is found in any component of any quantity, and that is named") {
  const Scene scene =
      scene_from(kAtRest, {{"materials.m",
                            "{model: j2_plasticity, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, "
                            "yield: 1 MPa, hardening: 1 MPa}"},
                           {"method.basis", "lcpdi"}});
  Step<2> step(scene);
  advance(step, 1);
  auto& particles = step.state().particles;
  const std::size_t p = 20;
  int components = 0;
  for (const Quantity q : particles.quantities())
    for (int k = 0; k < Particles<2>::components(q); ++k, ++components)
      for (const double none : {kNoNumber, std::numeric_limits<double>::infinity()}) {
        const std::string name(kQuantityTable[static_cast<std::size_t>(q)].name);
        CAPTURE(name);
        CAPTURE(k);
        const double right = std::exchange(particles.column(q, k)[p], none);
        const Blamed blamed(step, kNoNumber);
        CHECK(blamed.names(particles.id()[p]));
        CHECK(blamed.says("not a number any more (" + name + ")"));
        CHECK_FALSE(blamed.says("particles around it"));
        CHECK(blamed.has_position);
        particles.column(q, k)[p] = right;
      }
  CHECK(components > 20);
  CHECK(Blamed(step, kNoNumber).says("of all domains its own is the largest"));  // all are right again
}

TEST_CASE("where all particles are right and have domains, the largest of these is named, however it lies") {
  const Scene scene = scene_from(kAtRest, {{"method.basis", "lcpdi"}});
  for (const double share : {1.5, -1.5}) {
    Step<2> step(scene);
    auto& particles = step.state().particles;
    for (int e = 0; e < 4; ++e) particles.column(Quantity::domain_edges, e)[33] *= share;
    const Blamed largest(step, kNoNumber);
    CHECK(largest.names(particles.id()[33]));
    CHECK(largest.says("a speed is no number any more; of all domains its own is the largest"));
  }
}

}  // namespace
}  // namespace mpmfast
