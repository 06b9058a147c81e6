/// The passes between particles and nodes, and the sort, for each basis and dimension.

#include "bench/support.hpp"
#include "bench/work.hpp"
#include "engine/scene/keys/basis_names.hpp"
#include "kernels/transfer/update_rule.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::bench;

/// A strained block of one field on which any pass may be called again and again: XPIC, so that all columns
/// exist, or APIC.
template <int Dim>
struct Block : Running<Dim> {
  std::unique_ptr<Passes<Dim>> passes;
  PassWork<Dim> work;

  Block(int threads, BasisKind basis, const char* update)
      : Running<Dim>(threads,
                     parse_scene(block_yaml<Dim>(std::string(name_of(kBases, basis)), update), "block.yaml")),
        passes(make_passes<Dim>(basis)),
        work(basis, 0) {
    auto& state = this->step.state();
    strain_block(this->step);
    passes->shape_domains(state);
    state.nodes.plan(state.nodes.quantities(), true);  // space for Δv*, though nothing is in contact
    this->advance(2);
    passes->sort(state);  // wide supports may have drifted out of their windows
    work = PassWork<Dim>(basis, state.tiling.slots() / this->particles());
  }
};

/// Times `pass(block)` and reports particles/s with the rates of the least bytes and flops.
template <int Dim, class Pass>
void time_pass(benchmark::State& state, BasisKind basis, Pass pass, Work (*least)(const Block<Dim>&),
               const char* word = "xpic(2)") {
  Block<Dim> block(static_cast<int>(state.range(0)), basis, word);
  for (auto _ : state) pass(block, state);
  const Work work = least(block);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(block.particles()));
  state.counters["B/particle"] = work.bytes;
  state.counters["flop/particle"] = work.flops;
  set_rate(state, "B/s", work.bytes * block.particles());
  set_rate(state, "flop/s", work.flops * block.particles());
}

/// Too short to move or strain anything, however often a pass is repeated.
constexpr double kInstant = 1e-15;

// Scattering passes add to their columns, which a step clears first; here the sums just grow.

template <int Dim>
void project(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis, [](auto& block, auto&) { block.passes->project(block.step.state(), false); },
      [](const Block<Dim>& block) { return block.work.project(); });
}

template <int Dim>
void project_force(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis, [](auto& block, auto&) { block.passes->project(block.step.state(), true); },
      [](const Block<Dim>& block) { return block.work.project_force(); });
}

template <int Dim>
void project_affine(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis, [](auto& block, auto&) { block.passes->project(block.step.state(), false); },
      [](const Block<Dim>& block) { return block.work.project_affine(); }, "apic");
}

template <int Dim>
void strain_and_force(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis,
      [](auto& block, auto&) { block.passes->strain_and_force(block.step.state(), kInstant, 2); },
      [](const Block<Dim>& block) { return block.work.strain_and_force(); });
}

template <int Dim, ParticleUpdate Update>
void update(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis,
      [](auto& block, auto&) {
        const UpdateRule rule{Update, PositionUpdate::grid, kInstant, 0, 2, true};
        block.passes->update(block.step.state(), rule, Vec<Dim>::Constant(-1), Vec<Dim>::Constant(1));
      },
      [](const Block<Dim>& block) { return block.work.update(update_vectors(Update)); });
}

template <int Dim>
void update_strain(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis,
      [](auto& block, auto&) {
        const UpdateRule rule{ParticleUpdate::flip, PositionUpdate::grid, kInstant, kInstant, 2, true};
        block.passes->update(block.step.state(), rule, Vec<Dim>::Constant(-1), Vec<Dim>::Constant(1));
      },
      [](const Block<Dim>& block) { return block.work.update_strain(update_vectors(ParticleUpdate::flip)); });
}

template <int Dim>
void update_affine(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis,
      [](auto& block, auto&) {
        const UpdateRule rule{ParticleUpdate::apic, PositionUpdate::particle, kInstant, 0, 2, true};
        block.passes->update(block.step.state(), rule, Vec<Dim>::Constant(-1), Vec<Dim>::Constant(1));
      },
      [](const Block<Dim>& block) { return block.work.update_affine(); }, "apic");
}

template <int Dim, bool Paired>
void xpic(benchmark::State& state, BasisKind basis) {
  time_pass<Dim>(
      state, basis, [](auto& block, auto&) { block.passes->xpic(block.step.state(), Paired); },
      [](const Block<Dim>& block) { return block.work.xpic(Paired ? 2 : 1); });
}

/// As in a run: the particles drifted by half a cell since the last sort.
template <int Dim>
void sort(benchmark::State& state, BasisKind basis) {
  double way = 0.5;
  time_pass<Dim>(
      state, basis,
      [&way](auto& block, auto& timer) {
        timer.PauseTiming();
        auto& all = block.step.state();
        for (int d = 0; d < Dim; ++d)
          for (std::size_t p = 0; p < all.particles.size(); ++p)
            all.particles.column(Quantity::position, d)[p] += way * all.grid.cell;
        way = -way;
        timer.ResumeTiming();
        block.passes->sort(all);
      },
      [](const Block<Dim>& block) { return block.work.sort(block.step.plan().particle_columns); });
}

template <int Dim>
void list_passes(BasisKind basis) {
  const auto add = [&](const char* pass, void (*run)(benchmark::State&, BasisKind)) {
    const std::string name = fmt::format("{}/{}/{}d", pass, name_of(kBases, basis), Dim);
    benchmark::RegisterBenchmark(name.c_str(), run, basis)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("project", project<Dim>);
  add("project_force", project_force<Dim>);
  add("strain_and_force", strain_and_force<Dim>);
  add("update_flip", update<Dim, ParticleUpdate::flip>);
  add("update_strain", update_strain<Dim>);
  add("update_xpic", update<Dim, ParticleUpdate::xpic>);
  add("xpic_plain", xpic<Dim, false>);
  add("xpic_paired", xpic<Dim, true>);
  add("sort", sort<Dim>);
  if (!(facts(basis).spread > 0)) return;  // no apic
  add("project_apic", project_affine<Dim>);
  add("update_apic", update_affine<Dim>);
}

[[maybe_unused]] const bool listed = [] {
  for (const auto& basis : kBases) {
    list_passes<2>(basis.value);
    list_passes<3>(basis.value);
  }
  return true;
}();

}  // namespace
