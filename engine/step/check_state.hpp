#pragma once

/// @file What a checkpoint must hold to be the state of its scene: a file may have been made by anyone, and
/// its checksum says only that it is whole. Everything here throws FileError.

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/state/check_values.hpp"
#include "engine/state/particles.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Which body each particle of the scene is of, by its id.
template <int Dim>
std::vector<std::uint16_t> bodies_by_id(const Particles<Dim>& particles);

/// Every particle is one of the scene, once, with the body that it was seeded in, or was made by a split; all
/// its columns are finite, its mass and volume are not negative.
/// @param seeded  bodies_by_id of the particles as the scene seeds them
template <int Dim>
void check_particles(const Particles<Dim>& particles, const std::vector<std::uint16_t>& seeded);

/// Every particle lies within the box, its domain is no longer than domains may be
/// (kernels/basis/domain_limit.hpp), and it is in a tile with others of its body. Whether its place is that
/// of the tile is seen by the step, which sorts anew where a support leaves its window.
/// @param lower, upper  m, of the box that particles must stay in
template <int Dim>
void check_positions(const State<Dim>& state, const Vec<Dim>& lower, const Vec<Dim>& upper);

}  // namespace mpmfast
