#pragma once

/// @file What the charts that nobody asked for in particular show of a history.

#include <string>
#include <vector>

#include "table.hpp"

namespace mpmfast {

/// The columns whose names hold `part` ("_J": those in joules). Those that are zero throughout are left out,
/// as are `all.…` that repeat the one body that has any: of too many, those of all bodies together are left.
/// Never none but where no column has such a name.
std::vector<std::string> telling_columns(const Table& history, const std::string& part);

/// Total momenta that are but round-off of what the bodies carry become zero.
void clear_round_off(Table& history);

}  // namespace mpmfast
