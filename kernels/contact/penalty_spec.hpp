#pragma once

/// @file What a scene says of contact of surfaces by penalty (K24 §3.5).

#include "kernels/measure.hpp"

namespace mpmfast {

/// Springs between surfaces that overlap.
struct PenaltySpec {
  double stiffness = 1;   ///< ω = this × ρc²/Δh of the softer body, Pa/m
  double tangential = 1;  ///< ω_t/ω
  int per_cell = 2;       ///< boundary points along the side of a cell

  template <class Keys>
  void describe(Keys& map) {
    map.key("stiffness", "Of the springs that push, in moduli of the softer body a cell.", stiffness,
            Number{Measure::number, kPositive});
    map.key("tangential_stiffness", "Of the springs that hold what sticks, over `stiffness`.", tangential,
            Number{Measure::number, kPositive});
  }
};

}  // namespace mpmfast
