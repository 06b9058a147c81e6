#pragma once

/// @file Names in expressions that no column has, and what was probably meant.

#include <span>
#include <string>
#include <vector>

#include "engine/quantities/expression.hpp"

namespace mpmfast {

struct UnknownName {
  std::string name;
  std::string hint;  ///< with backquotes where an expression needs them; may be empty
};

/// The names of the expression that are not known. One that is known but lacks its backquotes falls apart
/// into several: they are reported once.
std::vector<UnknownName> unknown_names(const Expression& expression, std::span<const std::string> known);

}  // namespace mpmfast
