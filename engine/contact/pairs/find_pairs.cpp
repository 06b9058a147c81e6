#include "engine/contact/pairs/find_pairs.hpp"

#include <algorithm>
#include <utility>

#include "engine/constants.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

template <int Dim>
PairFinder<Dim>::PairFinder(const Scene& scene, const PairLaws& laws, const Cracks<Dim>& cracks)
    : spec_(scene.contact), laws_(laws), cracks_(cracks), cell_volume_(cell_volume(scene)) {}

template <int Dim>
std::size_t PairFinder<Dim>::bytes() const {
  std::size_t sum = bytes_in(field_begin_);
  for (const Listing& listing : listings_) sum += bytes_in(listing.nodes, listing.pairs);
  return sum;
}

/// Each thread lists its share of the blocks; the listings follow each other in the order of the threads.
template <int Dim>
void PairFinder<Dim>::find(const State<Dim>& state, PairMemory<Dim>& memory, ContactList<Dim>& list) {
  const std::size_t blocks = state.tiling.node_blocks.size();
  memory.store(list, state.threads);
  list.node_at.resize(state.tiling.block_nodes());
  field_begin_.resize(blocks + 1);
  const int asked = blocks < constants::threads::kFewBlocks ? 1 : state.threads;
  listings_.resize(std::max(static_cast<std::size_t>(asked), listings_.size()));
  on_threads(asked, [&](const TeamThread& me) {
    const auto threads = static_cast<std::size_t>(me.threads), thread = static_cast<std::size_t>(me.thread);
    Listing& mine = listings_[thread];
    const std::size_t begin = blocks * thread / threads, end = blocks * (thread + 1) / threads;
    for (std::size_t b = begin; b < end; ++b) field_begin_[b + 1] = count_fields(state, b);
    me.wait_for_all();
    if (thread == 0) {
      field_begin_[0] = 0;
      for (std::size_t b = 0; b < blocks; ++b) field_begin_[b + 1] += field_begin_[b];
      list.fields.resize(static_cast<std::size_t>(field_begin_[blocks]));
    }
    me.wait_for_all();
    mine.nodes.clear();
    mine.pairs.clear();
    mine.block_begin.clear();
    mine.meetings = mine.screened = 0;
    for (std::size_t b = begin; b < end; ++b) list_block(state, b, list, mine);
    me.wait_for_all();
    if (thread == 0) place_listings(threads, memory, list);
    me.wait_for_all();
    take_listing(state, mine, memory, list);
  });
}

/// The number of fields that the contact nodes of a block have together.
template <int Dim>
int PairFinder<Dim>::count_fields(const State<Dim>& state, std::size_t b) const {
  const auto& block = state.tiling.node_blocks[b];
  if (block.end - block.begin < 2) return 0;
  const double* mass = state.nodes.column(Nodal::mass);
  int sum = 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    int fields = 0;
    for (int t = block.begin; t < block.end; ++t) fields += mass[t * kTileNodes<Dim> + local] > 0;
    sum += fields > 1 ? fields : 0;
  }
  return sum;
}

/// The contact nodes of a block with their pairs in `out`, and their fields in the list.
template <int Dim>
void PairFinder<Dim>::list_block(const State<Dim>& state, std::size_t b, ContactList<Dim>& list,
                                 Listing& out) {
  int* node_at = &list.node_at[b * kTileNodes<Dim>];
  std::fill_n(node_at, kTileNodes<Dim>, -1);
  int next = field_begin_[b];
  if (next == field_begin_[b + 1]) return;
  const auto& block = state.tiling.node_blocks[b];
  const double* mass = state.nodes.column(Nodal::mass);
  const std::size_t begin = out.nodes.size();
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    int fields = 0;
    for (int t = block.begin; t < block.end; ++t) fields += mass[t * kTileNodes<Dim> + local] > 0;
    if (fields < 2) continue;
    ContactNode<Dim> node;
    node.field_begin = next;
    for (int t = block.begin; t < block.end; ++t) {
      const int slot = t * kTileNodes<Dim> + local;
      if (mass[slot] > 0)
        list.fields[next++] = {state.tiling.node_tiles[static_cast<std::size_t>(t)].field, slot};
    }
    node.field_end = next;
    node.block = static_cast<int>(b);
    node.local = local;
    node.index = state.tiling.node(block, local);
    node.rigid = -1;
    const NodeFields<Dim> of_node(state, list.fields, node);
    node.pair_begin = static_cast<int>(out.pairs.size());
    list_pairs(state, of_node, node, out);
    node.explicit_begin = static_cast<int>(out.pairs.size());
    if (spec_.fields == ManyFields::pairs && node.rigid < 0) list_explicit_pairs(of_node, node, out);
    node.pair_end = static_cast<int>(out.pairs.size());
    if (node.pair_begin == node.pair_end) continue;
    node_at[local] = static_cast<int>(out.nodes.size());
    out.nodes.push_back(node);
  }
  if (out.nodes.size() > begin) out.block_begin.push_back(begin);
}

