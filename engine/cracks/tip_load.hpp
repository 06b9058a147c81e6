#pragma once

/// @file Load of a crack at one of its ends: J, stress intensities and tractions, from the particles around
/// the end (kernels/fracture).

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/cracks/crack_line.hpp"
#include "engine/cracks/tip_samples.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Load at a tip. The tip is the end of the line, or, after growth, the leading softening bond behind it.
struct TipLoad {
  Vec<2> position = Vec<2>::Zero();   ///< of the tip, m
  double energy_release_rate{};       ///< J, J/m²
  double mode_i = 0;                  ///< K_I, Pa √m; 0 where the law of the body has no shear modulus
  double mode_ii{};                   ///< K_II, positive where the left side moves out of the crack, Pa √m
  double modulus = 0;                 ///< E′, Pa; 0 where the law of the body has no shear modulus
  double bonded_length{};             ///< from the tip to the end of the line, m
  Vec<2> direction = Vec<2>::Zero();  ///< of the line at its end, unit, out of the crack
  Vec<2> traction = Vec<2>::Zero();   ///< σ_tn and σ_nn across the line behind its end, Pa
  bool at_outline = false;            ///< the body has no material ahead of the end
};

/// What a tip load is computed for.
struct TipLoadInput {
  int crack;
  bool end;          ///< false: the first point of the line, true: its last point
  double radius;     ///< of the domain of J, m; it is reduced where the body ends ahead
  double thickness;  ///< of the plane, m
  double dt;         ///< of the last step, s
  bool bonded;       ///< the sides have bonds that soften
  Vec<2> gravity;    ///< acceleration by body forces, m/s²
};

/// The load after a step. Stresses must be current.
/// @param contacts  contact of the crack sides in the step
/// @param samples   workspace
template <int Dim>
TipLoad tip_load(State<Dim>& state, const ContactList<Dim>& contacts, const CrackLine<Dim>& line,
                 const TipLoadInput& input, TipSamples& samples);

}  // namespace mpmfast
