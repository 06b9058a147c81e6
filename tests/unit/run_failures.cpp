// A run that fails says when, where and why, and keeps what was written.

#include <nlohmann/json.hpp>

#include <fstream>

#include "engine/output/read_vtu.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kThrown = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: missile, box: {from: [2 mm, 4 mm], to: [4 mm, 6 mm]}, material: m, velocity: [40 m/s, 0 m/s]}]
output: {frames: 2, history: 10}
)";

struct Failed {
  std::string message;
  std::vector<std::string> warnings;
  nlohmann::json summary;
  History history;
  bool pictures = false;
};

Failed run_to_failure(const Scene& scene, const Folder& folder = {}) {
  RunOptions options;
  options.folder = folder / "run";
  options.force = true;
  Failed failed;
  try {
    run_scene(scene, options);
  } catch (const RunFailure& failure) {
    failed.message = failure.what();
    failed.warnings = failure.warnings();
  }
  std::ifstream file(options.folder / "run.json");
  failed.summary = nlohmann::json::parse(file);
  failed.history = read_history(options.folder / "history.csv");
  failed.pictures = std::filesystem::exists(options.folder / "picture_last_body.png");
  return failed;
}

TEST_CASE("a particle that leaves the grid ends the run with step, time, particle, body, field and place") {
  const Failed failed = run_to_failure(scene_from(kThrown));
  for (const char* part :
       {"step ", "time ", "particle ", "'missile'", "velocity field", "(0.011", "left the grid"}) {
    CAPTURE(std::string(part));
    CHECK(failed.message.find(part) != std::string::npos);
  }
  CHECK(failed.summary["status"] == "failed");
  CHECK(failed.summary["reason"] == failed.message);
  CHECK(failed.history.at("time_s").size() >= 2);
  // 6 mm and a cell to go at 40 m/s; the last whole row lies before that.
  CHECK(failed.history.at("time_s").back() == doctest::Approx(1e-4).epsilon(0.05));
  CHECK(failed.summary["time_s"].get<double>() == doctest::Approx(7e-3 / 40).epsilon(0.1));
  CHECK(failed.summary["energy_error"].is_number());
  CHECK(failed.summary.contains("scene_hash"));
  CHECK(failed.pictures);
}

TEST_CASE("a way out that the scene has taken already is not named") {
  CHECK(run_to_failure(scene_from(kThrown)).message.find("grid.leaving") != std::string::npos);
  const Failed failed =
      run_to_failure(scene_from(kThrown, {{"grid.leaving", "wall"}, {"boundaries", "{right: free}"}}));
  CHECK(failed.message.find("left the grid") != std::string::npos);
  CHECK(failed.message.find("grid.leaving") == std::string::npos);
}

/// A strip between two grips that draw it out until they leave the grid.
const char* const kDrawn = R"(
space: plane_strain
grid: {size: [24 mm, 6 mm], cell: 1 mm}
time: {end: 4 ms}
materials:
  rubber: {model: logarithmic_neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
  grip: {model: rigid}
bodies:
  - {name: strip, box: {from: [9 mm, 2 mm], to: [15 mm, 4 mm]}, material: rubber}
  - {name: l, box: {from: [7 mm, 1 mm], to: [9 mm, 5 mm]}, material: grip, velocity: [-4 m/s, 0]}
  - {name: r, box: {from: [15 mm, 1 mm], to: [17 mm, 5 mm]}, material: grip, velocity: [4 m/s, 0]}
contact: {law: perfect}
output: {frames: 0, history: 20}
)";

TEST_CASE("a failure carries the warnings of its run, that of a body which parts before all") {
  const Failed failed = run_to_failure(scene_from(kDrawn));
  REQUIRE(failed.message.find("left the grid") != std::string::npos);
  REQUIRE_FALSE(failed.warnings.empty());
  CHECK(failed.warnings[0].find("particles of body 'strip' came ") == 0);
  CHECK(failed.warnings[0].find("split: {edge: 1.5}") != std::string::npos);
  CHECK(failed.summary["warnings"] == failed.warnings);
}

TEST_CASE("failed.vtu holds the particles within four cells of the one that failed, and it") {
  const Scene scene =
      scene_from(kThrown, {{"bodies.0.box", "{from: [2 mm, 1 mm], to: [4 mm, 9 mm]}"},
                           {"bodies.0.particles_per_cell", "[1, 1]"}});  // ids 0 … 15, row by row from below
  const Folder folder;
  const Failed failed = run_to_failure(scene, folder);
  REQUIRE(failed.message.find("particle 1 of body 'missile'") != std::string::npos);
  const VtuReader file(folder / "run" / "failed.vtu");
  const auto points = file.points();
  const auto id = file.read<std::uint32_t>("id");
  CHECK(id == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});  // rows 1 mm apart
  REQUIRE(points.size() == 3 * id.size());
  for (std::size_t k = 0; k < points.size(); k += 3) {
    CHECK(std::abs(points[k] - points[3]) <= 4e-3);
    CHECK(std::abs(points[k + 1] - points[4]) <= 4e-3);
  }
  CHECK(points[3] > 11e-3);
  CHECK(file.read<float>("velocity")[3] == doctest::Approx(40));
  CHECK(file.read<float>("stress").size() == 6 * id.size());
  CHECK(file.read<double>("deformation_gradient").size() == 9 * id.size());
  CHECK_FALSE(std::filesystem::exists(folder / "run" / "failed.vtu.tmp"));
}

