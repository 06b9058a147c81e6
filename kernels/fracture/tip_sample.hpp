#pragma once

/// @file Input of the integrals at a crack tip (tip_integrals.hpp), in axes along the crack and to its left.

#include "kernels/dimension.hpp"

namespace mpmfast {

/// A small area of material near the tip.
struct TipSample {
  Vec<2> position;                            ///< from the tip, m
  double area;                                ///< m²
  Vec<2> displacement;                        ///< u, m
  Mat<2> gradient;                            ///< u_i,j
  Mat<2> stress;                              ///< σ, Cauchy, Pa
  double energy;                              ///< W per current volume, J/m³
  double density{};                           ///< ρ, kg/m³
  Vec<2> velocity = Vec<2>::Zero();           ///< v, m/s
  Mat<2> velocity_gradient = Mat<2>::Zero();  ///< v_i,j, 1/s
  Vec<2> acceleration = Vec<2>::Zero();       ///< a, by stresses alone, m/s²
};

/// A piece of a crack whose sides exert a force on each other.
struct TipTraction {
  Vec<2> position;       ///< from the tip, m
  Vec<2> force;          ///< on one side, N/m
  Mat<2> gradient_jump;  ///< u_i,j of this side less u_i,j of the other
};

}  // namespace mpmfast
