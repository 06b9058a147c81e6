#pragma once

/// @file SIGINT, SIGTERM, SIGHUP (a terminal that closes) and SIGUSR1 (which schedulers hand on) ask the run
/// to stop after the step; a second one kills. A limit on the size of files (SIGXFSZ) is left to the write
/// that meets it, a closed pipe to nobody.

namespace mpmfast {

void catch_stop_signals();

/// 0 until a signal came, then its number.
const volatile int* stop_signal();

}  // namespace mpmfast
