#pragma once

/// @file What drives a crack at one of its ends, from the particles around (kernels/fracture).

#include "engine/contact/cracks/cracks.hpp"

namespace mpmfast {

struct TipLoad {
  Vec<2> place = Vec<2>::Zero();  ///< m
  double release = 0;             ///< J, J/m²
  double opening = 0;             ///< K_I, Pa √m; 0 where the law of the body has no shear modulus
  double sliding = 0;             ///< K_II, positive where the left side moves out of the crack
};

/// @param end     of the line: where its points end, or start
/// @param radius  of the disk that is asked, m
template <int Dim>
TipLoad tip_load(State<Dim>& state, const CrackLine<Dim>& line, bool end, double radius, double thickness);

}  // namespace mpmfast
