// Particles that leave the grid: the run goes on without them, or walls keep them.

#include <omp.h>

#include <nlohmann/json.hpp>

#include "tests/scattered.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

TEST_CASE("what leaves is booked: mass and momentum to round-off, and the energy balance counts it") {
  for (const char* method :
       {"{update: flip}", "{basis: lcpdi, update: xpic(2)}", "{basis: bspline2, update: apic}"}) {
    CAPTURE(std::string(method));
    const Outcome outcome = run(scene_from(kScattered, {{"method", method}, {"grid.cell", "0.5 mm"}}));
    REQUIRE(outcome.failure.empty());
    const History& h = outcome.history;
    REQUIRE(h.at("time_s").size() == 26);
    const std::size_t last = 25;
    CHECK(h.at("outflow_kg")[0] == 0);
    CHECK(h.at("stone.mass_kg")[last] == 0);  // all of it: the run goes on
    CHECK(h.at("rock.mass_kg")[last] == h.at("rock.mass_kg")[0]);
    CHECK(h.at("outflow_kg")[last] == doctest::Approx(h.at("stone.mass_kg")[0]).epsilon(1e-8));
    bool in_part = false;
    for (std::size_t k = 0; k <= last; ++k) {
      const double mass = h.at("stone.mass_kg")[k] + h.at("outflow_kg")[k];
      CHECK(mass == doctest::Approx(h.at("stone.mass_kg")[0]).epsilon(1e-8));
      in_part |= h.at("outflow_kg")[k] > 0 && h.at("stone.mass_kg")[k] > 0;
      for (const char* axis : {"x", "y"}) {
        const auto total = [&](std::size_t row) {
          return h.at(std::string("momentum_") + axis)[row] +
                 h.at(std::string("outflow_momentum_") + axis)[row];
        };
        CHECK(std::abs(total(k) - total(0)) < 1e-7 * std::abs(h.at("momentum_x")[0]));  // nine digits
      }
    }
    CHECK(in_part);
    CHECK(outcome.summary.outflow->particles > 400);
    CHECK(std::abs(outcome.summary.energy_error) < 0.02);
  }
}

TEST_CASE("the energy that leaves is that of the particles: of a free flight all of it, to round-off") {
  const Scene scene = scene_from(kScattered, {{"bodies.1",
                                               "{name: rock, disk: {centre: [18 mm, 8 mm], radius: 1 mm}, "
                                               "material: m}"}});
  const Outcome outcome = run(scene);
  REQUIRE(outcome.failure.empty());
  CHECK(outcome.history.at("kinetic_J").back() < 1e-6 * outcome.history.at("kinetic_J").front());
  CHECK(outcome.history.at("outflow_J").back() ==
        doctest::Approx(outcome.history.at("kinetic_J").front()).epsilon(1e-7));
}

TEST_CASE("the ids of those that stay are theirs for good, and the particles that stay are not touched") {
  const Scene scene = scene_from(kScattered);
  Step<2> step(scene);
  std::map<std::uint32_t, std::uint16_t> body;
  const auto& particles = step.state().particles;
  const std::size_t seeded = particles.size();
  for (std::size_t p = 0; p < seeded; ++p) body[particles.id()[p]] = particles.body()[p];
  std::size_t before = seeded;
  int departures = 0;
  while (step.state().time < scene.time.end) {
    advance(step, 1);
    if (particles.size() == before) continue;
    ++departures;
    before = particles.size();
    REQUIRE(particles.size() + step.sums().outflow.particles == seeded);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      REQUIRE(body.at(particles.id()[p]) == particles.body()[p]);
      REQUIRE(particles.column(Quantity::mass)[p] > 0);
      REQUIRE(particles.vector(Quantity::position, p)[0] > -0.25e-3);
    }
  }
  CHECK(departures > 5);
  CHECK(step.stored_energy() > -1e-12);
}

TEST_CASE("a run that is stopped while particles leave goes on to the bit") {
  const Scene scene = scene_from(kScattered, {{"bodies.1.velocity", "[60 m/s, 0]"}});
  const Folder folder;
  RunOptions options;
  options.folder = folder / "whole";
  const RunSummary whole = run_scene(scene, options);
  CHECK(whole.outflow->particles > 2000);
  // Stops before, amid and after; two in a row, so that one lies right after a departure.
  for (std::uint64_t stop :
       {whole.steps / 10, whole.steps / 5, whole.steps / 5 + 1, whole.steps / 2, whole.steps - 2}) {
    if (sanitized() && stop != whole.steps / 5) continue;
    CAPTURE(stop);
    RunOptions first;
    first.folder = folder / "stopped";
    first.force = true;
    first.max_steps = stop;
    run_scene(scene, first);
    RunOptions next;
    next.folder = first.folder;
    next.threads = 3;
    const auto resumed = resume_run(next);
    REQUIRE(resumed);
    CHECK(resumed->checksum == whole.checksum);
    CHECK(resumed->outflow->energy == whole.outflow->energy);
    CHECK(read_history(folder / "stopped/history.csv") == read_history(folder / "whole/history.csv"));
  }
}

