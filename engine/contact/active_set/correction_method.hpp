#pragma once

/// @file How the contact corrections of a scene work together.

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Chosen once, from the plan and the scene (theory, "The energy of a contact").
struct CorrectionMethod {
  bool one_set;         ///< the active set is decided once a step, for all corrections
  bool has_first;       ///< there is a first correction
  bool first_stays;     ///< particles keep the impulse of the first correction
  bool holds_sticking;  ///< pairs that stick are constrained along the surface in every correction; FLIP only
  bool keeps_velocity_change;  ///< contact-aware XPIC: Δv of the first correction is stored in Nodal::star
  bool keeps_relative;         ///< relative velocities are stored, for the active set and the friction work
  bool third_ends_strain;      ///< strains end with the re-extrapolated velocities, else with the second's
  double first_share;          ///< share of the first impulse that the second counts as a force
  bool overlap_is_contact;     ///< surfaces that overlap are in contact, also if they part (detection:
                               ///< separation)
  bool persistent;             ///< the first correction constrains pairs that were in contact
  double hysteresis;           ///< m: a pair in contact stays so up to this gap
  bool predicts_gap;           ///< corrections decide by the gap at the end of the step (NN Eq. 3.56)

  CorrectionMethod(const Scene& scene, const Plan& plan)
      : one_set(plan.one_set),
        has_first(plan.first_correction),
        first_stays(plan.first_correction_stays),
        holds_sticking(plan.one_set && plan.update == ParticleUpdate::flip),
        keeps_velocity_change(plan.paired),
        keeps_relative(one_set || first_stays),
        third_ends_strain(one_set && !first_stays),
        first_share(plan.first_share),
        overlap_is_contact(scene.contact.detection == DetectionKind::separation),
        persistent(scene.contact.persistent),
        hysteresis(scene.contact.hysteresis * scene.grid.cell),
        predicts_gap(scene.contact.advance_separation) {}

  /// Pairs may stick in the corrections that act on the strain alone.
  bool strain_may_stick() const { return holds_sticking || first_stays; }
};

}  // namespace mpmfast
