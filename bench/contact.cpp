/// Normals and separations of all contact pairs of a state, without the rest of the step: what a pair
/// costs, with and without the mean over the nodes around and the separations.

#include <filesystem>

#include "bench/support.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::bench;

/// The grains as they are seeded, on the scene's grid; or pressed together by a fast piston on a grid of
/// twice its cells, where most contact nodes have three fields and more.
enum Grains { loose, pressed };

std::unique_ptr<Running<2>> grains(Grains kind, int threads) {
  const auto file = std::filesystem::path(MPMFAST_SOURCE_DIR) / "configs" / "ellipses.yaml";
  std::vector<Override> changes;
  if (kind == pressed)
    changes = {{"grid.cell", "1/35 mm"}, {"boundaries.top.piston", "600 m/s"}, {"time.end", "2.5 us"}};
  auto running = std::make_unique<Running<2>>(threads, read_scene(file, changes));
  running->advance(kind == pressed ? 600 : 20);
  return running;
}

/// Listing the nodes and finding the geometry of their pairs again and again, from a warm start.
void geometry(benchmark::State& state, Grains kind, NormalKind normal, SeparationKind separation) {
  const auto running = grains(kind, static_cast<int>(state.range(0)));
  Scene scene = running->scene;
  scene.contact.normal = normal;
  scene.contact.separation = separation;
  const Plan plan = make_plan(scene);
  const Cracks<2> cracks(scene, plan);
  Contact<2> contact(scene, plan, cracks);
  const auto passes = make_passes<2>(plan.basis);
  for (auto _ : state) {
    contact.find_pairs(running->step.state());
    contact.find_geometry(running->step.state(), *passes);
    benchmark::ClobberMemory();
  }
  const auto pairs = static_cast<double>(contact.list().pairs.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs));
  state.counters["nodes"] = static_cast<double>(contact.list().nodes.size());
  state.counters["entries"] = pairs;
}

[[maybe_unused]] const bool listed = [] {
  const auto list = [](const std::string& name, Grains kind, NormalKind normal, SeparationKind separation) {
    benchmark::RegisterBenchmark(("contact/" + name + (kind == loose ? "/loose" : "/pressed")).c_str(),
                                 geometry, kind, normal, separation)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
  };
  for (const Grains kind : {loose, pressed}) {
    list("smoothed", kind, NormalKind::smoothed_logistic_regression, SeparationKind::ellipsoid);
    list("plain", kind, NormalKind::logistic_regression, SeparationKind::ellipsoid);
    list("normals_alone", kind, NormalKind::logistic_regression, SeparationKind::none);
  }
  return true;
}();

}  // namespace
