// Every column of the halves of particles, and which edges are halved, against the rule written out plainly.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "engine/plan/seed.hpp"
#include "engine/state/splitting.hpp"
#include "tests/random.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two bodies whose domains differ, and one that is not split; of metals, whose state has many columns.
Scene three_bodies(const std::string& space, const std::string& rest) {
  const bool solid = space == "3d";
  const char *low = solid ? ", 1 mm" : "", *high = solid ? ", 3 mm" : "", *size = solid ? ", 4 mm" : "",
             *cells = solid ? "2, 1, 3" : "2, 3";
  const std::string metal =
      space == "plane_stress"
          ? "{model: neo_hookean, density: 8 g/cm^3, bulk: 160 GPa, shear: 80 GPa}"
          : "{model: johnson_cook, density: 8.96 g/cm^3, young: 124 GPa, poisson: 0.34, yield: 90 MPa, "
            "hardening: "
            "292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 1356 K, heat_capacity: 383 "
            "J/kg/K, conductivity: 400 W/m/K, equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49}}";
  std::string other = metal;  // that holds other heat
  if (const std::size_t heat = other.find("heat_capacity: 383"); heat != std::string::npos)
    other.replace(heat, 18, "heat_capacity: 900");
  // Springs between surfaces need to know how domains lay at the start.
  const char* angle = rest.starts_with("contact") && !solid ? ", seeding: {angle: 20 deg}" : "";
  return scene_from(fmt::format(R"(
space: {}
grid: {{size: [12 mm, 8 mm{s}], cell: 1 mm}}
time: {{end: 1 ms}}
materials: {{m: {}, n: {}}}
bodies:
  - {{name: a, box: {{from: [1 mm, 1 mm{l}], to: [4 mm, 5 mm{h}]}}, material: m, particles_per_cell: 1}}
  - {{name: b, box: {{from: [5 mm, 1 mm{l}], to: [7 mm, 5 mm{h}]}}, material: n, particles_per_cell: [{c}]{}}}
  - {{name: c, box: {{from: [8 mm, 1 mm{l}], to: [10 mm, 3 mm{h}]}}, material: m, particles_per_cell: 1}}
method: {{basis: lcpdi, split: true}}
{}
)",
                                space, metal, other, angle, rest, fmt::arg("s", size), fmt::arg("l", low),
                                fmt::arg("h", high), fmt::arg("c", cells)));
}

