#pragma once

/// @file Records what the contact pairs of a step did in its ledger.

#include <vector>

#include "engine/contact/active_set/correction_method.hpp"
#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/pairs/pair_laws.hpp"

namespace mpmfast {

/// Is an impulse entered, or an entry taken back?
enum class Entry { made, taken_back };

/// Enters the impulses that particles keep of the correction at hand: on rigid bodies with their moments and
/// work, and between the pairs that the scene names.
/// @param pivots  points about which moments count, by field, m
template <int Dim>
void record_impulses(const State<Dim>& state, const PairLaws& laws, const std::vector<Vec<Dim>>& pivots,
                     const ContactList<Dim>& list, Entry entry, ContactLedger<Dim>& ledger);

/// The friction work of each pair (PairImpulses::friction_work), and its sums, in an order that does not
/// depend on the threads.
/// @param block_sums  memory that is used again from step to step
template <int Dim>
void record_friction(const State<Dim>& state, const PairLaws& laws, const CorrectionMethod& method,
                     ContactList<Dim>& list, ContactLedger<Dim>& ledger, std::vector<double>& block_sums);

}  // namespace mpmfast
