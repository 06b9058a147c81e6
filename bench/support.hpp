#pragma once

/// @file Scenes of the benchmarks, and the least work that a pass must do on a particle.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <omp.h>

#include <string>

#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"

namespace mpmfast::bench {

/// Cells along the sides of the block: about 200 000 particles of 2 a cell side.
template <int Dim>
inline constexpr int kBlockSide = Dim == 2 ? 224 : 29;

/// A block of neo-Hookean solid in a grid with space to move, cut into `cuts` bodies along x and along y.
template <int Dim>
std::string block_yaml(const std::string& basis, const std::string& update, int cuts = 1) {
  constexpr int side = kBlockSide<Dim>, margin = 16;
  const auto cube = [](const std::string& length) {
    return Dim == 2 ? fmt::format("[{0}, {0}]", length) : fmt::format("[{0}, {0}, {0}]", length);
  };
  std::string text = fmt::format(R"(
space: {}
grid: {{origin: {}, size: {}, cell: 1 mm}}
time: {{end: 1 s}}
materials: {{rubber: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
method: {{basis: {}, update: {}}}
contact: {{law: coulomb, friction: 0.2}}
bodies:
)",
                                 Dim == 2 ? "plane_strain" : "3d", cube(fmt::format("-{} mm", margin)),
                                 cube(fmt::format("{} mm", side + 2 * margin)), basis, update);
  const auto corner = [&](int x, int y, int z) {
    const std::string plane = fmt::format("{} mm, {} mm", x * side / cuts, y * side / cuts);
    return Dim == 2 ? fmt::format("[{}]", plane) : fmt::format("[{}, {} mm]", plane, z * side);
  };
  for (int y = 0; y < cuts; ++y)
    for (int x = 0; x < cuts; ++x)
      text += fmt::format("  - {{name: part{}_{}, box: {{from: {}, to: {}}}, material: rubber}}\n", x, y,
                          corner(x, y, 0), corner(x + 1, y + 1, 1));
  return text;
}

/// Strains the particles of a step that was not yet taken by 2 % and shears them by 3 %, so that particles
/// and cells do not march in step, and lets them shear on.
template <int Dim>
void strain_block(Step<Dim>& step) {
  Mat<Dim> gradient = 0.02 * Mat<Dim>::Identity();
  gradient(0, 1) = 0.03;
  auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<Dim> shift = gradient * particles.vector(Quantity::position, p);
    for (int d = 0; d < Dim; ++d) {
      particles.column(Quantity::position, d)[p] += shift[d];
      particles.column(Quantity::velocity, d)[p] = 1.0 + 10.0 * shift[d];
      for (int j = 0; j < Dim; ++j)
        particles.column(Quantity::deformation_gradient, Dim * d + j)[p] += gradient(d, j);
    }
  }
}

/// A scene with its step. Threads are set first: the passes take one workspace for each.
template <int Dim>
struct Running {
  int threads;
  Scene scene;
  Step<Dim> step;

  Running(int thread_count, Scene read)
      : threads((omp_set_num_threads(thread_count), thread_count)), scene(std::move(read)), step(scene) {}
  void advance(int steps) {
    for (int k = 0; k < steps; ++k) step.advance(step.stable_dt());
  }
  double particles() const { return static_cast<double>(step.state().particles.size()); }
};

inline void set_rate(benchmark::State& state, const char* name, double amount) {
  state.counters[name] = benchmark::Counter(amount, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace mpmfast::bench
