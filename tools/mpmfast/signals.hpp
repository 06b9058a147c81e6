#pragma once

/// @file Signals that end a program ask the run to stop after the step; a second one kills. They come from a
/// user (SIGINT, SIGQUIT, SIGTERM), from a terminal that closes (SIGHUP), from a scheduler (SIGUSR1,
/// SIGUSR2), from a timer (SIGALRM) or from a limit on processor time (SIGXCPU). The kernel repeats SIGXCPU
/// every second up to the hard limit, so a second one of that kind does not kill. A limit on the size of
/// files (SIGXFSZ) is left to the write that meets it, a closed pipe to nobody.

namespace mpmfast {

void catch_stop_signals();

/// 0 until a signal came, then its number.
const volatile int* stop_signal();

}  // namespace mpmfast
