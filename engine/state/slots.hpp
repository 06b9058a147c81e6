#pragma once

/// @file Loops over the slots of the nodes.

#include <algorithm>
#include <cstdint>

#include "engine/state/state.hpp"

namespace mpmfast {

/// Calls f(first slot, last slot) over all slots, in parallel; whole tiles.
template <int Dim, class F>
void for_each_slot(const State<Dim>& state, F f) {
  constexpr std::int64_t block = 512;
  const auto n = static_cast<std::int64_t>(state.tiling.slots());
  const std::int64_t blocks = (n + block - 1) / block;
#pragma omp parallel for num_threads(state.threads) schedule(static) if (blocks > 4)
  for (std::int64_t b = 0; b < blocks; ++b) f(b * block, std::min(n, (b + 1) * block));
}

/// out = factor x/m, zero where there is no mass, of slots [begin, end): tiles, so a multiple of kLanes.
inline void divide_by_mass(const double* mass, const double* x, double factor, std::int64_t begin,
                           std::int64_t end, double* out) {
  for (std::int64_t i = begin; i < end; i += kLanes) {
    const Lanes m = load_lanes(mass + i);
    store_lanes(out + i, m > 0.0 ? factor * load_lanes(x + i) / m : 0.0);
  }
}

}  // namespace mpmfast
