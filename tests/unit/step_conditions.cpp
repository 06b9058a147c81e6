// Velocity conditions and rigid bodies: prescribed components are met to round-off, reactions balance.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kBlock = R"(
space: plane_strain
grid: {size: [20 mm, 20 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [4 mm, 4 mm], to: [12 mm, 10 mm]}, material: m, velocity: [3 m/s, -2 m/s]}]
)";

/// Velocity v⁺ of every node with mass, after a step.
template <class F>
void for_each_node(const Step<2>& step, F f) {
  const auto& state = step.state();
  for (const auto& block : state.tiling.node_blocks)
    for (int t = block.begin; t < block.end; ++t)
      for (int local = 0; local < kTileNodes<2>; ++local) {
        const int slot = t * kTileNodes<2> + local;
        if (state.nodes.column(Nodal::mass)[slot] > 0)
          f(state.tiling.node(block, local), state.nodes.vector(Nodal::velocity, slot));
      }
}

TEST_CASE("oblique conditions on the same nodes are both met to round-off") {
  const Scene scene = scene_from(std::string(kBlock) + R"(
boundaries:
  first: {box: {from: [3 mm, 3 mm], to: [7 mm, 12 mm]}, direction: [1, 0.2], speed: 5 m/s}
  second: {box: {from: [5 mm, 3 mm], to: [9 mm, 12 mm]}, direction: [0.5, 1], speed: -4 m/s}
)");
  Step<2> step(scene);
  advance(step, 20);
  const Vec<2> first = Vec<2>(1, 0.2).normalized(), second = Vec<2>(0.5, 1).normalized();
  int both = 0;
  for_each_node(step, [&](const NodeIndex<2>& n, const Vec<2>& v) {
    if (n[1] < 3 || n[1] > 12) return;
    if (n[0] >= 3 && n[0] <= 7) CHECK(std::abs(v.dot(first) - 5) < 1e-12);
    if (n[0] >= 5 && n[0] <= 9) CHECK(std::abs(v.dot(second) + 4) < 1e-12);
    both += n[0] >= 5 && n[0] <= 7;
  });
  CHECK(both > 10);
}

TEST_CASE("parallel conditions on the same nodes superpose") {
  const Scene scene = scene_from(std::string(kBlock) + R"(
boundaries:
  first: {box: {from: [3 mm, 3 mm], to: [7 mm, 12 mm]}, direction: [1, 0], speed: 5 m/s}
  second: {box: {from: [3 mm, 3 mm], to: [7 mm, 12 mm]}, direction: [-1, 0], speed: 2 m/s}
)");
  Step<2> step(scene);
  advance(step, 5);
  for_each_node(step, [&](const NodeIndex<2>& n, const Vec<2>& v) {
    if (n[0] >= 3 && n[0] <= 7 && n[1] >= 3 && n[1] <= 12) CHECK(std::abs(v[0] - 3) < 1e-12);
  });
}

/// A wall on the right at 12.3 mm and a piston from below, cells of 1 mm: what their planes do that they
/// should not, m/s.
template <int Dim>
double slip_of_planes(const std::string& yaml) {
  const Scene scene = scene_from(yaml);
  Step<Dim> step(scene);
  double worst = 0;
  int columns = 0;
  for (int k = 0; k < 200; ++k) {
    const double plane = 4.4 + 3e3 * step.state().time;  // cells, where the piston was when the step began
    step.advance(step.stable_dt());
    const auto& state = step.state();
    const auto velocity = [&](const NodeIndex<Dim>& node) -> std::optional<Vec<Dim>> {
      const int slot = state.tiling.slot(node, 0);
      if (slot < 0 || !(state.nodes.column(Nodal::mass)[slot] > 0)) return std::nullopt;
      return state.nodes.vector(Nodal::velocity, slot);
    };
    const auto check = [&](const NodeIndex<Dim>& inner, int axis, int out, double share,
                           const Vec<Dim>& wanted, int components) {
      NodeIndex<Dim> outer = inner;
      outer[axis] += out;
      const auto v_inner = velocity(inner), v_outer = velocity(outer);
      if (!v_inner || !v_outer || share < 0.05) return;
      const Vec<Dim> slip = (1 - share) * *v_inner + share * *v_outer - wanted;
      worst = std::max(worst, components > 1 ? slip.norm() : std::abs(slip[axis]));
      ++columns;
    };
    const int row = static_cast<int>(std::ceil(plane));
    for (int along = 6; along < 11; ++along) {
      NodeIndex<Dim> below = NodeIndex<Dim>::Constant(7), beside = below;
      below[0] = along;
      below[1] = row;
      check(below, 1, -1, row - plane, 3 * Vec<Dim>::Unit(1), 2);  // held: no component may slip
      beside[0] = 12;
      beside[1] = along;
      check(beside, 0, 1, 0.3, Vec<Dim>::Zero(), 1);
    }
  }
  CHECK(columns > 1000);
  return worst;
}

