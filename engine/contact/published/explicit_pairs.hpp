#pragma once

/// @file The explicit pairs of nodes where three or more fields meet (N20 §3.4).

#include "engine/contact/impulses/correction_pass.hpp"

namespace mpmfast {

/// No pair of the node touches; they are solved; the lumped pairs must do.
enum class ExplicitOutcome { none, solved, lumped };

/// Solves a node by its explicit pairs where one or two of them touch. More than two, bonds, and pairs that
/// do not converge are left to the lumped pairs.
template <int Dim>
ExplicitOutcome solve_explicit_pairs(const CorrectionPass<Dim>& pass, const ContactNode<Dim>& node,
                                     const NodeMotion<Dim>& motion);

}  // namespace mpmfast
