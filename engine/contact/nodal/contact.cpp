#include "engine/contact/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace mpmfast {

template <int Dim>
void Contact<Dim>::find_nodes(const State<Dim>& state) {
  remember();
  list_.nodes.clear();
  list_.fields.clear();
  list_.entries.clear();
  list_.node_at.assign(state.tiling.places(), -1);
  for (int s = 0; s < static_cast<int>(state.tiling.stacks.size()); ++s) {
    const auto& stack = state.tiling.stacks[static_cast<std::size_t>(s)];
    if (stack.end - stack.begin > 1) list_stack(state, s);
  }
  list_.counters.nodes_peak = std::max<std::uint64_t>(list_.counters.nodes_peak, list_.nodes.size());
  recall(state);
}

template <int Dim>
void Contact<Dim>::list_stack(const State<Dim>& state, int s) {
  const auto& stack = state.tiling.stacks[static_cast<std::size_t>(s)];
  const double* mass = state.nodes.column(Nodal::mass);
  std::array<int, kTileNodes<Dim>> fields{};
  for (int t = stack.begin; t < stack.end; ++t)
    for (int local = 0; local < kTileNodes<Dim>; ++local)
      fields[static_cast<std::size_t>(local)] += mass[t * kTileNodes<Dim> + local] > 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    if (fields[static_cast<std::size_t>(local)] < 2) continue;
    ContactNode<Dim> node;
    node.field_begin = static_cast<int>(list_.fields.size());
    node.rigid = -1;
    for (int t = stack.begin; t < stack.end; ++t) {
      const int slot = t * kTileNodes<Dim> + local;
      if (!(mass[slot] > 0)) continue;
      const int field = state.tiling.node_tiles[static_cast<std::size_t>(t)].field;
      list_.fields.push_back({field, slot});
    }
    node.field_end = static_cast<int>(list_.fields.size());
    node.stack = s;
    node.local = local;
    node.node = state.tiling.node(stack, local);
    node.entry_begin = static_cast<int>(list_.entries.size());
    add_entries(state, node);
    node.pair_begin = static_cast<int>(list_.entries.size());
    if (spec_.fields == ManyFields::pairs && node.rigid < 0) add_pairs(node);
    node.entry_end = static_cast<int>(list_.entries.size());
    if (node.entry_begin == node.entry_end) {
      list_.fields.resize(static_cast<std::size_t>(node.field_begin));
      continue;
    }
    list_.node_at[static_cast<std::size_t>(s) * kTileNodes<Dim> + static_cast<std::size_t>(local)] =
        static_cast<int>(list_.nodes.size());
    list_.nodes.push_back(node);
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
                         ContactEntry<Dim>& entry) const {
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
double Contact<Dim>::screen_of(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry,
                               int other) const {
  const AnyLaw& law = laws_[static_cast<std::size_t>(law_between(entry, node, other) + 1)];
  const LawScope scope = std::visit([](const auto& one) { return one.scope; }, law);
  return scope == LawScope::everywhere || scope == LawScope::bridged ? 0 : spec_.mass_screen;
}

/// Two deformable fields make one entry; with more, or against a rigid body, each deformable field faces the
/// rest, or every other one by itself. Of several rigid bodies on a node, the one with the most mass counts.
template <int Dim>
void Contact<Dim>::add_entries(const State<Dim>& state, ContactNode<Dim>& node) {
  const int fields = node.field_end - node.field_begin;
  const double* mass = state.nodes.column(Nodal::mass);
  const auto field_of = [&](int k) { return list_.fields[static_cast<std::size_t>(node.field_begin + k)]; };
  const auto mass_of = [&](int k) { return mass[field_of(k).slot]; };
  const auto is_rigid = [&](int k) { return state.field_rigid[static_cast<std::size_t>(field_of(k).field)]; };
  const bool own_normals = spec_.normal == NormalKind::own_gradient;
  ++list_.counters.meetings;
  if (is_screened(state, node)) {
    ++list_.counters.screened;
    return;
  }
  double total = 0;
  for (int k = 0; k < fields; ++k) {
    total += mass_of(k);
    if (is_rigid(k) && (node.rigid < 0 || mass_of(k) > mass_of(node.rigid))) node.rigid = k;
  }
  ContactEntry<Dim> entry;
  entry.normal = entry.impulse = Vec<Dim>::Zero();
  if (fields == 2 && cracks_.same_body(state, field_of(0).field, field_of(1).field)) {
    entry.a = 0;
    entry.b = 1;
    entry.alone = true;
    if (!parts(state, node, entry)) return;
    const bool screened = std::min(mass_of(0), mass_of(1)) < screen_of(node, entry, 1) * total;
    list_.counters.screened += screened;
    if (!screened) list_.entries.push_back(entry);
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
          list_.entries.push_back(entry);
        } else if (ContactEntry<Dim> sides = entry; parts(state, node, sides)) {
          list_.entries.push_back(sides);
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
    list_.entries.push_back(entry);
    if (entry.b >= 0) return;
  }
  list_.counters.screened += dropped;
}

/// What the next step wants to know of this one's entries.
template <int Dim>
void Contact<Dim>::remember() {
  memory_.clear();
  memory_.reserve(list_.entries.size());
  for (std::size_t k = 0; k < list_.entries.size(); ++k) {
    const auto& entry = list_.entries[k];
    Memory m{keys_[k], static_cast<std::uint32_t>(k), entry.touching, entry.stuck, entry.spring, {}};
    std::memcpy(m.plane, entry.plane, sizeof m.plane);
    memory_.push_back(m);
  }
  if (spec_.fields == ManyFields::pairs || cracks_.active())  // lumps come before the pairs of a node
    std::sort(memory_.begin(), memory_.end(), [](const Memory& m, const Memory& n) { return m.key < n.key; });
}

template <int Dim>
void Contact<Dim>::recall(const State<Dim>& state) {
  keys_.clear();
  if (bridges_) {
    last_bridges_.swap(list_.bridges);
    list_.bridges.assign(list_.entries.size(), {});
  }
  if (bonds_) {
    last_bonds_.swap(list_.bonds);
    list_.bonds.assign(list_.entries.size(), {});
  }
  if (keeps_fits_) {
    last_fits_.swap(list_.fits);
    list_.fits.assign(list_.entries.size(), {});
  }
  const auto less = [](const Memory& m, std::uint64_t k) { return m.key < k; };
  auto last = memory_.begin();  // keys mostly rise from entry to entry, and so does what they find
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      const std::uint64_t key = entry_key(state, list_, node, entry);
      if (!keys_.empty() && key < keys_.back()) last = std::lower_bound(memory_.begin(), last, key, less);
      if (entry.crack >= 0) last = std::lower_bound(memory_.begin(), memory_.end(), key, less);
      keys_.push_back(key);
      while (last != memory_.end() && last->key < key) ++last;
      if (last == memory_.end() || last->key != key) continue;
      if (bridges_) {
        const Bridge<Dim>& before = last_bridges_[last->entry];
        auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
        bridge.jump = before.jump;
        bridge.known = before.known;
        bridge.jump_normal = before.jump_normal;
      }
      if (bonds_) {
        const Bond<Dim>& before = last_bonds_[last->entry];
        auto& bond = list_.bonds[static_cast<std::size_t>(e)];
        bond.before = before.way;
        bond.offset_before = before.offset;
      }
      if (keeps_fits_) list_.fits[static_cast<std::size_t>(e)] = last_fits_[last->entry];
      entry.touched = last->touching;
      entry.stuck_before = last->stuck;
      entry.spring_before = last->spring;
      std::memcpy(entry.plane, last->plane, sizeof entry.plane);
    }
}

template <int Dim>
void Contact<Dim>::follow(const Tiling<Dim>& tiling) {
  for (KeptFit<Dim>& fit : list_.fits)
    for (std::int32_t& particle : fit.foremost)
      if (particle >= 0)
        particle = static_cast<std::int32_t>(tiling.moved(static_cast<std::uint32_t>(particle)));
}

/// What the fields of an entry's node have moved by, which is what the particles around have.
template <int Dim>
void Contact<Dim>::drift(const State<Dim>& state, double dt) {
  if (!keeps_fits_) return;
  for (const auto& node : list_.nodes) {
    double squared = 0;
    for (int f = node.field_begin; f < node.field_end; ++f)
      squared = std::max(
          squared,
          state.nodes.vector(Nodal::velocity, list_.fields[static_cast<std::size_t>(f)].slot).squaredNorm());
    const double way = dt * std::sqrt(squared);
    for (int e = node.entry_begin; e < node.entry_end; ++e)
      list_.fits[static_cast<std::size_t>(e)].drift += way;
  }
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
