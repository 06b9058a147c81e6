// What a scene would take of the machine is known before it is taken.

#include <omp.h>

#include <algorithm>
#include <string>

#include "engine/plan/memory.hpp"
#include "engine/state/columns.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

template <int Dim>
void check_estimate(const char* file) {
  CAPTURE(std::string(file));
  const Scene scene = scene_file(file);
  Step<Dim> step(scene);
  step.advance(step.stable_dt());
  const auto& state = step.state();
  const auto count = static_cast<double>(state.particles.size());
  CHECK(estimated_particles(scene) == doctest::Approx(count).epsilon(0.03));
  if (count < 5000) return;  // the nodes of half-empty tiles are then the most
  const auto columns = static_cast<double>(state.particles.planned_bytes()),
             later = static_cast<double>(state.nodes.bytes() + state.tiling.bytes());
  const double taken = columns + later + passing_need(scene, count, later).bytes;
  const double ratio = estimated_bytes(scene, step.plan(), count) / taken;
  CHECK(ratio > 0.67);
  CHECK(ratio < 1.5);
}

TEST_CASE("particles and memory of a scene are foretold") {
  check_estimate<2>("thick_ring.yaml");
  check_estimate<2>("oblique_impact.yaml");
  check_estimate<2>("bench/block-2d.yaml");
  check_estimate<3>("bench/block-3d.yaml");
  check_estimate<3>("sphere_plane.yaml");
}

TEST_CASE("the particles of a prism whose polygon follows the grid are foretold exactly") {
  // An L: three quarters of the box around it, which samples that lie evenly know.
  const Scene scene = scene_from(R"(
space: 3d
grid: {size: [8 mm, 8 mm, 6 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, polygon: {points: [[1 mm, 1 mm], [7 mm, 1 mm], [7 mm, 4 mm], [4 mm, 4 mm], [4 mm, 7 mm], [1 mm, 7 mm]], z: [1 mm, 5 mm]}, material: m}
)");
  const Step<3> step(scene);
  CHECK(step.state().particles.size() == 27 * 4 * 8);
  CHECK(estimated_particles(scene) == doctest::Approx(27 * 4 * 8).epsilon(1e-12));
}

TEST_CASE("the memory of a scene is foretold where nodes take much of it, with one particle a cell") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [220 mm, 220 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [10 mm, 10 mm], to: [210 mm, 210 mm]}, material: m, particles_per_cell: 1}]
method: {update: xpic(3)}
output: {picture: none, frames: 0}
)");
  Step<2> step(scene);
  step.advance(step.stable_dt());
  const auto& state = step.state();
  const auto count = static_cast<double>(state.particles.size());
  const double taken =
      static_cast<double>(state.particles.planned_bytes() + state.nodes.bytes() + state.tiling.bytes()) +
      8 * count;  // a row of the history
  const double ratio = estimated_bytes(scene, step.plan(), count) / taken;
  CHECK(ratio > 0.67);  // measured 1.28
  CHECK(ratio < 1.5);
}

TEST_CASE("particles take the memory of their numbers, and of padding and pages") {
  Particles<2> particles;
  constexpr std::size_t kMany = 100'000;
  particles.allocate(kMany, {Quantity::mass, Quantity::position});
  CHECK(particles.planned_bytes() == kMany * (3 * 8 + 4 + 2));
  CHECK(particles.bytes() >= particles.planned_bytes());
  CHECK(particles.bytes() < particles.planned_bytes() + 5 * (4096 + 64 * 8));
}

