#include "engine/run/overlap_at_start.hpp"

#include <fmt/format.h>

#include <numeric>

#include "engine/output/first_overlaps.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kMostPairs = 100;  ///< of bodies: who has so many has made one mistake for all of them

}  // namespace

OverlapAtStart overlap_at_start(const State<2>& state, const Scene& scene) {
  if (scene.bodies.size() < 2) return {};
  std::vector<int> owner(state.bodies.size());
  std::iota(owner.begin(), owner.end(), 0);
  const FirstOverlaps first =
      first_overlaps(state.particles, state.bodies, owner, state.surfaces, kMostPairs, state.threads);
  const Overlap& overlap = first.overlap;
  const auto name = [&](int body) { return scene.bodies[static_cast<std::size_t>(body)].name; };
  if (!first.all)
    return {fmt::format("more than {} pairs of bodies have particles in each other, '{}' in '{}' for one",
                        kMostPairs, name(overlap.owners.first), name(overlap.owners.second)),
            true, true};
  const double all = area_of_domains(state.particles, state.bodies, state.surfaces);
  if (overlap.area <= 1e-9 * all) return {};
  std::string who;
  if (overlap.particles_inside > 0) {
    who = fmt::format(", '{}' in '{}'", name(overlap.owners.first), name(overlap.owners.second));
  }
  return {fmt::format("{:.4g} m^2, {:.2g} % of all bodies ({} particles lie inside another body{})",
                      overlap.area, 100 * overlap.area / all, overlap.particles_inside, who),
          overlap.particles_inside > 0};
}

}  // namespace mpmfast