TEST_CASE("a run ends well when all particles have left, in 3-D too and with a rigid body among them") {
  for (const char* space : {"plane_strain", "3d"}) {
    const bool solid = std::string(space) == "3d";
    const std::string z = solid ? ", 0]" : "]", top = solid ? ", 2 mm]" : "]", still = solid ? ", 0]" : "]";
    const Scene scene =
        scene_from(std::string("space: ") + space + R"(
time: {end: 300 us}
materials:
  m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  tool: {model: rigid}
output: {frames: 2, history: 10}
grid: {cell: 1 mm, leaving: outflow, size: [8 mm, 6 mm)" +
                   top + R"(}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm)" +
                   z + ", to: [4 mm, 4 mm" + top + "}, material: m, velocity: [60 m/s, 0" + still + R"(}
  - {name: b, box: {from: [5 mm, 2 mm)" +
                   z + ", to: [6 mm, 4 mm" + top + "}, material: tool, velocity: [90 m/s, 0" + still + "}\n");
    const Outcome outcome = run(scene);
    CHECK(outcome.failure == "");
    CHECK(outcome.summary.status == "finished");
    CHECK(outcome.summary.particles == 0);
    CHECK(outcome.summary.particle_steps_per_second > 0);
    CHECK(outcome.summary.time == doctest::Approx(scene.time.end));
    CHECK(outcome.history.at("b.mass_kg").back() == 0);
    // The rigid body moved as it was told: it took no free mass along.
    CHECK(outcome.history.at("outflow_kg").back() ==
          doctest::Approx(outcome.history.at("a.mass_kg").front()));
  }
}

TEST_CASE("a tube leaves an axisymmetric grid along its axis with all that it has") {
  const Scene scene = scene_from(R"(
space: axisymmetric
grid: {size: [5 mm, 8 mm], cell: 0.5 mm, leaving: outflow}
time: {end: 150 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: tube, box: {from: [1 mm, 4 mm], to: [2 mm, 6 mm]}, material: m, velocity: [0, 60 m/s]}]
output: {frames: 0, history: 10}
)");
  const Outcome outcome = run(scene);
  REQUIRE(outcome.failure.empty());
  const History& h = outcome.history;
  CHECK(h.at("outflow_kg").back() == doctest::Approx(h.at("tube.mass_kg").front()));
  CHECK(h.at("outflow_momentum_y").back() == doctest::Approx(h.at("momentum_y").front()));
  CHECK(h.at("outflow_J").back() == doctest::Approx(h.at("kinetic_J").front()));
}

TEST_CASE("what is not a number does not flow out") {
  const Scene scene = scene_from(kScattered);
  Step<2> step(scene);
  advance(step, 2);
  step.state().particles.column(Quantity::velocity)[5] = std::nan("");
  CHECK_THROWS_WITH_AS(advance(step, 2), doctest::Contains("not a number any more"), RunFailure);
}

TEST_CASE("walls on the faces that a scene says nothing of keep particles in") {
  const Scene scene =
      scene_from(kScattered, {{"grid.leaving", "wall"}, {"boundaries", "{top: fixed, right: free}"}});
  REQUIRE(scene.boundaries.size() == 3);
  CHECK(scene.boundaries[0].name == "top");
  CHECK(scene.boundaries[1].name == "left");
  CHECK(scene.boundaries[2].name == "bottom");
  const auto& wall = std::get<WallSpec>(scene.boundaries[1].condition);
  CHECK(wall.axis == 0);
  CHECK_FALSE(wall.upper);
  CHECK_FALSE(wall.fixed);
  CHECK(wall.position == 0);
  CHECK(parse_scene(scene.resolved_yaml, "test.yaml").resolved_yaml == scene.resolved_yaml);

  const Outcome outcome = run(scene);
  REQUIRE(outcome.failure.empty());
  CHECK(outcome.summary.particles > 1000);
  CHECK(outcome.history.at("stone.vx").front() < -50);
  CHECK(outcome.history.at("stone.vx").back() > 10);  // it bounced off the left wall
  CHECK_FALSE(outcome.history.contains("outflow_kg"));
  const Scene stopped = scene_from(kScattered, {{"grid.leaving", "stop"}});
  CHECK(stopped.boundaries.empty());
  CHECK(run(stopped).failure.find("left the grid") != std::string::npos);
}

TEST_CASE("a rigid body must not be called as a wall that the grid makes") {
  const std::string yaml = R"(
space: plane_strain
grid: {size: [8 mm, 6 mm], cell: 1 mm, leaving: wall}
time: {end: 1 us}
materials: {m: {model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: rigid}}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [4 mm, 4 mm]}, material: m}
  - {name: top, box: {from: [5 mm, 2 mm], to: [6 mm, 4 mm]}, material: tool}
)";
  CHECK_THROWS_WITH_AS(scene_from(yaml), doctest::Contains("a rigid body is called 'top'"), SceneError);
  CHECK_THROWS_WITH_AS(scene_from(yaml, {{"grid.leaving", "gone"}}), doctest::Contains("grid.leaving"),
                       SceneError);
}

}  // namespace
}  // namespace mpmfast
