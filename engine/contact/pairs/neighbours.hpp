#pragma once

/// @file The contact nodes around one, and the pairs of the same two fields there.

#include <array>

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/node_fields.hpp"

namespace mpmfast {

/// A node of the grid: its block of nodes (−1: none), and its number there.
struct NodePlace {
  int block, local;
};

/// The node some steps along each axis from a contact node, at most kTileSide of them.
template <int Dim>
NodePlace place_near(const Tiling<Dim>& tiling, const ContactNode<Dim>& node, const NodeIndex<Dim>& steps) {
  int block_digit = 0, stride3 = 1, local = 0, stride4 = 1, rest = node.local;
  for (int d = 0; d < Dim; ++d) {
    int at = rest % kTileSide + steps[d], block = 1;
    if (at < 0) at += kTileSide, block = 0;
    if (at >= kTileSide) at -= kTileSide, block = 2;
    block_digit += block * stride3;
    local += at * stride4;
    stride3 *= 3;
    stride4 *= kTileSide;
    rest /= kTileSide;
  }
  return {tiling.node_blocks[static_cast<std::size_t>(node.block)].neighbour[block_digit], local};
}

/// The contact node at one of the 3^Dim positions around a node (itself in the middle), or −1.
template <int Dim>
int contact_neighbour(const Tiling<Dim>& tiling, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                      int position) {
  NodeIndex<Dim> steps;
  for (int& step : steps) step = position % 3 - 1, position /= 3;
  const NodePlace place = place_near(tiling, node, steps);
  return place.block < 0 ? -1
                         : list.node_at[static_cast<std::size_t>(place.block) * kTileNodes<Dim> +
                                        static_cast<std::size_t>(place.local)];
}

/// The pair of the same two fields at one of the 3^Dim positions around a node, or −1.
template <int Dim>
int same_pair(const State<Dim>& state, const ContactList<Dim>& list, const ContactNode<Dim>& node,
              const ContactPair& pair, int position) {
  const int k = contact_neighbour(state.tiling, list, node, position);
  if (k < 0) return -1;
  const ContactNode<Dim>& other = list.nodes[k];
  const NodeFields<Dim> here(state, list, node), there(state, list, other);
  for (int e = other.pair_begin; e < other.pair_end; ++e) {
    const ContactPair& beside = list.pairs.pair[e];
    if (beside.crack != pair.crack) continue;
    const bool same = pair.crack >= 0 ? beside.beyond == pair.beyond
                                      : there.field(beside.a) == here.field(pair.a) &&
                                            there.field(partner(there, other, beside)) ==
                                                here.field(partner(here, node, pair));
    if (same) return e;
  }
  return -1;
}

}  // namespace mpmfast
