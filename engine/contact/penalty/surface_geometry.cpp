#include "engine/contact/penalty/surface_geometry.hpp"

#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

template <int Dim>
void gather_positions(const State<Dim>& state, std::vector<Vec<Dim>>& out) {
  const auto& particles = state.particles;
  const double* x[Dim];
  for (int d = 0; d < Dim; ++d) x[d] = particles.column(Quantity::position, d);
  const auto runs = static_cast<std::int64_t>(state.tiling.runs.size());
  for_each_of(runs, state.threads, 1, [&](std::int64_t r) {
    const auto& run = item(state.tiling.runs, r);
    if (!run.on_surface) return;
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      Vec<Dim>& position = item(out, state.surfaces.number(run.body, particles.id()[p]));
      for (int d = 0; d < Dim; ++d) position[d] = x[d][p];
    }
  });
}

template void gather_positions<2>(const State<2>&, std::vector<Vec<2>>&);
template void gather_positions<3>(const State<3>&, std::vector<Vec<3>>&);

}  // namespace mpmfast::penalty
