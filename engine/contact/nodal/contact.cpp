#include "engine/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/state/team.hpp"

namespace mpmfast {

/// Each thread lists its share of the stacks, then all go behind each other: the same list for any number of
/// threads.
template <int Dim>
void Contact<Dim>::find_nodes(const State<Dim>& state) {
  constexpr std::size_t kFewest = 64;  // stacks below which threads would wait more than work
  const std::size_t stacks = state.tiling.stacks.size();
  remember(state);
  list_.node_at.resize(state.tiling.places());
  field_begin_.resize(stacks + 1);
  const int asked = stacks < kFewest ? 1 : state.threads;
  listings_.resize(std::max(static_cast<std::size_t>(asked), listings_.size()));
  on_threads(asked, [&](const Member& me) {
    const auto threads = static_cast<std::size_t>(me.threads), thread = static_cast<std::size_t>(me.thread);
    NodeListing<Dim>& mine = listings_[thread];
    const std::size_t begin = stacks * thread / threads, end = stacks * (thread + 1) / threads;
    for (std::size_t s = begin; s < end; ++s) field_begin_[s + 1] = fields_on(state, s);
    me.wait_for_all();
    if (thread == 0) {
      field_begin_[0] = 0;
      for (std::size_t s = 0; s < stacks; ++s) field_begin_[s + 1] += field_begin_[s];
      list_.fields.resize(static_cast<std::size_t>(field_begin_[stacks]));
    }
    me.wait_for_all();
    mine.nodes.clear();
    mine.entries.clear();
    mine.stack_begin.clear();
    mine.meetings = mine.screened = 0;
    for (std::size_t s = begin; s < end; ++s) list_stack(state, s, mine);
    me.wait_for_all();
    if (thread == 0) make_room(threads);
    me.wait_for_all();
    take_listed(state, mine);
  });
}

/// How many fields the contact nodes of a stack have together.
template <int Dim>
int Contact<Dim>::fields_on(const State<Dim>& state, std::size_t s) const {
  const auto& stack = state.tiling.stacks[s];
  if (stack.end - stack.begin < 2) return 0;
  const double* mass = state.nodes.column(Nodal::mass);
  int sum = 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    int fields = 0;
    for (int t = stack.begin; t < stack.end; ++t) fields += mass[t * kTileNodes<Dim> + local] > 0;
    sum += fields > 1 ? fields : 0;
  }
  return sum;
}

/// The contact nodes of a stack with their entries, in `out`, and their fields.
template <int Dim>
void Contact<Dim>::list_stack(const State<Dim>& state, std::size_t s, NodeListing<Dim>& out) {
  int* node_at = &list_.node_at[s * kTileNodes<Dim>];
  std::fill_n(node_at, kTileNodes<Dim>, -1);
  int next = field_begin_[s];
  if (next == field_begin_[s + 1]) return;
  const auto& stack = state.tiling.stacks[s];
  const double* mass = state.nodes.column(Nodal::mass);
  const std::size_t begin = out.nodes.size();
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    ContactNode<Dim> node;
    node.field_begin = next;
    node.rigid = -1;
    int fields = 0;
    for (int t = stack.begin; t < stack.end; ++t) fields += mass[t * kTileNodes<Dim> + local] > 0;
    if (fields < 2) continue;
    for (int t = stack.begin; t < stack.end; ++t) {
      const int slot = t * kTileNodes<Dim> + local;
      if (!(mass[slot] > 0)) continue;
      const int field = state.tiling.node_tiles[static_cast<std::size_t>(t)].field;
      list_.fields[static_cast<std::size_t>(next++)] = {field, slot};
    }
    node.field_end = next;
    node.stack = static_cast<int>(s);
    node.local = local;
    node.node = state.tiling.node(stack, local);
    node.entry_begin = static_cast<int>(out.entries.size());
    add_entries(state, node, out);
    node.pair_begin = static_cast<int>(out.entries.size());
    if (spec_.fields == ManyFields::pairs && node.rigid < 0) add_pairs(node, out.entries);
    node.entry_end = static_cast<int>(out.entries.size());
    if (node.entry_begin == node.entry_end) continue;
    node_at[local] = static_cast<int>(out.nodes.size());
    out.nodes.push_back(node);
  }
  if (out.nodes.size() > begin) out.stack_begin.push_back(begin);
}

/// Where the share of each thread goes, and room for all of them.
template <int Dim>
void Contact<Dim>::make_room(std::size_t threads) {
  std::size_t nodes = 0, entries = 0, stacks = 0;
  for (std::size_t t = 0; t < threads; ++t) {
    NodeListing<Dim>& listing = listings_[t];
    listing.node_begin = std::exchange(nodes, nodes + listing.nodes.size());
    listing.entry_begin = std::exchange(entries, entries + listing.entries.size());
    listing.stacks_begin = std::exchange(stacks, stacks + listing.stack_begin.size());
    list_.counters.meetings += listing.meetings;
    list_.counters.screened += listing.screened;
  }
  list_.counters.nodes_peak = std::max<std::uint64_t>(list_.counters.nodes_peak, nodes);
  list_.nodes.resize(nodes);
  list_.stack_begin.resize(stacks + 1);
  list_.stack_begin.back() = nodes;
  list_.entries.resize(entries);
  keys_.resize(entries);
  if (bridges_) last_bridges_.swap(list_.bridges), list_.bridges.resize(entries);
  if (bonds_) last_bonds_.swap(list_.bonds), list_.bonds.resize(entries);
  if (keeps_fits_) last_fits_.swap(list_.fits), list_.fits.resize(entries);
}

