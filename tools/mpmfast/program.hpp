#pragma once

/// @file The command line.

namespace mpmfast {

/// All of the program. Other libraries may see it: it may be one of its own (cmake/Levels.cmake).
__attribute__((visibility("default"))) int run_program(int count, char** arguments);

}  // namespace mpmfast
