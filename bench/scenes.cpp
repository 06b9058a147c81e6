/// Whole scenes in particle-steps per second, without output: where the seconds of a step go.

#include <algorithm>
#include <filesystem>
#include <vector>

#include "bench/support.hpp"
#include "bench/work.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::bench;

constexpr int kSteps = 50;

/// Two disks or spheres that touch and fly into each other: about 100 000 particles each.
template <int Dim>
std::string impact_yaml() {
  if constexpr (Dim == 2)
    return R"(
space: plane_strain
grid: {origin: [-184 mm, -95 mm], size: [368 mm, 190 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: left, disk: {centre: [-89.2 mm, 0 mm], radius: 89.2 mm}, material: rubber, velocity: [20 m/s, 2 m/s]}
  - {name: right, disk: {centre: [89.2 mm, 0 mm], radius: 89.2 mm}, material: rubber, velocity: [-20 m/s, -2 m/s]}
contact: {law: coulomb, friction: 0.2}
method: {basis: ugimp, update: flip}
)";
  return R"(
space: 3d
grid: {origin: [-34 mm, -20 mm, -20 mm], size: [68 mm, 40 mm, 40 mm], cell: 1 mm}
time: {end: 1 s}
materials: {rubber: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: left, sphere: {centre: [-14.4 mm, 0 mm, 0 mm], radius: 14.4 mm}, material: rubber, velocity: [20 m/s, 2 m/s, 0 m/s]}
  - {name: right, sphere: {centre: [14.4 mm, 0 mm, 0 mm], radius: 14.4 mm}, material: rubber, velocity: [-20 m/s, -2 m/s, 0 m/s]}
contact: {law: coulomb, friction: 0.2}
method: {basis: ugimp, update: flip}
)";
}

/// kSteps steps after the first, which allocates. @param prepare called with a step not yet taken
/// @param count_work reports the least bytes and flops of a step: of neo-Hookean particles without contact
template <int Dim, class Prepare>
void time_steps(benchmark::State& state, const Scene& scene, Prepare prepare, bool count_work = false) {
  std::array<double, kTimerNames.size()> seconds{};
  double particles = 0, contact_nodes = 0, regressions = 0, total = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto running = std::make_unique<Running<Dim>>(static_cast<int>(state.range(0)), scene);
    prepare(running->step);
    running->advance(1);
    const auto before = running->step.clock().seconds();
    const auto regressions_before = running->step.contact_counters().regressions;
    state.ResumeTiming();

    running->advance(kSteps);

    state.PauseTiming();
    particles = running->particles();
    if (count_work) {
      const auto& plan = running->step.plan();
      const PassWork<Dim> work(plan.basis, running->step.state().tiling.slots() / particles);
      state.counters["B/particle"] = work.step(plan).bytes;
      state.counters["flop/particle"] = work.step(plan).flops;
    }
    contact_nodes = static_cast<double>(running->step.contact_counters().nodes_peak);
    regressions += static_cast<double>(running->step.contact_counters().regressions - regressions_before);
    for (std::size_t pass = 0; pass < seconds.size(); ++pass) {
      seconds[pass] += running->step.clock().seconds()[pass] - before[pass];
      total += running->step.clock().seconds()[pass] - before[pass];
    }
    running.reset();
    state.ResumeTiming();
  }
  state.SetItemsProcessed(state.iterations() * kSteps * static_cast<std::int64_t>(particles));
  state.counters["particles"] = particles;
  state.counters["contact_nodes"] = contact_nodes;
  state.counters["regressions/s"] = benchmark::Counter(regressions, benchmark::Counter::kIsRate);
  for (std::size_t pass = 0; pass < seconds.size(); ++pass)
    state.counters["%" + std::string(kTimerNames[pass])] = 100 * seconds[pass] / total;
}

template <int Dim>
void impact(benchmark::State& state) {
  time_steps<Dim>(state, parse_scene(impact_yaml<Dim>(), "impact.yaml"), [](auto&) {});
}
BENCHMARK(impact<2>)
    ->Name("scene/disks/2d")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(impact<3>)
    ->Name("scene/spheres/3d")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The same particles in 1, 4, 16, 64 velocity fields: the cost may grow with the contact nodes, not with the
/// fields. `law: ignore` has the fields without contact, and shows what the fields cost alone.
void fields(benchmark::State& state, const char* law) {
  const int cuts = static_cast<int>(state.range(1));
  const Scene scene =
      parse_scene(block_yaml<2>("ugimp", "flip", cuts), "fields.yaml", {{"contact.law", law}});
  time_steps<2>(state, scene, [](Step<2>& step) { strain_block(step); });
}
BENCHMARK_CAPTURE(fields, , "coulomb")
    ->Name("scene/fields/contact")
    ->ArgNames({"threads", "cuts"})
    ->ArgsProduct({{1, 2}, {1, 2, 4, 8}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fields, , "ignore")
    ->Name("scene/fields/apart")
    ->ArgNames({"threads", "cuts"})
    ->ArgsProduct({{1, 2}, {1, 2, 4, 8}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void ellipses(benchmark::State& state, const std::filesystem::path& file) {
  time_steps<2>(state, read_scene(file), [](auto&) {});
}

/// A scene of configs/bench with about 10^5 particles.
void block(benchmark::State& state, const std::filesystem::path& file) {
  const Scene scene = read_scene(file);
  if (scene.dimension() == 2)
    return time_steps<2>(
        state, scene, [](auto&) {}, true);
  time_steps<3>(
      state, read_scene(file, {{"grid.cell", "1/23 m"}}), [](auto&) {}, true);
}

[[maybe_unused]] const bool blocks_listed = [] {
  const auto folder = std::filesystem::path(MPMFAST_SOURCE_DIR) / "configs" / "bench";
  if (!std::filesystem::is_directory(folder)) return false;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files)
    benchmark::RegisterBenchmark(("scene/" + file.stem().string()).c_str(), block, file)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  return true;
}();

[[maybe_unused]] const bool listed = [] {
  const auto file = std::filesystem::path(MPMFAST_SOURCE_DIR) / "configs" / "ellipses.yaml";
  if (!std::filesystem::exists(file)) return false;
  benchmark::RegisterBenchmark("scene/ellipses/2d", ellipses, file)
      ->ArgName("threads")
      ->Arg(1)
      ->Arg(2)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