/// Puts what a thread has listed in the list, with what the last step knew of it.
template <int Dim>
void Contact<Dim>::take_listed(const State<Dim>& state, const NodeListing<Dim>& listing) {
  const auto offset = static_cast<int>(listing.entry_begin);
  for (std::size_t k = 0; k < listing.stack_begin.size(); ++k)
    list_.stack_begin[listing.stacks_begin + k] = listing.node_begin + listing.stack_begin[k];
  std::uint64_t key_before = ~std::uint64_t{0};
  auto last = memory_.begin();  // keys mostly rise from entry to entry, and so does what they find
  for (std::size_t k = 0; k < listing.nodes.size(); ++k) {
    ContactNode<Dim>& node = list_.nodes[listing.node_begin + k];
    node = listing.nodes[k];
    node.entry_begin += offset, node.pair_begin += offset, node.entry_end += offset;
    list_.node_at[static_cast<std::size_t>(node.stack) * kTileNodes<Dim> +
                  static_cast<std::size_t>(node.local)] = static_cast<int>(listing.node_begin + k);
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      ContactEntry<Dim>& entry = list_.entries[at];
      entry = {};
      static_cast<ListedEntry<Dim>&>(entry) = listing.entries[at - listing.entry_begin];
      if (bridges_) list_.bridges[at] = {};
      if (bonds_) list_.bonds[at] = {};
      if (keeps_fits_) list_.fits[at] = {};
      const std::uint64_t key = keys_[at] = entry_key(state, list_, node, entry);
      const auto less = [](const Memory& m, std::uint64_t of) { return m.key < of; };
      if (key < key_before || entry.crack >= 0)
        last = std::lower_bound(memory_.begin(), memory_.end(), key, less);
      key_before = key;
      while (last != memory_.end() && last->key < key) ++last;
      if (last != memory_.end() && last->key == key) recall(*last, at);
    }
  }
}

/// Is there too little material on the node for a normal to be trusted (DC)?
template <int Dim>
bool Contact<Dim>::is_screened(const State<Dim>& state, const ContactNode<Dim>& node) const {
  if (!state.nodes.has(Nodal::volume) || spec_.volume_screen <= 0) return false;
  double volume = 0;
  for (int f = node.field_begin; f < node.field_end; ++f)
    volume += state.nodes.column(Nodal::volume)[list_.fields[static_cast<std::size_t>(f)].slot];
  return volume < spec_.volume_screen * cell_volume_;
}

/// Are the two fields of an entry, sides of one body, parted by one crack? It then has its normal.
template <int Dim>
bool Contact<Dim>::parts(const State<Dim>& state, const ContactNode<Dim>& node,
                         ListedEntry<Dim>& entry) const {
  const auto field = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  };
  const auto parting = cracks_.parting(state, node.node, field(entry.a), field(entry.b),
                                       node.field_end - node.field_begin == 2);
  entry.crack = static_cast<std::int16_t>(parting.crack);
  entry.beyond = parting.beyond;
  entry.normal = parting.normal;
  entry.settled = true;
  return parting.crack >= 0;
}

/// The least share of a node's mass that a field must have for contact: tied ones must move as one to the
/// last node (the perfect interface is exact), and springs know what to do with little.
template <int Dim>
double Contact<Dim>::screen_of(const ContactNode<Dim>& node, const ListedEntry<Dim>& entry, int other) const {
  const AnyLaw& law = laws_[static_cast<std::size_t>(law_between(entry, node, other) + 1)];
  const LawScope scope = std::visit([](const auto& one) { return one.scope; }, law);
  return scope == LawScope::everywhere || scope == LawScope::interface ? 0 : spec_.mass_screen;
}

