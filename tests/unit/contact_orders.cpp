/// Bodies that meet at nodes move the same in whatever order a scene names them.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A rigid floor, and two blocks above it that fly onto it and at each other.
const std::array<std::pair<std::string, std::string>, 3> kBodies{{
    {"floor", "box: {from: [2 mm, 2 mm], to: [14 mm, 6 mm]}, material: tool"},
    {"left", "box: {from: [4.3 mm, 6.1 mm], to: [8 mm, 9 mm]}, material: m, velocity: [3 m/s, -4 m/s]"},
    {"right",
     "box: {from: [8.05 mm, 6.05 mm], to: [11.2 mm, 8.6 mm]}, material: m, velocity: [-5 m/s, -2 m/s]"},
}};

/// Velocities by the body's name and the particle's place at the start, m/s.
using Motion = std::map<std::pair<std::string, std::uint32_t>, Vec<2>>;
Motion motion_of(const std::array<int, 3>& order, const std::string& contact) {
  std::string bodies;
  for (const int b : order) {
    const auto& [name, text] = kBodies[static_cast<std::size_t>(b)];
    bodies += fmt::format("  - {{name: {}, {}}}\n", name, text);
  }
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: rigid}}
method: {basis: bspline2}
contact: {)" + contact + "}\nbodies:\n" +
                                 bodies);
  Step<2> step(scene);
  advance(step, 60);
  const auto& particles = step.state().particles;
  std::array<std::uint32_t, 3> first;
  first.fill(~0u);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    std::uint32_t& least = first[static_cast<std::size_t>(particles.body()[p])];
    least = std::min<std::uint32_t>(least, particles.id()[p]);
  }
  Motion out;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto body = static_cast<std::size_t>(particles.body()[p]);
    out[{kBodies[static_cast<std::size_t>(order[body])].first, particles.id()[p] - first[body]}] =
        particles.vector(Quantity::velocity, p);
  }
  return out;
}

TEST_CASE("three bodies move the same in whatever order they are named, by each way to normals and fields") {
  for (const char* contact :
       {"normal: linear_regression, separation: ellipsoid, fields: simultaneous, friction: 0.2",
        "normal: logistic_regression, separation: ellipsoid, fields: pairs, friction: 0.2",
        "normal: max_gradient, separation: position_power, law: stick",
        "normal: max_volume, separation: ellipsoid_support, law: frictionless",
        "normal: average_gradient, separation: position_offset, fields: lump, friction: 0.3",
        "normal: max_margin, friction: 0.1"}) {
    CAPTURE(std::string(contact));
    const Motion known = motion_of({0, 1, 2}, contact);
    bool slowed = false;
    for (const auto& [place, velocity] : known) slowed |= place.first == "left" && velocity[1] > -3.5;
    CHECK(slowed);
    for (const std::array<int, 3>& order : {std::array{1, 0, 2}, std::array{2, 1, 0}, std::array{1, 2, 0}}) {
      const Motion found = motion_of(order, contact);
      REQUIRE(found.size() == known.size());
      double apart = 0;
      for (const auto& [place, velocity] : known) {
        const auto other = found.find(place);
        REQUIRE(other != found.end());
        apart = std::max(apart, (other->second - velocity).norm());
      }
      CAPTURE(order[0]);
      CAPTURE(order[1]);
      CHECK(apart < 1e-5);
    }
  }
}

}  // namespace
}  // namespace mpmfast
