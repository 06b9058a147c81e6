#pragma once

/// @file What is asked of the material and of the sides of a crack near its tip (tip_integrals.hpp).

#include "kernels/dimension.hpp"

namespace mpmfast {

/// A piece of the plane near a tip, in axes along the crack and to the left of it.
struct TipSample {
  Vec<2> place;                            ///< from the tip, m
  double area;                             ///< m²
  Vec<2> moved;                            ///< u, m
  Mat<2> slope;                            ///< u_i,j
  Mat<2> stress;                           ///< Cauchy, Pa
  double energy;                           ///< W by the volume now, J/m³
  double density{};                        ///< kg/m³
  Vec<2> velocity = Vec<2>::Zero();        ///< m/s
  Mat<2> velocity_slope = Mat<2>::Zero();  ///< v_i,j, 1/s
  Vec<2> acceleration = Vec<2>::Zero();    ///< by stresses, m/s²
};

/// A piece of a crack that carries a force across.
struct TipTraction {
  Vec<2> place;  ///< from the tip, m
  Vec<2> force;  ///< on one side, N/m
  Mat<2> slope;  ///< u_i,j of that side less that of the other
};

}  // namespace mpmfast
