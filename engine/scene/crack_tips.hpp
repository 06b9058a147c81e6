#pragma once

/// @file Ends of cracks that lie inside of their bodies.

#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace mpmfast {

struct CrackTip {
  int crack;         ///< of Scene::cracks
  bool end;          ///< where its points end; else where they start
  std::string name;  ///< NAME.start or NAME.end
};

/// In order of the cracks.
std::vector<CrackTip> crack_tips(const Scene& scene);

}  // namespace mpmfast
