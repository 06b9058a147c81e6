#pragma once

/// @file What the nodes knew in the last step, for a look at contact.

#include <filesystem>

#include "engine/step/step.hpp"

namespace mpmfast {

/// One VTU file with a point for every velocity field of every node that has mass: its mass, velocity and,
/// where it meets others, the contact that it feels most: normal (out of the field), separation, whether it
/// touches, and the impulse of the last correction from all of them; where springs or bonds join it, their
/// jump and damage. Written aside and renamed; throws FileError.
template <int Dim>
void write_grid(const std::filesystem::path& vtu, const Step<Dim>& step, const Scene& scene);

}  // namespace mpmfast
