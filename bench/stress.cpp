/// The constitutive laws alone, on columns that stay in the second-level cache.

#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/state/columns.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/neo_hookean.hpp"

namespace {

using namespace mpmfast;

template <int Dim, class Law>
void stress(benchmark::State& state) {
  Law law{1200, 80e6, 30e6};
  benchmark::DoNotOptimize(law);  // a scene's numbers are no constants
  constexpr std::size_t n = 1024;
  Column<double> deformation[Dim * Dim], tau[kSymmetric<Dim>], wave_speed;
  for (auto& column : deformation) column.resize_discard(n);
  for (auto& column : tau) column.resize_discard(n);
  wave_speed.resize_discard(n);
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t e = 0; e < Dim * Dim; ++e)  // strains of up to 10 %, no two particles alike
      deformation[e][p] = (e % (Dim + 1) == 0 ? 1.0 : 0.0) + 0.1 * std::sin(static_cast<double>(p * 9 + e));
  for (auto& column : tau) benchmark::DoNotOptimize(column.data());  // somebody reads them
  benchmark::DoNotOptimize(wave_speed.data());
  for (auto _ : state) {
    for (std::size_t p = 0; p < n; p += kLanes) {
      Lanes f[Dim * Dim], t[kSymmetric<Dim>], c2;
      for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(deformation[e].data() + p);
      law.template stress<Dim>(f, t, c2);
      for (int s = 0; s < kSymmetric<Dim>; ++s) store_lanes(tau[s].data() + p, t[s]);
      store_lanes(wave_speed.data() + p, square_root(c2));
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}

BENCHMARK(stress<2, NeoHookean>)->Name("stress/neo_hookean/2d");
BENCHMARK(stress<3, NeoHookean>)->Name("stress/neo_hookean/3d");
BENCHMARK(stress<2, LinearElastic>)->Name("stress/linear_elastic/2d");
BENCHMARK(stress<3, LinearElastic>)->Name("stress/linear_elastic/3d");

}  // namespace
