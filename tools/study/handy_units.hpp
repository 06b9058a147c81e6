#pragma once

/// @file Units that a chart's axis reads well in, from the ends of the columns' names.

#include <string>

#include "engine/quantities/expression.hpp"

namespace mpmfast {

/// The unit at the end of a column's name: "s" of time_s; empty where it has none.
std::string unit_of_column(const std::string& name);

/// That of a column, and of a sum of columns of one unit; empty for anything else, whose factors we do not
/// know.
std::string unit_of(const Expression& expression);

/// A column on an axis that has its unit beside it: kinetic_J is kinetic. Any other expression is as it is,
/// without backquotes.
std::string name_beside(const Expression& expression, const std::string& unit);

/// "energy" for J: what columns of that unit are; empty where it is not known.
std::string quantity_in(const std::string& unit);

/// Numbers in SI times `factor` are in `symbol`.
struct HandyUnit {
  double factor = 1;
  std::string symbol;
};

/// The unit with a prefix that leaves the largest number between 1 and 1000: "s" up to 3e-4 → µs.
HandyUnit handy_unit(const std::string& unit, double largest);

}  // namespace mpmfast