TEST_CASE("where the plane of a wall cuts a cell, it is the plane that moves with the wall, to round-off") {
  const std::string common = R"(
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
boundaries:
  bottom: {piston: 3 m/s, position: 4.4 mm, held: true, at: plane}
  right: {wall: sliding, position: 12.3 mm, at: plane}
)";
  for (const char* update : {"flip", "xpic(3)"}) {
    const std::string method = std::string("method: {update: ") + update + "}\n";
    CHECK(slip_of_planes<2>(common + method + R"(
space: plane_strain
grid: {size: [20 mm, 20 mm], cell: 1 mm}
bodies: [{name: a, box: {from: [4 mm, 4.4 mm], to: [12.3 mm, 12 mm]}, material: m, velocity: [3 m/s, -2 m/s]}]
)") < 1e-12);
    CHECK(slip_of_planes<3>(common + method + R"(
space: 3d
grid: {size: [20 mm, 20 mm, 20 mm], cell: 1 mm}
bodies: [{name: a, box: {from: [4 mm, 4.4 mm, 5 mm], to: [12.3 mm, 12 mm, 9 mm]}, material: m, velocity: [3 m/s, -2 m/s, 1 m/s]}]
)") < 1e-12);
  }
}

/// Of a picture, material may lie far behind a wall.
TEST_CASE("what lies far behind the plane of a wall that holds stands still, on every side") {
  auto image = std::make_shared<GreyImage>();
  image->width = image->height = 12;
  image->pixel.assign(144, 7);
  struct Side {
    const char* name;
    int axis;
    double plane;  // mm
    bool upper;
  };
  for (const Side& side : {Side{"left", 0, 7.4, false}, Side{"bottom", 1, 7.4, false},
                           Side{"right", 0, 8.6, true}, Side{"top", 1, 8.6, true}}) {
    CAPTURE(std::string(side.name));
    Scene scene = scene_from(
        std::string(kBlock) + fmt::format("boundaries: {{{}: {{wall: held, position: {} mm, at: plane}}}}\n",
                                          side.name, side.plane),
        {{"bodies.0.box.from", "[7.4 mm, 7.4 mm]"}, {"bodies.0.box.to", "[8.6 mm, 8.6 mm]"}});
    scene.bodies[0].shape = BitmapShape{"", {2e-3, 2e-3, 0}, {14e-3, 14e-3, 0}, 7, image};
    Step<2> step(scene);
    advance(step, 3);
    int beyond = 0;
    for_each_node(step, [&](const NodeIndex<2>& n, const Vec<2>& v) {
      const double way = side.upper ? n[side.axis] - side.plane : side.plane - n[side.axis];
      if (way < 3) return;  // nearer rows are on a line through the plane
      CHECK(v.norm() < 1e-12);
      ++beyond;
    });
    CHECK(beyond > 25);
  }
}

TEST_CASE("the impulse of the boundaries is the change of momentum, and their work that of the energy") {
  const Scene scene = scene_from(std::string(kBlock) + R"(
boundaries: {bottom: {wall: sliding, position: 4 mm}, left: {piston: {times: [0 us, 200 us], values: [0 m/s, 3 m/s]}, position: 4 mm}}
method: {update: flip}
)",
                                 {{"bodies.0.velocity", "[0 m/s, 0 m/s]"}});
  Step<2> step(scene);
  const Vec<2> before = momentum(step.state().particles);
  const double energy = kinetic_energy(step.state().particles);
  advance(step, 400);
  Vec<2> impulse = Vec<2>::Zero();
  for (const auto& j : step.sums().boundary_impulse) impulse += j;
  const Vec<2> gained = momentum(step.state().particles) - before;
  CHECK((gained - impulse).norm() < 1e-12 * impulse.norm());
  const double work = step.sums().boundary_work;
  const double change = kinetic_energy(step.state().particles) + step.stored_energy() - energy;
  CHECK(work > 0);
  CHECK(change == doctest::Approx(work).epsilon(0.01));  // FLIP at CFL 0.5 from rest, no blow
}

