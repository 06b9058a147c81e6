#include "engine/step/contact.hpp"

#include <algorithm>
#include <cstring>

#include "kernels/contact/laws.hpp"

namespace mpmfast {

namespace {

/// Momentum and mass of one entry: field a against the rest.
template <int Dim>
struct Side {
  double mass = 0;
  Vec<Dim> momentum = Vec<Dim>::Zero();
};

}  // namespace

template <int Dim>
void Contact<Dim>::find_nodes(const State<Dim>& state) {
  const bool memory = spec_.hysteresis > 0 || spec_.warm_start || spec_.persistent;
  if (memory) remember();
  list_.nodes.clear();
  list_.fields.clear();
  list_.entries.clear();
  list_.node_at.assign(state.tiling.places(), -1);
  for (int s = 0; s < static_cast<int>(state.tiling.stacks.size()); ++s) {
    const auto& stack = state.tiling.stacks[static_cast<std::size_t>(s)];
    if (stack.end - stack.begin > 1) list_stack(state, s);
  }
  list_.counters.nodes_peak = std::max<std::uint64_t>(list_.counters.nodes_peak, list_.nodes.size());
  if (memory) recall(state);
}

template <int Dim>
void Contact<Dim>::list_stack(const State<Dim>& state, int s) {
  const auto& stack = state.tiling.stacks[static_cast<std::size_t>(s)];
  const double* mass = state.nodes.column(Nodal::mass);
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
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
    if (node.field_end - node.field_begin > 1) add_entries(state, node);
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

/// Two deformable fields make one entry; with more, or against a rigid body, each deformable field faces the
/// rest. Of several rigid bodies on a node, the one with the most mass there counts.
template <int Dim>
void Contact<Dim>::add_entries(const State<Dim>& state, ContactNode<Dim>& node) {
  const int fields = node.field_end - node.field_begin;
  const double* mass = state.nodes.column(Nodal::mass);
  const auto field_of = [&](int k) { return list_.fields[static_cast<std::size_t>(node.field_begin + k)]; };
  const auto mass_of = [&](int k) { return mass[field_of(k).slot]; };
  const auto is_rigid = [&](int k) { return state.field_rigid[static_cast<std::size_t>(field_of(k).field)]; };
  // Tied fields must move as one to the last node (the perfect interface is exact).
  const double screen = spec_.law == LawKind::perfect ? 0 : spec_.mass_screen;
  const bool own_normals = spec_.normal == NormalKind::own_gradient;
  if (is_screened(state, node)) return;
  double total = 0;
  for (int k = 0; k < fields; ++k) {
    total += mass_of(k);
    if (is_rigid(k) && (node.rigid < 0 || mass_of(k) > mass_of(node.rigid))) node.rigid = k;
  }
  ContactEntry<Dim> entry;
  entry.normal = entry.impulse = Vec<Dim>::Zero();
  for (int k = 0; k < fields; ++k) {
    if (is_rigid(k)) continue;
    if (node.rigid < 0 && (mass_of(k) < screen * total || mass_of(k) > (1 - screen) * total)) continue;
    entry.a = k;
    entry.b = fields == 2 && !own_normals ? 1 - k : -1;
    list_.entries.push_back(entry);
    if (entry.b >= 0) return;
  }
}

/// What the next step wants to know of this one's entries.
template <int Dim>
void Contact<Dim>::remember() {
  memory_.clear();
  for (std::size_t k = 0; k < list_.entries.size(); ++k) {
    const auto& entry = list_.entries[k];
    Memory m{keys_[k], entry.touching, entry.sticking, {}};
    std::memcpy(m.plane, entry.plane, sizeof m.plane);
    memory_.push_back(m);
  }
}

template <int Dim>
void Contact<Dim>::recall(const State<Dim>& state) {
  keys_.clear();
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      const std::uint64_t key = entry_key(state, list_, node, entry);
      keys_.push_back(key);
      const auto last = std::lower_bound(memory_.begin(), memory_.end(), key,
                                         [](const Memory& m, std::uint64_t k) { return m.key < k; });
      if (last == memory_.end() || last->key != key) continue;
      entry.touched = last->touching;
      entry.stuck = last->sticking;
      std::memcpy(entry.plane, last->plane, sizeof entry.plane);
    }
}

template <int Dim>
void Contact<Dim>::resolve(State<Dim>& state, Correction correction, double dt) {
  switch (spec_.law) {
    case LawKind::coulomb:
      return resolve_law(state, Coulomb{spec_.friction}, correction, dt);
    case LawKind::frictionless:
      return resolve_law(state, Frictionless{}, correction, dt);
    case LawKind::stick:
      return resolve_law(state, Stick{}, correction, dt);
    case LawKind::perfect:
      return resolve_law(state, Perfect{}, correction, dt);
    case LawKind::ignore:
      return resolve_law(state, Ignore{}, correction, dt);
  }
}

template <int Dim>
template <class Law>
void Contact<Dim>::resolve_law(State<Dim>& state, const Law& law, Correction correction, double dt) {
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
#pragma omp parallel for num_threads(state.threads) schedule(static) if (n > 64)
  for (std::int64_t k = 0; k < n; ++k)
    resolve_node(state, law, correction, dt, list_.nodes[static_cast<std::size_t>(k)]);
  if (correction == Correction::initial) {
    friction_work_ = rigid_work_ = 0;
    rigid_impulse_.assign(static_cast<std::size_t>(state.fields()), Vec<Dim>::Zero());
    if (!first_correction_stays_) return;
  }
  book(state);
}

/// Adds up, in a fixed order, what the particles will keep of a correction.
template <int Dim>
void Contact<Dim>::book(const State<Dim>& state) {
  const double* mass = state.nodes.column(Nodal::mass);
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      // In a lump, each touching pair is seen from both sides.
      friction_work_ += (entry.b >= 0 || node.rigid >= 0 ? 1.0 : 0.5) * entry.friction_work;
      if (node.rigid < 0) continue;
      const auto [field, slot] = list_.fields[static_cast<std::size_t>(node.field_begin + node.rigid)];
      rigid_impulse_[static_cast<std::size_t>(field)] -= entry.impulse;
      rigid_work_ += entry.impulse.dot(state.nodes.vector(Nodal::momentum, slot)) / mass[slot];
    }
}

