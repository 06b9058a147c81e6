// A checkpoint may hold anything, with a checksum that fits. Whatever one of its columns holds, a step is
// refused or goes on; it does not crash, and it does not take what is no state of its scene.

#include <limits>

#include "tests/forged.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

const std::string kPlane = R"(
space: plane_strain
grid: {size: [6 mm, 4 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [2 mm, 2 mm], radius: 0.9 mm}, material: m, velocity: [60 m/s, 5 m/s]}
  - {name: b, disk: {centre: [3.7 mm, 2.2 mm], radius: 0.9 mm}, material: m, velocity: [-60 m/s, 0 m/s]}
)";

const char* const kCracked = R"(
space: plane_strain
grid: {size: [6 mm, 4 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [1 mm, 1 mm], to: [5 mm, 3 mm]}, material: m, velocity: [10 m/s, 0]}]
cracks: [{body: a, line: [[0.5 mm, 2.1 mm], [3.1 mm, 2.1 mm]]}]
)";

const char* const kHot = R"(
space: plane_strain
grid: {size: [6 mm, 4 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K,
  conductivity: 2 kW/m/K, thermal_expansion: 1e-5 K^-1}}
bodies: [{name: a, box: {from: [1 mm, 0 mm], to: [3 mm, 2 mm]}, material: m, velocity: [10 m/s, -5 m/s]}]
boundaries: {bottom: wall}
heat: {temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}
)";

const char* const kSolid = R"(
space: 3d
grid: {size: [4 mm, 3 mm, 3 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm, 1 mm], to: [2 mm, 2 mm, 2 mm]}, material: m, velocity: [30 m/s, 0, 0]}
  - {name: b, box: {from: [2 mm, 1 mm, 1 mm], to: [3 mm, 2 mm, 2 mm]}, material: m, velocity: [-30 m/s, 0, 0]}
)";

template <int Dim>
Forged written(const Scene& scene, int steps = 6) {
  Step<Dim> step(scene);
  advance(step, steps);
  Forged state;
  step.visit(state);
  state.rewind();
  return state;
}

/// Reads the state and goes on for some steps. @return what it says; empty when it goes on
template <int Dim>
std::string goes_on(const Scene& scene, Forged state, int steps = 3) {
  try {
    Step<Dim> step(scene);
    const double first = step.stable_dt();
    step.visit(state);
    for (int k = 0; k < steps && step.state().time < scene.time.end; ++k)
      step.advance(step.dt_towards(scene.time.end, first));
  } catch (const FileError& error) {
    return std::string("file: ") + error.what();
  } catch (const RunFailure& error) {
    return std::string("run: ") + error.what();
  }
  return "";
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Alters each column in turn: one entry, all, how many there are.
template <int Dim>
int alter_all(const Scene& scene) {
  const Forged good = written<Dim>(scene);
  REQUIRE(goes_on<Dim>(scene, good) == "");
  int altered = 0;
  const auto attempt = [&](const std::string& what, const auto& alter) {
    CAPTURE(what);
    Forged state = good;
    alter(state);
    CHECK_NOTHROW(goes_on<Dim>(scene, state));
    ++altered;
  };
  for (const std::string& name : good.names()) {
    const std::size_t n = good.count(name);
    for (const std::size_t other : {std::size_t{0}, n > 0 ? n - 1 : 0, n + 1, 2 * n})
      if (other != n) attempt(name + " resized", [&](Forged& state) { state.resize(name, other); });
    std::vector<double> values{-1, 0, 1, 3, 65535, 2e9, -2e9, 1.8e19};
    if (good.is_real(name)) values = {-1, 0, 1e3, 1e300, -1e300, kInfinite, kNaN};
    for (const double value : values) {
      attempt(name + " all", [&](Forged& state) { state.set_all(name, value); });
      if (n > 1) attempt(name + " one", [&](Forged& state) { state.set(name, n / 2, value); });
    }
  }
  return altered;
}

TEST_CASE("no column of a state crashes the step that reads it: contact, in the plane") {
  CHECK(alter_all<2>(
            scene_from(kPlane + "contact: {law: coulomb, friction: 0.3}\nmethod: {basis: lcpdi}\n")) > 300);
}

TEST_CASE("no column of a state crashes the step that reads it: planes between clouds, simultaneous") {
  alter_all<2>(
      scene_from(kPlane + "contact: {law: coulomb, normal: logistic_regression, fields: simultaneous}\n"));
}

TEST_CASE("no column of a state crashes the step that reads it: penalty contact") {
  alter_all<2>(scene_from(kPlane + "contact: {family: penalty, friction: 0.3}\nmethod: {basis: bspline2}\n"));
}

TEST_CASE("no column of a state crashes the step that reads it: cracks") {
  alter_all<2>(scene_from(kCracked));
}

TEST_CASE("no column of a state crashes the step that reads it: heat") { alter_all<2>(scene_from(kHot)); }

TEST_CASE("no column of a state crashes the step that reads it: in space") {
  alter_all<3>(scene_from(kSolid));
}

TEST_CASE("a state that is none of its scene is refused, with the column") {
  const Scene scene = scene_from(kPlane + "contact: {law: coulomb, friction: 0.3}\n");
  const Forged good = written<2>(scene);
  const auto told = [&](const std::string& name, std::size_t k, double value) {
    Forged state = good;
    state.set(name, k, value);
    return goes_on<2>(scene, state);
  };
  const auto refused = [](const std::string& text, const std::string& part) {
    return text.starts_with("file: the checkpoint is none of its scene") &&
           text.find(part) != std::string::npos;
  };
  CHECK(refused(told("particles/body", 5, 65535), "is of body 65535"));
  CHECK(refused(told("particles/body", 5, good.count("particles/body") > 5 ? 7 : 0), "is of body"));
  CHECK(refused(told("particles/id", 5, 4e9), "a particle has the id"));
  CHECK(refused(told("tiling/bodies", 0, 0), "its tiles do not fit the particles"));
  CHECK(refused(told("tiling/keys", 5, 0), "its tiles do not fit the particles"));
  CHECK(refused(told("particles/mass", 5, kNaN), "mass holds nan at 5"));
  CHECK(refused(told("particles/velocity_0", 0, kInfinite), "velocity holds inf at 0"));
  CHECK(refused(told("particles/position_1", 3, 1e9), "lies outside of the grid"));
  CHECK(refused(told("step/travelled", 0, -1e9), "step/travelled is -"));
  CHECK(refused(told("contact/planes", 0, kNaN), "contact/planes holds nan"));
  Forged none = good;
  none.resize("tiling/keys", 0);
  CHECK(refused(goes_on<2>(scene, none), "no particle is in a tile"));
  Forged twice = good;
  twice.set_all("particles/id", 1);
  CHECK(refused(goes_on<2>(scene, twice), "a particle has the id 1"));
}

}  // namespace
}  // namespace mpmfast
