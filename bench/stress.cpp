/// The constitutive laws alone, on columns that stay in the second-level cache.

#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/state/columns.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/metal.hpp"
#include "kernels/materials/neo_hookean.hpp"
#include "kernels/transfer/strain_chunk.hpp"

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

/// One step of a law with a history, state columns included; every step flows plastically (if the law does).
template <int Dim, auto Parameters>
void advance(benchmark::State& state) {
  auto law = Parameters;
  benchmark::DoNotOptimize(law);
  constexpr std::size_t n = 1024;
  Column<double> increment[Dim * Dim], tau[kSymmetric<Dim>], wave_speed, evolving[5 + kSymmetric<Dim>];
  for (auto& column : increment) column.resize_discard(n);
  for (auto& column : tau) column.resize_discard(n);
  for (auto& column : evolving) column.resize_discard(n);
  wave_speed.resize_discard(n);
  StateView<Dim> view{
      evolving[0].data(), evolving[1].data(), evolving[2].data(), evolving[3].data(), {}, nullptr};
  view.volume_ratio = evolving[4 + kSymmetric<Dim>].data();
  for (int c = 0; c < kSymmetric<Dim>; ++c) view.elastic_strain[c] = evolving[4 + c].data();
  for (std::size_t p = 0; p < n; ++p) {
    view.temperature[p] = law.start_temperature;
    view.volume_ratio[p] = 1;
    for (int c = 0; c < 3; ++c) view.elastic_strain[c][p] = 1;
    for (std::size_t e = 0; e < Dim * Dim; ++e)
      increment[e][p] = 0.02 * std::sin(static_cast<double>(p * 9 + e));
  }
  for (auto& column : tau) benchmark::DoNotOptimize(column.data());
  benchmark::DoNotOptimize(wave_speed.data());
  double sign = 1;
  for (auto _ : state) {
    sign = -sign;  // to and fro
    for (std::size_t p = 0; p < n; p += kLanes) {
      Lanes l[Dim * Dim], f[Dim * Dim], t[kSymmetric<Dim>], c2;
      for (int e = 0; e < Dim * Dim; ++e) {
        l[e] = sign * load_lanes(increment[e].data() + p);
        f[e] = broadcast<Lanes>(e % (Dim + 1) == 0 ? 1.0 : 0.0);
      }
      advance_law<Dim>(view, law, l, 1.0, 1, static_cast<std::uint32_t>(p), kLanes, f, t, c2);
      for (int s = 0; s < kSymmetric<Dim>; ++s) store_lanes(tau[s].data() + p, t[s]);
      store_lanes(wave_speed.data() + p, square_root(c2));
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}

constexpr GruneisenVolume kState{188e9, 2, 1.44, 0.4, 4, 1e-3};
constexpr JohnsonCook kCook{90e6, 292e6, 0.31, 0.025, 1, 1.09, 293, 1356};
constexpr MieGruneisen kFluid{8870, 76e9, kState, {}, 444};
constexpr ElasticPlastic kSteel{7800, 80e9, {160e9}, {400e6, 1e9}};
constexpr MieGruneisenPlastic kNickel{8870, 76e9, kState, {150e6, 0}, 444};
constexpr ElasticJohnsonCook kCopper{8960, 46e9, {140e9}, kCook, 383};
constexpr MieGruneisenJohnsonCook kShockedCopper{8960, 46e9, kState, kCook, 383};

BENCHMARK(stress<2, NeoHookean>)->Name("stress/neo_hookean/2d");
BENCHMARK(stress<3, NeoHookean>)->Name("stress/neo_hookean/3d");
BENCHMARK(stress<2, LinearElastic>)->Name("stress/linear_elastic/2d");
BENCHMARK(stress<3, LinearElastic>)->Name("stress/linear_elastic/3d");
BENCHMARK(stress<2, LogarithmicNeoHookean>)->Name("stress/logarithmic_neo_hookean/2d");
BENCHMARK(stress<3, LogarithmicNeoHookean>)->Name("stress/logarithmic_neo_hookean/3d");
BENCHMARK(advance<2, kFluid>)->Name("stress/mie_gruneisen/2d");
BENCHMARK(advance<3, kFluid>)->Name("stress/mie_gruneisen/3d");
BENCHMARK(advance<2, kSteel>)->Name("stress/j2_plasticity/2d");
BENCHMARK(advance<3, kSteel>)->Name("stress/j2_plasticity/3d");
BENCHMARK(advance<2, kNickel>)->Name("stress/j2_plasticity_mie_gruneisen/2d");
BENCHMARK(advance<3, kNickel>)->Name("stress/j2_plasticity_mie_gruneisen/3d");
BENCHMARK(advance<2, kCopper>)->Name("stress/johnson_cook/2d");
BENCHMARK(advance<3, kCopper>)->Name("stress/johnson_cook/3d");
BENCHMARK(advance<2, kShockedCopper>)->Name("stress/johnson_cook_mie_gruneisen/2d");
BENCHMARK(advance<3, kShockedCopper>)->Name("stress/johnson_cook_mie_gruneisen/3d");

}  // namespace
