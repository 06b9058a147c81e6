/// Cost of the contacts of one node where several fields meet, solved together, by the number of fields:
/// alone, and in a lane of as many nodes as a vector holds.

#include "kernels/contact/lane_solver.hpp"

#include <benchmark/benchmark.h>

#include <bit>
#include <random>
#include <vector>

#include "kernels/contact/resolve_pair.hpp"
#include "tests/compressed_node.hpp"

namespace {

using namespace mpmfast;

/// Orders of magnitude that masses span: those of the corners of grains.
constexpr double kOrders = 4;

template <int Dim>
void solve(benchmark::State& state) {
  constexpr std::size_t draws = 256;  // enough that the branches are not learnt by heart
  std::mt19937_64 draw(20);
  std::vector<CompressedNode<Dim>> nodes;
  for (std::size_t i = 0; i < draws; ++i) nodes.emplace_back(static_cast<int>(state.range(0)), kOrders, draw);
  const Coulomb friction{0.2, 0};
  NodeSolver<Dim> solver;
  std::size_t next = 0;
  std::int64_t laws = 0, unsettled = 0;
  for (auto _ : state) {
    solver.fields = nodes[next].fields;
    solver.contacts = nodes[next].contacts;
    unsettled += !solver.solve([&](std::size_t k, const Vec<Dim>& stick) {
      ++laws;
      return response_of(resolve_pair<Dim>(stick, solver.contacts[k].normal, -1.0, friction), stick);
    });
    benchmark::DoNotOptimize(solver.contacts.data());
    next = (next + 1) % draws;
  }
  state.SetItemsProcessed(state.iterations());
  const auto average = [&](std::int64_t n) {
    return benchmark::Counter(static_cast<double>(n), benchmark::Counter::kAvgIterations);
  };
  state.counters["laws"] = average(laws);
  state.counters["unsettled"] = average(unsettled);
}

/// The same nodes, filled into lanes and solved there; an item is a node.
template <int Dim, int kFields>
void solve_in_lanes(benchmark::State& state) {
  constexpr int draws = 256;
  std::mt19937_64 draw(20);
  std::vector<CompressedNode<Dim>> nodes;
  for (int i = 0; i < draws; ++i) nodes.emplace_back(kFields, kOrders, draw);
  const Coulomb friction{0.2, 0};
  ActiveSetRule<Dim> rule;
  rule.acts = rule.friction = true;
  LaneSolver<Dim, kFields> solver;
  std::size_t next = 0;
  std::int64_t unsettled = 0;
  for (auto _ : state) {
    while (!solver.is_full()) {
      const CompressedNode<Dim>& node = nodes[next];
      const int lane = solver.begin_node();
      for (int k = 0; k < kFields; ++k) {
        const MovingField<Dim>& field = node.fields[static_cast<std::size_t>(k)];
        solver.set_field(lane, k, field.velocity, field.inverse_mass);
      }
      for (const FieldContact<Dim>& c : node.contacts)
        solver.add_contact(lane, c.a, c.b, c.normal, c.reduced_mass, 0, rule, friction);
      next = (next + 1) % draws;
    }
    unsettled += kLanes - std::popcount(solver.solve(true));
  }
  state.SetItemsProcessed(state.iterations() * kLanes);
  state.counters["unsettled"] =
      benchmark::Counter(static_cast<double>(unsettled) / kLanes, benchmark::Counter::kAvgIterations);
}

BENCHMARK(solve_in_lanes<2, 3>)->Name("together_in_lanes/2d/fields:3");
BENCHMARK(solve_in_lanes<2, 4>)->Name("together_in_lanes/2d/fields:4");
BENCHMARK(solve_in_lanes<3, 3>)->Name("together_in_lanes/3d/fields:3");
BENCHMARK(solve_in_lanes<3, 4>)->Name("together_in_lanes/3d/fields:4");
BENCHMARK(solve<2>)->Name("together/2d")->ArgName("fields")->Arg(3)->Arg(4)->Arg(5);
BENCHMARK(solve<3>)->Name("together/3d")->ArgName("fields")->Arg(3)->Arg(4)->Arg(5);

}  // namespace
