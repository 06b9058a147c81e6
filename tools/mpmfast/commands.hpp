#pragma once

/// @file What each command does; returns the exit code.

#include "command_line.hpp"

namespace mpmfast {

int new_command(const CommandLine& line);
int run_command(const CommandLine& line);
int resume_command(const CommandLine& line);
int check_command(const CommandLine& line);
int study_command(const CommandLine& line);
int plot_command(const CommandLine& line);
int report_command(const CommandLine& line);
int list_command(const CommandLine& line);
int schema_command(const CommandLine& line);

}  // namespace mpmfast
