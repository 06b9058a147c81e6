#pragma once

/// @file The nodes on which particles have weight in the basis of the run.

#include <cstddef>
#include <functional>

#include "engine/constants.hpp"
#include "kernels/dimension.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// A box of nodes, x fastest.
template <int Dim>
struct NodeRange {
  NodeIndex<Dim> first, count;  ///< lowest node, and nodes along each axis

  int size() const { return count.prod(); }
  NodeIndex<Dim> node(int k) const {
    NodeIndex<Dim> node = first;
    for (int d = 0, rest = k; d < Dim; rest /= count[d++]) node[d] += rest % count[d];
    return node;
  }
};

/// Supports of particles.
template <int Dim>
struct Supports {
  /// (particle, shift) → the first node of its support, if the particle were shifted by so much along each
  /// axis, m
  std::function<NodeIndex<Dim>(std::size_t, double)> first;
  int nodes{};  ///< along each axis
};

/// The nodes that a particle reaches before the sides are classified again.
template <int Dim>
NodeRange<Dim> nodes_ahead(const Supports<Dim>& supports, std::size_t particle, double cell) {
  const double margin = crack_constants::kSupportMargin * cell;
  const NodeIndex<Dim> first = supports.first(particle, -margin);
  return {first, supports.first(particle, margin) - first + NodeIndex<Dim>::Constant(supports.nodes)};
}

/// Calls f(particle) for the particles of a tile, in their order.
template <int Dim, class Runs, class F>
void for_each_particle(const Runs& runs, const ParticleTile<Dim>& tile, const F& f) {
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const ParticleRun<Dim>& run = runs[static_cast<std::size_t>(r)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) f(p);
  }
}

}  // namespace mpmfast
