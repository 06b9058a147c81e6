// What conduction must do to round-off, whatever the scene; and what laws see of bodies that heat stretches.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "engine/plan/seed.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two blocks of one material that fly into each other obliquely and rub, of different temperatures.
std::string impact(int dimension) {
  const std::string material =
      "materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: "
      "50 J/kg/K, conductivity: 2 kW/m/K}}\n";
  if (dimension == 2)
    return "space: plane_strain\ngrid: {origin: [-5 mm, -5 mm], size: [34 mm, 24 mm], cell: 1 mm}\n"
           "time: {end: 1 s}\nheat: {temperature: 310 K}\n" +
           material + R"(
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm], to: [6.3 mm, 8.2 mm]}, material: m, velocity: [8 m/s, 1 m/s], temperature: 400 K}
  - {name: b, box: {from: [6.3 mm, 3.7 mm], to: [13.3 mm, 9.7 mm]}, material: m, velocity: [-9 m/s, -2 m/s]}
)";
  return "space: 3d\ngrid: {origin: [-4 mm, -4 mm, -4 mm], size: [20 mm, 14 mm, 14 mm], cell: 1 mm}\n"
         "time: {end: 1 s}\nheat: {temperature: 310 K}\n" +
         material + R"(
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm, 0.4 mm], to: [4.3 mm, 4.2 mm, 4.4 mm]}, material: m, velocity: [8 m/s, 1 m/s, 2 m/s], temperature: 400 K}
  - {name: b, box: {from: [4.3 mm, 1.7 mm, 1.2 mm], to: [9.3 mm, 5.7 mm, 4.2 mm]}, material: m, velocity: [-9 m/s, -2 m/s, 0 m/s]}
)";
}

/// Σ M c (T − 310 K), J, and by body.
template <int Dim>
std::vector<double> contents(const Step<Dim>& step) {
  const auto& state = step.state();
  std::vector<double> sum(state.bodies.size() + 1);
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    const std::size_t b = state.particles.body()[p];
    const double heat = state.particles.column(Quantity::mass)[p] * state.bodies[b].heat.capacity *
                        (state.particles.column(Quantity::temperature)[p] - 310);
    sum[b] += heat;
    sum.back() += heat;
  }
  return sum;
}

template <int Dim>
void check_heat_is_kept(const std::vector<Override>& sets) {
  const Scene scene = scene_from(impact(Dim), sets);
  Step<Dim> step(scene);
  const std::vector<double> before = contents(step);
  advance(step, sanitized() ? 10 : 60);
  const std::vector<double> after = contents(step);
  CHECK(after[0] < 0.999 * before[0]);  // some crossed
  CHECK(step.heat().sums().friction > 0);
  CHECK(std::abs(after.back() - before.back() - step.heat().sums().friction) < 1e-12 * before[0]);
  CHECK(step.heat().sums().friction == doctest::Approx(step.sums().friction_work).epsilon(1e-12).scale(0));
}

TEST_CASE("heat is conserved to round-off through conduction, contact and friction") {
  for (const char* basis : bases()) {
    CAPTURE(std::string(basis));
    const std::vector<Override> sets{{"method.basis", basis}, {"contact", "{friction: 0.3}"}};
    check_heat_is_kept<2>(sets);
    for (const char* filter : {"none", "{order: 2, every: 0}", "{order: 1, every: 0.3}"}) {
      auto filtered = sets;
      filtered.push_back({"heat.filter", filter});
      check_heat_is_kept<2>(filtered);
    }
  }
  check_heat_is_kept<3>({{"contact", "{friction: 0.3, conductance: 3 MW/m^2/K}"}});
  check_heat_is_kept<3>({{"contact", "{friction: 0.3}"}, {"heat.filter", "{order: 1, every: 0}"}});
}

template <int Dim>
void check_one_field(const std::vector<Override>& sets) {
  auto one = sets, two = sets;
  one.push_back({"contact", "none"});
  two.push_back({"contact", "{law: perfect}"});
  const Scene scene_one = scene_from(impact(Dim), one), scene_two = scene_from(impact(Dim), two);
  Step<Dim> single(scene_one), tied(scene_two);
  const int steps = sanitized() ? 8 : 40;
  advance(single, steps);
  advance(tied, steps);
  REQUIRE(tied.state().fields() == 2);
  for (const Quantity q : {Quantity::temperature, Quantity::temperature_slope, Quantity::velocity})
    CHECK(relative_difference(by_id(tied.state().particles, q), by_id(single.state().particles, q)) < 1e-12);
}

