#pragma once

/// @file The contact nodes around one, and the pairs of the same two fields there.

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/node_fields.hpp"

namespace mpmfast {

/// The contact node at one of the 3^Dim positions around a node (itself in the middle), or −1.
template <int Dim>
int contact_neighbour(const Tiling<Dim>& tiling, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                      int position) {
  int block_digit = 0, stride3 = 1, local = 0, stride4 = 1, rest = node.local;
  for (int d = 0; d < Dim; ++d) {
    int at = rest % kTileSide + position % 3 - 1;
    int step = 1;
    if (at < 0) at += kTileSide, step = 0;
    if (at >= kTileSide) at -= kTileSide, step = 2;
    block_digit += step * stride3;
    local += at * stride4;
    stride3 *= 3;
    stride4 *= kTileSide;
    rest /= kTileSide;
    position /= 3;
  }
  const int block = tiling.node_blocks[static_cast<std::size_t>(node.block)].neighbour[block_digit];
  return block < 0 ? -1
                   : list.node_at[static_cast<std::size_t>(block) * kTileNodes<Dim> +
                                  static_cast<std::size_t>(local)];
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
