#pragma once

#include <string>

#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

struct OverlapAtStart {
  std::string
      text;  ///< "2.25e-06 m^2, 4 % of all bodies (288 particles lie inside another body, 'right' in 'left')"
  bool is_likely_a_mistake = false;  ///< more than the corners of particles on a curved or tilted side
  bool crowded = false;              ///< so many bodies are in each other that the search ended
};

/// What the bodies of a plane both claim before anything moves; no text where that is round-off.
OverlapAtStart overlap_at_start(const State<2>& state, const Scene& scene);

}  // namespace mpmfast