TEST_CASE("whatever share of an approach particles take from a wall, their momentum and the impulse agree") {
  using Update = std::pair<const char*, const char*>;  // and every how many steps it filters
  for (const char* enforcement : {"nodes", "plane"})
    for (const Update& filter : {Update{"flip", "1"}, Update{"pic", "1"}, Update{"xpic(3)", "1"},
                                 Update{"xpic(3)", "5"}, Update{"fmpm(3)", "1"}, Update{"fmpm(3)", "5"}}) {
      CAPTURE(std::string(enforcement));
      const char *update = filter.first, *every = filter.second;
      CAPTURE(std::string(update));
      CAPTURE(std::string(every));
      const std::string at = std::string("at: ") + enforcement;
      const Scene scene =
          scene_from(std::string(kBlock) + "boundaries: {bottom: {piston: 2 m/s, position: 3.7 mm, " + at +
                         "}, left: {wall: sliding, position: 4 mm, " + at + "}}\n",
                     {{"method.strain", "average+"}, {"method.update", update}, {"method.every", every}});
      Step<2> step(scene);
      const Vec<2> before = momentum(step.state().particles);
      advance(step, 97);
      const Vec<2> impulse = step.sums().boundary_impulse[0] + step.sums().boundary_impulse[1];
      CHECK((momentum(step.state().particles) - before - impulse).norm() < 1e-12 * impulse.norm());
    }
}

/// What a block loses that a piston presses, over the work. It starts as the piston moves, without a blow.
double lost_at_walls(const char* enforcement) {
  const std::string at = std::string("at: ") + enforcement;
  const Scene scene =
      scene_from(std::string(kBlock) + "boundaries: {bottom: {wall: sliding, position: 4 mm, " + at +
                     "}, top: {piston: 6 m/s, position: 10 mm, " + at + "}}\n",
                 {{"method.strain", "average+"}, {"time.end", "0.9 ms"}});
  Step<2> step(scene);
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::velocity, 0)[p] = 0;
    particles.column(Quantity::velocity, 1)[p] = -1e3 * (particles.column(Quantity::position, 1)[p] - 4e-3);
  }
  const auto energy = [&] { return kinetic_energy(particles) + step.stored_energy(); };
  const double before = energy();
  advance(step, 200);
  const double work = step.sums().boundary_work;
  return 1 - (energy() - before) / work;
}

TEST_CASE("what FLIP's particles gain and store with `average+` is the work of the walls") {
  CHECK(std::abs(lost_at_walls("nodes")) < 0.0015);  // measured 0.0009; all of v_s: 0.0024
  CHECK(std::abs(lost_at_walls("plane")) < 0.0015);  // 0.0010; 0.0026
}

template <int Dim>
void check_rigid_floor(const std::string& yaml, double weight) {
  const Scene scene = scene_from(yaml);
  Step<Dim> step(scene);
  const auto floor_particles = by_id(step.state().particles, Quantity::position);
  // Two periods of the slowly loaded block's oscillation are averaged.
  while (step.state().time < 6e-3) step.advance(step.stable_dt());
  const Vec<Dim> start = step.sums().rigid_impulse[1];
  const double start_time = step.state().time;
  while (step.state().time < 12e-3) step.advance(step.stable_dt());
  const Vec<Dim> force = (step.sums().rigid_impulse[1] - start) / (step.state().time - start_time);
  CHECK(force[1] == doctest::Approx(-weight).epsilon(0.02));
  // At rest: the floor holds still under gravity, and so does what lies on it.
  CHECK(std::abs(step.state().particles.vector(Quantity::velocity, 0)[1]) < 2e-3);
  const auto moved = by_id(step.state().particles, Quantity::position);
  const std::size_t rigid_begin = moved.size() - 2;  // a particle of the floor, the last body
  CHECK(moved[rigid_begin] == floor_particles[rigid_begin]);
}

