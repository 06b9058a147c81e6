#pragma once

/// @file Splitting: a particle whose convected domain has become longer than the grid functions span is
/// halved across its longest direction (tools/manual/theory.md, "Splitting").
///
/// A domain has the half-edge vectors r_k = F s_k l_k e_k, l_k of its body and s_k its own share of that.
/// Halved along k, it becomes two with s_k/2 at X ± r_k/2, which fill the same place. Both have the velocity,
/// F, J, stress and history of the one that was there, and half of its mass and initial volume. So mass,
/// centre of mass, momentum, angular momentum and all energies stay what they were.

#include <cstdint>
#include <vector>

#include "engine/state/state.hpp"

namespace mpmfast {

/// What is too long, and whose.
struct SplitRule {
  double longest;                        ///< m, of a full edge
  const std::vector<bool>& body_splits;  ///< as Scene::bodies
};

struct SplitCounters {
  std::uint64_t splits = 0;  ///< so far
  std::uint64_t held = 0;    ///< particles that were too long at the last look, and halved often enough
};

/// Half-edge vector k of particle p as F has it, m.
template <int Dim>
Vec<Dim> half_edge(const State<Dim>& state, std::size_t p, int k);

/// How many edges, over all particles and directions, are too long: first those that are to be halved, then
/// those that were halved constants::splitting::kMostHalvings times.
template <int Dim>
SplitCounters count_long_edges(const State<Dim>& state, const SplitRule& rule);

/// The particles to be halved along direction k, in order of their ids.
template <int Dim>
std::vector<std::uint32_t> long_along(const State<Dim>& state, const SplitRule& rule, int k);

/// Halves particles along direction k. Of each the half towards −r_k keeps the index and the id, the other
/// stands behind all particles, in the order given, with the next id. Domain edges stay as they were, tiles
/// and slots are void until the next sort.
/// @return the first of the new particles
template <int Dim>
std::size_t halve(State<Dim>& state, const std::vector<std::uint32_t>& parents, int k);

}  // namespace mpmfast
