// How long steps are, what a push between two of them does, and how long they take.

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "engine/step/clock.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kBlock = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: block, box: {from: [2 mm, 4 mm], to: [6 mm, 6 mm]}, material: m, velocity: [4 m/s, -3 m/s]}]
)";

TEST_CASE("what is left of the time is one step, or two that are alike, or more than two") {
  const Scene scene = scene_from(kBlock);
  const Step<2> step(scene);
  const double stable = step.stable_dt();
  CHECK(step.dt_towards(0.7 * stable, stable) == 0.7 * stable);
  CHECK(step.dt_towards(stable, stable) == stable);
  CHECK(step.dt_towards(1.5 * stable, stable) == 0.75 * stable);
  CHECK(step.dt_towards(1.99 * stable, stable) == doctest::Approx(0.995 * stable).epsilon(1e-12));
  CHECK(step.dt_towards(2.1 * stable, stable) == stable);
}

TEST_CASE("a step is as long as what is fastest lets it be: waves, or a rigid body, however slow all are") {
  // Waves in what is so soft run at 0.3 m/s.
  const std::string soft = R"(
space: plane_strain
grid: {size: [20 mm, 10 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials:
  jelly: {model: neo_hookean, density: 1000 kg/m^3, bulk: 50 Pa, shear: 30 Pa}
  hard: {model: rigid}
bodies:
  - {name: block, box: {from: [2 mm, 4 mm], to: [6 mm, 6 mm]}, material: jelly}
)";
  const std::string plate =
      "  - {name: plate, box: {from: [8 mm, 2 mm], to: [16 mm, 6 mm]}, material: hard, ";
  const double waves = std::sqrt((50 + 4.0 / 3 * 30) / 1000);
  const auto fastest = [](const std::string& yaml) {
    const Scene scene = scene_from(yaml);
    return 0.4 * 1e-3 / Step<2>(scene).stable_dt();
  };
  CHECK(fastest(soft) == doctest::Approx(waves).epsilon(1e-9));
  CHECK(fastest(soft + plate + "velocity: [0.1 m/s, 0 m/s]}\n") == doctest::Approx(waves).epsilon(1e-9));
  CHECK(fastest(soft + plate + "velocity: [0.3 m/s, 0.4 m/s]}\n") == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(fastest(soft + plate + "velocity: [[[0 s, 0 m/s], [1 s, 0.7 m/s]], 0]}\n") ==
        doctest::Approx(0.7).epsilon(1e-9));
  // Of the particles at quarters of the cells the farthest are 3.75 mm and 1.75 mm from the middle.
  CHECK(fastest(soft + plate +
                "velocity: [0.3 m/s, 0 m/s], rotation: {about: [12 mm, 4 mm], speed: -100 rad/s}}\n") ==
        doctest::Approx(0.3 + 100e-3 * std::hypot(3.75, 1.75)).epsilon(1e-9));
}

TEST_CASE("a push between two steps does the work that the particles gain") {
  const Scene scene = scene_from(kBlock);
  Step<2> step(scene);
  advance(step, 2);
  auto& particles = step.state().particles;
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < particles.size(); ++p)
      sum +=
          0.5 * particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p).squaredNorm();
    return sum;
  };
  std::vector<double> change(particles.size());
  for (std::size_t p = 0; p < change.size(); ++p) change[p] = 0.1 * static_cast<double>(p % 7) - 0.2;
  for (const int axis : {0, 1}) {
    const double before = kinetic(), work = step.sums().body_force_work;
    std::vector<Vec<2>> expected;
    for (std::size_t p = 0; p < change.size(); ++p) {
      expected.push_back(particles.vector(Quantity::velocity, p));
      expected.back()[axis] += change[p];
    }
    step.add_velocity(axis, change);
    CHECK(step.sums().body_force_work - work == doctest::Approx(kinetic() - before).epsilon(1e-12));
    for (std::size_t p = 0; p < change.size(); ++p)
      CHECK(particles.vector(Quantity::velocity, p) == expected[p]);
  }
}

