#pragma once

/// @file Particles as a frame of a series has them, to draw and to measure after a run.

#include "engine/output/lines.hpp"
#include "engine/output/read_vtu.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// The columns that the file holds, or that follow from it: position, velocity, F, stress, initial volume,
/// evolving state. Throws FileError where it does not fit the scene.
template <int Dim>
Particles<Dim> read_frame(const VtuReader& file, const std::filesystem::path& path, const Scene& scene);

/// The cracks of the frame; none where the file has none.
Polylines read_lines(const VtuReader& file, const std::filesystem::path& path);

}  // namespace mpmfast
