// A step that is filled from an archive goes on to the bit as the one that was written.

#include <fmt/format.h>
#include <omp.h>

#include <cstring>

#include "engine/state/archive.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// An archive in memory.
class Memory final : public Archive {
 public:
  bool reading() const override { return reading_; }
  void rewind() { reading_ = true; }
  bool operator==(const Memory& other) const { return columns_ == other.columns_; }
  bool has(const std::string& name) const { return columns_.contains(name); }
  void forget(const std::string& name) { columns_.erase(name); }

 private:
  struct Kept {
    std::size_t count;
    std::string bytes;
    bool operator==(const Kept&) const = default;
  };
  static std::size_t size_of(NumberKind kind) {
    switch (kind) {
      case NumberKind::whole8:
        return 1;
      case NumberKind::whole16:
        return 2;
      case NumberKind::whole32:
      case NumberKind::signed32:
        return 4;
      default:
        return 8;
    }
  }
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    const std::size_t bytes = n * size_of(kind);
    if (!reading_) {
      REQUIRE_MESSAGE(!has(name), name);
      columns_[name] = {n, std::string(static_cast<const char*>(values), bytes)};
      return;
    }
    if (!has(name)) return;  // forgotten
    REQUIRE(columns_[name].count == n);
    if (n > 0) std::memcpy(values, columns_[name].bytes.data(), bytes);
  }
  std::size_t length(const std::string& name) override { return columns_.at(name).count; }

  std::map<std::string, Kept> columns_;
  bool reading_ = false;
};

template <int Dim>
Memory written(Step<Dim>& step) {
  Memory memory;
  step.visit(memory);
  memory.rewind();
  return memory;
}

/// All but the wall time.
template <int Dim>
Memory figures(Step<Dim>& step) {
  Memory memory;
  step.visit(memory);
  memory.forget("step/seconds");
  return memory;
}

template <int Dim>
void check_goes_on(const std::string& yaml, int stop, int steps) {
  const Scene scene = scene_from(yaml);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  Step<Dim> whole(scene), stopped(scene);
  advance(whole, steps);
  omp_set_num_threads(3);
  advance(stopped, stop);
  Memory memory = written(stopped);
  Step<Dim> resumed(scene);
  resumed.visit(memory);
  CHECK(figures(resumed) == figures(stopped));
  advance(resumed, steps - stop);
  CHECK(figures(resumed) == figures(whole));
  CHECK(checksum(resumed.state().particles) == checksum(whole.state().particles));
  CHECK(resumed.stored_energy() == whole.stored_energy());
  advance(stopped, steps - stop);  // writing changes nothing
  CHECK(figures(stopped) == figures(whole));
  omp_set_num_threads(before);
}

