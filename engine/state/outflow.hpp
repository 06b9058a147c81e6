#pragma once

/// @file What left the grid with the particles that a run goes on without.

#include <array>
#include <cstdint>

namespace mpmfast {

/// Sums over the particles that left so far. Rigid ones count by their number alone: as in the balance,
/// theirs is no mass that moves freely.
struct Outflow {
  std::uint64_t particles = 0;
  double mass = 0;                   ///< kg
  double energy = 0;                 ///< J: kinetic, stored and dissipated
  std::array<double, 3> momentum{};  ///< kg m/s
};

}  // namespace mpmfast
