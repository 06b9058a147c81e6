/// Cost of the contact normal of one node, by the size of its cloud.

#include "kernels/contact/regression.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace mpmfast;

/// Two half-spaces of jittered points about the node, parted by a plane of random direction and offset.
template <int Dim>
struct RandomCloud {
  std::array<std::vector<double>, Dim> xi;
  std::vector<double> side;
  int count;

  RandomCloud(int n, std::mt19937_64& draw) : count(n) {
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> coordinate(-1.25, 1.25), offset(-0.2, 0.2);
    Vec<Dim> normal;
    for (int d = 0; d < Dim; ++d) normal[d] = gauss(draw);
    normal.normalize();
    const double plane = offset(draw);
    const auto padded = static_cast<std::size_t>(padded_count(n));
    for (auto& column : xi) column.assign(padded, 0.0);
    side.assign(padded, 0.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
      Vec<Dim> x;
      do {  // no point closer to the plane than a particle's half-size
        for (int d = 0; d < Dim; ++d) x[d] = coordinate(draw);
      } while (std::abs(x.dot(normal) - plane) < 0.2);
      for (std::size_t d = 0; d < Dim; ++d) xi[d][k] = x[static_cast<int>(d)];
      side[k] = x.dot(normal) < plane ? -1.0 : 1.0;
    }
  }

  CloudView<Dim> view() const {
    CloudView<Dim> v;
    for (std::size_t d = 0; d < Dim; ++d) v.xi[d] = xi[d].data();
    v.side = side.data();
    v.count = count;
    return v;
  }
};

template <int Dim>
void fit(benchmark::State& state) {
  constexpr std::size_t draws = 256;  // enough that the branches are not learnt by heart
  std::mt19937_64 draw(20);
  std::vector<RandomCloud<Dim>> clouds;
  for (std::size_t i = 0; i < draws; ++i) clouds.emplace_back(static_cast<int>(state.range(0)), draw);
  std::size_t next = 0;
  std::int64_t steps = 0;
  for (auto _ : state) {
    auto fitted = fit_normal<Dim>(clouds[next].view(), {.penalty = 1e-7});
    benchmark::DoNotOptimize(fitted);
    steps += fitted.iterations;
    next = (next + 1) % draws;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["steps"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kAvgIterations);
}

BENCHMARK(fit<2>)->Name("regression/2d")->Arg(12)->Arg(24)->Arg(36);
BENCHMARK(fit<3>)->Name("regression/3d")->Arg(60)->Arg(150);

}  // namespace
