#pragma once

/// @file New velocities and positions of a chunk of particles: no basis in sight, so that the engine compiles
/// it once and not with every basis.

#include "kernels/basis/domain_limit.hpp"
#include "kernels/basis/weights.hpp"
#include "kernels/constants.hpp"
#include "kernels/transfer/update_rule.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// What an update reports of a tile, by lane.
struct LaneReport {
  Lanes fastest{}, speed_squared{};
  bool lost = false;

  void add_to(TileReport& sum) const {
    for (int i = 0; i < kLanes; ++i) {
      sum.fastest = larger(fastest[i], sum.fastest);
      sum.speed = larger(square_root(speed_squared[i]), sum.speed);
    }
    sum.lost |= lost;
  }
};

/// New velocities and positions of a chunk from the nodal quantities in `value`, and its domains if
/// Convected.
template <int Dim, bool Convected>
void move_chunk(const TileContext<Dim>& c, int body, std::uint32_t begin, int count,
                const double (*value)[kChunk<Dim>], const UpdateRule& rule, const double (&lower)[Dim],
                const double (&upper)[Dim], LaneReport& report) {
  const ParticleView<Dim>& p = *c.particles;
  for (int k = 0; k < count; k += kLanes) {
    fetch_further(p.position, begin + static_cast<std::uint32_t>(k));
    fetch_further(p.velocity, begin + static_cast<std::uint32_t>(k));
    const IntLanes counts = lanes_before(count - k);
    const LaneSet all = leading_lanes(count - k);
    LaneSet sound = all;  // finite, and in the box
    Lanes speed2 = broadcast<Lanes>(0.0), drift2 = broadcast<Lanes>(0.0);
    for (int d = 0; d < Dim; ++d) {
      const Lanes grid = load_lanes(&value[d][k]), jump = load_lanes(&value[Dim + d][k]);
      const Lanes v = load_lanes(p.velocity[d] + begin + k), x = load_lanes(p.position[d] + begin + k);
      Lanes v_new = grid;
      if (rule.velocity == ParticleUpdate::flip) v_new = v + jump;
      if (rule.velocity == ParticleUpdate::xpic) v_new = load_lanes(&value[2 * Dim + d][k]) + jump;
      Lanes mean = grid;
      if (rule.position == PositionUpdate::grid) mean = grid - 0.5 * jump;
      if (rule.position == PositionUpdate::trapezoid) mean = 0.5 * (v + v_new);
      if (rule.position == PositionUpdate::particle) mean = v_new;
      const Lanes x_new = x + rule.dt * mean;
      store_first(p.position[d] + begin + k, x_new, count - k);
      store_first(p.velocity[d] + begin + k, v_new, count - k);
      sound = where_less(sound, broadcast<Lanes>(lower[d]), x_new);
      sound = where_less(sound, x_new, broadcast<Lanes>(upper[d]));
      speed2 += v_new * v_new;
      drift2 += mean * mean;
    }
    const Lanes fastest = square_root(speed2) + load_lanes(p.wave_speed + begin + k);
    report.lost |= !same_lanes(where_less(sound, fastest, broadcast<Lanes>(constants::kMostSound)), all);
    report.fastest = larger(counts ? fastest : 0.0, report.fastest);
    report.speed_squared = larger(counts ? larger(speed2, drift2) : 0.0, report.speed_squared);
    if constexpr (Convected) {
      fetch_further(p.edges, begin + static_cast<std::uint32_t>(k));
      Lanes f[Dim * Dim], edge[Dim * Dim];
      for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(p.deformation[e] + begin + k);
      if (p.domain_share[0])
        for (int e = 0; e < Dim * Dim; ++e) f[e] *= load_lanes(p.domain_share[e % Dim] + begin + k);
      convect_domain<Dim>(f, c.bodies[body].half_size, c.grid->inverse_cell, edge);
      for (int e = 0; e < Dim * Dim; ++e) store_first(p.edges[e] + begin + k, edge[e], count - k);
    }
  }
}

}  // namespace mpmfast
