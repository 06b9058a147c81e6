#pragma once

/// @file `contact.pairs`: pairs of bodies or of materials with a law of their own.

#include "engine/scene/keys/keys.hpp"

namespace mpmfast {

/// Needs the bodies.
/// @param top  the scene, where bodies stand that could not be read
void describe_pairs(Keys& contact, Keys& top, Scene& scene);

}  // namespace mpmfast