TEST_CASE("a perfect interface is one field to round-off with heat on, filtered or not") {
  for (const char* basis : bases()) {
    CAPTURE(std::string(basis));
    check_one_field<2>({{"method.basis", basis}, {"heat.filter", "none"}});
    check_one_field<2>({{"method.basis", basis}, {"heat.filter", "{order: 2, every: 0}"}});
    check_one_field<2>({{"method.basis", basis},
                        {"heat.boundaries",
                         "{hot: {box: {from: [5 mm, 3 mm], to: "
                         "[8 mm, 5 mm]}, temperature: 350 K}}"}});
  }
  check_one_field<3>({});
  check_one_field<3>({{"heat.filter", "{order: 1, every: 0.5}"}});
}

/// A disk that no node lies well for, of a temperature that rises along x and y.
const char* const kDisk = R"(
space: plane_strain
grid: {origin: [-2 mm, -2 mm], size: [12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
heat: {temperature: 310 K}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 0 W/m/K}}
bodies: [{name: a, disk: {centre: [4.13 mm, 3.86 mm], radius: 3.1 mm}, material: m}]
)";

TEST_CASE("temperatures of nodes are exact where they are linear, also at surfaces") {
  for (const char* basis : bases()) {
    CAPTURE(std::string(basis));
    const Scene scene = scene_from(kDisk, {{"method.basis", basis}});
    Step<2> step(scene);
    auto& particles = step.state().particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec<2> x = particles.vector(Quantity::position, p);
      particles.column(Quantity::temperature)[p] = 330 + 4e3 * x[0] - 7e3 * x[1];
      particles.column(Quantity::temperature_slope, 0)[p] = 4e3;
      particles.column(Quantity::temperature_slope, 1)[p] = -7e3;
    }
    step.advance(step.stable_dt());
    const auto& state = step.state();
    const double* mass = state.nodes.column(Nodal::mass);
    int nodes = 0;
    for (const auto& block : state.tiling.node_blocks)
      for (int local = 0; local < kTileNodes<2>; ++local) {
        const int slot = block.begin * kTileNodes<2> + local;
        if (!(mass[slot] > 1e-12)) continue;
        const NodeIndex<2> node = state.tiling.node(block, local);
        const double x = -2e-3 + node[0] * 1e-3, y = -2e-3 + node[1] * 1e-3;
        CHECK(step.heat().temperature(state, slot) ==
              doctest::Approx(330 + 4e3 * x - 7e3 * y).epsilon(1e-12).scale(0));
        ++nodes;
      }
    CHECK(nodes > 40);
    // And particles keep their slopes.
    for (std::size_t p = 0; p < particles.size(); ++p)
      REQUIRE(std::abs(particles.column(Quantity::temperature_slope, 0)[p] - 4e3) < 1e-6);
  }
}

/// A disk whose particles have temperatures at random, after some steps at the largest that conduction
/// allows: the largest difference of a particle and of a node from the mean, of 1 K at the start.
struct Rough {
  double particles, nodes;
};
Rough rough_left(const std::string& basis, double x) {
  const Scene scene = scene_from(
      kDisk,
      {{"method.basis", basis},
       {"materials.m.conductivity", "100 kW/m/K"},  // conduction alone bounds the step
       {"bodies.0.disk.centre", "[" + std::to_string(4 + x) + " mm, " + std::to_string(3.9 - x) + " mm]"}});
  Step<2> step(scene);
  auto& particles = step.state().particles;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.column(Quantity::temperature)[p] = 310 + any(random);
  REQUIRE(step.stable_dt() == step.heat().stable_dt());
  advance(step, sanitized() ? 40 : 600);
  const double* t = particles.column(Quantity::temperature);
  const auto n = static_cast<std::ptrdiff_t>(particles.size());
  const double mean = std::accumulate(t, t + n, 0.0) / static_cast<double>(n);
  Rough most{0, 0};
  for (std::ptrdiff_t p = 0; p < n; ++p) most.particles = std::max(most.particles, std::abs(t[p] - mean));
  const auto& state = step.state();
  for (int slot = 0; slot < state.tiling.slots(); ++slot)
    if (state.nodes.column(Nodal::heat_capacity)[slot] > 0.2 * 1e-6 * 1200 * 50)  // of a full cell's
      most.nodes = std::max(most.nodes, std::abs(step.heat().temperature(state, slot) - mean));
  return most;
}

