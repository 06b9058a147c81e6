// A particle that is halved: what its halves have together, and where they lie.

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <numbers>
#include <numeric>
#include <random>
#include <set>

#include "engine/output/overlap.hpp"
#include "engine/plan/seed.hpp"
#include "engine/state/splitting.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A block of a metal with all its history; rows of one particle a cell.
Scene block(const std::string& space, const std::string& rest = "") {
  const bool solid = space == "3d";
  const std::string z = solid ? ", 6 mm]" : "]", low = solid ? ", 2 mm]" : "]",
                    high = solid ? ", 4 mm]" : "]";
  const std::string metal =
      space == "plane_stress"
          ? "{model: neo_hookean, density: 8 g/cm^3, bulk: 160 GPa, shear: 80 GPa}"
          : "{model: johnson_cook, density: 8.96 g/cm^3, young: 124 GPa, poisson: 0.34, yield: 90 MPa, "
            "hardening: "
            "292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 1356 K, heat_capacity: 383 "
            "J/kg/K, "
            "conductivity: 400 W/m/K, equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49}}";
  Scene scene =
      scene_from("space: " + space + "\ngrid: {size: [8 mm, 8 mm" + z +
                 ", cell: 1 mm}\ntime: {end: 1 ms}\nmaterials: {m: " + metal +
                 "}\nbodies: [{name: a, box: {from: [2 mm, 2 mm" + low + ", to: [5 mm, 6 mm" + high +
                 "}, material: m, particles_per_cell: 1}]\nmethod: {basis: lcpdi, split: true}\n" + rest);
  return scene;
}

/// As after a long run: every column has telling values, F of particles is not small.
template <int Dim>
void live_through(State<Dim>& state) {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  auto& particles = state.particles;
  const auto fill = [&](Quantity q, double mean, double spread) {
    if (!particles.has(q)) return;
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      for (std::size_t p = 0; p < particles.size(); ++p)
        particles.column(q, k)[p] = mean + spread * unit(draw);
  };
  fill(Quantity::velocity, 3, 40);
  fill(Quantity::kirchhoff_stress, 0, 1e8);
  fill(Quantity::dissipated_energy, 2e6, 1e6);
  fill(Quantity::internal_energy, 2e7, 1e7);
  fill(Quantity::plastic_strain, 0.2, 0.1);
  fill(Quantity::temperature, 500, 100);
  fill(Quantity::temperature_slope, 0, 3e4);
  fill(Quantity::out_of_plane_stretch, 1, 0.2);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      for (std::size_t p = 0; p < particles.size(); ++p)
        particles.column(Quantity::deformation_gradient, Dim * i + j)[p] = (i == j) + 0.3 * unit(draw);
}

template <int Dim>
struct Sums {
  double mass = 0, kinetic = 0, stored = 0, dissipated = 0, volume = 0, heat = 0, internal = 0;
  Vec<3> moment = Vec<3>::Zero(), momentum = Vec<3>::Zero(), angular = Vec<3>::Zero();

  explicit Sums(State<Dim>& state) : stored(stored_energy(state)), dissipated(dissipated_energy(state)) {
    const auto& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double m = particles.column(Quantity::mass)[p],
                   v0 = particles.column(Quantity::initial_volume)[p];
      Vec<3> x = Vec<3>::Zero(), v = Vec<3>::Zero();
      x.template head<Dim>() = particles.vector(Quantity::position, p);
      v.template head<Dim>() = particles.vector(Quantity::velocity, p);
      mass += m;
      kinetic += 0.5 * m * v.squaredNorm();
      volume += v0 * particles.volume_ratio(p);
      if (particles.has(Quantity::temperature)) heat += m * particles.column(Quantity::temperature)[p];
      if (particles.has(Quantity::internal_energy))
        internal += v0 * particles.column(Quantity::internal_energy)[p];
      moment += m * x;
      momentum += m * v;
      angular += m * x.cross(v);
    }
  }
};

void check_same(double a, double b) { CHECK(std::abs(a - b) <= 1e-14 * std::abs(b)); }
void check_same(const Vec<3>& a, const Vec<3>& b) { CHECK((a - b).norm() <= 1e-14 * b.norm()); }

template <int Dim>
State<Dim> seeded(const Scene& scene) {
  State<Dim> state;
  seed(scene, make_plan(scene), state);
  return state;
}

