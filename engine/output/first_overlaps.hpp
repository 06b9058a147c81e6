#pragma once

/// @file Whether bodies overlap, at a cost that is linear in the particles however many lie at one place.

#include <cstddef>
#include <vector>

#include "engine/output/overlap.hpp"

namespace mpmfast {

struct FirstOverlaps {
  Overlap overlap;  ///< of what was looked at
  bool all = true;  ///< all was; false: more pairs of owners have particles in each other than were wanted
};

/// As measure_overlap, to the bit, where no more than `most` pairs of owners have particles in each other.
/// Where more do, the search ends: what it found is a part.
FirstOverlaps first_overlaps(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                             const std::vector<int>& owner, const Surfaces<2>& surfaces, std::size_t most,
                             int threads);

}  // namespace mpmfast