const char* const kPlane = R"(
space: plane_strain
grid: {size: [12 mm, 8 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials:
  soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  tool: {model: rigid}
bodies:
  - {name: a, disk: {centre: [3.8 mm, 4 mm], radius: 2 mm}, material: soft, velocity: [60 m/s, 5 m/s]}
  - {name: b, disk: {centre: [8 mm, 4.4 mm], radius: 2 mm}, material: soft, velocity: [-60 m/s, 0 m/s]}
)";
const std::string kContact = "contact: {law: coulomb, friction: 0.3}\n";

TEST_CASE("at every step, before a sort and after it, a step can be written and goes on to the bit") {
  const std::string yaml = std::string(kPlane) + kContact + "method: {basis: lcpdi, update: xpic(3)}\n";
  constexpr int kSteps = 24;
  const Scene scene = scene_from(yaml);
  Step<2> whole(scene);
  int sorts = 0;
  std::vector<Memory> at;
  for (int k = 0; k < kSteps; ++k) {
    at.push_back(written(whole));
    const std::uint32_t* id = whole.state().particles.id().data();
    const std::vector<std::uint32_t> before(id, id + whole.state().particles.size());
    whole.advance(whole.stable_dt());
    sorts += !std::equal(before.begin(), before.end(), whole.state().particles.id().data());
  }
  CHECK(sorts >= 3);
  CHECK(whole.contact_counters().nodes_peak > 5);
  CHECK(at.back().has("contact/planes"));
  const Memory end = figures(whole);
  for (int k = 0; k < kSteps; ++k) {
    CAPTURE(k);
    Step<2> resumed(scene);
    resumed.visit(at[static_cast<std::size_t>(k)]);
    CHECK(resumed.state().step == static_cast<std::uint64_t>(k));
    advance(resumed, kSteps - k);
    CHECK(figures(resumed) == end);
  }
}

TEST_CASE("what is forgotten of a state shows in the steps that follow") {
  const Scene scene = scene_from(std::string(kPlane) + kContact + "method: {basis: lcpdi, update: apic}\n",
                                 {{"method.basis", "bspline2"}});
  constexpr int kStop = 16, kSteps = 26;
  Step<2> whole(scene);
  advance(whole, kStop);
  const Memory memory = written(whole);
  advance(whole, kSteps - kStop);
  const std::string end = checksum(whole.state().particles);
  const auto end_without = [&](const char* name) {
    Memory less = memory;
    REQUIRE_MESSAGE(less.has(name), std::string(name));
    less.forget(name);
    Step<2> resumed(scene);
    try {
      resumed.visit(less);
    } catch (const FileError& refused) {  // what is left does not fit the scene
      return std::string(refused.what());
    }
    advance(resumed, kSteps - kStop);
    return checksum(resumed.state().particles);
  };
  for (const char* name : {"step/fastest", "particles/id", "particles/velocity_slopes_3", "contact/touching",
                           "contact/planes", "step/sort_due", "step/travelled"})
    CHECK_MESSAGE(end_without(name) != end, std::string(name));
}

TEST_CASE("every column that the plan has is written, with every component") {
  const Scene scene = scene_from(std::string(kPlane) + "method: {basis: lcpdi}\n");
  Step<2> step(scene);
  const Memory memory = written(step);
  for (const Quantity q : step.plan().particle_columns) {
    const std::string name = "particles/" + std::string(kQuantityTable[static_cast<std::size_t>(q)].name);
    const int components = Particles<2>::components(q);
    if (components == 1) CHECK_MESSAGE(memory.has(name), name);
    for (int k = 0; k < components && components > 1; ++k)
      CHECK_MESSAGE(memory.has(name + "_" + std::to_string(k)), name, k);
  }
}

TEST_CASE("every method of contact goes on to the bit") {
  for (const char* rest :
       {"contact: {normal: logistic_regression, hysteresis: 0.05}\nmethod: {update: flip, strain: last}\n",
        "contact: {normal: smoothed_logistic_regression, law: stick}\nmethod: {update: fmpm(3)}\n",
        "contact: {normal: average_gradient, separation: displacement}\nmethod: {update: pic}\n",
        "contact: {friction: 0.3, refit: 0.2}\nmethod: {basis: lcpdi}\n",
        "contact: {fields: pairs, refit: 0.2, rigid_bias: 10}\n",
        "contact: {normal: average_gradient, separation: ellipsoid_support, refit: 0.2}\n",
        "contact: {corrections: 1, friction: 0.2}\nmethod: {update: xpic(2), own_filter: true}\n",
        "contact: {fields: pairs, pairs: [{between: [a, b], friction: 0.4}]}\nmethod: {basis: qcpdi}\n",
        "contact: {law: adhesion, normal_strength: 1 MPa, shear_strength: 1 MPa}\nmethod: {basis: linear}\n",
        "contact: {family: surface, friction: 0.3}\nmethod: {update: xpic(2)}\n",
        "contact: {family: penalty, friction: 0.3}\nmethod: {basis: bspline2, extension: {occupation: "
        "0.75}}\n",
        "contact: none\nmethod: {basis: bspline3, update: apic, deformation_terms: exponential}\n"}) {
    CAPTURE(std::string(rest));
    check_goes_on<2>(std::string(kPlane) + rest, 13, 21);
  }
}

TEST_CASE("rigid bodies that turn and travel, pistons, walls and gravity go on to the bit") {
  check_goes_on<2>(
      std::string(kPlane) +
          "  - {name: paddle, box: {from: [1 mm, 6 mm], to: [5 mm, 7 mm]}, material: tool,\n"
          "     velocity: [[[0, 5 m/s], [20 us, -3 m/s]], 0], rotation: {about: [3 mm, 6.5 mm], speed: "
          "900 rad/s}}\n" +
          "boundaries: {bottom: wall, left: {piston: [[0, 0], [30 us, 20 m/s]], direction: right}}\n"
          "gravity: {acceleration: [0, -5000], ramp: 10 us}\n" +
          kContact,
      15, 24);
}

TEST_CASE("what sticks to a wall goes on sticking, to the bit") {
  const std::string yaml = R"(
space: plane_strain
grid: {size: [8 mm, 8 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: block, box: {from: [2 mm, 1.2 mm], to: [6 mm, 4 mm]}, material: soft, velocity: [3 m/s, -9 m/s]}]
boundaries: {bottom: {wall: sliding, position: 1.2 mm, at: surface, friction: 0.8}}
)";
  check_goes_on<2>(yaml, 19, 30);
  const Scene scene = scene_from(yaml);
  Step<2> step(scene);
  advance(step, 19);
  std::vector<std::uint64_t> stuck;
  Memory memory = written(step);
  memory.list("walls/stuck", stuck);
  CHECK(stuck.size() >= 4);
}

