#pragma once

/// @file What drives a crack at one of its ends, from the particles around (kernels/fracture).

#include <cmath>
#include <vector>

#include "engine/contact/cracks/cracks.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "kernels/fracture/tip_sample.hpp"

namespace mpmfast {

/// About the end of a crack, or of one that grows about the foremost bond that softens: its end leads that.
struct TipLoad {
  Vec<2> place = Vec<2>::Zero();   ///< m
  double release{};                ///< J, J/m²
  double opening = 0;              ///< K_I, Pa √m; 0 where the law of the body has no shear modulus
  double sliding{};                ///< K_II, positive where the left side moves out of the crack
  double modulus = 0;              ///< E′, Pa; 0 likewise
  double lead{};                   ///< from there on to the end, m
  Vec<2> ahead = Vec<2>::Zero();   ///< unit, out of the crack at its end
  Vec<2> across = Vec<2>::Zero();  ///< σ_tn and σ_nn on what is straight behind that, Pa
  bool through = false;            ///< there is nothing ahead of the end: it has come to the outline
};

/// About which end, and the last step.
struct TipQuestion {
  int crack;
  bool end;          ///< where its points end; else where they start
  double radius;     ///< of the disk, m; smaller where the body ends ahead
  double thickness;  ///< of the plane, m
  double dt;         ///< of the step, s
  bool bonded;       ///< its law has bonds that soften
  Vec<2> fall;       ///< acceleration by body forces, m/s²
};

/// What a question works with, kept from one to the next.
using TipSamples = std::vector<TipSample>;

/// After a step, with the stresses of the moment.
template <int Dim>
TipLoad tip_load(State<Dim>& state, const ContactList<Dim>& contacts, const CrackLine<Dim>& line,
                 const TipQuestion& question, TipSamples& samples);

}  // namespace mpmfast
