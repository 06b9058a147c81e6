#pragma once

/// @file What is said of a command line that cannot be read.

#include <CLI/CLI.hpp>
#include <string>

namespace mpmfast {

/// What is wrong, with the option that was probably meant or those that there are.
/// @param command the one that was chosen, or the program; @param first the first word of the command line
std::string mistake_text(const CLI::App& command, const CLI::ParseError& error, const std::string& first);

}  // namespace mpmfast