/// All columns with random values, F not small, shares that halvings leave.
template <int Dim>
void live_through(State<Dim>& state, Random& random) {
  auto& particles = state.particles;
  for (const Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      for (std::size_t p = 0; p < particles.size(); ++p) {
        double& value = particles.column(q, k)[p];
        if (q == Quantity::position)
          value *= random.in(0.9, 1.1);
        else if (q == Quantity::domain_share)
          value = std::pow(0.5, static_cast<double>(random.below(6)));
        else if (q == Quantity::temperature)
          value = random.in(300, 500);
        else if (q == Quantity::temperature_slope)
          value = random.in(-2e7, 2e7);  // some rise by more than there is
        else if (q == Quantity::deformation_gradient)
          value = (k % (Dim + 1) == 0) + random.in(-0.9, 0.9);
        else
          value = random.in(0.5, 1.5);
      }
  for (std::size_t k = particles.size(); k > 1; --k)
    std::swap(particles.id()[k - 1], particles.id()[random.below(k)]);
}

/// Rows of all columns of one particle.
template <int Dim>
std::vector<std::vector<double>> row_of(const Particles<Dim>& particles, std::size_t p) {
  std::vector<std::vector<double>> out;
  for (const Quantity q : particles.quantities()) {
    out.emplace_back();
    for (int k = 0; k < Particles<Dim>::components(q); ++k) out.back().push_back(particles.column(q, k)[p]);
  }
  return out;
}

template <int Dim>
void check_halves(const std::string& space, const std::string& rest) {
  CAPTURE(space);
  CAPTURE(rest);
  const Scene scene = three_bodies(space, rest);
  Random random(static_cast<unsigned>(Dim + space.size()));
  for (int k = 0; k < Dim; ++k) {
    State<Dim> state;
    seed(scene, make_plan(scene), state);
    live_through(state, random);
    auto& particles = state.particles;
    CHECK(particles.has(Quantity::reference_position) == rest.starts_with("contact"));
    CHECK(particles.has(Quantity::initial_deformation) == (rest.starts_with("contact") && Dim == 2));
    const std::vector<Quantity> quantities = particles.quantities();
    const auto at = [&](Quantity q) {
      return static_cast<std::size_t>(std::find(quantities.begin(), quantities.end(), q) -
                                      quantities.begin());
    };
    const std::size_t n = particles.size();
    const std::uint32_t next = particles.next_id();
    std::vector<std::vector<std::vector<double>>> before;
    std::vector<std::uint32_t> ids, parents;
    std::vector<std::uint16_t> bodies;
    for (std::size_t p = 0; p < n; ++p) {
      before.push_back(row_of(particles, p));
      ids.push_back(particles.id()[p]);
      bodies.push_back(particles.body()[p]);
      if (random.below(3) > 0)
        parents.insert(parents.begin() + static_cast<std::ptrdiff_t>(random.below(parents.size() + 1)),
                       static_cast<std::uint32_t>(p));
    }
    REQUIRE(halve(state, parents, k) == n);
    REQUIRE(particles.size() == n + parents.size());
    CHECK(particles.next_id() == next + parents.size());
    int led = 0, not_led = 0;
    for (std::size_t p = 0; p < n; ++p) {
      const auto found = std::find(parents.begin(), parents.end(), p);
      CHECK(particles.id()[p] == ids[p]);
      CHECK(particles.body()[p] == bodies[p]);
      if (found == parents.end()) {
        CHECK(row_of(particles, p) == before[p]);
        continue;
      }
      const auto number = static_cast<std::size_t>(found - parents.begin()), q = n + number;
      CHECK(particles.id()[q] == next + number);
      CHECK(particles.body()[q] == bodies[p]);
      const auto& old = before[p];
      const auto d_of = [](int d) { return static_cast<std::size_t>(d); };
      const double share = old[at(Quantity::domain_share)][d_of(k)],
                   length = 0.5 * state.bodies[bodies[p]].half_size[k] * share;
      // From the middle to those of the halves, now and at the start.
      Vec<Dim> way, reference = Vec<Dim>::Zero();
      for (int d = 0; d < Dim; ++d) {
        way[d] = length * old[at(Quantity::deformation_gradient)][d_of(Dim * d + k)];
        reference[d] = particles.has(Quantity::initial_deformation)
                           ? length * old[at(Quantity::initial_deformation)][d_of(Dim * d + k)]
                       : d == k ? length
                                : 0;
      }
      const double x = old[at(Quantity::position)][0],
                   outer = space == "axisymmetric" ? (x + way[0]) / (2 * x) : 0.5;
      double rise = 0;
      if (particles.has(Quantity::temperature_slope))
        for (int d = 0; d < Dim; ++d) rise += old[at(Quantity::temperature_slope)][d_of(d)] * way[d];
      const bool leads =
          particles.has(Quantity::temperature_slope) && std::abs(rise) < old[at(Quantity::temperature)][0];
      (leads ? led : not_led) += 1;
      for (const auto& [half, sign, part] : {std::tuple(p, -1, 1 - outer), std::tuple(q, 1, outer)}) {
        auto expected = old;
        for (std::size_t e = 0; e < quantities.size(); ++e)
          if (kQuantityTable[static_cast<std::size_t>(quantities[e])].extensive) expected[e][0] *= part;
        expected[at(Quantity::domain_share)][d_of(k)] *= 0.5;
        for (int d = 0; d < Dim; ++d) {
          expected[at(Quantity::position)][d_of(d)] += sign * way[d];
          if (particles.has(Quantity::reference_position))
            expected[at(Quantity::reference_position)][d_of(d)] += sign * reference[d];
        }
        if (leads) {
          expected[at(Quantity::temperature)][0] += sign * rise;
          if (particles.has(Quantity::internal_energy))
            expected[at(Quantity::internal_energy)][0] += sign * rise * state.bodies[bodies[p]].heat.stored;
        }
        const auto got = row_of(particles, half);
        for (std::size_t e = 0; e < quantities.size(); ++e) {
          const std::string name(kQuantityTable[static_cast<std::size_t>(quantities[e])].name);
          CAPTURE(name);
          for (std::size_t c = 0; c < got[e].size(); ++c)
            CHECK(std::abs(got[e][c] - expected[e][c]) <=
                  1e-13 * std::max(std::abs(old[e][c]), std::abs(expected[e][c])) + 1e-17);
        }
      }
    }
    if (particles.has(Quantity::temperature_slope)) {
      CHECK(led > 5);
      CHECK(not_led > 5);
    }
  }
}

TEST_CASE("each column of the halves is what the rule says of their parent's") {
  for (const char* space : {"plane_strain", "plane_stress", "axisymmetric"}) check_halves<2>(space, "");
  check_halves<3>("3d", "");
  for (const char* space : {"plane_strain", "axisymmetric"})
    check_halves<2>(space, "heat: {temperature: 300 K}");
  check_halves<3>("3d", "heat: {temperature: 300 K}");
  const std::string springs =
      "contact: {law: interface, normal_stiffness: 2 GPa/mm, shear_stiffness: 1 GPa/mm}";
  check_halves<2>("plane_strain", springs);
  check_halves<3>("3d", springs);
}

template <int Dim>
void check_edges(const std::string& space) {
  CAPTURE(space);
  const Scene scene = three_bodies(space, "");
  Random random(static_cast<unsigned>(7 * Dim + space.size()));
  std::uint64_t splits = 0, held = 0;
  for (int trial = 0; trial < 10; ++trial) {
    State<Dim> state;
    seed(scene, make_plan(scene), state);
    state.threads = 1 + trial % 3;
    live_through(state, random);
    auto& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      // Some rings near the axis, on either side; some domains too thin for a number.
      if (p % 4 == 0) particles.column(Quantity::position, 0)[p] = random.in(-0.1e-3, 0.5e-3);
      if (p % 9 == 0) particles.column(Quantity::deformation_gradient, 0)[p] = p % 2 == 0 ? 1e151 : 1e149;
    }
    const std::vector<bool> body_splits{true, true, false};
    const SplitRule rule{random.in(0.1e-3, 1e-3), body_splits};
    SplitCounters plain{};
    for (int k = 0; k < Dim; ++k) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> to_halve;
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const std::size_t body = particles.body()[p];
        const double share = particles.column(Quantity::domain_share, k)[p],
                     edge = 2 * state.bodies[body].half_size[k] * share;
        double squares = 0;
        for (int d = 0; d < Dim; ++d)
          squares += std::pow(particles.column(Quantity::deformation_gradient, Dim * d + k)[p], 2);
        const Vec<Dim> half = half_edge(state, p, k);
        for (int d = 0; d < Dim; ++d)
          CHECK(half[d] ==
                doctest::Approx(edge / 2 * particles.column(Quantity::deformation_gradient, Dim * d + k)[p]));
        if (!body_splits[body] || edge * std::sqrt(squares) <= rule.longest) continue;
        // The middles of its halves lie a quarter of its edge from its own, and each half as far again.
        const double quarter = std::abs(edge * particles.column(Quantity::deformation_gradient, k)[p]) / 4;
        const bool beside_axis =
            space != "axisymmetric" || quarter < particles.column(Quantity::position, 0)[p];
        if (share > 1.0 / 16 && beside_axis && squares < 1e300) {
          ++plain.splits;
          to_halve.emplace_back(particles.id()[p], static_cast<std::uint32_t>(p));
        } else {
          ++plain.held;
        }
      }
      std::sort(to_halve.begin(), to_halve.end());
      std::vector<std::uint32_t> by_id;
      for (const auto& [id, p] : to_halve) by_id.push_back(p);
      CHECK(long_along(state, rule, k) == by_id);
    }
    const SplitCounters counted = count_long_edges(state, rule);
    CHECK(counted.splits == plain.splits);
    CHECK(counted.held == plain.held);
    splits += plain.splits;
    held += plain.held;
  }
  CHECK(splits > 20);
  CHECK(held > 20);
}

TEST_CASE(
    "edges are halved where they are too long, and held where they are small, no numbers or across the "
    "axis") {
  for (const char* space : {"plane_strain", "plane_stress", "axisymmetric"}) check_edges<2>(space);
  check_edges<3>("3d");
}

}  // namespace
}  // namespace mpmfast