TEST_CASE("a block at rest on a rigid floor presses it with its weight") {
  const std::string common = R"(
time: {end: 1 s}
materials: {m: {model: linear_elastic, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.2}, floor: {model: rigid}}
contact: {law: coulomb, friction: 0.4}
method: {update: xpic(2)}
)";
  check_rigid_floor<2>(common + R"(
space: plane_strain
grid: {size: [24 mm, 20 mm], cell: 1 mm}
gravity: {acceleration: [0 m/s^2, -100 m/s^2], ramp: 4 ms}
bodies:
  - {name: block, box: {from: [8 mm, 4 mm], to: [14 mm, 10 mm]}, material: m}
  - {name: floor, box: {from: [4 mm, 2 mm], to: [18 mm, 4 mm]}, material: floor}
)",
                       1000 * 36e-6 * 100);
  check_rigid_floor<3>(common + R"(
space: 3d
grid: {size: [12 mm, 12 mm, 12 mm], cell: 1 mm}
gravity: {acceleration: [0 m/s^2, -100 m/s^2, 0 m/s^2], ramp: 4 ms}
bodies:
  - {name: block, box: {from: [4 mm, 4 mm, 4 mm], to: [8 mm, 8 mm, 8 mm]}, material: m}
  - {name: floor, box: {from: [2 mm, 2 mm, 2 mm], to: [10 mm, 4 mm, 10 mm]}, material: floor}
)",
                       1000 * 64e-9 * 100);
}

const char* const kRam = R"(
space: plane_strain
grid: {size: [30 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: rigid}}
bodies:
  - {name: a, box: {from: [8 mm, 4 mm], to: [12 mm, 8 mm]}, material: m}
  - {name: ram, box: {from: [4 mm, 3 mm], to: [8 mm, 9 mm]}, material: tool, velocity: [{times: [0 us, 100 us], values: [0 m/s, 10 m/s]}, 0 m/s]}
contact: {law: frictionless}
)";

TEST_CASE("a rigid body follows its table exactly and carries what it touches") {
  const Scene scene = scene_from(kRam);
  Step<2> step(scene);
  const auto start = by_id(step.state().particles, Quantity::position);
  while (step.state().time < 500e-6) step.advance(step.stable_dt());
  const double t = step.state().time, path = 10 * 50e-6 + 10 * (t - 100e-6);
  const auto end = by_id(step.state().particles, Quantity::position);
  CHECK(end[end.size() - 2] - start[start.size() - 2] == doctest::Approx(path).epsilon(1e-12));
  double least = 1;  // the block is ahead of the ram's face
  for (std::size_t p = 0; p < step.state().particles.size(); ++p)
    if (step.state().particles.body()[p] == 0)
      least = std::min(least, step.state().particles.column(Quantity::position, 0)[p]);
  CHECK(least > 8e-3 + path);
}

TEST_CASE("what a rigid body gives is what the others gain, with every update") {
  for (const char* update : {"flip", "pic", "xpic(2)", "xpic(5)", "uncorrected"}) {
    CAPTURE(std::string(update));
    const bool uncorrected = std::string(update) == "uncorrected";
    const Scene scene = scene_from(kRam, {{"method.update", uncorrected ? "xpic(3)" : update},
                                          {"method.contact_correction", uncorrected ? "false" : "true"}});
    Step<2> step(scene);
    while (step.state().time < 300e-6) step.advance(step.stable_dt());
    double gained = 0, kinetic = 0;
    const auto& particles = step.state().particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.body()[p] != 0) continue;
      gained += particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p)[0];
      kinetic +=
          0.5 * particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p).squaredNorm();
    }
    CHECK(gained > 0.1);
    CHECK(-step.sums().rigid_impulse[1][0] == doctest::Approx(gained).epsilon(1e-10));
    // The ram's work is the block's energy; filtered updates and the first blow may lose a part, none may
    // gain.
    CHECK(kinetic + step.stored_energy() < 1.01 * step.sums().boundary_work);
    CHECK(kinetic + step.stored_energy() > 0.7 * step.sums().boundary_work);
  }
}

TEST_CASE("a block between two rigid bodies on the same nodes is pushed by one and moves neither") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [20 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: rigid}}
bodies:
  - {name: floor, box: {from: [4 mm, 2 mm], to: [14 mm, 4 mm]}, material: tool}
  - {name: side, box: {from: [2 mm, 2 mm], to: [4 mm, 10 mm]}, material: tool}
  - {name: block, box: {from: [4 mm, 4 mm], to: [8 mm, 8 mm]}, material: m, velocity: [-3 m/s, -3 m/s]}
