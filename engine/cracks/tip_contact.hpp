#pragma once

/// @file Softening bonds and tractions near a tip, read from the contact of crack sides. No other file of
/// cracks reads the list of contacts.

#include <optional>
#include <vector>

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/cracks/tip_line.hpp"
#include "engine/state/state.hpp"
#include "kernels/fracture/tip_sample.hpp"

namespace mpmfast {

/// Length of the line from its end to the leading softening bond, m; nothing where no bond softens.
/// @param distance  up to which the line is searched, m
template <int Dim>
std::optional<double> length_to_softening(const State<Dim>& state, const ContactList<Dim>& contacts,
                                          int crack, const TipLine& line, double distance);

/// The contact forces on the sides of a crack in the last step, at nodes.
/// @param springs    forces of interface springs count too. Those of softening bonds do not: J is their work.
/// @param thickness  of the plane, m
/// @param dt         of the step, s
/// @return positions and components in the axes of a tip, which are the rows of `axes`
template <int Dim>
std::vector<TipTraction> side_tractions(const State<Dim>& state, const ContactList<Dim>& contacts, int crack,
                                        bool springs, double thickness, double dt, const Vec<2>& origin,
                                        const Mat<2>& axes);

}  // namespace mpmfast
