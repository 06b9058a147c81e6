#pragma once

/// @file Fitted normals that outlast a step: which nodes are fitted anew, and the separations of the others.
/// A normal hardly turns while what is near moves by a few hundredths of a cell, and the support particles
/// stay the same.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/node_fields.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// How far a node's kept fits may have drifted at most, m; infinite where a pair has none.
template <int Dim>
double largest_drift(const PairColumns<Dim>& pairs, const ContactNode<Dim>& node) {
  double most = 0;
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    if (pairs.pair[e].crack >= 0) continue;  // the crack gives its normal
    most = std::max(most, pairs.fit[e].known ? pairs.fit[e].drift : kInfinity);
  }
  return most;
}

/// Marks the contact nodes that are fitted anew: those whose fields have drifted by `refit`, and those with a
/// new pair. The particles near a block are gathered together, so a block with such a node also fits its
/// nodes that have drifted half as far. Calls reuse(node) for all others, in parallel.
/// @param refit  m
/// @param due    result, by contact node
template <int Dim, class F>
void find_due(const ContactList<Dim>& list, double refit, int threads, Shares& shares,
              std::vector<std::uint8_t>& due, const F& reuse) {
  using constants::threads::kBlocksAtOnce, constants::threads::kFewBlocks;
  due.assign(list.nodes.size(), true);
  if (list.pairs.fit.empty()) return;
  const auto blocks = static_cast<std::int64_t>(list.block_begin.size()) - 1;
  share_out(shares, blocks, threads, kBlocksAtOnce, kFewBlocks, [&](std::int64_t b) {
    const std::size_t begin = list.block_begin[b], end = list.block_begin[b + 1];
    bool any = false;
    for (std::size_t k = begin; k < end; ++k) {
      const double drift = largest_drift(list.pairs, list.nodes[k]);
      any |= drift >= refit;
      due[k] = drift >= constants::contact::kEarlyRefit * refit;
    }
    for (std::size_t k = begin; k < end; ++k) {
      due[k] &= any;
      if (!due[k]) reuse(list.nodes[k]);
    }
  });
}

/// How far one particle reaches from a node along the unit vector n, cells (reach_along).
template <Extent E, int Dim>
double reach_of(const State<Dim>& state, std::size_t p, const NodeIndex<Dim>& node, const Vec<Dim>& n) {
  const auto& particles = state.particles;
  const auto& half_size = state.bodies[static_cast<std::size_t>(particles.body()[p])].half_size;
  double edges[Dim * Dim], shape[shape_size<Dim>(E)], ahead = 0;
  for (int e = 0; e < Dim * Dim; ++e)
    edges[e] = particles.column(Quantity::deformation_gradient, e)[p] *
               (half_size[e % Dim] * state.grid.inverse_cell) * particles.domain_share(p, e % Dim);
  domain_shape<E, Dim>(edges, shape);
  for (int d = 0; d < Dim; ++d)
    ahead += ((particles.column(Quantity::position, d)[p] - state.grid.origin[d]) * state.grid.inverse_cell -
              node[d]) *
             n[d];
  return ahead + extent_along<E, Dim>(shape, n);
}

/// The separation by the support particles of the fit, cells.
template <Extent E, int Dim>
double kept_separation(const State<Dim>& state, const NodeIndex<Dim>& node, const KeptFit<Dim>& fit) {
  const auto reach = [&](std::size_t side, const Vec<Dim>& n) {
    return reach_of<E, Dim>(state, static_cast<std::size_t>(fit.support[side]), node, n);
  };
  return -reach(0, fit.normal) - reach(1, -fit.normal);
}

/// After a sort: the support particles have new numbers.
template <int Dim>
void renumber_fits(const Tiling<Dim>& tiling, Indexed<KeptFit<Dim>>& fits) {
  for (KeptFit<Dim>& fit : fits)
    for (std::int32_t& particle : fit.support)
      if (particle >= 0)
        particle = static_cast<std::int32_t>(tiling.moved(static_cast<std::uint32_t>(particle)));
}

/// After particles have moved: adds to the drift of each fit how far the fastest field of its node has moved,
/// or kSlipDrift times the slip of surfaces in contact if that is more, since slip brings other support
/// particles.
template <int Dim>
void drift_fits(const State<Dim>& state, double dt, ContactList<Dim>& list) {
  using constants::contact::kSlipDrift, constants::threads::kFewCopies;
  PairColumns<Dim>& pairs = list.pairs;
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), state.threads, kFewCopies, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    const NodeFields<Dim> fields(state, list, node);
    double fastest = 0;
    for (int f = 0; f < fields.count(); ++f)
      fastest = std::max(fastest, fields.vector(Nodal::velocity, f).norm());
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      Vec<Dim> slip = Vec<Dim>::Zero();
      if (!pair.is_lumped() && pairs.status[e].touching)
        slip = fields.vector(Nodal::velocity, pair.a) - fields.vector(Nodal::velocity, pair.b);
      const Vec<Dim>& normal = pairs.geometry[e].normal;
      slip -= slip.dot(normal) * normal;
      pairs.fit[e].drift += dt * std::max(fastest, kSlipDrift * slip.norm());
    }
  });
}

}  // namespace mpmfast
