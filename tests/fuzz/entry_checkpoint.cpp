#include <algorithm>
#include <sstream>
#include <string>

#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "entries.hpp"
#include "tests/forged.hpp"

namespace mpmfast::fuzz {

namespace {

const char* const kScene = R"(
space: plane_strain
grid: {size: [4 mm, 4 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm], to: [2 mm, 3 mm]}, material: m, velocity: [60 m/s, 0]}
  - {name: b, box: {from: [2 mm, 1 mm], to: [3 mm, 3 mm]}, material: m, velocity: [-60 m/s, 0]}
contact: {law: coulomb, friction: 0.3}
)";

const Scene& small_scene() {
  static const Scene scene = parse_scene(kScene, "scene.yaml");
  return scene;
}

const test::Forged& good_state() {
  static const test::Forged state = [] {
    Step<2> step(small_scene());
    for (int k = 0; k < 4; ++k) step.advance(step.stable_dt());
    test::Forged out;
    step.visit(out);
    out.rewind();
    return out;
  }();
  return state;
}

}  // namespace

void read_checkpoint_bytes(Bytes bytes) {
  constexpr std::size_t kMostEntries = 10000;
  test::Forged state = good_state();
  std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  std::string name, entry;
  for (double value = 0; lines >> name >> entry >> value;) {
    if (!state.has(name)) continue;
    if (entry == "length")
      state.resize(name, static_cast<std::size_t>(std::clamp(value, 0.0, double{kMostEntries})));
    else
      state.set(name, static_cast<std::size_t>(std::strtoul(entry.c_str(), nullptr, 10)), value);
  }
  try {
    Step<2> step(small_scene());
    const double first = step.stable_dt();
    step.visit(state);
    step.advance(step.dt_towards(small_scene().time.end, first));
  } catch (const FileError&) {
  } catch (const RunFailure&) {
  }
}

}  // namespace mpmfast::fuzz
