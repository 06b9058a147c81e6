// The shared library through its one header, as another program has it.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/library/simulation.hpp"

namespace {

using namespace mpmfast;

const char* const kScene = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 100 us}
materials: {soft: {model: neo_hookean, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies:
  - {name: left, box: {from: [1 mm, 2 mm], to: [4 mm, 6 mm]}, material: soft, velocity: [5, 0]}
  - {name: right, box: {from: [5 mm, 2 mm], to: [8 mm, 6 mm]}, material: soft}
output: {frames: 0, picture: none}
)";

Simulation simulation_of(const Settings& settings = {}, int threads = 0) {
  return Simulation::from_text(kScene, ".", settings, threads);
}

/// A folder that is removed, with the scene in it.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "mpmfast_library_test";
  std::filesystem::path scene = path / "scene.yaml";
  Folder() {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
    std::ofstream(scene) << kScene;
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

template <class F>
Error::Kind kind_of(F f) {
  try {
    f();
  } catch (const Error& error) {
    return error.kind();
  }
  FAIL("no Error was thrown");
  return {};
}

TEST_CASE("steps one by one are those of one way to the end, and end with it") {
  Simulation by_steps = simulation_of(), at_once = simulation_of();
  double time = 0;
  while (!by_steps.finished()) time += by_steps.step();
  at_once.advance_to(at_once.end());
  CHECK(at_once.finished());
  CHECK(by_steps.steps() == at_once.steps());
  CHECK(by_steps.checksum() == at_once.checksum());
  CHECK(time == doctest::Approx(by_steps.end()));
  CHECK(by_steps.step() == 0);
  CHECK(by_steps.steps() == at_once.steps());
}

TEST_CASE("a way in ten parts takes ten, whatever round-off makes of its parts") {
  for (const char* end : {"100 us", "7 us", "0.3 ms"}) {
    Simulation simulation = simulation_of({{"time.end", end}});
    int parts = 0;
    for (int k = 1; !simulation.finished(); ++k, ++parts) simulation.advance_to(simulation.end() * k / 10);
    CHECK(parts == 10);
  }
}

TEST_CASE("a simulation has the threads that it is given, and the same bits on any number") {
  std::array<std::string, 2> checksums;
  for (int threads : {1, 3}) {
    Simulation simulation = simulation_of({{"grid.cell", "0.1 mm"}, {"time.end", "2 us"}}, threads);
    simulation.advance_to(simulation.end());
    checksums[threads == 1 ? 0 : 1] = simulation.checksum();
  }
  CHECK(checksums[0] == checksums[1]);
  CHECK(kind_of([] { simulation_of({}, -1); }) == Error::Kind::misuse);
  CHECK(kind_of([] { simulation_of({}, 1000000); }) == Error::Kind::misuse);
}

TEST_CASE("a call that makes no sense throws an Error") {
  Simulation simulation = simulation_of();
  CHECK(simulation.has_column("velocity.x"));
  CHECK_FALSE(simulation.has_column("velocity.z"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> too_few(3), wrong(simulation.particles(), nan), right(simulation.particles());
  CHECK(kind_of([&] { simulation.column("velocity.z"); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.unit("velocity.z"); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.advance(0); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.advance_to(nan); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.add_velocity(0, too_few); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.add_velocity(0, wrong); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { simulation.add_velocity(2, right); }) == Error::Kind::misuse);
}

TEST_CASE("a simulation that was moved from says so, and can be assigned to") {
  Simulation first = simulation_of();
  Simulation second = std::move(first);
  CHECK(second.particles() > 0);
  CHECK(kind_of([&] { first.time(); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { first.step(); }) == Error::Kind::misuse);
  CHECK(kind_of([&] { first.energies(); }) == Error::Kind::misuse);
  first = std::move(second);
  CHECK(first.particles() > 0);
}

TEST_CASE("what is likely a mistake in a scene is told") {
  CHECK(simulation_of().warnings().empty());
  const Settings heavy{{"materials.soft.density", "1000 g/cm^3"}};
  const Folder folder;
  const std::vector<std::string> warnings = Simulation(folder.scene, heavy).warnings();
  REQUIRE(!warnings.empty());
  std::vector<std::string> told;
  const Callbacks callbacks{.stop = {}, .warn = [&](const std::string& text) { told.push_back(text); }};
  const std::string json = run(folder.scene, folder.path / "out", heavy, false, 0, callbacks);
  REQUIRE(told.size() >= warnings.size());
  CHECK(std::equal(warnings.begin(), warnings.end(), told.begin()));
  CHECK(json.find("is no density of a solid") != std::string::npos);
}

TEST_CASE("whoever steps may stop, and a run that was stopped has a checkpoint") {
  const Settings endless{{"time.end", "100 s"}, {"bodies.0.velocity", "[0, 0]"}};
  Simulation simulation = simulation_of(endless);
  int asked = 0;
  simulation.advance_to(simulation.end(), [&] { return ++asked == 2; });
  CHECK(asked == 2);
  CHECK(simulation.steps() > 0);
  CHECK_FALSE(simulation.finished());
  const Folder folder;
  const std::string json =
      run(folder.scene, folder.path / "out", endless, false, 0, {.stop = [] { return true; }, .warn = {}});
  CHECK(json.find("\"status\": \"stopped\"") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path / "out" / "checkpoint.h5"));
}

TEST_CASE("a folder that is there is replaced by force only, and the message has the word") {
  const Folder folder;
  run(folder.scene, folder.path / "out");
  try {
    run(folder.scene, folder.path / "out");
    FAIL("it was replaced");
  } catch (const Error& error) {
    CHECK(error.kind() == Error::Kind::file);
    CHECK(std::string(error.what()).find("with force") != std::string::npos);
  }
  run(folder.scene, folder.path / "out", {}, true);
}

TEST_CASE("a way in parts says how many steps each part took, and none where the time is past") {
  Simulation simulation = simulation_of({{"time.end", "20 us"}});
  const std::uint64_t first = simulation.advance_to(0.4 * simulation.end());
  CHECK(first > 0);
  CHECK(first == simulation.steps());
  const std::uint64_t second = simulation.advance_to(simulation.end());
  CHECK(second > 0);
  CHECK(first + second == simulation.steps());
  CHECK(simulation.advance_to(0.5 * simulation.end()) == 0);
}

TEST_CASE("a column has the name and the unit of what it holds, a scalar no component") {
  const Simulation simulation = simulation_of();
  const std::vector<std::pair<std::string, std::string>> known{
      {"position.x", "m"},           {"velocity.y", "m/s"},     {"mass", "kg"},
      {"kirchhoff_stress.xy", "Pa"}, {"initial_volume", "m^3"}, {"deformation_gradient.yx", "-"}};
  for (const auto& column : known) {
    CAPTURE(column.first);
    REQUIRE(simulation.has_column(column.first));
    CHECK(simulation.unit(column.first) == column.second);
  }
  double mass = 0;
  for (const double m : simulation.column("mass")) mass += m;
  CHECK(mass == doctest::Approx(1000 * 2 * 3e-3 * 4e-3));  // two bodies, a metre thick
  const std::vector<std::string> columns = simulation.columns();
  const auto of_mass = [](const std::string& name) { return name.rfind("mass", 0) == 0; };
  CHECK(std::count_if(columns.begin(), columns.end(), of_mass) == 1);
}

TEST_CASE(
    "a body in flight has its kinetic energy and no other, and energies are none until they are known") {
  Simulation simulation = simulation_of({{"time.end", "20 us"}});
  const auto others = [](const Energies& e) {
    return std::abs(e.stored) + std::abs(e.friction) + std::abs(e.dissipated) + std::abs(e.boundary_work) +
           std::abs(e.body_force_work);
  };
  const double kinetic = 0.5 * 1000 * 3e-3 * 4e-3 * 5 * 5;  // J, of the left one
  for (const bool at_start : {true, false}) {
    if (!at_start) simulation.advance_to(simulation.end());
    const Energies now = simulation.energies();
    CHECK(now.kinetic == doctest::Approx(kinetic));
    CHECK(others(now) < 1e-9 * kinetic);
  }
  const Energies none;
  CHECK(none.kinetic + others(none) == 0);
}

TEST_CASE("as many threads may be asked for as the message says, and not one more") {
  const auto kind = [](int threads) {  // of a run that finds no scene, so that no thread is made
    return kind_of([&] { run("/nowhere/scene.yaml", "/nowhere/out", {}, false, threads); });
  };
  std::string message;
  try {
    run("/nowhere/scene.yaml", "/nowhere/out", {}, false, std::numeric_limits<int>::max());
  } catch (const Error& error) {
    message = error.what();
  }
  const std::size_t at = message.find("(1 to ");
  REQUIRE(at != std::string::npos);
  const int most = std::stoi(message.substr(at + 6));
  CHECK(kind(most) != Error::Kind::misuse);
  CHECK(kind(0) != Error::Kind::misuse);
  CHECK(kind(most + 1) == Error::Kind::misuse);
}

TEST_CASE("run.json of a library's run has its settings as --set would give them") {
  const Folder folder;
  const std::string json =
      run(folder.scene, folder.path / "out", {{"time.end", "2 us"}, {"bodies.0.velocity", "[3, 1]"}});
  CHECK(json.find("\"time.end=2 us\"") != std::string::npos);
  CHECK(json.find("\"bodies.0.velocity=[3, 1]\"") != std::string::npos);
}

/// Two blocks that yield, slide with friction and lose bonds under a ram and gravity.
const char* const kWorked = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 20 us}
materials:
  metal: {model: j2_plasticity, density: 2 g/cm^3, bulk: 50 MPa, shear: 30 MPa, yield: 50 kPa}
bodies:
  - {name: left, box: {from: [1 mm, 2 mm], to: [5 mm, 6 mm]}, material: metal, velocity: [20, 3]}
  - {name: right, box: {from: [5 mm, 2 mm], to: [9 mm, 6 mm]}, material: metal}
boundaries:
  right: {piston: 1 m/s, direction: left}
gravity: [0, -1000]
contact:
  {law: cohesive, shape: triangular, normal_strength: 10 kPa, shear_strength: 10 kPa,
   normal_toughness: 0.001 J/m^2, shear_toughness: 0.001 J/m^2, friction: 0.3}
output: {frames: 0, picture: none}
)";

double of_history(Simulation& simulation, const std::string& name) {
  const std::vector<std::string> names = simulation.history_columns();
  const std::vector<double> numbers = simulation.history();
  REQUIRE(names.size() == numbers.size());
  const auto found = std::find(names.begin(), names.end(), name);
  REQUIRE(found != names.end());
  return numbers[static_cast<std::size_t>(found - names.begin())];
}

TEST_CASE("energies are those of the history, and what was dissipated has the bonds' share") {
  Simulation simulation = Simulation::from_text(kWorked);
  simulation.advance_to(simulation.end());
  const Energies e = simulation.energies();
  CHECK(e.kinetic == of_history(simulation, "kinetic_J"));
  CHECK(e.stored == of_history(simulation, "stored_J"));
  CHECK(e.friction == of_history(simulation, "friction_J"));
  CHECK(e.boundary_work == of_history(simulation, "boundary_work_J"));
  CHECK(e.body_force_work == of_history(simulation, "body_force_work_J"));
  const double plastic = of_history(simulation, "dissipated_J"),
               bonds = of_history(simulation, "interface_J");
  CHECK(plastic > 0);
  CHECK(bonds > 0);
  CHECK(e.dissipated == plastic + bonds);
  CHECK(e.body_force_work != 0);
  CHECK(e.boundary_work != 0);
}

TEST_CASE("a row of the history is of the step that was taken last, and its forces since the row before") {
  Simulation simulation = Simulation::from_text(kWorked);
  CHECK(of_history(simulation, "dt_s") == 0);
  const double dt = 0.5 * simulation.stable_dt();
  simulation.advance(dt);
  simulation.advance(dt);
  CHECK(simulation.steps() == 2);
  CHECK(simulation.time() == doctest::Approx(2 * dt));
  CHECK(of_history(simulation, "dt_s") == dt);
  CHECK(of_history(simulation, "step") == 2);
  CHECK(of_history(simulation, "time_s") == simulation.time());
  const double last = simulation.step();
  CHECK(of_history(simulation, "dt_s") == last);
}

TEST_CASE("columns are named after their quantities and components, in the plane and in space") {
  const auto names_of = [](const Simulation& simulation, const std::string& quantity) {
    std::string out;
    for (const std::string& name : simulation.columns())
      if (name == quantity || name.rfind(quantity + ".", 0) == 0) out += name.substr(quantity.size()) + " ";
    return out;
  };
  const Simulation plane = Simulation::from_text(kWorked);
  CHECK(plane.dimension() == 2);
  CHECK(names_of(plane, "position") == ".x .y ");
  CHECK(names_of(plane, "deformation_gradient") == ".xx .xy .yx .yy ");
  CHECK(names_of(plane, "kirchhoff_stress") == ".xx .yy .zz .xy ");
  CHECK(names_of(plane, "elastic_strain") == ".xx .yy .zz .xy ");
  CHECK(names_of(plane, "mass") == " ");
  const Simulation space = Simulation::from_text(R"(
space: 3d
grid: {size: [4 mm, 4 mm, 4 mm], cell: 1 mm}
time: {end: 1 us}
materials:
  metal: {model: j2_plasticity, density: 2 g/cm^3, bulk: 50 MPa, shear: 30 MPa, yield: 50 kPa}
bodies:
  - {name: cube, box: {from: [1 mm, 1 mm, 1 mm], to: [3 mm, 3 mm, 3 mm]}, material: metal}
output: {frames: 0, picture: none}
)");
  CHECK(space.dimension() == 3);
  CHECK(space.particles() == 64);
  CHECK(names_of(space, "position") == ".x .y .z ");
  CHECK(names_of(space, "deformation_gradient") == ".xx .xy .xz .yx .yy .yz .zx .zy .zz ");
  CHECK(names_of(space, "kirchhoff_stress") == ".xx .yy .zz .xy .yz .xz ");
  CHECK(names_of(space, "elastic_strain") == ".xx .yy .zz .xy .yz .xz ");
}

TEST_CASE("spans show each particle once with its body, and a push from outside is work of body forces") {
  Simulation simulation = Simulation::from_text(kWorked);
  const std::size_t n = simulation.particles();
  CHECK(n == 2 * 64);
  CHECK(simulation.ids().size() == n);
  CHECK(simulation.bodies().size() == n);
  CHECK(simulation.body_names() == std::vector<std::string>{"left", "right"});
  std::vector<bool> seen(n);
  for (std::size_t p = 0; p < n; ++p) {
    seen[simulation.ids()[p]] = true;
    CHECK(simulation.bodies()[p] == (simulation.column("position.x")[p] < 5e-3 ? 0 : 1));
  }
  CHECK(std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }));
  const double before = simulation.energies().kinetic;
  std::vector<double> change(n);
  for (std::size_t p = 0; p < n; ++p) change[p] = 0.1 * static_cast<double>(p);
  const std::vector<double> old(simulation.column("velocity.y").begin(),
                                simulation.column("velocity.y").end());
  simulation.add_velocity(1, change);
  for (std::size_t p = 0; p < n; ++p) CHECK(simulation.column("velocity.y")[p] == old[p] + change[p]);
  const Energies after = simulation.energies();
  CHECK(after.kinetic > before);
  CHECK(after.body_force_work == doctest::Approx(after.kinetic - before));
}

}  // namespace
