#pragma once

/// @file The line of a crack behind one of its ends, as points in the plane from the end on.

#include <vector>

#include "engine/cracks/crack_line.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

using TipLine = std::vector<Vec<2>>;  ///< two or more points, m

/// The points of a crack from one of its ends on, up to the first one farther away than a distance.
template <int Dim>
TipLine line_behind(const CrackLine<Dim>& line, bool end, double distance);

/// Direction out of the crack at its end, unit: from the first point at least kDirection cells behind the
/// end, but not from beyond the last turn.
/// @param straight  length of the line without a turn, m
Vec<2> end_direction(const TipLine& line, double cell, double straight);

/// Cuts a length off the line at its end.
void shorten(TipLine& line, double length);

}  // namespace mpmfast