std::vector<std::uint32_t> all_of(std::size_t n) {
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

template <int Dim>
void check_conserves(const std::string& space, const std::string& rest) {
  const Scene scene = block(space, rest);
  for (int k = 0; k < Dim; ++k) {
    State<Dim> state = seeded<Dim>(scene);
    live_through(state);
    const Sums<Dim> before(state);
    const auto n = state.particles.size();
    REQUIRE(halve(state, all_of(n), k) == n);
    REQUIRE(state.particles.size() == 2 * n);
    const Sums<Dim> after(state);
    check_same(after.mass, before.mass);
    check_same(after.moment, before.moment);
    check_same(after.momentum, before.momentum);
    check_same(after.angular, before.angular);
    check_same(after.kinetic, before.kinetic);
    check_same(after.volume, before.volume);
    check_same(after.stored, before.stored);
    check_same(after.dissipated, before.dissipated);
    check_same(after.heat, before.heat);
    check_same(after.internal, before.internal);
  }
}

TEST_CASE(
    "the halves of particles have their mass, momentum, angular momentum, heat and energies, to round-off") {
  const std::string heat = "heat: {temperature: 300 K}\n";
  check_conserves<2>("plane_strain", "");
  check_conserves<2>("plane_strain", heat);
  check_conserves<2>("plane_stress", "");
  check_conserves<3>("3d", "");
  check_conserves<3>("3d", heat);
}

TEST_CASE("the halves of a ring have its mass and energies, and its momentum along the axis") {
  const Scene scene = block("axisymmetric");
  for (int k = 0; k < 2; ++k) {
    State<2> state = seeded<2>(scene);
    live_through(state);
    const Sums<2> before(state);
    halve(state, all_of(state.particles.size()), k);
    const Sums<2> after(state);
    check_same(after.mass, before.mass);
    check_same(after.momentum[1], before.momentum[1]);
    check_same(after.kinetic, before.kinetic);
    check_same(after.volume, before.volume);
    check_same(after.stored, before.stored);
    check_same(after.dissipated, before.dissipated);
  }
}

TEST_CASE("the halves fill the place of the domain, and have its F, J, stress and history") {
  const Scene scene = block("plane_strain");
  State<2> state = seeded<2>(scene);
  live_through(state);
  const double area = area_of_domains(state.particles, state.bodies, state.surfaces);
  const std::size_t p = 5, q = halve(state, {5}, 1);
  const auto& particles = state.particles;
  for (const Quantity quantity : particles.quantities()) {
    const QuantityInfo& info = kQuantityTable[static_cast<std::size_t>(quantity)];
    if (quantity == Quantity::position) continue;
    CAPTURE(std::string(info.name));
    for (int k = 0; k < Particles<2>::components(quantity); ++k)
      CHECK(particles.column(quantity, k)[p] == particles.column(quantity, k)[q]);
  }
  CHECK(particles.body()[q] == particles.body()[p]);
  CHECK(particles.domain_share(p, 0) == 1);
  CHECK(particles.domain_share(p, 1) == 0.5);
  const Vec<2> apart = particles.vector(Quantity::position, q) - particles.vector(Quantity::position, p);
  CHECK((apart - 2 * half_edge(state, p, 1)).norm() < 1e-15 * apart.norm() + 1e-18);
  CHECK(area_of_domains(state.particles, state.bodies, state.surfaces) ==
        doctest::Approx(area).epsilon(1e-14));
}

TEST_CASE("temperatures of halves lie on the slope of the particle's, unless they would be none") {
  const Scene scene = block("plane_strain", "heat: {temperature: 300 K}\n");
  State<2> state = seeded<2>(scene);
  auto& particles = state.particles;
  particles.column(Quantity::temperature_slope, 0)[0] = 1e5;
  particles.column(Quantity::temperature_slope, 0)[1] = 1e7;  // 2500 K over a quarter of a millimetre
  const double before = particles.column(Quantity::temperature)[0];
  const std::size_t q = halve(state, {0, 1}, 0);
  const double* temperature = particles.column(Quantity::temperature);
  CHECK(temperature[0] == doctest::Approx(before - 25));
  CHECK(temperature[q] == doctest::Approx(before + 25));
  CHECK(temperature[1] == before);
  CHECK(temperature[q + 1] == before);
}

TEST_CASE(
    "displacements of halves are those that the domain has there, with domains at an angle at the start "
    "too") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1 g/cm^3, bulk: 2 GPa, shear: 1 GPa}}
bodies:
  - {name: a, polygon: [[5 mm, 1 mm], [9 mm, 5 mm], [7 mm, 7 mm], [3 mm, 3 mm]], material: m, seeding: {angle: 45 deg}}
  - {name: b, polygon: [[3 mm, 3 mm], [7 mm, 7 mm], [5 mm, 9 mm], [1 mm, 5 mm]], material: m, seeding: {angle: 45 deg}}