TEST_CASE("a neighbourhood that cannot be written does not hide the failure") {
  const Folder folder;
  std::filesystem::create_directories(folder / "run/failed.vtu/taken");
  std::ofstream(folder / "run/run.log") << "of a run before\n";
  const Failed failed = run_to_failure(scene_from(kThrown), folder);
  CHECK(failed.message.find("left the grid") != std::string::npos);
  CHECK(failed.summary["reason"] == failed.message);
  CHECK(failed.pictures);
}

TEST_CASE("a run that goes on from before its failure leaves none of the old neighbourhood") {
  const Folder folder;
  const auto steps = run_to_failure(scene_from(kThrown)).summary["steps"].get<std::uint64_t>();
  const std::string checkpoint = "{steps: " + std::to_string(steps - 2) + "}";
  run_to_failure(scene_from(kThrown, {{"output.checkpoint", checkpoint}}), folder);
  REQUIRE(std::filesystem::exists(folder / "run/failed.vtu"));
  RunOptions options;
  options.folder = folder / "run";
  options.max_steps = steps - 1;
  REQUIRE(resume_run(options));
  CHECK_FALSE(std::filesystem::exists(folder / "run/failed.vtu"));
}

/// A block and one that it presses on.
const char* const kBlocks = R"(
space: plane_strain
grid: {size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: left, box: {from: [2 mm, 2 mm], to: [8 mm, 10 mm]}, material: m, velocity: [20 m/s, 1 m/s]}
  - {name: right, box: {from: [8 mm, 2 mm], to: [14 mm, 10 mm]}, material: m, velocity: [-20 m/s, 0 m/s]}
contact: {law: coulomb, friction: 0.3}
)";

/// Spoils a particle in the middle of the left block and says how the run fails within two steps.
template <int Dim>
void check_caught(const Scene& scene, Quantity column) {
  Step<Dim> step(scene);
  advance(step, 3);
  auto& particles = step.state().particles;
  std::size_t victim = 0;
  const auto middle = [](const Vec<Dim>& x) {
    Vec<Dim> from = x;
    from[0] -= 5e-3;
    from[1] -= 6e-3;
    if constexpr (Dim == 3) from[2] -= 2e-3;
    return from.norm();
  };
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (middle(particles.vector(Quantity::position, p)) <
        middle(particles.vector(Quantity::position, victim)))
      victim = p;
  const Vec<Dim> position = particles.vector(Quantity::position, victim);
  particles.column(column, Particles<Dim>::components(column) - 1)[victim] = std::nan("");
  std::string message;
  RunFailure::Position where{};
  try {
    advance(step, 2);
  } catch (const RunFailure& failure) {
    message = failure.what();
    REQUIRE(failure.position());
    where = *failure.position();
  }
  CAPTURE(message);
  CHECK(message.find("of body 'left'") != std::string::npos);
  CHECK(message.find("not a number any more") != std::string::npos);
  for (int d = 0; d < Dim; ++d) CHECK(std::abs(where[static_cast<std::size_t>(d)] - position[d]) < 2.5e-3);
  // What failed.vtu is made from is finite everywhere.
  for (std::size_t p = 0; p < particles.size(); ++p) REQUIRE(step.position_of(p).allFinite());
}

TEST_CASE(
    "a number that is none is caught within two steps, near where it began, in every basis and update") {
  for (const BasisFacts& basis : kBasisFacts)
    for (const char* update : {"flip", "pic", "xpic(2)", "fmpm(3)", "apic"})
      for (const char* strain : {"first", "last", "average"}) {
        if (std::string(update) == "apic" && basis.spread == 0) continue;
        CAPTURE(std::string(basis.keyword));
        CAPTURE(std::string(update));
        CAPTURE(std::string(strain));
        const Scene scene =
            scene_from(kBlocks, {{"method", "{basis: " + std::string(basis.keyword) + ", update: " + update +
                                                ", strain: " + strain + "}"}});
        check_caught<2>(scene, Quantity::velocity);
        check_caught<2>(scene, Quantity::deformation_gradient);
        // Strain first makes a stress of this law anew before anyone reads it.
        if (std::string(strain) == "last") check_caught<2>(scene, Quantity::kirchhoff_stress);
      }
}

