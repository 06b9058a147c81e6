/// Where particles are, and what they bring to the nodes.

#include <algorithm>
#include <cstring>

#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// A particle may drift by one cell before the cell table that contact clouds are gathered from is out of
/// date; half a cell is kept for the growth of CPDI domains.
template <int Dim>
void Step<Dim>::sort_if_due() {
  const bool due = sort_due_ || travelled_ >= 0.5 * state_.grid.cell;
  if (due) sort();
  if (cracks_.active() && (due || cracks_.look_due(state_.grid.cell))) look_at_cracks(due);
}

template <int Dim>
void Step<Dim>::sort() {
  clock_.time(Pass::sort, [&] { passes_->sort(state_); });
  number_slots();
  sort_due_ = false;
  travelled_ = 0;
}

/// Groups the particles anew where they see other sides than before.
template <int Dim>
void Step<Dim>::look_at_cracks(bool sorted) {
  const Supports<Dim> supports = passes_->supports(state_);
  const auto look = [&] {
    return clock_.time(Pass::contact_nodes, [&] { return cracks_.look(state_, supports); });
  };
  Seen seen = look();
  if (seen == Seen::outside && !sorted) {
    sort();
    sorted = true;
    seen = look();
  }
  if (seen != Seen::same) {
    clock_.time(Pass::sort, [&] { cracks_.group(state_); });
    number_slots();
  }
  if (seen != Seen::same || sorted) cracks_.mark(state_);
}

/// What follows from slots that have been numbered anew.
template <int Dim>
void Step<Dim>::number_slots() {
  state_.nodes.resize(static_cast<std::size_t>(state_.tiling.slots()));
  conditions_.forget_nodes();
  extension_.forget_nodes();
  penalty_.forget_tiles();
  heat_.forget_nodes();
  nodes_peak_ = std::max<std::uint64_t>(nodes_peak_, static_cast<std::uint64_t>(state_.tiling.slots()));
}

namespace {

template <int Dim>
void clear_geometry(Nodes<Dim>& nodes, std::int64_t begin, std::int64_t count) {
  for (const Nodal q :
       {Nodal::volume, Nodal::volume_gradient, Nodal::mass_position, Nodal::mass_displacement})
    for (int k = 0; k < nodes.width(q); ++k)
      std::memset(nodes.column(q, k) + begin, 0, static_cast<std::size_t>(count) * sizeof(double));
}

/// Elsewhere nothing is added, and nobody reads.
template <int Dim>
void clear_geometry_near_cracks(State<Dim>& state) {
  const auto& tiling = state.tiling;
  for (std::size_t k = 0; k < tiling.node_tiles.size(); ++k) {
    const auto& over = tiling.node_tiles[k].particle_tile;
    if (std::any_of(over, over + kCorners<Dim>,
                    [&](int t) { return t >= 0 && tiling.tiles[static_cast<std::size_t>(t)].cracked; }))
      clear_geometry(state.nodes, static_cast<std::int64_t>(k) * kTileNodes<Dim>, kTileNodes<Dim>);
  }
}

}  // namespace

template <int Dim>
void Step<Dim>::project() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    const bool inside = clock_.time(Pass::project, [&] {
      auto& nodes = state_.nodes;
      for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
        const auto bytes = static_cast<std::size_t>(end - begin) * sizeof(double);
        const auto clear = [&](Nodal q, int components) {
          if (!nodes.has(q)) return;
          for (int k = 0; k < components; ++k) std::memset(nodes.column(q, k) + begin, 0, bytes);
        };
        for (Nodal q : {Nodal::mass, Nodal::occupied}) clear(q, 1);
        for (Nodal q : {Nodal::momentum, Nodal::force, Nodal::mass_offset}) clear(q, Dim);
        clear(Nodal::mass_slope, Dim * Dim);
        if (!plan_.cracks_alone) clear_geometry<Dim>(nodes, begin, end - begin);
        if (plan_.paired)
          for (int d = 0; d < Dim; ++d) std::memset(nodes.column(Nodal::star, Dim + d) + begin, 0, bytes);
      });
      if (plan_.cracks_alone) clear_geometry_near_cracks(state_);
      const bool all_inside = passes_->project(state_, plan_.force_with_mass);
      if (all_inside && plan_.geometry)
        passes_->project_geometry(state_, plan_.cracks_alone, plan_.cracks_alone || !plan_.bridges);
      if (all_inside && extension_.active()) passes_->occupy(state_);
      return all_inside;
    });
    if (inside) return;
    sort_due_ = true;
    sort_if_due();
  }
  fail("a support reaches further than the grid can follow in one step");
}

// Here: the members that this file defines.
template void Step<2>::sort_if_due();
template void Step<3>::sort_if_due();
template void Step<2>::sort();
template void Step<3>::sort();
template void Step<2>::look_at_cracks(bool);
template void Step<3>::look_at_cracks(bool);
template void Step<2>::number_slots();
template void Step<3>::number_slots();
template void Step<2>::project();
template void Step<3>::project();

}  // namespace mpmfast