TEST_CASE("conduction is stable at its own time step, wherever the surface cuts the cells") {
  for (const char* basis : bases())
    for (double x : {0.0, 0.05, 0.17, 0.4, 0.71, 0.93}) {
      CAPTURE(std::string(basis));
      CAPTURE(x);
      const Rough left = rough_left(basis, x);
      CHECK(left.particles < 1.5);  // what the grid cannot see of them stays
      if (!sanitized()) CHECK(left.nodes < 1e-3);
    }
}

TEST_CASE("heat goes the same way on any number of threads") {
  const auto temperatures = [](int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    const Scene scene = scene_from(impact(2), {{"grid.cell", "0.25 mm"}, {"contact", "{friction: 0.3}"}});
    Step<2> step(scene);
    advance(step, sanitized() ? 4 : 30);
    omp_set_num_threads(before);
    return by_id(step.state().particles, Quantity::temperature);
  };
  const std::vector<double> one = temperatures(1);
  CHECK(one == temperatures(2));
  CHECK(one == temperatures(3));
}

/// A slab that moves along a held face which cuts its cells, fed on one side, with contact and friction.
const char* const kFed = R"(
space: plane_strain
grid: {size: [20 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 2 kW/m/K}}
bodies:
  - {name: slab, box: {from: [2 mm, 0.4 mm], to: [12 mm, 4 mm]}, material: m, velocity: [30 m/s, 0 m/s]}
  - {name: top, box: {from: [5 mm, 4 mm], to: [10 mm, 8 mm]}, material: m, velocity: [0 m/s, -3 m/s], temperature: 400 K}
boundaries: {bottom: {wall: sliding, position: 0.4 mm}}
heat: {temperature: 310 K, boundaries: {bottom: {temperature: 350 K}, top: {ambient: 300 K, coefficient: 1 MW/m^2/K}, left: {flux: 1 MW/m^2}}}
contact: {friction: 0.3}
)";

/// What came in and what friction made is what bodies have more.
template <int Dim>
void check_ledger(const std::string& yaml, const std::vector<Override>& sets) {
  const Scene scene = scene_from(yaml, sets);
  Step<Dim> step(scene);
  const double before = contents(step).back();
  advance(step, sanitized() ? 10 : 60);
  const HeatSums& sums = step.heat().sums();
  const double in =
      std::accumulate(sums.conditions.begin(), sums.conditions.end(), sums.friction + sums.rigid);
  CHECK(std::abs(in) > 0);
  CHECK(std::abs(contents(step).back() - before - in) < 1e-11 * std::abs(before) + 1e-11 * std::abs(in));
}

TEST_CASE("what comes in through faces is what the bodies have more, with every basis, filtered or not") {
  for (const char* basis : bases())
    for (const char* filter : {"none", "{order: 2, every: 0}", "{order: 1, every: 0.1}"}) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(filter));
      check_ledger<2>(kFed, {{"method.basis", basis}, {"heat.filter", filter}});
    }
}

/// Three blocks that meet at a place; the third of any model.
std::string three(const std::string& model) {
  return R"(
space: plane_strain
grid: {size: [24 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials:
  m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 2 kW/m/K}
  n: {)" +
         model +
         R"(, heat_capacity: 50 J/kg/K}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [10 mm, 8.5 mm]}, material: m, velocity: [3 m/s, 0 m/s]}
  - {name: b, box: {from: [10 mm, 2 mm], to: [18 mm, 5.3 mm]}, material: m, temperature: 350 K}
  - {name: c, box: {from: [10 mm, 5.3 mm], to: [20 mm, 10 mm]}, material: n, temperature: 400 K}
heat: {temperature: 310 K}
)";
}
const std::string kRubber = "model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa";

