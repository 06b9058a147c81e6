#include "engine/step/contact.hpp"

#include <algorithm>
#include <limits>

#include "kernels/contact/separation.hpp"

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
  if (spec_.hysteresis > 0) remember_touching();
  list_.nodes.clear();
  list_.fields.clear();
  list_.entries.clear();
  list_.node_at.assign(state.tiling.places(), -1);
  for (int s = 0; s < static_cast<int>(state.tiling.stacks.size()); ++s) {
    const auto& stack = state.tiling.stacks[static_cast<std::size_t>(s)];
    if (stack.end - stack.begin > 1) list_stack(state, s);
  }
  list_.counters.nodes_peak = std::max<std::uint64_t>(list_.counters.nodes_peak, list_.nodes.size());
  if (spec_.hysteresis > 0) recall_touching(state);
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
  const double screen = exact_fields_ ? 0 : spec_.mass_screen;
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
    entry.b = fields == 2 ? 1 - k : -1;
    list_.entries.push_back(entry);
    if (fields == 2) return;
  }
}

template <int Dim>
std::uint64_t Contact<Dim>::entry_key(const State<Dim>& state, const ContactNode<Dim>& node,
                                      const ContactEntry<Dim>& entry) const {
  const auto& stack = state.tiling.stacks[static_cast<std::size_t>(node.stack)];
  const auto place =
      static_cast<std::uint64_t>(state.tiling.node_tiles[static_cast<std::size_t>(stack.begin)].place);
  const int field = list_.fields[static_cast<std::size_t>(node.field_begin + entry.a)].field;
  const auto fields = static_cast<std::uint64_t>(state.fields());
  const std::uint64_t key = (place * kTileNodes<Dim> + static_cast<std::uint64_t>(node.local)) * fields +
                            static_cast<std::uint64_t>(field);
  if (spec_.fields == ManyFields::lump) return key;
  const bool pair = entry.b >= 0 && node.field_end - node.field_begin > 2;
  const int other = pair ? list_.fields[static_cast<std::size_t>(node.field_begin + entry.b)].field + 1 : 0;
  return key * (fields + 1) + static_cast<std::uint64_t>(other);
}

template <int Dim>
void Contact<Dim>::remember_touching() {
  touching_.clear();
  for (std::size_t k = 0; k < list_.entries.size(); ++k)
    if (list_.entries[k].touching) touching_.push_back(keys_[k]);
  if (spec_.fields == ManyFields::pairs) std::sort(touching_.begin(), touching_.end());
}

template <int Dim>
void Contact<Dim>::recall_touching(const State<Dim>& state) {
  keys_.clear();
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      keys_.push_back(entry_key(state, node, entry));
      entry.touched = std::binary_search(touching_.begin(), touching_.end(), keys_.back());
    }
}

template <int Dim>
void Contact<Dim>::find_geometry(State<Dim>& state, Passes<Dim>& passes) {
  if (list_.nodes.empty() || !geometry_) return;
  if (spec_.normal == NormalKind::specified || spec_.normal == NormalKind::average_gradient)
    grid_normals(state);
  if (spec_.separation == SeparationKind::none)
    for (auto& entry : list_.entries) entry.separation = -std::numeric_limits<double>::infinity();
  passes.fit_contact(state, spec_, list_);
  if (state.nodes.has(Nodal::mass_position)) grid_separations(state);
}

template <int Dim>
void Contact<Dim>::grid_normals(const State<Dim>& state) {
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      const int own = node.field_begin + entry.a,
                other = own == node.field_begin ? own + 1 : node.field_begin;
      const auto field = [&](int f) { return list_.fields[static_cast<std::size_t>(f)].field; };
      if (spec_.normal ==
          NormalKind::specified) {  // into the rigid body, else from the lower field to the higher
        const double sign = node.rigid >= 0 || field(own) < field(other) ? 1.0 : -1.0;
        for (int d = 0; d < Dim; ++d)
          entry.normal[d] = sign * spec_.specified_normal[static_cast<std::size_t>(d)];
        continue;
      }
      // A volume gradient points out of its own material: from a to the rest is g_a − g_b (N20 Eq. 13).
      Vec<Dim> sum = Vec<Dim>::Zero();
      for (int f = node.field_begin; f < node.field_end; ++f)
        sum += (f == own ? 1.0 : -1.0) *
               state.nodes.vector(Nodal::volume_gradient, list_.fields[static_cast<std::size_t>(f)].slot);
      const double length = sum.norm();
      if (length > 0) entry.normal = sum / length;
    }
}

template <int Dim>
void Contact<Dim>::grid_separations(const State<Dim>& state) {
  const double* mass = state.nodes.column(Nodal::mass);
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      Side<Dim> own, rest;  // first moments in place of momenta
      for (int f = node.field_begin; f < node.field_end; ++f) {
        const int slot = list_.fields[static_cast<std::size_t>(f)].slot;
        Side<Dim>& side = f - node.field_begin == entry.a ? own : rest;
        side.mass += mass[slot];
        side.momentum += state.nodes.vector(Nodal::mass_position, slot);
      }
      const auto ahead = [&](const Side<Dim>& side) {  // e = (x − x_i)·n in cells
        return (side.momentum / (side.mass * state.grid.cell) - node.node.template cast<double>())
            .dot(entry.normal);
      };
      entry.separation =
          state.grid.cell * (spec_.separation == SeparationKind::position_offset
                                 ? position_offset(ahead(own), ahead(rest), spec_.position_offset)
                                 : position_power(ahead(own), ahead(rest)));
    }
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
