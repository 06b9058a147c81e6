#pragma once

/// @file Which nodes are fitted anew, and the separations of the others: a normal hardly turns while what is
/// near moves by a few hundredths of a cell, and the same particles lie foremost.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/contact/nodal/list.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// Marks the contact nodes that are to be fitted anew: where fields have drifted so far since, where an entry
/// is new, and beside one of these what will be due soon, since the particles near a stack are gathered
/// together. Calls reuse(node) for the others, in parallel.
/// @param refit  m
template <int Dim, class F>
void find_due(const ContactList<Dim>& contact, double refit, int threads, Shares& shares,
              std::vector<std::uint8_t>& due, const F& reuse) {
  constexpr std::int64_t kAtOnce = 8, kFew = 64;  // stacks
  due.assign(contact.nodes.size(), true);
  if (contact.fits.empty()) return;
  const auto drift_of = [&](const ContactNode<Dim>& node) {
    double most = 0;
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      if (contact.entries[at].crack >= 0) continue;  // its normal is the line's
      most = std::max(most, contact.fits[at].known ? contact.fits[at].drift : kInfinity);
    }
    return most;
  };
  const auto stacks = static_cast<std::int64_t>(contact.stack_begin.size()) - 1;
  share_out(shares, stacks, threads, kAtOnce, kFew, [&](std::int64_t s) {
    const std::size_t begin = contact.stack_begin[static_cast<std::size_t>(s)],
                      end = contact.stack_begin[static_cast<std::size_t>(s) + 1];
    bool any = false;
    for (std::size_t k = begin; k < end; ++k) {
      const double drift = drift_of(contact.nodes[k]);
      any |= drift >= refit;
      due[k] = drift >= 0.5 * refit;
    }
    for (std::size_t k = begin; k < end; ++k) {
      due[k] &= any;
      if (!due[k]) reuse(contact.nodes[k]);
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

/// The separation by the particles that lay foremost when the normal was found, cells.
template <Extent E, int Dim>
double kept_separation(const State<Dim>& state, const NodeIndex<Dim>& node, const KeptFit<Dim>& fit) {
  const auto reach = [&](int side, const Vec<Dim>& n) {
    return reach_of<E, Dim>(state, static_cast<std::size_t>(fit.foremost[static_cast<std::size_t>(side)]),
                            node, n);
  };
  return -reach(0, fit.normal) - reach(1, -fit.normal);
}

}  // namespace mpmfast
