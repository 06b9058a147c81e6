#pragma once

/// @file How long threads spin before they sleep when they wait for each other.

namespace mpmfast {

/// Spinning for long, libgomp's default, makes a run ten times slower as soon as another program wants one of
/// its cores. libgomp reads its settings before main: unless the user has set one, the program sets a short
/// spin and starts itself again. Returns where that is not needed or not possible.
void wait_quietly(char** arguments);

}  // namespace mpmfast