/// Finds the rigid body of a node, and lists its pairs. Two deformable fields make one pair. With more fields
/// each deformable one meets every other, or all others lumped. Of several rigid bodies on a node, only the
/// one of the largest mass counts.
template <int Dim>
void PairFinder<Dim>::list_pairs(const State<Dim>& state, const NodeFields<Dim>& fields,
                                 ContactNode<Dim>& node, Listing& out) const {
  ++out.meetings;
  if (has_little_volume(state, fields)) {
    ++out.screened;
    return;
  }
  double total = 0;
  for (int k = 0; k < fields.count(); ++k) {
    total += fields.mass(k);
    if (fields.is_rigid(k) && (node.rigid < 0 || fields.mass(k) > fields.mass(node.rigid))) node.rigid = k;
  }
  const bool two = fields.count() == 2;
  if (two && cracks_.same_body(state, fields.field(0), fields.field(1))) {
    ListedPair sides{{0, 1}};
    sides.pair.sole = true;
    if (!is_separated(state, fields, node, sides)) return;
    const bool screened =
        std::min(fields.mass(0), fields.mass(1)) < least_mass_share(fields, sides.pair, 1) * total;
    out.screened += screened;
    if (!screened) out.pairs.push_back(sides);
  } else if (!two && spec_.fields == ManyFields::simultaneous && spec_.normal != NormalKind::own_gradient) {
    list_all_pairs(state, fields, node, out);
  } else {
    list_lumped_pairs(fields, node, total, out);
  }
}

/// Every two fields of a node that may touch.
template <int Dim>
void PairFinder<Dim>::list_all_pairs(const State<Dim>& state, const NodeFields<Dim>& fields,
                                     const ContactNode<Dim>& node, Listing& out) const {
  for (int a = 0; a < fields.count(); ++a) {
    if (fields.is_rigid(a)) continue;
    for (int b = 0; b < fields.count(); ++b) {
      if (!(b == node.rigid || (b > a && !fields.is_rigid(b)))) continue;
      ListedPair listed{{a, b}};
      if (!cracks_.same_body(state, fields.field(a), fields.field(b)) ||
          is_separated(state, fields, node, listed))
        out.pairs.push_back(listed);
    }
  }
}

/// The pair of a node of two fields, or each deformable field against all others lumped.
template <int Dim>
void PairFinder<Dim>::list_lumped_pairs(const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                                        double total, Listing& out) const {
  const bool two = fields.count() == 2, lumped = !two || spec_.normal == NormalKind::own_gradient;
  bool dropped = false;
  for (int k = 0; k < fields.count(); ++k) {
    if (fields.is_rigid(k)) continue;
    ListedPair listed{{k, lumped ? -1 : 1 - k}};
    listed.pair.sole = two;
    const int other = laws_.none_by_fields() ? -1 : partner(fields, node, listed.pair);
    const double least = least_mass_share(fields, listed.pair, other);
    if (node.rigid < 0 && (fields.mass(k) < least * total || fields.mass(k) > (1 - least) * total)) {
      dropped = true;
      continue;
    }
    out.pairs.push_back(listed);
    if (!lumped) return;
  }
  out.screened += dropped;
}

/// Beside the lumped pairs: every two fields of a node of three or more that have a lumped pair (N20 §3.4).
template <int Dim>
void PairFinder<Dim>::list_explicit_pairs(const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                                          Listing& out) const {
  if (fields.count() < 3) return;
  const auto lumped_field = [&](int e) { return out.pairs[static_cast<std::size_t>(e)].pair.a; };
  for (int e = node.pair_begin; e < node.explicit_begin; ++e)
    for (int f = e + 1; f < node.explicit_begin; ++f)
      out.pairs.push_back({{lumped_field(e), lumped_field(f)}});
}