TEST_CASE("heat crosses where several bodies meet, by pairs, lumps or at once, and rigid ones keep theirs") {
  for (const char* contact : {"{friction: 0.2}", "{normal: logistic_regression, friction: 0.2}",
                              "{normal: average_gradient}", "{normal: logistic_regression, fields: pairs}"}) {
    CAPTURE(std::string(contact));
    const std::vector<Override> sets{{"contact", contact}};
    const Scene scene = scene_from(three(kRubber), sets);
    Step<2> step(scene);
    const std::vector<double> before = contents(step);
    advance(step, sanitized() ? 10 : 60);
    const std::vector<double> after = contents(step);
    CHECK(after[0] > before[0]);
    CHECK(after[2] < before[2]);
    CHECK(std::abs(after.back() - before.back() - step.heat().sums().friction) < 1e-12 * before.back());
  }
  const Scene scene = scene_from(three("model: rigid"));
  Step<2> step(scene);
  const std::vector<double> before = contents(step);
  advance(step, sanitized() ? 10 : 60);
  const std::vector<double> after = contents(step);
  CHECK(after[2] == before[2]);
  CHECK(step.heat().sums().rigid > 0);
  CHECK(std::abs(after.back() - before.back() - step.heat().sums().friction - step.heat().sums().rigid) <
        1e-12 * before.back());
}

/// Two blocks that touch along one flat face.
TEST_CASE(
    "a third body far away does not change what crosses between two, whatever is done where many meet") {
  const auto crossed = [](const std::string& contact, bool third) {
    std::string yaml = three(kRubber);
    const auto at = yaml.find("  - {name: c");
    if (third)
      yaml.replace(yaml.find("[10 mm, 5.3 mm], to: [20 mm, 10 mm]"), 35, "[21 mm, 9 mm], to: [23 mm, 11 mm]");
    else
      yaml.erase(at, yaml.find('\n', at) + 1 - at);
    const Scene scene = scene_from(yaml, {{"contact", contact}});
    Step<2> step(scene);
    const double before = contents(step)[0];
    advance(step, 20);
    return contents(step)[0] - before;
  };
  for (const char* contact : {"{friction: 0.2}", "{normal: logistic_regression, fields: pairs}"})
    CHECK(crossed(contact, true) == doctest::Approx(crossed(contact, false)).epsilon(1e-9).scale(0));
}

TEST_CASE("a scene with heat says what it does not know") {
  const auto refused = [](const std::string& yaml, const std::vector<Override>& sets,
                          const std::string& what) {
    CAPTURE(what);
    try {
      scene_from(yaml, sets);
      FAIL("it was taken");
    } catch (const SceneError& error) {
      CHECK(std::string(error.what()).find(what) != std::string::npos);
    }
  };
  const std::string soft = three(kRubber);
  refused(three("model: rigid"), {{"contact", "{law: perfect}"}}, "tied to rigid ones");
  refused(soft, {{"contact", "{family: penalty}"}}, "surfaces that are followed");
  refused(soft, {{"heat.boundaries", "{left: {temperature: -5 K}}"}}, "not positive");
  refused(soft,
          {{"heat.boundaries", "{left: {ambient: [[0 s, 300 K], [1 s, 0 K]], coefficient: 1 W/m^2/K}}"}},
          "not positive");
  refused(soft,
          {{"heat.boundaries", "{hot: {box: {from: [5 mm, 5 mm], to: [4 mm, 6 mm]}, temperature: 300 K}}"}},
          "lies below");
  refused(soft, {{"heat.boundaries", "{lefft: 300 K}"}}, "not a face of the grid");
  refused(soft, {{"heat", "none"}}, "bodies have temperatures where the scene has heat");
  std::string bare = soft;
  bare.erase(bare.rfind(", heat_capacity: 50 J/kg/K"), 26);
  refused(bare, {}, "needs its heat_capacity");
}

/// Materials of each kind of law that heat may stretch; all with K = 80, G = 30 MPa.
const std::vector<const char*> kExpanding{
    "{model: neo_hookean, bulk: 80 MPa, shear: 30 MPa, ",
    "{model: linear_elastic, young: 80 MPa, poisson: 0.333333333333333333, ",
    "{model: logarithmic_neo_hookean, lambda: 60 MPa, shear: 30 MPa, ",
    "{model: j2_plasticity, bulk: 80 MPa, shear: 30 MPa, yield: 50 MPa, ",
    "{model: johnson_cook, bulk: 80 MPa, shear: 30 MPa, yield: 50 MPa, hardening: 0 Pa, exponent: 1, melt: "
    "3000 K, temperature: 310 K, ",
    "{model: drucker_prager, bulk: 80 MPa, shear: 30 MPa, friction_angle: 30 deg, cohesion: 50 MPa, "};

