#pragma once

/// @file Nodes to particles: velocities, positions, and (strain last) strains at the end of a step (theory
/// §3).

#include "kernels/transfer/affine.hpp"
#include "kernels/transfer/strain_force.hpp"

namespace mpmfast {

enum class ParticleUpdate { flip, pic, xpic, apic };
/// The end velocity makes X and V a symplectic pair. With the midpoint, X ← X + ½Δt (v + v⁺) under forces at
/// the old X, oscillations held by the geometric stiffness (the pressure) grow by ½(ωΔt)² a step.
enum class PositionUpdate { grid_end, grid, trapezoid, particle };

struct UpdateRule {
  ParticleUpdate velocity;
  PositionUpdate position;
  double dt;
  double dt_strain;  ///< > 0: advance the strain with v⁺ by this time
  int terms;         ///< of the exponential in the strain
};

/// Columns gathered by the update: v⁺, a Δt, and for XPIC m(v − v*).
inline constexpr int update_vectors(ParticleUpdate u) { return u == ParticleUpdate::xpic ? 3 : 2; }

template <int Dim, class Basis>
struct UpdateRoom : StrainForceRoom<Dim, Basis> {
  static constexpr int kRecords = records_for(3 * Dim);
  Window<Dim, records_for(2 * Dim)> two;
  Window<Dim, kRecords> three;
  Record values[kRecords][kChunk<Dim>];
  alignas(64) double value[4 * kRecords][kChunk<Dim>];  ///< by component
  alignas(64) double moved[2 * Dim][kChunk<Dim>];       ///< new positions, new velocities
  alignas(64) double edge[Dim * Dim][kChunk<Dim>];
  alignas(64) double drift[kChunk<Dim>];
};

/// What an update reports of a tile.
struct TileReport {
  double fastest = 0;  ///< max_p (c_p + |v_p|), m/s
  double speed = 0;    ///< max_p |V_p| and |mean velocity of its motion|, m/s
  double smallest_j = 1e300;
  bool lost = false;  ///< a particle is not finite or outside the allowed box
};

/// One tile. FLIP: V ← V + S aΔt; PIC: V ← S v⁺ (N20 Eq. 38); XPIC: V ← m S(v − v*) + S aΔt (Eq. 41; FMPM
/// alike); APIC: as PIC, and the slopes about the particle. Positions: grid_end X ← X + Δt S v⁺; grid X ← X +
/// Δt(S v⁺ − ½ S aΔt); trapezoid ½(V_old + V_new); particle V_new.
/// @param nodes  v⁺, aΔt (and m(v − v*) when NV is 3)
/// @param lower, upper  box that particles must stay in, m
template <int Dim, class Basis, int NV, class VisitMaterial>
TileReport update_tile(const TileContext<Dim>& c, UpdateRoom<Dim, Basis>& room,
                       const NodeColumns<NV * Dim>& nodes, const UpdateRule& rule, const double (&lower)[Dim],
                       const double (&upper)[Dim], const VisitMaterial& visit_material) {
  constexpr int NR = records_for(NV * Dim);
  const ParticleView<Dim>& p = *c.particles;
  TileReport report;
  auto& window = [&]() -> auto& {
    if constexpr (NV == 2)
      return room.two;
    else
      return room.three;
  }
  ();
  load_window<Dim, NV * Dim>(nodes, c.tile->slot, window);
  for_each_chunk<Dim, Basis, Wanted::values>(
      c, room.weights, [&](auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        Record(&values)[NR][kChunk<Dim>] = reinterpret_cast<Record(&)[NR][kChunk<Dim>]>(room.values);
        for (int r = 0; r < NR; ++r)
          for (int k = 0; k < count; ++k) values[r][k] = gather_values(w, k, window.at[r]);
        unstack<Dim, NR>(values, count, reinterpret_cast<double(&)[4 * NR][kChunk<Dim>]>(room.value));
        if constexpr (Basis::kSpread > 0 && NV == 2) {
          if (rule.velocity == ParticleUpdate::apic)
            gather_slopes<Dim, Basis>(c, run, w, begin, count, window.at[0], values[0], room);
        }
        if (rule.dt_strain > 0) {
          if (Dim == 2 && p.depth == Depth::hoop)
            for (int k = 0; k < count; k += kLanes)  // S v⁺_r / r
              store_lanes(&room.hoop_rate[k],
                          load_lanes(&room.value[0][k]) / load_lanes(p.position[0] + begin + k));
          Basis::template stage<Wanted::gradients>(chunk_geometry(c, run, begin, count), w);
          // v⁺ comes first in the window, so its gradient is that of the first record.
          gather_velocity_gradient(w, count, window.at[0], room);
          visit_material(c.bodies[run.body].material, [&](const auto& law) {
            const double j = strain_chunk<Dim>(p, law, begin, count, rule.dt_strain, rule.terms, room);
            report.smallest_j = j < report.smallest_j ? j : report.smallest_j;
          });
        }
        for (int k = 0; k < count; k += kLanes) {
          Lanes speed2 = broadcast<Lanes>(0.0), drift2 = broadcast<Lanes>(0.0);
          for (int d = 0; d < Dim; ++d) {
            const Lanes grid = load_lanes(&room.value[d][k]), jump = load_lanes(&room.value[Dim + d][k]);
            const Lanes v = load_lanes(p.velocity[d] + begin + k), x = load_lanes(p.position[d] + begin + k);
            Lanes v_new = grid;
            if (rule.velocity == ParticleUpdate::flip) v_new = v + jump;
            if (rule.velocity == ParticleUpdate::xpic) v_new = load_lanes(&room.value[2 * Dim + d][k]) + jump;
            Lanes mean = grid;
            if (rule.position == PositionUpdate::grid) mean = grid - 0.5 * jump;
            if (rule.position == PositionUpdate::trapezoid) mean = 0.5 * (v + v_new);
            if (rule.position == PositionUpdate::particle) mean = v_new;
            store_lanes(&room.moved[d][k], x + rule.dt * mean);
            store_lanes(&room.moved[Dim + d][k], v_new);
            speed2 += v_new * v_new;
            drift2 += mean * mean;
          }
          const Lanes speed = square_root(speed2);
          store_lanes(&room.jacobian[k], speed + load_lanes(p.wave_speed + begin + k));
          store_lanes(&room.drift[k], square_root(larger(speed2, drift2)));
          if constexpr (Basis::kConvected) {
            Lanes f[Dim * Dim], edge[Dim * Dim];
            for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(p.deformation[e] + begin + k);
            Basis::convect(f, c.bodies[run.body].half_size, c.grid->inverse_cell, edge);
            for (int e = 0; e < Dim * Dim; ++e) store_lanes(&room.edge[e][k], edge[e]);
          }
        }
        const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
        for (int d = 0; d < Dim; ++d) {
          std::memcpy(p.position[d] + begin, room.moved[d], bytes);
          std::memcpy(p.velocity[d] + begin, room.moved[Dim + d], bytes);
        }
        if constexpr (Basis::kConvected)
          for (int e = 0; e < Dim * Dim; ++e) std::memcpy(p.edges[e] + begin, room.edge[e], bytes);
        bool inside = true;
        for (int k = 0; k < count; ++k) {
          report.fastest = larger(room.jacobian[k], report.fastest);
          report.speed = larger(room.drift[k], report.speed);
          inside &= room.jacobian[k] < 1e300;  // false for NaN
        }
        for (int d = 0; d < Dim; ++d)
          for (int k = 0; k < count; ++k)
            inside &= room.moved[d][k] > lower[d] && room.moved[d][k] < upper[d];
        report.lost |= !inside;
      });
  return report;
}

}  // namespace mpmfast
