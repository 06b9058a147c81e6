#pragma once

/// @file How the program ends (design §3). A signal adds its number to kExitSignal.

namespace mpmfast {

inline constexpr int kExitWrongInput = 2;  ///< the command line or the scene; nothing was written
inline constexpr int kExitRunFailed = 3;
inline constexpr int kExitFile = 4;
inline constexpr int kExitSignal = 128;

}  // namespace mpmfast
