#pragma once

/// @file What laws with a history add to F → τ: state columns of their own, and a step of strain in place of
/// a strain. An elastic law has `stress(F, τ, c²)` and `energy(F)`. An evolving law has `kColumns`,
/// `advance(step, state, τ, c²)`, `energy(F, state)` and `shape_limit()` (shape_memory.hpp);
/// transfer/strain_chunk.hpp loads and stores the columns that it names and no others. J of its particles is
/// a state too, J ← J det(I + a): the determinant of an F that has grown by flow has no digits left.

#include "kernels/simd/lanes.hpp"
#include "kernels/tensor.hpp"

namespace mpmfast {

/// The columns of evolving state that a law reads and writes.
struct StateColumns {
  bool dissipated = false, internal_energy = false, plastic_strain = false, temperature = false,
       elastic_strain = false;
};

/// The evolving state of one particle (or of Lanes of them); what a law does not name is left alone.
template <int Dim, class V>
struct MaterialState {
  V dissipated;                       ///< work turned into heat or defects, per undeformed volume, J/m³
  V internal_energy;                  ///< of volume change and heat, per undeformed volume (ρ0 U), J/m³
  V plastic_strain;                   ///< equivalent plastic strain
  V temperature;                      ///< K
  V elastic_strain[kSymmetric<Dim>];  ///< elastic left Cauchy–Green tensor; of metals isochoric
  V volume_ratio;                     ///< J that the law answers to; `energy` reads it, the caller sets it
};

/// One step of strain, F ← (I + a) F.
template <int Dim, class V>
struct StrainStep {
  const V (&increment)[Dim * Dim];    ///< a
  const V (&deformation)[Dim * Dim];  ///< F after the step
  V volume_before, volume_now;        ///< J
  V expansion;                        ///< tr ∇v, 1/s
  double dt;                          ///< s
};

template <class Law>
concept Evolving = requires {
  Law::kColumns;
};

/// The unstrained state at a temperature.
template <int Dim, class V>
inline MaterialState<Dim, V> resting_state(double temperature) {
  MaterialState<Dim, V> state{};
  state.temperature = broadcast<V>(temperature);
  state.volume_ratio = broadcast<V>(1.0);
  for (int c = 0; c < 3; ++c) state.elastic_strain[c] = broadcast<V>(1.0);
  return state;
}

}  // namespace mpmfast