TEST_CASE("the search for bodies that overlap counts those in each other's boxes, beyond what comes later") {
  const auto need = [](const char* second, double later) {
    return passing_need(scene_from(std::string(R"(
space: plane_strain
grid: {size: [1 m, 1 m], cell: 1 cm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
output: {picture: none, frames: 0}
bodies:
  - {name: a, box: {from: [0.1 m, 0.1 m], to: [0.5 m, 0.9 m]}, material: m}
  - {name: b, box: )") + second + ", material: m}\n"),
                        1000, later);
  };
  const PassingNeed beside = need("{from: [0.5 m, 0.1 m], to: [0.9 m, 0.9 m]}", 0),
                    inside = need("{from: [0.1 m, 0.1 m], to: [0.5 m, 0.9 m]}", 0),
                    half = need("{from: [0.3 m, 0.1 m], to: [0.7 m, 0.9 m]}", 0),
                    late = need("{from: [0.1 m, 0.1 m], to: [0.5 m, 0.9 m]}", 1e6);
  CHECK(std::string(beside.reason) == "a row of the history");
  CHECK(std::string(inside.reason) == "the search for bodies that overlap");
  CHECK(half.bytes == doctest::Approx(0.5 * inside.bytes));
  CHECK(late.bytes == beside.bytes);
}

TEST_CASE("a column tells of the memory that it has touched, in pages") {
  Column<double> small, large;
  small.resize_discard(1000, 5000);
  CHECK(small.bytes() == 3 * 4096);  // 1064 numbers
  small.resize_discard(2000);
  CHECK(small.bytes() == 5 * 4096);
  constexpr std::size_t kMany = std::size_t{1} << 21;  // 16 MiB: in pages of 2 MiB
  large.resize_discard(kMany, 2 * kMany);
  CHECK(large.bytes() == (std::size_t{18} << 20));
  large.resize_discard(1);
  CHECK(large.bytes() == (std::size_t{18} << 20));
}

TEST_CASE("a column that grows within its capacity finds zeros there, up to the end of its padding") {
  constexpr std::size_t kPadding = Column<double>::kPadding, kCapacity = 1000;
  for (const std::size_t more : {std::size_t{1}, kPadding - 1, kPadding, kPadding + 1}) {
    CAPTURE(more);
    Column<double> column;
    column.resize_discard(1, kCapacity);
    for (std::size_t i = 1 + kPadding; i < kCapacity + kPadding; ++i)
      column.data()[i] = 7;  // of others, before
    for (std::size_t n = 1 + more; n <= kCapacity; n += more) {
      column.resize_discard(n);
      REQUIRE(column.size() == n);
      REQUIRE(std::all_of(column.data(), column.data() + n + kPadding, [](double x) { return x == 0; }));
    }
  }
  // Padding is touched as the rest is: the first number on another page is one of it.
  Column<double> pages;
  pages.resize_discard(4096 / 8 - kPadding, 5000);
  CHECK(pages.bytes() == 4096);
  pages.resize_discard(4096 / 8 - kPadding + 1);
  CHECK(pages.bytes() == 2 * 4096);
}

TEST_CASE("of the workspaces, those of threads at work are counted") {
  const Scene scene = scene_file("bench/block-2d.yaml", {{"grid.cell", "1/8 m"}});
  Step<2> step(scene);
  const auto workspaces = [&](int threads) {
    step.state().threads = threads;
    return step.workspace_bytes();
  };
  const int most = omp_get_max_threads();
  const std::size_t one = workspaces(1);
  CHECK(one > 0);
  for (int threads = 2; threads <= most; ++threads)
    CHECK(workspaces(threads) == static_cast<std::size_t>(threads) * one);
  CHECK(workspaces(most + 1000) == static_cast<std::size_t>(most) * one);  // there are no more
}

TEST_CASE("a scene that needs more memory than there is, is refused with the figures") {
  const Scene scene = scene_file("bench/block-2d.yaml", {{"grid.cell", "1/15810 m"}});
  const Plan plan = make_plan(scene);
  try {
    check_memory(scene, plan, {std::uint64_t{8} << 30, "of the machine"});
    FAIL("it was taken");
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).find("about 1e+09 particles would take ") != std::string::npos);
    CHECK(std::string(error.what()).find("and there are 8 GiB of the machine") != std::string::npos);
  }
  CHECK_NOTHROW(check_memory(scene, plan, {std::uint64_t{1} << 50, ""}));
  CHECK_NOTHROW(check_memory(scene, plan, {}));
}

TEST_CASE("a scene is not refused for the empty corners of the boxes around its bodies") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [1 m, 1 m], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, ring: {centre: [0.5 m, 0.5 m], outer: 0.4 m, inner: 0.39 m}, material: m}]
)");
  const Plan plan = make_plan(scene);
  const double bytes = estimated_bytes(scene, plan, estimated_particles(scene));
  CHECK_NOTHROW(check_memory(scene, plan, {static_cast<std::uint64_t>(1.2 * bytes), ""}));
  CHECK_THROWS_AS(check_memory(scene, plan, {static_cast<std::uint64_t>(0.8 * bytes), ""}), SceneError);
}

}  // namespace
}  // namespace mpmfast