contact: {law: interface, normal_stiffness: 2 GPa/mm, shear_stiffness: 1 GPa/mm}
method: {basis: lcpdi, split: true}
)");
  State<2> state = seeded<2>(scene);
  auto& particles = state.particles;
  REQUIRE(particles.has(Quantity::initial_deformation));
  // All of it is stretched by A about the origin: u = (A − 1) X everywhere.
  const Mat<2> a = (Mat<2>() << 1.3, 0.2, -0.1, 0.9).finished();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<2> x = a * particles.vector(Quantity::position, p);
    const Mat<2> f = a * particles.deformation_gradient(p);
    for (int i = 0; i < 2; ++i) {
      particles.column(Quantity::position, i)[p] = x[i];
      for (int j = 0; j < 2; ++j) particles.column(Quantity::deformation_gradient, 2 * i + j)[p] = f(i, j);
    }
  }
  for (int k = 0; k < 2; ++k) halve(state, all_of(particles.size()), k);
  double error = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    error = std::max(error, (a * particles.vector(Quantity::reference_position, p) -
                             particles.vector(Quantity::position, p))
                                .norm());
  CHECK(error < 1e-16);
}

TEST_CASE(
    "halves have ids of their own, in order of those of their parents, and none that was taken before") {
  const Scene scene = block("3d");
  State<3> state = seeded<3>(scene);
  auto& particles = state.particles;
  const auto n = static_cast<std::uint32_t>(particles.size());
  REQUIRE(particles.next_id() == n);
  particles.keep_first(n - 1);  // the last one left: its number is not given again
  halve(state, {3, 1}, 2);
  CHECK(particles.id()[n - 1] == n);
  CHECK(particles.id()[n] == n + 1);
  CHECK(particles.next_id() == n + 2);
  std::set<std::uint32_t> ids;
  for (std::size_t p = 0; p < particles.size(); ++p) ids.insert(particles.id()[p]);
  CHECK(ids.size() == particles.size());
}

TEST_CASE("edges that are too long are found by id, and held when they were halved often enough") {
  Scene scene = block("plane_strain");
  State<2> state = seeded<2>(scene);
  auto& particles = state.particles;
  std::swap(particles.id()[2], particles.id()[7]);
  const std::vector<bool> splits{true};
  const SplitRule rule{1.5e-3, splits};
  const auto stretch = [&](std::size_t p, int k) -> double& {
    return particles.column(Quantity::deformation_gradient, 3 * k)[p];
  };
  stretch(2, 0) = 1.4999, stretch(3, 0) = stretch(7, 0) = stretch(2, 1) = 1.5001;
  particles.column(Quantity::deformation_gradient, 2)[2] = 0.1;  // its edge is 1.5032 long
  CHECK(long_along(state, rule, 0) == std::vector<std::uint32_t>{7, 3, 2});
  CHECK(long_along(state, rule, 1) == std::vector<std::uint32_t>{2});
  CHECK(count_long_edges(state, rule).splits == 4);
  CHECK(count_long_edges(state, rule).held == 0);
  stretch(3, 0) = 100;
  for (int times = 0; times < constants::splitting::kMostHalvings; ++times) {
    CHECK(count_long_edges(state, rule).splits >= 4);
    halve(state, {3}, 0);
  }
  CHECK(particles.domain_share(3, 0) == 1.0 / 16);
  CHECK(count_long_edges(state, rule).held == 2);  // of the last pair, 100/16 cells each
  const std::vector<bool> none{false};
  CHECK(count_long_edges(state, {1.5e-3, none}).splits == 0);
}

TEST_CASE("a ring whose halves would not lie beside the axis stays whole, whichever way its edges point") {
  const Scene scene = block("axisymmetric");
  const std::vector<bool> splits{true};
  for (int k = 0; k < 2; ++k)
    for (const double stretch : {3.0, -3.0}) {
      CAPTURE(k);
      CAPTURE(stretch);
      State<2> state = seeded<2>(scene);
      auto& particles = state.particles;
      particles.column(Quantity::deformation_gradient, k)[0] = stretch;
      particles.column(Quantity::position, 0)[0] = 0.76e-3;  // half its edge goes 1.5 mm from the axis
      const SplitCounters beside = count_long_edges(state, {1.5e-3, splits});
      CHECK(beside.splits == 1);
      CHECK(beside.held == 0);
      particles.column(Quantity::position, 0)[0] = 0.74e-3;
      const SplitCounters across = count_long_edges(state, {1.5e-3, splits});
      CHECK(across.splits == 0);
      CHECK(across.held == 1);
    }
}

TEST_CASE("a column that grows keeps what it holds") {
  Column<double> column;
  column.grow(3);
  for (std::size_t i = 0; i < 3; ++i) column[i] = 1 + static_cast<double>(i);
  for (std::size_t n = 3; n < 200000; n += n / 2) {
    column.grow(n);
    CHECK(column.size() == n);
    CHECK(column[2] == 3);
    column[n - 1] = static_cast<double>(n);
    column.grow(n + 1);
    CHECK(column[n - 1] == static_cast<double>(n));
  }
}

}  // namespace
}  // namespace mpmfast
