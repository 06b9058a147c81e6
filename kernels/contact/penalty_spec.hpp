#pragma once

/// @file Parameters of penalty contact in a scene (K24 §3.5).

#include "kernels/measure.hpp"

namespace mpmfast {

/// Springs between overlapping surfaces.
struct PenaltySpec {
  double stiffness = 1;   ///< ω over ρc²/Δh of the softer body, –
  double tangential = 1;  ///< ω_t/ω, –
  int per_cell = 2;       ///< boundary points per side of a cell

  template <class Keys>
  void describe(Keys& map) {
    map.key("stiffness",
            "Normal stiffness of the springs, in longitudinal moduli of the softer body per cell.", stiffness,
            Number{Measure::number, kPositive});
    map.key("tangential_stiffness", "Tangential stiffness of the springs, over `stiffness`.", tangential,
            Number{Measure::number, kPositive});
  }
};

}  // namespace mpmfast
