// Whom a step that fails blames among many, and how crowded cells are, against plain searches over random
// states.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/contact/pairs/find_pairs.hpp"
#include "engine/plan/seed.hpp"
#include "engine/step/crowding.hpp"
#include "tests/random.hpp"
#include "tests/support.hpp"
#include "tests/text.hpp"

namespace mpmfast {
namespace {

using namespace test;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

/// Two blocks of one velocity field and one of another, off the origin, with metals' columns.
Scene three_blocks(int dimension, const std::string& basis) {
  const std::string z = dimension == 3 ? ", -3 mm]" : "]", size_z = dimension == 3 ? ", 6 mm]" : "]",
                    low = dimension == 3 ? ", -2 mm]" : "]", high = dimension == 3 ? ", 1 mm]" : "]";
  return scene_from(fmt::format(R"(
space: {}
grid: {{origin: [10 mm, -20 mm{}, size: [14 mm, 9 mm{}, cell: 1 mm}}
time: {{end: 1 ms}}
materials: {{m: {{model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 1 MPa, hardening: 1 MPa}}}}
bodies:
  - {{name: first, field: both, box: {{from: [12 mm, -18 mm{l}, to: [14 mm, -15 mm{h}}}, material: m}}
  - {{name: second, box: {{from: [16 mm, -18 mm{l}, to: [18 mm, -14 mm{h}}}, material: m}}
  - {{name: third, field: both, box: {{from: [20 mm, -17 mm{l}, to: [22 mm, -14 mm{h}}}, material: m}}
method: {{basis: {}}}
)",
                                dimension == 3 ? "3d" : "plane_strain", z, size_z, basis, fmt::arg("l", low),
                                fmt::arg("h", high)));
}

/// What is said of a time step that is too short, or that is no number.
template <int Dim>
struct BlamedBy {
  BlamedBy(const Step<Dim>& step, double dt, double share = 0.25) {
    try {
      step.fail_collapsed(dt, share);
    } catch (const RunFailure& failure) {
      message = failure.what();
      if (failure.position()) position.assign(failure.position()->begin(), failure.position()->end());
    }
  }
  std::string message;
  std::vector<double> position;
};

/// Where it is, or a cell and a half above the first node of its support where its place is no number.
template <int Dim>
std::pair<Vec<Dim>, bool> position_of(const Step<Dim>& step, std::size_t p) {
  const State<Dim>& state = step.state();
  const Vec<Dim> x = state.particles.vector(Quantity::position, p);
  if (x.allFinite()) return {x, true};
  Vec<Dim> near;
  for (int d = 0; d < Dim; ++d)
    near[d] = state.grid.origin[d] + (state.tiling.sorted_node(p)[d] + 1.5) * state.grid.cell;
  return {near, false};
}

template <int Dim>
void check_blames(const Step<Dim>& step, const BlamedBy<Dim>& blamed, std::size_t p,
                  const std::string& cause) {
  const State<Dim>& state = step.state();
  const std::array<std::string, 3> bodies{"first", "second", "third"}, fields{"both", "second", "both"};
  const auto [x, known] = position_of(step, p);
  std::string where;
  for (int d = 0; d < Dim; ++d) where += fmt::format("{}{:.6g}", d > 0 ? ", " : "", x[d]);
  const std::size_t body = state.particles.body()[p];
  CHECK(blamed.message ==
        fmt::format("step {}, time {:.9g} s: particle {} of body '{}' (velocity field '{}') {} ({}) m: {}",
                    state.step, state.time, state.particles.id()[p], bodies[body], fields[body],
                    known ? "at" : "near", where, cause));
  REQUIRE(blamed.position.size() == 3);
  for (int d = 0; d < 3; ++d)  // some compilers fuse the sum of `position_of`
    CHECK(std::abs(blamed.position[static_cast<std::size_t>(d)] - (d < Dim ? x[std::min(d, Dim - 1)] : 0)) <
          1e-15);
}

template <int Dim>
void shuffle_ids(Particles<Dim>& particles, Random& random) {
  for (std::size_t k = particles.size(); k > 1; --k)
    std::swap(particles.id()[k - 1], particles.id()[random.below(k)]);
}

/// The particle of the least value; of equal ones that of the least number.
template <int Dim, class Value>
std::size_t plain_least(const Particles<Dim>& particles, const Value& value) {
  std::size_t least = 0;
  for (std::size_t p = 1; p < particles.size(); ++p)
    if (std::pair(value(p), particles.id()[p]) < std::pair(value(least), particles.id()[least])) least = p;
  return least;
}

template <int Dim>
void check_spoilt() {
  const Scene scene = three_blocks(Dim, "bspline2");
  Random random(Dim);
  Step<Dim> step(scene);
  advance(step, 2);
  auto& particles = step.state().particles;
  for (int trial = 0; trial < 60; ++trial) {
    shuffle_ids(particles, random);
    const std::size_t count = 1 + random.below(trial % 3 == 0 ? 2 : 9);
    std::vector<std::pair<double*, double>> before;
    std::set<std::size_t> spoilt;
    std::map<std::size_t, std::set<Quantity>> what;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = random.below(particles.size());
      const Quantity q = trial % 4 == 0 ? Quantity::position
                                        : particles.quantities()[random.below(particles.quantities().size())];
      double* value = &particles.column(
          q, static_cast<int>(random.below(static_cast<std::size_t>(Particles<Dim>::components(q)))))[p];
      before.emplace_back(value, *value);
      *value = k % 2 == 0 ? kNone : -kInfinity;
      spoilt.insert(p);
      what[p].insert(q);
    }
    Vec<Dim> middle = Vec<Dim>::Zero();
    for (const std::size_t p : spoilt) middle += position_of(step, p).first;
    middle /= static_cast<double>(spoilt.size());
    const auto distance = [&](std::size_t q) { return (position_of(step, q).first - middle).norm(); };
    std::size_t p =
        plain_least(particles, [&](std::size_t q) { return spoilt.contains(q) ? distance(q) : kInfinity; });
    const BlamedBy<Dim> blamed(step, kNone);
    const double least = distance(p);
    for (const std::size_t q : spoilt)  // of two, both are as far from the middle, but for round-off
      if (distance(q) < least + 1e-15 &&
          holds(blamed.message, fmt::format("particle {} of", particles.id()[q])))
        p = q;
    std::string names;
    for (const Quantity q : particles.quantities())
      if (what[p].contains(q))
        names += (names.empty() ? "" : ", ") + std::string(kQuantityTable[static_cast<std::size_t>(q)].name);
    std::string cause = "not a number any more (" + names + ")";
    if (spoilt.size() == 2) cause += ", nor is one particle around it";
    if (spoilt.size() > 2) cause += fmt::format(", nor are {} particles around it", spoilt.size() - 1);
    check_blames(step, blamed, p, cause);
    for (auto value = before.rbegin(); value != before.rend(); ++value) *value->first = value->second;
  }
  // So far apart that no distance is a number: the first.
  particles.column(Quantity::position, 0)[7] = 1e200;
  particles.column(Quantity::position, 0)[9] = -1e200;
  particles.column(Quantity::mass)[7] = particles.column(Quantity::mass)[9] = kNone;
  check_blames(step, BlamedBy<Dim>(step, kNone), 7,
               "not a number any more (mass), nor is one particle around it");
}

TEST_CASE("of many particles with numbers that are none the one in their middle is named, with all of them") {
  check_spoilt<2>();
  check_spoilt<3>();
}

template <int Dim>
void check_inverted_and_lost() {
  const Scene scene = three_blocks(Dim, "bspline2");
  Random random(10 + Dim);
  for (int trial = 0; trial < 12; ++trial) {
    Step<Dim> step(scene);
    advance(step, 1);
    auto& particles = step.state().particles;
    shuffle_ids(particles, random);
    // Some are beyond a face of the grid and the cell around it, others just within.
    double least = kInfinity;
    std::size_t lost = 0;
    for (int k = 0; k < 8; ++k) {
      const std::size_t p = random.below(particles.size());
      const auto d = static_cast<int>(random.below(Dim));
      const double cell = 1e-3, lower = scene.grid.origin[static_cast<std::size_t>(d)] - cell,
                   upper = lower + scene.grid.size[static_cast<std::size_t>(d)] + 2 * cell,
                   beyond = k % 2 == 0 ? 1e-6 : -1e-6;
      for (int e = 0; e < Dim; ++e)
        particles.column(Quantity::position, e)[p] = scene.grid.origin[static_cast<std::size_t>(e)] + 3e-3;
      particles.column(Quantity::position, d)[p] = k % 4 < 2 ? lower - beyond : upper + beyond;
      for (int e = 0; e < Dim; ++e) particles.column(Quantity::velocity, e)[p] = random.in(-50, 50);
    }
    for (std::size_t p = 0; p < particles.size(); ++p) {
      bool outside = false;
      for (int d = 0; d < Dim; ++d) {
        const auto e = static_cast<std::size_t>(d);
        const double x = particles.column(Quantity::position, d)[p];
        outside = outside || x < scene.grid.origin[e] - 1e-3 ||
                  x > scene.grid.origin[e] + scene.grid.size[e] + 1e-3;
      }
      if (outside && particles.id()[p] < least) least = particles.id()[p], lost = p;
    }
    if (least < kInfinity)
      check_blames(
          step, BlamedBy<Dim>(step, kNone), lost,
          fmt::format("it left the grid at {:.4g} m/s (grid.leaving says what else may become of it)",
                      particles.vector(Quantity::velocity, lost).norm()));
    // Volumes that are none come first.
    for (const double volume : {0.0, -0.5, -0.5, -2.0}) {
      const std::size_t p = random.below(particles.size());
      for (int e = 0; e < Dim * Dim; ++e)
        particles.column(Quantity::deformation_gradient, e)[p] = e == 0 ? volume : e % (Dim + 1) == 0;
      if (particles.has(Quantity::volume_ratio)) particles.column(Quantity::volume_ratio)[p] = volume;
      const std::size_t named =
          plain_least(particles, [&](std::size_t q) { return particles.volume_ratio(q); });
      check_blames(
          step, BlamedBy<Dim>(step, kNone), named,
          fmt::format("its volume became zero or negative (J = {:.3g})", particles.volume_ratio(named)));
    }
  }
}

TEST_CASE("of particles that are turned inside out the worst is named, of those that left the least number") {
  check_inverted_and_lost<2>();
  check_inverted_and_lost<3>();
}

TEST_CASE("the coldest of many is named where temperatures fall to nothing") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {origin: [10 mm, -20 mm], size: [14 mm, 9 mm], cell: 1 mm}
time: {end: 1 ms}
heat: {temperature: 300 K}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 900 J/kg/K, conductivity: 1 W/m/K}}
bodies:
  - {name: first, field: both, box: {from: [12 mm, -18 mm], to: [14 mm, -15 mm]}, material: m}
  - {name: second, box: {from: [16 mm, -18 mm], to: [18 mm, -14 mm]}, material: m}
  - {name: third, field: both, box: {from: [20 mm, -17 mm], to: [22 mm, -14 mm]}, material: m}
)");
  Random random(40);
  for (int trial = 0; trial < 6; ++trial) {
    Step<2> step(scene);
    advance(step, 1);
    auto& particles = step.state().particles;
    shuffle_ids(particles, random);
    for (int k = 0; k < 5; ++k)
      particles.column(Quantity::temperature)[random.below(particles.size())] = random.in(-900, -100);
    std::string message;
    try {
      advance(step, 1);
    } catch (const RunFailure& failure) {
      message = failure.what();
    }
    const double* temperature = step.state().particles.column(Quantity::temperature);
    const std::size_t p = plain_least(step.state().particles, [&](std::size_t q) { return temperature[q]; });
    CHECK(message.find(fmt::format(": particle {} of body '", particles.id()[p])) != std::string::npos);
    CHECK(message.ends_with(fmt::format(" m: its temperature fell to {:.3g} K", temperature[p])));
  }
}

template <int Dim>
void check_fastest() {
  const Scene scene = three_blocks(Dim, "lcpdi");
  Random random(20 + Dim);
  Step<Dim> step(scene);
  advance(step, 1);
  auto& particles = step.state().particles;
  for (int trial = 0; trial < 20; ++trial) {
    shuffle_ids(particles, random);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.column(Quantity::wave_speed)[p] = std::floor(random.in(0, 8));
      for (int d = 0; d < Dim; ++d)
        particles.column(Quantity::velocity, d)[p] =
            static_cast<std::size_t>(d) == p % Dim ? std::floor(random.in(-8, 8)) : 0;
      for (int e = 0; e < Dim * Dim; ++e) {
        particles.column(Quantity::deformation_gradient, e)[p] = (e % (Dim + 1) == 0) + random.in(-0.2, 0.2);
        particles.column(Quantity::domain_edges, e)[p] = 0x1p-30 * std::floor(random.in(-3, 3));
      }
    }
    const auto speed = [&](std::size_t p) { return particles.vector(Quantity::velocity, p).norm(); };
    const std::size_t p = plain_least(
        particles, [&](std::size_t q) { return -particles.column(Quantity::wave_speed)[q] - speed(q); });
    const std::string rest =
        fmt::format(": its waves run at {:.4g} m/s, it moves at {:.4g} m/s, J = {:.3g}",
                    particles.column(Quantity::wave_speed)[p], speed(p), particles.volume_ratio(p));
    for (const double share : {0.123, 0.999})
      check_blames(step, BlamedBy<Dim>(step, 1.2345e-9, share), p,
                   fmt::format("the time step collapsed to 1.23e-09 s, {} of the first (time.collapse){}",
                               share < 0.5 ? "0.12" : "1", rest));
    for (const double share : {1.0, 2.0})
      check_blames(step, BlamedBy<Dim>(step, 1.2345e-9, share), p,
                   "steps of 1.23e-09 s never reach the end" + rest);
    // Where all are right, the domain whose edges are the largest.
    const std::size_t widest = plain_least(particles, [&](std::size_t q) {
      double squares = 0;
      for (int e = 0; e < Dim * Dim; ++e)
        squares += std::pow(particles.column(Quantity::domain_edges, e)[q], 2);
      return -squares;
    });
    check_blames(step, BlamedBy<Dim>(step, kInfinity), widest,
                 "a speed is no number any more; of all domains its own is the largest");
  }
}

TEST_CASE(
    "the fastest of many is blamed for a time step, and the widest domain where nothing else is wrong") {
  check_fastest<2>();
  check_fastest<3>();
}

template <int Dim>
void check_cells() {
  const std::string z = Dim == 3 ? ", 4 mm]" : "]", one = Dim == 3 ? ", 1 mm]" : "]",
                    zero = Dim == 3 ? ", 0 mm]" : "]";
  constexpr std::size_t kBodies = 60;
  std::string yaml = fmt::format(R"(
space: {}
grid: {{size: [4 mm, 4 mm{}, cell: 1 mm}}
time: {{end: 1 s}}
materials: {{m: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
contact: {{law: coulomb}}
bodies:
)",
                                 Dim == 3 ? "3d" : "plane_strain", z);
  for (std::size_t k = 0; k < kBodies; ++k)
    yaml += fmt::format("  - {{name: b{}, box: {{from: [0 mm, 0 mm{}, to: [1 mm, 1 mm{}}}, material: m}}\n",
                        k, zero, one);
  const Scene scene = scene_from(yaml);
  State<Dim> state;
  seed(scene, make_plan(scene), state);
  Random random(30 + Dim);
  for (int trial = 0; trial < 10; ++trial) {
    state.grid.origin[trial % Dim] = random.in(-1, 1);
    for (std::size_t b = 0; b < kBodies; ++b)
      state.body_field[b] = static_cast<int>(trial % 2 == 0 ? b : random.below(kBodies));
    using Cell = std::array<int, 3>;
    std::map<Cell, std::set<int>> fields;
    for (std::size_t p = 0; p < state.particles.size(); ++p) {
      Cell cell{};
      for (int d = 0; d < Dim; ++d) {
        // Also in the row of cells around the grid, where particles still may be.
        const std::size_t row = random.below(40);
        const int at = row == 0 ? 3000000 : static_cast<int>(row % 5) - 1;  // or far beyond it
        cell[static_cast<std::size_t>(d)] = at;
        state.particles.column(Quantity::position, d)[p] =
            state.grid.origin[d] + 1e-3 * (at + random.in(0.01, 0.99));
      }
      fields[cell].insert(state.body_field[state.particles.body()[p]]);
    }
    double pairs = 0;
    std::size_t most = 0;
    for (const auto& [cell, of] : fields) {
      pairs += static_cast<double>(of.size() * (of.size() - 1) / 2);
      most = std::max(most, of.size());
    }
    const Crowding found = crowding(state, kBodies);
    CHECK(found.pairs == pairs);
    CHECK(found.fields == most);
    // The two that are named are the least and the largest field of such a cell.
    bool there = false;
    for (const auto& [cell, of] : fields)
      there = there || (of.size() == most && *of.begin() == state.body_field[found.one] &&
                        *of.rbegin() == state.body_field[found.other]);
    CHECK(there);
  }
}

template <int Dim>
void check_refused() {
  const double pair = PairFinder<Dim>::kPairBytes + kPairBytes<Dim> + PairMemory<Dim>::kPairBytes;
  Scene scene = three_blocks(Dim, "bspline2");
  scene.contact.active = true;
  State<Dim> state;
  seed(scene, make_plan(scene), state);
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    for (int d = 0; d < Dim; ++d)
      state.particles.column(Quantity::position, d)[p] = state.grid.origin[d] + 4.5e-3;
  state.body_field = {0, 1, 2};
  const auto said = [&](double bytes) {
    try {
      check_crowding(scene, state, 33, {static_cast<std::uint64_t>(bytes), "of the machine"});
    } catch (const SceneError& error) {
      const std::string text = error.what();
      return text;
    }
    return std::string();
  };
  CHECK(said(3 * pair) == "");
  CHECK(
      said(3 * pair - 1) ==
      fmt::format(
          "{}: bodies: up to 3 bodies lie in one cell, 'first' and 'third' among them: contact would list 3 "
          "pairs of them in {:.3g} GiB, and there are {:.3g} GiB of the machine. Bodies that are to be apart "
          "must not overlap; those that move as one share a field",
          scene.file.string(), 3 * pair / 1073741824.0, (3 * pair - 1) / 1073741824.0));
}

TEST_CASE("pairs of crowded bodies are refused where they take a byte more than there is") {
  check_refused<2>();
  check_refused<3>();
}

TEST_CASE("fields in each cell are counted once, wherever the cell lies, and all pairs of them") {
  check_cells<2>();
  check_cells<3>();
}

}  // namespace
}  // namespace mpmfast