contact: {law: frictionless}
)");
  Step<2> step(scene);
  const auto start = by_id(step.state().particles, Quantity::position);
  const Vec<2> before = momentum(step.state().particles);
  advance(step, 200);
  const auto end = by_id(step.state().particles, Quantity::position);
  for (std::size_t i = 0; i < start.size(); ++i)
    if (i / 2 < 40 + 48) REQUIRE(end[i] == start[i]);  // the particles of the two rigid bodies come first
  const Vec<2> change = momentum(step.state().particles) - before;
  const Vec<2> given = -(step.sums().rigid_impulse[0] + step.sums().rigid_impulse[1]);
  CHECK((change - given).norm() < 1e-12 * change.norm());
  CHECK(change[0] > 0);
  CHECK(change[1] > 0);
}

TEST_CASE("each of two oblique boundaries pushes along its own direction only") {
  const Scene scene = scene_from(std::string(kBlock) + R"(
boundaries:
  first: {box: {from: [3 mm, 3 mm], to: [7 mm, 12 mm]}, direction: [1, 0.2], speed: 5 m/s}
  second: {box: {from: [5 mm, 3 mm], to: [9 mm, 12 mm]}, direction: [0.5, 1], speed: -4 m/s}
)");
  Step<2> step(scene);
  const Vec<2> before = momentum(step.state().particles);
  advance(step, 20);
  const Vec<2> first = Vec<2>(1, 0.2).normalized(), second = Vec<2>(0.5, 1).normalized();
  const auto& impulse = step.sums().boundary_impulse;
  const auto across = [](const Vec<2>& j, const Vec<2>& n) { return std::abs(j[0] * n[1] - j[1] * n[0]); };
  CHECK(across(impulse[0], first) < 1e-12 * impulse[0].norm());
  CHECK(across(impulse[1], second) < 1e-12 * impulse[1].norm());
  const Vec<2> change = momentum(step.state().particles) - before;
  CHECK((impulse[0] + impulse[1] - change).norm() < 1e-12 * impulse[0].norm());
}

TEST_CASE("a body's own acceleration acts on it alone, beside gravity and with its ramp") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 20 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: pulled, box: {from: [4 mm, 8 mm], to: [8 mm, 12 mm]}, material: m, acceleration: [300 m/s^2, 0 m/s^2]}
  - {name: falls, box: {from: [24 mm, 8 mm], to: [28 mm, 12 mm]}, material: m}
gravity: {acceleration: [0 m/s^2, -100 m/s^2], ramp: 1 ms}
)");
  Step<2> step(scene);
  while (step.state().time < 2e-3) step.advance(std::min(step.stable_dt(), 2e-3 - step.state().time));
  const auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {  // half of the ramp, then all
    const Vec<2> v = particles.vector(Quantity::velocity, p);
    CHECK(v[0] == doctest::Approx(particles.body()[p] == 0 ? 300 * 1.5e-3 : 0).epsilon(1e-6).scale(1));
    CHECK(v[1] == doctest::Approx(-100 * 1.5e-3).epsilon(1e-6));
  }
  const double mass = 1000 * 16e-6, kinetic = 0.5 * mass * (0.45 * 0.45 + 2 * 0.15 * 0.15);
  CHECK(step.sums().body_force_work == doctest::Approx(kinetic).epsilon(1e-6));
}

TEST_CASE("accelerations are refused of rigid bodies, and where one velocity field would have two") {
  const std::string head = R"(
space: plane_strain
grid: {size: [40 mm, 20 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1, bulk: 1, shear: 1}, r: {model: rigid}}
bodies:
  - {name: a, box: {from: [4 mm, 8 mm], to: [8 mm, 12 mm]}, material: m}
  - {name: b, box: {from: [24 mm, 8 mm], to: [28 mm, 12 mm]}, acceleration: [1 m/s^2, 0 m/s^2], )";
  CHECK_THROWS_WITH(scene_from(head + "material: r}\n"), doctest::Contains("moves as it is told"));
  CHECK_THROWS_WITH(scene_from(head + "material: m, field: a}\n"), doctest::Contains("another acceleration"));
  CHECK_THROWS_WITH(scene_from(head + "material: m}\ncontact: none\n"),
                    doctest::Contains("another acceleration"));
  CHECK_NOTHROW(scene_from(head + "material: m}\n"));
}

}  // namespace
}  // namespace mpmfast
