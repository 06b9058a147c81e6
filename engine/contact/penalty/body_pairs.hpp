#pragma once

/// @file Properties of two bodies in contact: stiffness of the springs, contact law, entry of the ledger.

#include <optional>
#include <vector>

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast::penalty {

struct BodyPairs {
  std::vector<int> field;       ///< velocity field, by body
  std::vector<bool> rigid;      ///< by body
  std::vector<double> modulus;  ///< ρc², by body, Pa; 0: rigid
  PairTable table;
  std::vector<AnyLaw> laws;  ///< the default, then those of ContactSpec::pairs
  PenaltySpec springs;
  double cell = 1;  ///< m, of the grid

  /// A pair that the scene names, whose sums the ledger keeps.
  struct Named {
    std::size_t number;  ///< in ContactSpec::pairs
    bool forward;        ///< the first body given is the pair's first
  };

  bool may_touch(int body_a, int body_b) const;
  const AnyLaw& law(int body_a, int body_b) const;
  /// Stiffness ω of the normal springs for an area, Pa/m (K24 Eq. 40, with ρc² of the softer body for E).
  double stiffness(int body_a, int body_b) const;
  std::optional<Named> named(int body_a, int body_b) const;
};

/// @param seeded  the state at time 0, from which wave speeds are taken
template <int Dim>
BodyPairs make_body_pairs(const Scene& scene, const Plan& plan, const State<Dim>& seeded);

}  // namespace mpmfast::penalty
