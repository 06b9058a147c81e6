#pragma once

/// @file What a good scene says that is likely a mistake: warnings.

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

/// @param places  of the scene's bodies
void find_suspicions(const Node& root, const Scene& scene, const std::vector<BodyLocation>& locations,
                     Problems& found);
/// Warns of a grid of which nearly all lies where nothing comes: its cells take memory and time.
/// @param place  of its size
void find_idle_cells(const SourceLocation& location, const Scene& scene, Problems& found);
/// Of what is written, whatever it comes to: degrees where radians are read.
void find_suspicious_text(const Node& root, Problems& found);

}  // namespace mpmfast
