#pragma once

/// @file Phase 4, ledger: what contact forces did in a step, for balance and history.

#include <vector>

#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/penalty/body_pairs.hpp"
#include "engine/contact/penalty/point_contact.hpp"
#include "engine/contact/penalty/surface_geometry.hpp"

namespace mpmfast::penalty {

/// Records friction work, and impulse, friction work and area of named pairs. The area of a pair is half of
/// the undeformed area of both surfaces in contact. @param out  opened
template <int Dim>
void record_contacts(const Surfaces<Dim>& surfaces, const BodyPairs& pairs,
                     const std::vector<ThreadContacts<Dim>>& contacts, double dt, ContactLedger<Dim>& out);

/// Records impulse, moment and work of the forces on rigid bodies.
/// @param forces    by point, N
/// @param previous  positions at the start of the last step: the work is that on the motion since then
/// @param pivots    by velocity field, m: the impulse's moment is about them
template <int Dim>
void record_rigid_bodies(const SurfaceGeometry<Dim>& current, const SurfaceGeometry<Dim>& previous,
                         const BodyPairs& pairs, const std::vector<Vec<Dim>>& forces,
                         const std::vector<Vec<Dim>>& pivots, double dt, ContactLedger<Dim>& out);

}  // namespace mpmfast::penalty
