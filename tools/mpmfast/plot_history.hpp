#pragma once

/// @file Charts of the histories of runs.

#include "command_line.hpp"
#include "plot_files.hpp"

namespace mpmfast {

/// Draws --columns against --x, or of one run the usual charts. Returns the exit code; throws FileError.
int plot_history(const CommandLine& line, const PlotFiles& files);

}  // namespace mpmfast