/// Two blocks of a material that meet.
std::string blocks(const char* space, const char* material) {
  return std::string("space: ") + space +
         "\ngrid: {size: [8 mm, 8 mm], cell: 0.5 mm}\ntime: {end: 1 ms}\nmaterials: {m: " + material +
         "}\nbodies:\n"
         "  - {name: low, box: {from: [0 mm, 1 mm], to: [4 mm, 3 mm]}, material: m, velocity: [0, 80 m/s]}\n"
         "  - {name: high, box: {from: [0 mm, 3.2 mm], to: [3 mm, 5 mm]}, material: m, velocity: [0, -80 "
         "m/s]}\n" +
         kContact;
}

TEST_CASE("materials with a history, plane stress and axisymmetry go on to the bit") {
  const char* const mild =
      "{model: j2_plasticity, density: 8 g/cm^3, bulk: 160 GPa, shear: 80 GPa, yield: 30 MPa, hardening: 500 "
      "MPa}";
  const char* const copper =
      "{model: johnson_cook, density: 8.96 g/cm^3, young: 124 GPa, poisson: 0.34, yield: 90 MPa, hardening: "
      "292 "
      "MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 1356 K, heat_capacity: 383 J/kg/K, "
      "equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: "
      "2}}";
  const char* const rubber = "{model: neo_hookean, density: 1 g/cm^3, bulk: 2 GPa, shear: 1 GPa}";
  check_goes_on<2>(blocks("plane_strain", mild), 12, 20);
  check_goes_on<2>(blocks("plane_strain", copper), 12, 20);
  check_goes_on<2>(blocks("axisymmetric", copper), 12, 20);
  check_goes_on<2>(blocks("axisymmetric", rubber) + "method: {basis: lcpdi}\n", 12, 20);
  check_goes_on<2>(blocks("plane_stress", rubber) + "method: {basis: lcpdi, update: xpic(2)}\n", 12, 20);
}

TEST_CASE("three dimensions go on to the bit") {
  const std::string spheres = R"(
space: 3d
grid: {size: [8 mm, 8 mm, 8 mm], cell: 0.8 mm}
time: {end: 1 ms}
materials:
  m: {model: j2_plasticity, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, yield: 1 MPa, hardening: 5 MPa}
  tool: {model: rigid}
bodies:
  - {name: a, sphere: {centre: [2.6 mm, 2.6 mm, 2.6 mm], radius: 1.6 mm}, material: m, velocity: [30 m/s, 30 m/s, 30 m/s]}
  - {name: b, sphere: {centre: [4.6 mm, 4.6 mm, 4.6 mm], radius: 1.6 mm}, material: m, velocity: [-30 m/s, -30 m/s, -30 m/s]}
  - {name: c, box: {from: [1 mm, 6 mm, 1 mm], to: [7 mm, 7 mm, 7 mm]}, material: tool, rotation: {about: [4 mm, 6 mm, 4 mm], axis: [0, 1, 1], speed: 100 rad/s}}
)" + kContact;
  check_goes_on<3>(spheres + "method: {basis: lcpdi, update: xpic(3)}\n", 7, 12);
  check_goes_on<3>(spheres + "method: {basis: bspline2, update: apic}\n", 7, 12);
}