/// Two deformable fields make one entry; with more, or against a rigid body, each deformable field faces the
/// rest, or every other one by itself. Of several rigid bodies on a node, the one with the most mass counts.
template <int Dim>
void Contact<Dim>::add_entries(const State<Dim>& state, ContactNode<Dim>& node, NodeListing<Dim>& out) const {
  const int fields = node.field_end - node.field_begin;
  const double* mass = state.nodes.column(Nodal::mass);
  const auto field_of = [&](int k) { return list_.fields[static_cast<std::size_t>(node.field_begin + k)]; };
  const auto mass_of = [&](int k) { return mass[field_of(k).slot]; };
  const auto is_rigid = [&](int k) { return state.field_rigid[static_cast<std::size_t>(field_of(k).field)]; };
  const bool own_normals = spec_.normal == NormalKind::own_gradient;
  ++out.meetings;
  if (is_screened(state, node)) {
    ++out.screened;
    return;
  }
  double total = 0;
  for (int k = 0; k < fields; ++k) {
    total += mass_of(k);
    if (is_rigid(k) && (node.rigid < 0 || mass_of(k) > mass_of(node.rigid))) node.rigid = k;
  }
  ListedEntry<Dim> entry;
  if (fields == 2 && cracks_.same_body(state, field_of(0).field, field_of(1).field)) {
    entry.a = 0;
    entry.b = 1;
    entry.alone = true;
    if (!parts(state, node, entry)) return;
    const bool screened = std::min(mass_of(0), mass_of(1)) < screen_of(node, entry, 1) * total;
    out.screened += screened;
    if (!screened) out.entries.push_back(entry);
    return;
  }
  const bool together = spec_.fields == ManyFields::simultaneous && fields > 2 && !own_normals;
  bool dropped = false;
  for (int k = 0; k < fields; ++k) {
    if (is_rigid(k)) continue;
    if (together) {
      entry.a = k;
      for (entry.b = 0; entry.b < fields; ++entry.b) {
        if (!(entry.b == node.rigid || (entry.b > k && !is_rigid(entry.b)))) continue;
        if (!cracks_.same_body(state, field_of(k).field, field_of(entry.b).field)) {
          out.entries.push_back(entry);
        } else if (ListedEntry<Dim> sides = entry; parts(state, node, sides)) {
          out.entries.push_back(sides);
        }
      }
      continue;
    }
    entry.a = k;
    entry.b = fields == 2 && !own_normals ? 1 - k : -1;
    entry.alone = fields == 2;
    const double screen = screen_of(node, entry, pairs_.empty() ? -1 : partner(state, node, entry));
    if (node.rigid < 0 && (mass_of(k) < screen * total || mass_of(k) > (1 - screen) * total)) {
      dropped = true;
      continue;
    }
    out.entries.push_back(entry);
    if (entry.b >= 0) return;
  }
  out.screened += dropped;
}

/// What the next step wants to know of this one's entries.
template <int Dim>
void Contact<Dim>::remember(const State<Dim>& state) {
  const auto n = static_cast<std::int64_t>(list_.entries.size());
  memory_.resize(list_.entries.size());
  for_each_of(n, state.threads, 1024, [&](std::int64_t k) {
    const auto at = static_cast<std::size_t>(k);
    const auto& entry = list_.entries[at];
    Memory& m = memory_[at];
    m = {keys_[at], static_cast<std::uint32_t>(k), entry.touching, entry.stuck, entry.spring, {}};
    std::memcpy(m.plane, entry.plane, sizeof m.plane);
  });
  if (spec_.fields == ManyFields::pairs || cracks_.active())  // lumps come before the pairs of a node
    std::sort(memory_.begin(), memory_.end(), [](const Memory& m, const Memory& n) { return m.key < n.key; });
}

/// Gives an entry what the last step knew of it.
template <int Dim>
void Contact<Dim>::recall(const Memory& memory, std::size_t at) {
  if (bridges_) {
    const Bridge<Dim>& before = last_bridges_[memory.entry];
    auto& bridge = list_.bridges[at];
    bridge.jump = before.jump;
    bridge.known = before.known;
    bridge.jump_normal = before.jump_normal;
  }
  if (bonds_) {
    const Bond<Dim>& before = last_bonds_[memory.entry];
    auto& bond = list_.bonds[at];
    bond.before = before.way;
    bond.offset_before = before.offset;
  }
  if (keeps_fits_) list_.fits[at] = last_fits_[memory.entry];
  auto& entry = list_.entries[at];
  entry.touched = memory.touching;
  entry.stuck_before = memory.stuck;
  entry.spring_before = memory.spring;
  std::memcpy(entry.plane, memory.plane, sizeof entry.plane);
}

template <int Dim>
void Contact<Dim>::follow(const Tiling<Dim>& tiling) {
  for (KeptFit<Dim>& fit : list_.fits)
    for (std::int32_t& particle : fit.foremost)
      if (particle >= 0)
        particle = static_cast<std::int32_t>(tiling.moved(static_cast<std::uint32_t>(particle)));
}

/// What the fields of an entry's node have moved by, which is what the particles around have; what they slide
/// where they touch counts more, since other particles come to lie foremost by that.
template <int Dim>
void Contact<Dim>::drift(const State<Dim>& state, double dt) {
  constexpr double kSlide = 30;
  if (!keeps_fits_) return;
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), state.threads, 1024, [&](std::int64_t k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    const auto velocity = [&](int field) {
      return state.nodes.vector(Nodal::velocity,
                                list_.fields[static_cast<std::size_t>(node.field_begin + field)].slot);
    };
    double fastest = 0;
    for (int f = 0; f < node.field_end - node.field_begin; ++f)
      fastest = std::max(fastest, velocity(f).norm());
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const auto& entry = list_.entries[at];
      Vec<Dim> slides = Vec<Dim>::Zero();
      if (entry.b >= 0 && entry.touching) slides = velocity(entry.a) - velocity(entry.b);
      slides -= slides.dot(entry.normal) * entry.normal;
      list_.fits[at].drift += dt * std::max(fastest, kSlide * slides.norm());
    }
  });
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
