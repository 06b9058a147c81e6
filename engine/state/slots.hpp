#pragma once

/// @file Loops over the slots of the nodes, and over blocks of anything.

#include <algorithm>
#include <cstdint>

#include "engine/constants.hpp"
#include "engine/state/state.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// Calls f(first, last) for blocks of [0, n), in parallel where there are more than a few.
template <class F>
void for_each_block(std::int64_t n, std::int64_t block, int threads, F f) {
  const std::int64_t blocks = (n + block - 1) / block;
  for_each_of(blocks, threads, constants::threads::kFewStretches,
              [&](std::int64_t b) { f(b * block, std::min(n, (b + 1) * block)); });
}

/// Calls f(first slot, last slot) over all slots, in parallel; whole tiles.
template <int Dim, class F>
void for_each_slot(const State<Dim>& state, F f) {
  for_each_block(static_cast<std::int64_t>(state.tiling.slots()), constants::threads::kSlotsAtOnce,
                 state.threads, f);
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