TEST_CASE("interfaces go on to the bit on any number of threads, with the energy of their springs") {
  const std::string springs =
      "contact: {law: interface, normal_stiffness: 2 GPa/mm, compression_stiffness: 9 GPa/mm, "
      "shear_stiffness: 1 GPa/mm}\n";
  check_goes_on<2>(kPlane + springs, 12, 24);
  check_goes_on<2>(std::string(kPlane) +
                       "contact: {law: interface, normal_stiffness: 0, compression_stiffness: 20 GPa/mm, "
                       "shear_stiffness: 0, friction: 0.3, jumps: integrated}\n",
                   12, 24);
  check_goes_on<2>(
      std::string(kPlane) +
          "contact: {law: nonlinear_interface, friction: 0.3, normal_curve: [[-1 um, -9 MPa], [0, 0], "
          "[1 um, 1 MPa], [4 um, 0]], shear_curve: [[0, 0], [1 um, 2 MPa], [5 um, 1 MPa]]}\n",
      12, 24);
  check_goes_on<3>(R"(
space: 3d
grid: {size: [8 mm, 8 mm, 8 mm], cell: 0.8 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm, 1 mm], to: [6 mm, 6 mm, 3.5 mm]}, material: soft, velocity: [0 m/s, 0 m/s, -3 m/s]}
  - {name: b, box: {from: [1 mm, 1 mm, 3.5 mm], to: [6 mm, 6 mm, 6 mm]}, material: soft, velocity: [4 m/s, 0 m/s, 0 m/s]}
)" + springs,
                   7, 12);
}

/// Bricks and a rigid one pressed together, so that three meet on many nodes, and four on some: these are
/// solved side by side, in the order in which each thread comes to them.
TEST_CASE("a wall of bricks goes on to the bit on any number of threads") {
  std::string wall =
      "space: plane_strain\ngrid: {size: [14 mm, 14 mm], cell: 0.5 mm}\ntime: {end: 1 ms}\n"
      "materials: {m: {model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: "
      "rigid}}\n"
      "bodies:\n";
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k < 4; ++k) {
      const double x = 1 + 3 * k + (row == 2 ? 0.9 : 0), y = 1 + 3 * row;
      wall += fmt::format(
          "  - {{name: b{}{}, box: {{from: [{} mm, {} mm], to: [{} mm, {} mm]}}, material: {}, "
          "velocity: [{} m/s, {} m/s]}}\n",
          row, k, x, y, x + 2.9, y + 2.95, row == 1 && k == 2 ? "tool" : "m",
          row == 1 && k == 2 ? 0 : 6 * (6 - x), row == 1 && k == 2 ? 0 : 6 * (6 - y));
    }
  check_goes_on<2>(wall + kContact, 40, 70);
  check_goes_on<2>(wall + kContact + "method: {basis: lcpdi, update: xpic(2)}\n", 40, 70);
}

/// Two that cross in one body, while another strikes it where they end.
TEST_CASE("cracks go on to the bit on any number of threads, where two cross and another body touches") {
  const char* cracks =
      "cracks:\n  - {body: a, line: [[0 mm, 4 mm], [4 mm, 4.2 mm], [5.5 mm, 4.1 mm]]}\n"
      "  - {body: a, arc: {centre: [4.2 mm, 2.6 mm], radius: 2.3 mm, from: 60 deg, to: 130 deg}, law: "
      "frictionless}\n";
  check_goes_on<2>(std::string(kPlane) + kContact + cracks, 13, 30);
  check_goes_on<2>(std::string(kPlane) + kContact + cracks + "method: {basis: lcpdi, update: xpic(3)}\n", 13,
                   30);
}

/// It turns, and its new sides soften.
TEST_CASE("a crack that grows goes on to the bit on any number of threads") {
  check_goes_on<2>(R"(
space: plane_strain
grid: {size: [30 mm, 40 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {acrylic: {model: neo_hookean, density: 1.18 g/cm^3, young: 3 GPa, poisson: 0.35}}
bodies: [{name: plate, box: {from: [3 mm, 3 mm], to: [27 mm, 37 mm]}, material: acrylic}]
cracks: [{body: plate, line: [[0 mm, 17 mm], [12 mm, 20 mm]], growth: {toughness: 20 J/m^2}}]
boundaries:
  up: {box: {from: [0 mm, 36.6 mm], to: [30 mm, 40 mm]}, direction: +y, speed: 10 m/s}
  down: {box: {from: [0 mm, 0 mm], to: [30 mm, 3.4 mm]}, direction: -y, speed: 10 m/s}
)",
                   85, 150);
}

/// Kept from breaking at once: beside whole ones there are bonds that soften, are broken, move to new nodes.
TEST_CASE(
    "bonds that soften and break go on to the bit on any number of threads, as they move through the grid") {
  for (const char* more : {"", ", shape: exponential, compression: contact, friction: 0.2"})
    check_goes_on<2>(R"(
space: plane_strain
grid: {size: [12 mm, 8 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm], to: [5 mm, 3.2 mm]}, material: soft, velocity: [20 m/s, 40 m/s]}
  - {name: b, box: {from: [1 mm, 3.2 mm], to: [5 mm, 5.4 mm]}, material: soft, velocity: [24 m/s, 44 m/s]}
contact: {law: cohesive, normal_strength: 1 MPa, shear_strength: 1.2 MPa, normal_toughness: 10 J/m^2, shear_toughness: 14 J/m^2, mode_exponent: 2)" +
                         std::string(more) + "}\n",
                     20, 60);
  check_goes_on<3>(R"(
space: 3d
grid: {size: [8 mm, 8 mm, 8 mm], cell: 0.8 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [1 mm, 1 mm, 1 mm], to: [6 mm, 6 mm, 3.5 mm]}, material: soft, velocity: [0 m/s, 0 m/s, -3 m/s]}
  - {name: b, box: {from: [1 mm, 1 mm, 3.5 mm], to: [6 mm, 6 mm, 6 mm]}, material: soft, velocity: [4 m/s, 0 m/s, 0 m/s]}
contact: {law: cohesive, normal_strength: 0.2 MPa, shear_strength: 0.1 MPa, normal_toughness: 2 J/m^2, shear_toughness: 2 J/m^2}
)",
                   12, 24);
}