TEST_CASE("a push of any one particle makes the stable step as short as its speed then asks") {
  const Scene scene = scene_from(kBlock);
  Step<2> step(scene);
  advance(step, 1);
  auto& particles = step.state().particles;
  double push = 1000;  // m/s: faster than waves, and each push than the one before
  for (const std::size_t p : {std::size_t{0}, particles.size() / 2, particles.size() - 1})
    for (const int axis : {0, 1}) {
      CAPTURE(p);
      CAPTURE(axis);
      std::vector<double> change(particles.size(), 0);
      change[p] = push *= 2;
      step.add_velocity(axis, change);
      const double fastest =
          particles.column(Quantity::wave_speed)[p] + particles.vector(Quantity::velocity, p).norm();
      CHECK(fastest > push);
      CHECK(step.stable_dt() == doctest::Approx(scene.time.cfl * scene.grid.cell / fastest).epsilon(1e-14));
    }
}

double of(const StepClock& clock, Timer timer) { return clock.seconds()[static_cast<std::size_t>(timer)]; }

TEST_CASE("a clock gives each second to the innermost task that runs, also where one fails") {
  StepClock clock;
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const auto start = std::chrono::steady_clock::now();
  {
    const auto heat = clock.enter(Task::heat);
    wait();
    {
      const auto sort = clock.enter(Task::sort);
      wait();
    }
    wait();
  }
  wait();
  const double heat = of(clock, Timer::heat), sort = of(clock, Timer::sort);
  CHECK(heat >= 4e-3);
  CHECK(sort >= 2e-3);
  const auto fails = [&] {
    const auto timed = clock.enter(Task::update);
    wait();
    throw std::runtime_error("in a task");
  };
  CHECK_THROWS_AS(fails(), std::runtime_error);
  wait();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  CHECK(of(clock, Timer::update) >= 2e-3);
  CHECK(of(clock, Timer::heat) == heat);
  CHECK(heat + sort + of(clock, Timer::update) <= wall - 4e-3);
  for (std::size_t k = 0; k < kTimerNames.size(); ++k)
    if (const auto timer = static_cast<Timer>(k);
        timer != Timer::heat && timer != Timer::sort && timer != Timer::update)
      CHECK(clock.seconds()[k] == 0);
}

TEST_CASE("a clock tells the tasks of a step in the order in which they were entered first") {
  StepClock clock;
  for (const Task task : {Task::update, Task::sort, Task::update, Task::grow_cracks}) (void)clock.enter(task);
  CHECK(std::ranges::equal(clock.tasks(), std::array{Task::update, Task::sort, Task::grow_cracks}));
  clock.begin_step();
  CHECK(clock.tasks().empty());
  (void)clock.enter(Task::sort);
  CHECK(std::ranges::equal(clock.tasks(), std::array{Task::sort}));
}

TEST_CASE("tasks take no longer than the steps, and those that a scene lacks take no time") {
  const Scene scene = scene_from(kBlock, {{"method", "{update: flip}"}});
  Step<2> step(scene);
  const auto start = std::chrono::steady_clock::now();
  advance(step, 20);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  double sum = 0;
  for (const double seconds : step.clock().seconds()) {
    CHECK(seconds >= 0);
    sum += seconds;
  }
  CHECK(sum <= wall);
  for (const Timer timer : {Timer::sort, Timer::project, Timer::strain_force, Timer::nodes, Timer::update})
    CHECK(of(step.clock(), timer) > 0);
  for (const Timer timer : {Timer::extension, Timer::surfaces, Timer::contact_nodes, Timer::contact_resolve,
                            Timer::xpic, Timer::heat})
    CHECK(of(step.clock(), timer) == 0);
}

}  // namespace
}  // namespace mpmfast
