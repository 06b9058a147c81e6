#include "engine/run/overlap_at_start.hpp"

#include <fmt/format.h>

#include <numeric>

#include "engine/output/overlap.hpp"

namespace mpmfast {

OverlapAtStart overlap_at_start(const State<2>& state, const Scene& scene) {
  if (scene.bodies.size() < 2) return {};
  std::vector<int> owner(state.bodies.size());
  std::iota(owner.begin(), owner.end(), 0);
  const Overlap overlap =
      measure_overlap(state.particles, state.bodies, owner, state.surfaces, state.threads);
  const double all = area_of_domains(state.particles, state.bodies, state.surfaces);
  if (overlap.area <= 1e-9 * all) return {};
  std::string who;
  if (overlap.particles_inside > 0) {
    const auto name = [&](int body) { return scene.bodies[static_cast<std::size_t>(body)].name; };
    who = fmt::format(", '{}' in '{}'", name(overlap.owners.first), name(overlap.owners.second));
  }
  return {fmt::format("{:.4g} m^2, {:.2g} % of all bodies ({} particles lie inside another body{})",
                      overlap.area, 100 * overlap.area / all, overlap.particles_inside, who),
          overlap.particles_inside > 0};
}

}  // namespace mpmfast
