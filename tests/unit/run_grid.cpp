// Grid files: the frames that have one, and the impulses of contact in them.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/output/read_vtu.hpp"
#include "engine/run/write_grid.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two boxes that rush at each other along an axis and slide past each other along all others.
template <int Dim>
Scene rushing(int axis) {
  const auto point = [](std::array<double, 3> x, const char* unit) {
    return Dim == 2 ? fmt::format("[{} {u}, {} {u}]", x[0], x[1], fmt::arg("u", unit))
                    : fmt::format("[{} {u}, {} {u}, {} {u}]", x[0], x[1], x[2], fmt::arg("u", unit));
  };
  const auto at = [&](double along) {
    std::array<double, 3> x{2, 2, 2};
    x[static_cast<std::size_t>(axis)] = along;
    return x;
  };
  const auto to = [&](double along) {
    std::array<double, 3> x{5, 5, 5};
    x[static_cast<std::size_t>(axis)] = along;
    return x;
  };
  std::array<double, 3> velocity{1, 2, 3};
  velocity[static_cast<std::size_t>(axis)] = 20;
  return scene_from(fmt::format(R"(
space: {}
grid: {{size: {}, cell: 1 mm}}
time: {{end: 1 ms}}
materials: {{m: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
bodies:
  - {{name: low, box: {{from: {}, to: {}}}, material: m, velocity: {}}}
  - {{name: high, box: {{from: {}, to: {}}}, material: m}}
method: {{update: flip, strain: first}}
contact: {{friction: 0.3, corrections: 1}}
)",
                                Dim == 2 ? "plane_strain" : "3d", point({12, 12, 12}, "mm"),
                                point(at(2), "mm"), point(to(5), "mm"), point(velocity, "m/s"),
                                point(at(5), "mm"), point(to(8), "mm")));
}

template <int Dim>
std::array<Vec<Dim>, 2> momenta(const Particles<Dim>& particles) {
  std::array<Vec<Dim>, 2> sum{Vec<Dim>::Zero(), Vec<Dim>::Zero()};
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum[particles.body()[p]] += particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p);
  return sum;
}

struct TwoD {
  static constexpr int dimension = 2;
};
struct ThreeD {
  static constexpr int dimension = 3;
};

TEST_CASE_TEMPLATE("what grid files have of impulses is what contact changes each body's momentum by", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::dimension;
  for (int axis = 0; axis < Dim; ++axis) {
    CAPTURE(axis);
    const Folder folder;
    const auto file = folder / "grid.vtu";
    const Scene scene = rushing<Dim>(axis);
    Step<Dim> step(scene);
    advance(step, 2);
    const auto before = momenta<Dim>(step.state().particles);
    advance(step, 1);
    const auto after = momenta<Dim>(step.state().particles);
    write_grid(file, step, scene);
    const VtuReader reader(file);
    const auto impulse = reader.values(*reader.find("contact_impulse")),
               field = reader.values(*reader.find("field"));
    std::array<Vec3, 2> sum{Vec3{}, Vec3{}};
    for (std::size_t k = 0; k < reader.size(); ++k)
      for (std::size_t d = 0; d < 3; ++d) sum[static_cast<std::size_t>(field[k])][d] += impulse[3 * k + d];
    for (std::size_t body = 0; body < 2; ++body) {
      const Vec<Dim> change = after[body] - before[body];
      REQUIRE(std::abs(change[axis]) > 0);
      // Single precision, of some dozen nodes.
      for (int d = 0; d < 3; ++d) {
        CAPTURE(d);
        CHECK(std::abs(sum[body][static_cast<std::size_t>(d)] -
                       (d < Dim ? change[std::min(d, Dim - 1)] : 0)) < 1e-5 * change.norm());
      }
      for (int d = 0; d < Dim; ++d) CHECK(std::abs(change[d]) > 1e-3 * change.norm());  // friction too
    }
  }
}

TEST_CASE("every frame after the start has a grid file, also one after the first step") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [8 mm, 8 mm], cell: 1 mm}
time: {end: 50 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [2 mm, 2 mm], to: [6 mm, 6 mm]}, material: m, velocity: [3 m/s, -2 m/s]}]
output: {frames: 2, grid: true, picture: none}
)");
  for (const std::uint64_t steps : {0, 1, 2}) {
    CAPTURE(steps);
    const Folder folder;
    RunOptions options;
    options.folder = folder / "run";
    options.max_steps = steps;
    const RunSummary summary = run_scene(scene, options);
    REQUIRE(summary.steps == steps);
    const auto frames = [&](const std::string& name) {
      std::ifstream list(options.folder / (name + ".pvd"));
      int listed = 0;
      for (std::string line; std::getline(list, line);) listed += line.find("<DataSet") != std::string::npos;
      int files = 0;
      for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(options.folder / name))
        ++files;
      CHECK(files == listed);
      return files;
    };
    CHECK(frames("particles") == (steps > 0 ? 2 : 1));
    CHECK(frames("grid") == (steps > 0 ? 1 : 0));
  }
}

}  // namespace
}  // namespace mpmfast
