/// Counts the instructions per particle-step of small scenes and compares them with bounds.txt: a figure of
/// speed without noise.
///
/// usage: instruction_count BOUNDS [CASE...]
///
/// Without a name all cases are counted (a minute, most of it that of the balls).
///
/// Exit status: 0 within the bounds, 1 above one, 2 wrong input, 77 not possible here (ctest: skipped).

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "kernels/simd/lanes.hpp"
#include "single_step.hpp"

namespace {

using namespace mpmfast;

constexpr int kSkipped = 77;  // ctest: SKIP_RETURN_CODE

struct Case {
  const char *name, *scene;
  int before = 2;  ///< steps before the one that counts: the first allocates
};

const std::vector<Case> kCases{
    // One field: 256 particles in 8 x 8 cells that stretch.
    {"flip", R"(
space: plane_strain
grid: {size: [16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
method: {basis: ugimp, update: flip}
bodies:
  - {name: left, box: {from: [4 mm, 4 mm], to: [8 mm, 12 mm]}, material: rubber, velocity: [-5 m/s, 1 m/s]}
  - {name: right, box: {from: [8 mm, 4 mm], to: [12 mm, 12 mm]}, material: rubber, velocity: [5 m/s, 0 m/s]}
contact: none
)"},
    // Two disks of about 110 particles that are pressed together, XPIC(2) with contact.
    {"contact", R"(
space: plane_strain
grid: {size: [20 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
method: {basis: ugimp, update: xpic(2)}
contact: {law: coulomb, friction: 0.2}
bodies:
  - {name: left, disk: {centre: [7.1 mm, 6 mm], radius: 3 mm}, material: rubber, velocity: [20 m/s, 2 m/s]}
  - {name: right, disk: {centre: [13 mm, 6 mm], radius: 3 mm}, material: rubber, velocity: [-20 m/s, -2 m/s]}
)"},
    // Bricks of 16 particles pressed together, once the first blow is over: three and four meet on most
    // nodes.
    {"bricks", R"(
space: plane_strain
grid: {size: [12 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {law: coulomb, friction: 0.2}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [4 mm, 4 mm]}, material: rubber, velocity: [9 m/s, 5 m/s]}
  - {name: b, box: {from: [4 mm, 2 mm], to: [6 mm, 4 mm]}, material: rubber, velocity: [3 m/s, 5 m/s]}
  - {name: c, box: {from: [6 mm, 2 mm], to: [8 mm, 4 mm]}, material: rubber, velocity: [-3 m/s, 4 m/s]}
  - {name: d, box: {from: [3 mm, 4 mm], to: [5 mm, 6 mm]}, material: rubber, velocity: [6 m/s, 0 m/s]}
  - {name: e, box: {from: [5 mm, 4 mm], to: [7 mm, 6 mm]}, material: rubber, velocity: [-6 m/s, 1 m/s]}
  - {name: f, box: {from: [2 mm, 6 mm], to: [4 mm, 8 mm]}, material: rubber, velocity: [9 m/s, -5 m/s]}
  - {name: g, box: {from: [4 mm, 6 mm], to: [6 mm, 8 mm]}, material: rubber, velocity: [3 m/s, -6 m/s]}
  - {name: h, box: {from: [6 mm, 6 mm], to: [8 mm, 8 mm]}, material: rubber, velocity: [-3 m/s, -5 m/s]}
)",
     20},
    // As "flip" in 3-D: 256 particles in 4 x 4 x 2 cells.
    {"flip-3d", R"(
space: 3d
grid: {size: [12 mm, 12 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
method: {basis: ugimp, update: flip}
bodies:
  - {name: left, box: {from: [4 mm, 4 mm, 4 mm], to: [6 mm, 8 mm, 6 mm]}, material: rubber, velocity: [-5 m/s, 1 m/s, 1 m/s]}
  - {name: right, box: {from: [6 mm, 4 mm, 4 mm], to: [8 mm, 8 mm, 6 mm]}, material: rubber, velocity: [5 m/s, 0 m/s, 1 m/s]}
contact: none
)"},
    // As "contact" in 3-D: two balls of about 110 particles.
    {"contact-3d", R"(
space: 3d
grid: {size: [14 mm, 10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
method: {basis: ugimp, update: xpic(2)}
contact: {law: coulomb, friction: 0.2}
bodies:
  - {name: left, sphere: {centre: [5.05 mm, 5 mm, 5 mm], radius: 1.5 mm}, material: rubber, velocity: [20 m/s, 2 m/s, 0 m/s]}
  - {name: right, sphere: {centre: [8 mm, 5 mm, 5 mm], radius: 1.5 mm}, material: rubber, velocity: [-20 m/s, -2 m/s, 0 m/s]}
)"}};

struct Count {
  double per_particle_step = 0;
  std::uint64_t contact_nodes = 0;
};

/// Of one step.
template <int Dim>
Count count_in(const Scene& scene, int before) {
  Step<Dim> step(scene);
  for (int k = 0; k < before; ++k) step.advance(step.stable_dt());
  instructions::start_counting();
  step.advance(step.stable_dt());
  const std::uint64_t counted = instructions::stop_counting();
  const auto work = static_cast<double>(step.state().particles.size());
  return {static_cast<double>(counted) / work, step.contact_counters().nodes_peak};
}

Count count_of(const Case& test) {
  const Scene scene = parse_scene(test.scene, test.name);
  return scene.dimension() == 3 ? count_in<3>(scene, test.before) : count_in<2>(scene, test.before);
}

struct InstructionBounds {
  double slack = 0;
  std::map<std::pair<std::string, int>, double> measured;  ///< by case and lanes
};

/// "slack 1.25" and lines "CASE LANES MEASURED"; # starts a comment.
InstructionBounds read_bounds(const char* file) {
  InstructionBounds limits;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string name;
    int lanes = 0;
    double measured = 0;
    if (!(words >> name)) continue;
    if (name == "slack" ? !(words >> limits.slack) : !(words >> lanes >> measured)) return {};
    if (name != "slack") limits.measured[{name, lanes}] = measured;
  }
  return limits;
}

}  // namespace

int main(int count, char** arguments) {
  const InstructionBounds limits = count >= 2 ? read_bounds(arguments[1]) : InstructionBounds{};
  const std::set<std::string> wanted(arguments + std::min(count, 2), arguments + count);
  const auto is_case = [](const std::string& name) {
    return std::any_of(kCases.begin(), kCases.end(), [&](const Case& test) { return name == test.name; });
  };
  if (!(limits.slack > 1) || !std::all_of(wanted.begin(), wanted.end(), is_case)) {
    fmt::print(stderr,
               "usage: instruction_count BOUNDS [CASE...], a file with a line 'slack FACTOR' and lines 'CASE "
               "LANES MEASURED', and names of cases of tests/instructions/main.cpp\n");
    return 2;
  }
  if (!instructions::can_count()) {
    fmt::print("instructions cannot be counted on this architecture\n");
    return kSkipped;
  }
#ifndef NDEBUG
  fmt::print("the bounds are those of an optimised build\n");
  return kSkipped;
#endif
  omp_set_num_threads(1);  // what another thread does would not be counted
  bool above = false, known = false;
  for (const Case& test : kCases) {
    if (!wanted.empty() && wanted.count(test.name) == 0) continue;
    const Count counted = count_of(test);
    fmt::print("{:10} {} lanes: {:.0f} instructions per particle-step", test.name, kLanes,
               counted.per_particle_step);
    if (counted.contact_nodes > 0) fmt::print(", {} contact nodes", counted.contact_nodes);
    const auto found = limits.measured.find({test.name, kLanes});
    if (found == limits.measured.end()) {
      fmt::print("; no bound for so many lanes\n");
      continue;
    }
    known = true;
    const double bound = limits.slack * found->second;
    const bool too_many = !(counted.per_particle_step <= bound);
    above = above || too_many;
    fmt::print("; recorded {:.0f}, bound {:.0f}{}\n", found->second, bound, too_many ? ": TOO MANY" : "");
    if (counted.per_particle_step < found->second / limits.slack)
      fmt::print("           far fewer than recorded: lower the figure in {}\n", arguments[1]);
    std::fflush(stdout);
  }
  return above ? 1 : known ? 0 : kSkipped;
}
