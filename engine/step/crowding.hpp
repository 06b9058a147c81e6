#pragma once

/// @file How many bodies lie at one place: contact lists each pair of those that meet at a node, so that cost
/// and memory grow with the square.

#include <cstddef>

#include "engine/plan/memory_limits.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

struct Crowding {
  std::size_t fields{};        ///< the most velocity fields that have particles in one cell
  double pairs{};              ///< of fields with particles in one cell, over all cells
  std::size_t one{}, other{};  ///< bodies of the fullest cell
};

/// Nothing where the scene has so few fields that no cell is crowded.
template <int Dim>
Crowding crowding(const State<Dim>& state, std::size_t fields);

/// Throws SceneError when the pairs of bodies at one place would take more memory than is available.
template <int Dim>
void check_crowding(const Scene& scene, const State<Dim>& state, std::size_t fields,
                    const MemoryLimit& available);

}  // namespace mpmfast
