#pragma once

/// @file What a scene is made of, in lines for `mpmfast check`.

#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// The first few of many lines, and how many more there are, unless all are wanted.
std::vector<std::string> folded(std::vector<std::string> lines, bool all);

/// A line a body: name, material and its law, particles, mass, extents.
template <int Dim>
std::vector<std::string> body_lines(const Scene& scene, const Particles<Dim>& particles);
/// A line a pair with a law of its own.
std::vector<std::string> pair_lines(const Scene& scene);

}  // namespace mpmfast
