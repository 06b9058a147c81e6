#pragma once

/// @file `variables:` of a scene and `${…}` in its values: computed on the tree, before any reader sees it.

#include "engine/scene/tree.hpp"

namespace mpmfast {

/// Replaces every `${…}` in the values of the tree. A name alone gives what the variable says, word for word;
/// arithmetic gives a number in SI with its unit. `$${` stands for `${`. What cannot be computed is reported
/// and its value marked as faulty.
void expand_variables(Node& root, Problems& problems);

}  // namespace mpmfast
