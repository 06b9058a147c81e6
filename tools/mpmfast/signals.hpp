#pragma once

/// @file SIGINT and SIGTERM ask the run to stop after the step; a second one kills.

namespace mpmfast {

void catch_stop_signals();

/// 0 until a signal came, then its number.
const volatile int* stop_signal();

}  // namespace mpmfast