/// A block that is warmed by 100 K at once and cannot stretch in the directions that are told.
template <int Dim>
double pressed(const std::string& space, const std::string& material, double temperature_rise) {
  const std::string grid =
      Dim == 2 ? "{size: [4 mm, 4 mm], cell: 1 mm}" : "{size: [4 mm, 4 mm, 4 mm], cell: 1 mm}";
  const std::string box = Dim == 2 ? "{from: [0 mm, 0 mm], to: [4 mm, 4 mm]}"
                                   : "{from: [0 mm, 0 mm, 0 mm], to: [4 mm, 4 mm, 4 mm]}";
  const Scene scene =
      scene_from("space: " + space + "\ngrid: " + grid +
                 "\ntime: {end: 1 s}\nheat: {temperature: 310 K}\nmaterials: {m: " + material +
                 "density: 1200 kg/m^3, heat_capacity: 50 J/kg/K, thermal_expansion: 1e-5 K^-1}}\n"
                 "bodies: [{name: a, box: " +
                 box + ", material: m}]\nboundaries: {left: wall, right: wall, bottom: wall, top: wall" +
                 (Dim == 3 ? ", back: wall, front: wall}" : "}") + "\n");
  Step<Dim> step(scene);
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.column(Quantity::temperature)[p] += temperature_rise;
  step.advance(step.stable_dt());
  step.advance(step.stable_dt());
  return particles.column(Quantity::kirchhoff_stress, 0)[particles.size() / 2];
}

TEST_CASE("a block that cannot stretch is pressed by its heat, of any material and in any space") {
  // −3 K α ΔT where nothing can stretch; −E α ΔT/(1 − ν) where one direction is free (plane stress).
  const double held = -3 * 80e6 * 1e-3, free = -80e6 * 1e-3 / (1 - 1.0 / 3);
  for (const std::string material : kExpanding) {
    CAPTURE(material);
    CHECK(pressed<2>("plane_strain", material, 100) == doctest::Approx(held).epsilon(5e-3).scale(0));
    CHECK(pressed<2>("axisymmetric", material, 100) == doctest::Approx(held).epsilon(5e-3).scale(0));
    CHECK(pressed<3>("3d", material, 100) == doctest::Approx(held).epsilon(5e-3).scale(0));
  }
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(pressed<2>("plane_stress", kExpanding[k], 100) == doctest::Approx(free).epsilon(5e-3).scale(0));
}

TEST_CASE("work that a law without a temperature dissipates heats its particles") {
  const std::string yaml = R"(
space: plane_strain
grid: {size: [8 mm, 4 mm], cell: 0.5 mm}
time: {end: 1 s}
heat: {temperature: 310 K}
materials: {m: {model: MODEL, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 100 W/m/K}}
bodies: [{name: a, box: {from: [0 mm, 0 mm], to: [6 mm, 4 mm]}, material: m, velocity: [-40 m/s, 0 m/s]}]
boundaries: {left: wall, bottom: wall, top: wall}
)";
  const auto check = [&](const std::string& model, double share) {
    std::string text = yaml;
    text.replace(text.find("MODEL"), 5, model);
    const Scene scene = scene_from(text);
    Step<2> step(scene);
    advance(step, 80);
    const double warmed = contents(step).back(), worked = step.dissipated_energy();
    CHECK(worked > 0);
    CHECK(warmed == doctest::Approx(share * worked).epsilon(1e-10).scale(0));
  };
  check("j2_plasticity, yield: 1 MPa, taylor_quinney: 0.8", 0.8);
  check("johnson_cook, yield: 1 MPa, hardening: 1 MPa, exponent: 1, melt: 3000 K, temperature: 310 K", 0.9);
  check("drucker_prager, friction_angle: 30 deg, cohesion: 0.2 MPa", 1);
}

}  // namespace
}  // namespace mpmfast
