#pragma once

/// @file Inputs and results of the particle update, without its kernel.

namespace mpmfast {

enum class ParticleUpdate { flip, pic, xpic, apic };
/// The end velocity (v⁺, or v′ where that strains too) makes X and V a symplectic pair. With the midpoint, X
/// ← X + ½Δt (v + v⁺) under forces at the old X, oscillations held by the geometric stiffness (the pressure)
/// grow by ½(ωΔt)² a step.
enum class PositionUpdate { grid_end, grid, trapezoid, particle };

struct UpdateRule {
  ParticleUpdate velocity;
  PositionUpdate position;
  double dt;
  double dt_strain;  ///< > 0: advance the strain with v⁺ or v′ by this time
  int terms;         ///< of the exponential in the strain
  bool stresses;     ///< also the stresses that follow from the strain, where they can wait
};

/// Columns gathered by the update: v⁺, a Δt, and for XPIC m(v − v*).
inline constexpr int update_vectors(ParticleUpdate u) { return u == ParticleUpdate::xpic ? 3 : 2; }

/// What an update reports of a tile.
struct TileReport {
  double fastest{};       ///< max_p (c_p + |v_p|), m/s
  double speed{};         ///< max_p |V_p| and |mean velocity of its motion|, m/s
  bool inverted = false;  ///< some J is no positive number
  bool lost = false;      ///< a particle is not finite or outside the allowed box
};

}  // namespace mpmfast
