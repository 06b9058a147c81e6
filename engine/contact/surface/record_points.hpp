#pragma once

/// @file Records what the points of a step did in its ledger.

#include "engine/contact/active_set/correction_method.hpp"
#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/surface/surface_list.hpp"

namespace mpmfast {

/// Adds the impulses that particles keep of the correction at hand: on rigid bodies with their moments and
/// work, and between the pairs that the scene names.
/// @param pivots  points about which moments count, by field, m
template <int Dim>
void record_impulses(const SurfaceList<Dim>& points, const std::vector<Vec<Dim>>& pivots,
                     ContactLedger<Dim>& ledger);

/// Adds the friction work of the points: the tangential impulse times the mean relative velocity in the
/// strains of the step. Where a point sticks, the work of forces on the relative velocity that the strains
/// lack is added (theory, "The energy of a contact").
template <int Dim>
void record_friction(const SurfaceList<Dim>& points, const CorrectionMethod& method,
                     ContactLedger<Dim>& ledger);

}  // namespace mpmfast
