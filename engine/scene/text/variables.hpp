#pragma once

/// @file `variables:` of a scene and `${…}` in its values: computed on the tree, before any reader sees it.

#include <set>
#include <string>

#include "engine/scene/text/tree.hpp"

namespace mpmfast {

/// Replaces every `${…}` in the values of the tree. A name alone gives what the variable says, word for word;
/// arithmetic gives a number in SI with its unit. `$${` stands for `${`. What cannot be computed is reported
/// and its value marked as faulty.
/// @param used  variables that need not be named any more
void expand_variables(Node& root, Problems& problems, const std::set<std::string>& used = {});

/// The names in all `${…}` of the tree.
std::set<std::string> names_in_expressions(const Node& root);

}  // namespace mpmfast