TEST_CASE("a number that is none is caught in 3-D, and in a metal's elastic strain") {
  const Scene solid = scene_from(
      kBlocks,
      {{"space", "3d"},
       {"grid", "{size: [16 mm, 12 mm, 4 mm], cell: 1 mm}"},
       {"bodies.0", "{name: left, box: {from: [2 mm, 2 mm, 0], to: [8 mm, 10 mm, 4 mm]}, material: m}"},
       {"bodies.1", "{name: right, box: {from: [8 mm, 2 mm, 0], to: [14 mm, 10 mm, 4 mm]}, material: m}"}});
  check_caught<3>(solid, Quantity::velocity);
  check_caught<3>(solid, Quantity::deformation_gradient);
  const Scene metal =
      scene_from(kBlocks, {{"materials.m",
                            "{model: j2_plasticity, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, "
                            "yield: 1 MPa, hardening: 1 MPa}"}});
  check_caught<2>(metal, Quantity::elastic_strain);
}

TEST_CASE("the neighbourhood of particles without a place holds finite points") {
  const Scene scene =
      scene_from(kBlocks, {{"grid", "{origin: [-5 mm, -4 mm], size: [21 mm, 16 mm], cell: 1 mm}"}});
  Step<2> step(scene);
  advance(step, 2);
  auto& particles = step.state().particles;
  const Vec<2> position = particles.vector(Quantity::position, 77);
  for (int d = 0; d < 2; ++d) particles.column(Quantity::position, d)[77] = std::nan("");
  CHECK((step.position_of(77) - position).norm() < 2.5e-3);
  std::vector<Vec<2>> positions;
  for (std::size_t p = 0; p < particles.size(); ++p) positions.push_back(step.position_of(p));
  const Folder folder;
  write_neighbourhood(folder / "failed.vtu", particles, scene, positions, step.position_of(77), 4e-3, 0.5);
  const VtuReader file(folder / "failed.vtu");
  const auto points = file.points();
  const auto id = file.read<std::uint32_t>("id");
  CHECK(std::find(id.begin(), id.end(), particles.id()[77]) != id.end());
  CHECK(points.size() < 3 * particles.size());
  for (double x : points) REQUIRE(std::isfinite(x));
}

/// Falls so hard that the particles' speed soon rules the time step.
const char* const kFalling = R"(
space: plane_strain
grid: {size: [4 mm, 100 mm], cell: 1 mm}
time: {end: 120 us, collapse: 0.5}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: stone, box: {from: [1 mm, 96 mm], to: [3 mm, 98 mm]}, material: m}]
gravity: [0, -1e7]
output: {frames: 0, history: 2}
)";

TEST_CASE("a time step that collapses ends the run with the particle that holds it, its speed and J") {
  const Scene scene = scene_from(kFalling);
  const Failed failed = run_to_failure(scene);
  for (const char* part : {"step ", "time ", "of body 'stone'", " at (", "the time step collapsed to",
                           "of the first", "time.collapse", "m/s", "J = 1"}) {
    CAPTURE(std::string(part));
    CHECK(failed.message.find(part) != std::string::npos);
  }
  CHECK(failed.summary["status"] == "failed");
  CHECK(failed.summary["dt_min_s"].get<double>() >= 0.5 * failed.summary["dt_max_s"].get<double>());
  CHECK(failed.summary["dt_min_s"].get<double>() < 0.6 * failed.summary["dt_max_s"].get<double>());
  const Outcome off = run(scene_from(kFalling, {{"time.collapse", "0"}}));
  CHECK(off.failure.empty());
  CHECK(off.summary.dt_min < 0.5 * off.summary.dt_max);
  CHECK(run(scene_from(kFalling, {{"time.collapse", "0.001"}})).failure.empty());
}

TEST_CASE("a run that goes on measures its time step against the first of all") {
  const Folder folder;
  const Failed whole = run_to_failure(scene_from(kFalling));
  RunOptions options;
  options.folder = folder / "run";
  options.max_steps = whole.summary["steps"].get<std::uint64_t>() - 3;
  run_scene(scene_from(kFalling), options);
  RunOptions next;
  next.folder = options.folder;
  CHECK_THROWS_WITH_AS(resume_run(next), whole.message.c_str(), RunFailure);
}

TEST_CASE("a particle that is turned inside out is named") {
  const Scene scene =
      scene_from(kThrown, {{"boundaries", "{right: {piston: 4000 m/s, direction: left, position: 6 mm}}"},
                           {"time.cfl", "1"},
                           {"method.deformation_terms", "1"}});
  const Failed failed = run_to_failure(scene);
  CHECK(failed.message.find("particle ") != std::string::npos);
  CHECK(failed.summary["status"] == "failed");
}

TEST_CASE("a body without particles, or one outside the grid, is a scene error before anything is written") {
  const auto dust = [](const std::string& centre) {
    return scene_from(kThrown, {{"bodies.0", "{name: dust, disk: {centre: " + centre +
                                                 ", radius: 0.001 mm}, material: m}"}});
  };
  const Scene empty = dust("[5.01 mm, 5.01 mm]");
  CHECK_THROWS_AS(Step<2>{empty}, SceneError);
  CHECK_THROWS_AS(dust("[15 mm, 5 mm]"), SceneError);
}

}  // namespace
}  // namespace mpmfast
