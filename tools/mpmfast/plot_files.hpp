#pragma once

/// @file Which pictures `mpmfast plot` was asked for, and where they go.

#include <filesystem>
#include <string>

#include "command_line.hpp"

namespace mpmfast {

struct PlotFiles {
  std::filesystem::path folder;   ///< --out DIR, or that of the run; of several runs the working folder
  std::filesystem::path picture;  ///< --out FILE; else empty

  /// FILE, or NAME in the folder.
  std::filesystem::path at(const std::string& name) const {
    return picture.empty() ? (folder / name).lexically_normal() : picture;
  }
};

PlotFiles plot_files(const CommandLine& line);

/// Are the particles to be drawn, and not only because nothing else was asked for?
bool asks_for_particles(const CommandLine& line);

/// What does not go together in the options; empty when all does.
std::string contradiction(const CommandLine& line);

/// Throws FileError when it is not the output folder of a run, and says what it is.
void check_run_folder(const std::filesystem::path& folder);

}  // namespace mpmfast
