#pragma once

/// @file Pictures and animations of the particle files of a run.

#include <filesystem>

#include "command_line.hpp"
#include "plot_files.hpp"

namespace mpmfast {

bool has_particle_files(const std::filesystem::path& folder);

/// Draws --field of --frame (of all: an animation) with colours over --range. Returns the exit code; throws
/// FileError.
int plot_particles(const CommandLine& line, const PlotFiles& files);

}  // namespace mpmfast