/// With enough particles for several threads, and facets for each of them.
TEST_CASE("surfaces that rub go on to the bit in three dimensions, on any number of threads") {
  check_goes_on<3>(R"(
space: 3d
grid: {size: [8 mm, 8 mm, 8 mm], cell: 0.8 mm}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, sphere: {centre: [2.6 mm, 2.6 mm, 2.6 mm], radius: 1.6 mm}, material: soft, particles_per_cell: 5, velocity: [30 m/s, 30 m/s, 50 m/s]}
  - {name: b, sphere: {centre: [4.6 mm, 4.6 mm, 4.6 mm], radius: 1.6 mm}, material: soft, particles_per_cell: 5, velocity: [-30 m/s, -30 m/s, -30 m/s]}
contact: {family: penalty, friction: 0.3, points_per_cell: 4}
method: {basis: bspline2, extension: {occupation: 0.75}}
)",
                   8, 14);
}

TEST_CASE("right after particles left the grid a step can be written and goes on to the bit") {
  const std::string yaml = R"(
space: plane_strain
grid: {size: [12 mm, 8 mm], cell: 0.5 mm, leaving: outflow}
time: {end: 1 ms}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [2.1 mm, 4 mm], radius: 2 mm}, material: soft, velocity: [-200 m/s, 5 m/s]}
  - {name: b, disk: {centre: [6.2 mm, 4.4 mm], radius: 2 mm}, material: soft, velocity: [-250 m/s, 0 m/s]}
method: {basis: lcpdi}
)" + kContact;
  const Scene scene = scene_from(yaml);
  Step<2> step(scene);
  const auto& particles = step.state().particles;
  int tried = 0;
  for (int k = 1; tried < 4; ++k) {
    const std::size_t before = particles.size();
    advance(step, 1);
    REQUIRE(particles.size() > 0);
    if (particles.size() == before) continue;
    check_goes_on<2>(yaml, k, k + 8);
    ++tried;
  }
}

TEST_CASE("heat goes on to the bit: held and fed faces, contact, friction, expansion and the filter") {
  for (const char* basis : {"ugimp", "bspline2"})
    check_goes_on<2>(std::string(R"(
space: plane_strain
grid: {size: [20 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 50 J/kg/K, conductivity: 2 kW/m/K, thermal_expansion: 1e-5 K^-1}}
bodies:
  - {name: slab, box: {from: [2 mm, 0.4 mm], to: [12 mm, 4 mm]}, material: m, velocity: [30 m/s, 0 m/s]}
  - {name: top, box: {from: [5 mm, 4 mm], to: [10 mm, 8 mm]}, material: m, velocity: [0 m/s, -3 m/s], temperature: 400 K}
boundaries: {bottom: {wall: sliding, position: 0.4 mm}}
heat: {temperature: 310 K, filter: {every: 0.3}, boundaries: {bottom: {temperature: 350 K}, left: {flux: 1 MW/m^2}}}
contact: {friction: 0.3}
method: {basis: )") + basis +
                         "}\n",
                     sanitized() ? 9 : 23, sanitized() ? 16 : 46);
}

}  // namespace
}  // namespace mpmfast