/// All entries of a node, from the momenta before any of them changes.
template <int Dim>
template <class Law>
void Contact<Dim>::resolve_node(State<Dim>& state, const Law& law, Correction correction, double dt,
                                const ContactNode<Dim>& node) {
  auto& nodes = state.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const auto slot_of = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
  };
  Side<Dim> all;
  for (int k = 0; k < node.field_end - node.field_begin; ++k) {
    all.mass += mass[slot_of(k)];
    all.momentum += nodes.vector(Nodal::momentum, slot_of(k));
  }
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    auto& entry = list_.entries[static_cast<std::size_t>(e)];
    const double m_a = mass[slot_of(entry.a)];
    const Vec<Dim> p_a = nodes.vector(Nodal::momentum, slot_of(entry.a));
    double reduced = m_a * (all.mass - m_a) / all.mass;
    Vec<Dim> stick = (m_a / all.mass) * all.momentum - p_a;
    if (node.rigid >= 0) {  // m_b → ∞: b keeps its velocity
      const int r = slot_of(node.rigid);
      stick = (m_a / mass[r]) * nodes.vector(Nodal::momentum, r) - p_a;
      reduced = m_a;
    }
    double separation = entry.separation;
    if (entry.touched) separation -= spec_.hysteresis * state.grid.cell;
    if (correction == Correction::final && spec_.advance_separation)
      separation += stick.dot(entry.normal) * dt / reduced;  // NN Eq. 3.56
    entry.impulse = resolve_pair<Dim>(stick, entry.normal, separation, law);
    if (correction == Correction::initial && spec_.persistent && entry.touched && separation < 0 &&
        stick.dot(entry.normal) > 0)
      entry.impulse = entry.stuck && spec_.persistent > 1 ? stick : Vec<Dim>(stick.dot(entry.normal) * entry.normal);
    entry.touching = !entry.impulse.isZero(0);
    entry.sticking = (entry.impulse - stick).isZero(0);
    const Vec<Dim> tangential = entry.impulse - entry.impulse.dot(entry.normal) * entry.normal;
    entry.friction_work =
        Law::scope == LawScope::contact ? tangential.dot(stick - entry.impulse) / reduced : 0.0;
  }
  const auto apply = [&](int slot, const Vec<Dim>& impulse) {
    nodes.set(Nodal::momentum, slot, nodes.vector(Nodal::momentum, slot) + impulse);
    if (correction == Correction::final)
      nodes.set(Nodal::force, slot, nodes.vector(Nodal::force, slot) + impulse / dt);
    else if (keep_velocity_change_)
      for (int d = 0; d < Dim; ++d) nodes.column(Nodal::star, Dim + d)[slot] = impulse[d] / mass[slot];
  };
  for (int e = node.entry_begin; e < node.entry_end; ++e) {
    const auto& entry = list_.entries[static_cast<std::size_t>(e)];
    if (!entry.touching) continue;
    apply(slot_of(entry.a), entry.impulse);
    if (entry.b >= 0 && entry.b != node.rigid) apply(slot_of(entry.b), -entry.impulse);
  }
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
