#pragma once

/// @file The command line described from itself: nothing that it offers is written twice.

#include <CLI/CLI.hpp>
#include <string>

namespace mpmfast {

/// The man page mpmfast(1).
std::string man_page(const CLI::App& app);

/// Completion for bash: commands, options, topics, scenes and folders.
std::string bash_completion(const CLI::App& app);

}  // namespace mpmfast
