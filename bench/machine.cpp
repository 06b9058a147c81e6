/// The machine's bounds, against which the other figures are read: memory bandwidth and floating-point peak.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cstddef>

#include "engine/state/columns.hpp"
#include "kernels/simd/lanes.hpp"

namespace {

using namespace mpmfast;

/// Sets the threads and makes the team, which takes milliseconds.
void start_threads(int threads) {
  omp_set_num_threads(threads);
#pragma omp parallel
  benchmark::ClobberMemory();
}

/// A bound is the best of many short repetitions: one of them is not interrupted.
void repeat_often(benchmark::internal::Benchmark* bound) { bound->Repetitions(20)->MinTime(0.005); }

/// a = b + s c over three columns of n doubles, far beyond or well within the caches.
void triad(benchmark::State& state) {
  start_threads(static_cast<int>(state.range(0)));
  const auto n = static_cast<std::int64_t>(state.range(1)) * (1024 / 8);
  // Kept from one repetition to the next: their pages cost more than the triad.
  static Column<double> a, b, c;
  for (auto* column : {&a, &b, &c}) column->resize_discard(static_cast<std::size_t>(n));
  double *to = a.data(), *from = b.data(), *scaled = c.data();
  for (auto _ : state) {
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; k += kLanes)
      store_lanes(to + k, load_lanes(from + k) + 3.0 * load_lanes(scaled + k));
    benchmark::ClobberMemory();
  }
  state.counters["B/s"] =
      benchmark::Counter(24.0 * static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate,
                         benchmark::Counter::kIs1000);
}
BENCHMARK(triad)
    ->Name("machine/triad")
    ->ArgNames({"threads", "KiB"})
    ->ArgsProduct({{1, 2}, {4 * 1024, 128 * 1024}})
    ->Apply(repeat_often)
    ->UseRealTime();

/// Multiply-adds on registers alone, enough of them in flight to cover their latency.
void multiply_add(benchmark::State& state) {
  constexpr int chains = 12, rounds = 1 << 14;
  const int threads = static_cast<int>(state.range(0));
  start_threads(threads);
  // Not DoNotOptimize: with g++, that of benchmark 1.7 leaves another number in a double.
  volatile double one = 1.0;
  const double start = one;
  for (auto _ : state) {
#pragma omp parallel
    {
      const Lanes factor = broadcast<Lanes>(1.0 - 1e-9 * start), term = broadcast<Lanes>(1e-9 * start);
      Lanes sum[chains];
      for (auto& s : sum) s = broadcast<Lanes>(start);
      for (int round = 0; round < rounds; ++round) {
#pragma GCC unroll 16
        for (int k = 0; k < chains; ++k) sum[k] = sum[k] * factor + term;
      }
      for (auto& s : sum) benchmark::DoNotOptimize(s);
    }
  }
  state.counters["flop/s"] = benchmark::Counter(2.0 * kLanes * chains * rounds * threads,
                                                benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(multiply_add)
    ->Name("machine/multiply_add")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Apply(repeat_often)
    ->UseRealTime();

}  // namespace