/// Is there too little material on the node for a normal to be trusted (DC)?
template <int Dim>
bool PairFinder<Dim>::has_little_volume(const State<Dim>& state, const NodeFields<Dim>& fields) const {
  if (!state.nodes.has(Nodal::volume) || spec_.volume_screen <= 0) return false;
  double volume = 0;
  for (int k = 0; k < fields.count(); ++k) volume += fields.volume(k);
  return volume < spec_.volume_screen * cell_volume_;
}

/// Are the two fields of a pair, sides of one body, separated by one crack? The pair then has its normal.
template <int Dim>
bool PairFinder<Dim>::is_separated(const State<Dim>& state, const NodeFields<Dim>& fields,
                                   const ContactNode<Dim>& node, ListedPair& listed) const {
  const auto parting = cracks_.parting(state, node.index, fields.field(listed.pair.a),
                                       fields.field(listed.pair.b), fields.count() == 2);
  listed.pair.crack = static_cast<std::int16_t>(parting.crack);
  listed.pair.beyond = parting.beyond;
  listed.normal = parting.normal;
  listed.prescribed = true;
  return parting.crack >= 0;
}

/// The least share of a node's mass that a field must have for contact. Tied fields move as one to the last
/// node (the perfect interface is exact), and springs take any mass.
template <int Dim>
double PairFinder<Dim>::least_mass_share(const NodeFields<Dim>& fields, const ContactPair& pair,
                                         int other) const {
  const LawScope scope = std::visit([](const auto& law) { return law.scope; },
                                    laws_.law(laws_.number_between(fields, pair, other)));
  return scope == LawScope::everywhere || scope == LawScope::interface ? 0 : spec_.mass_screen;
}

/// Where the listing of each thread goes in the whole list, and memory for all of them.
template <int Dim>
void PairFinder<Dim>::place_listings(std::size_t threads, PairMemory<Dim>& memory, ContactList<Dim>& list) {
  std::size_t nodes = 0, pairs = 0, blocks = 0;
  for (std::size_t t = 0; t < threads; ++t) {
    Listing& listing = listings_[t];
    listing.node_begin = std::exchange(nodes, nodes + listing.nodes.size());
    listing.pair_begin = std::exchange(pairs, pairs + listing.pairs.size());
    listing.blocks_begin = std::exchange(blocks, blocks + listing.block_begin.size());
    list.counters.meetings += listing.meetings;
    list.counters.screened += listing.screened;
  }
  list.counters.nodes_peak = std::max<std::uint64_t>(list.counters.nodes_peak, nodes);
  list.nodes.resize(nodes);
  list.block_begin.resize(blocks + 1);
  list.block_begin.back() = nodes;
  memory.resize(pairs, list);
}

/// Puts the listing of a thread in the list, with what the last step left of its pairs.
template <int Dim>
void PairFinder<Dim>::take_listing(const State<Dim>& state, const Listing& listing, PairMemory<Dim>& memory,
                                   ContactList<Dim>& list) const {
  const auto offset = static_cast<int>(listing.pair_begin);
  for (std::size_t k = 0; k < listing.block_begin.size(); ++k)
    list.block_begin[listing.blocks_begin + k] = listing.node_begin + listing.block_begin[k];
  typename PairMemory<Dim>::Cursor cursor;
  PairColumns<Dim>& pairs = list.pairs;
  for (std::size_t k = 0; k < listing.nodes.size(); ++k) {
    ContactNode<Dim>& node = list.nodes[listing.node_begin + k];
    node = listing.nodes[k];
    node.pair_begin += offset, node.explicit_begin += offset, node.pair_end += offset;
    list.node_at[static_cast<std::size_t>(node.block) * kTileNodes<Dim> +
                 static_cast<std::size_t>(node.local)] = static_cast<int>(listing.node_begin + k);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ListedPair& listed = listing.pairs[static_cast<std::size_t>(e - offset)];
      pairs.pair[e] = listed.pair;
      pairs.geometry[e] = {};
      pairs.geometry[e].normal = listed.normal;
      pairs.geometry[e].prescribed = listed.prescribed;
      pairs.before[e] = {};
      pairs.status[e] = {};
      pairs.impulse[e] = {};
      if (!pairs.spring.empty()) pairs.spring[e] = {};
      if (!pairs.bond.empty()) pairs.bond[e] = {};
      if (!pairs.fit.empty()) pairs.fit[e] = {};
      memory.restore(pair_key(state, list, node, listed.pair), static_cast<std::size_t>(e), cursor, list);
    }
  }
}

template class PairFinder<2>;
template class PairFinder<3>;

}  // namespace mpmfast
