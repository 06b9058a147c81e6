/// Where particles are, and what they bring to the nodes.

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/constants.hpp"
#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// A particle may drift by one cell before it leaves its window, or the cell table that contact clouds are
/// gathered from is out of date, of which a quarter is kept for the growth of CPDI domains. The fastest
/// particles mostly vibrate and hardly leave their place: as long as all are near the cell they were sorted
/// to, they may go as far again.
template <int Dim>
void Step<Dim>::sort_if_due() {
  using namespace constants::step;
  const bool found_by_fit =
      plan_.contact || cracks_.active() || penalty_.active() || facts(plan_.basis).convected;
  const double cell = state_.grid.cell, near = (found_by_fit ? kNearHomeOfClouds : kNearHome) * cell,
               further = (found_by_fit ? kCheckTravelOfClouds : kCheckTravel) * cell;
  bool due = sort_due_;
  if (!due && travelled_ >= further) {
    const auto timed = clock_.enter(Task::sort);
    due = !passes_->near_home(state_, cell - near);
    if (!due) travelled_ = 0;
  }
  if (due) sort();
  if (cracks_.active() && (due || cracks_.classification_due(state_.grid.cell))) find_crack_sides(due);
}

template <int Dim>
void Step<Dim>::sort() {
  const auto timed = clock_.enter(Task::sort);
  passes_->sort(state_);
  number_slots();
  sort_due_ = false;
  travelled_ = 0;
}

/// Groups the particles anew where they see other sides than before.
template <int Dim>
void Step<Dim>::find_crack_sides(bool sorted) {
  const auto timed = clock_.enter(Task::find_crack_sides);
  const Supports<Dim> supports = passes_->supports(state_);
  SideChange change = cracks_.classify(state_, supports);
  if (change == SideChange::sort_first && !sorted) {
    sort();
    sorted = true;
    change = cracks_.classify(state_, supports);
  }
  if (change != SideChange::none) {
    cracks_.group(state_);
    number_slots();
  }
  cracks_.mark_tiles(state_, supports);
}

/// What follows from slots that have been numbered anew.
template <int Dim>
void Step<Dim>::number_slots() {
  state_.nodes.resize(static_cast<std::size_t>(state_.tiling.slots()));
  conditions_.invalidate_nodes();
  extension_.invalidate_nodes();
  penalty_.invalidate_tiles();
  heat_.invalidate_nodes();
  contact_.renumber_fits(state_.tiling);
  nodes_peak_ = std::max<std::uint64_t>(nodes_peak_, static_cast<std::uint64_t>(state_.tiling.slots()));
}

namespace {

constexpr std::array kGeometry{Nodal::volume, Nodal::volume_gradient, Nodal::mass_position,
                               Nodal::mass_displacement};
constexpr std::array kDisplacements{Nodal::mass_offset, Nodal::mass_slope};

template <int Dim, class Quantities>
void clear(Nodes<Dim>& nodes, const Quantities& quantities, std::int64_t begin, std::int64_t count) {
  for (const Nodal q : quantities)
    for (int k = 0; k < nodes.width(q); ++k)
      std::memset(nodes.column(q, k) + begin, 0, static_cast<std::size_t>(count) * sizeof(double));
}

/// What is only added near cracks, and only read there.
template <int Dim>
void clear_near_cracks(State<Dim>& state, bool geometry) {
  const auto& tiling = state.tiling;
  for (std::size_t k = 0; k < tiling.node_tiles.size(); ++k) {
    const auto& over = tiling.node_tiles[k].particle_tile;
    const auto is_cracked = [&](int t) {  // it, or another group at its place
      if (t < 0) return false;
      const auto tile = tiling.tiles.begin() + t;
      return std::any_of(tile, tile + 1 + tile->others, [](const auto& group) { return group.cracked; });
    };
    if (std::none_of(over, over + kCorners<Dim>, is_cracked)) continue;
    const auto begin = static_cast<std::int64_t>(k) * kTileNodes<Dim>;
    if (geometry) clear(state.nodes, kGeometry, begin, kTileNodes<Dim>);
    clear(state.nodes, kDisplacements, begin, kTileNodes<Dim>);
  }
}

}  // namespace

/// Clears the nodes and gives them masses and momenta. @return whether all supports lie in the grid
template <int Dim>
bool Step<Dim>::project_masses(bool cracked) {
  const auto timed = clock_.enter(Task::project);
  auto& nodes = state_.nodes;
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    const std::int64_t count = end - begin;
    clear(nodes, std::array{Nodal::mass, Nodal::momentum, Nodal::force, Nodal::occupied}, begin, count);
    if (!plan_.cracks_alone) clear(nodes, kGeometry, begin, count);
    if (!cracked) clear(nodes, kDisplacements, begin, count);
    if (plan_.paired)
      for (int d = 0; d < Dim; ++d)
        std::memset(nodes.column(Nodal::star, Dim + d) + begin, 0,
                    static_cast<std::size_t>(count) * sizeof(double));
  });
  if (cracked) clear_near_cracks(state_, plan_.cracks_alone);
  return passes_->project(state_, plan_.force_with_mass);
}

template <int Dim>
void Step<Dim>::project() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    const bool cracked =
        plan_.cracks_alone || (cracks_.active() && !plan_.interface_springs);  // those displaced
    const bool inside = project_masses(cracked);
    if (inside && plan_.geometry) {
      const auto timed = clock_.enter(Task::project_geometry);
      passes_->project_geometry(state_, plan_.cracks_alone, cracked);
    }
    if (inside && extension_.active()) {
      const auto timed = clock_.enter(Task::project);
      passes_->occupy(state_);
    }
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
template void Step<2>::find_crack_sides(bool);
template void Step<3>::find_crack_sides(bool);
template void Step<2>::number_slots();
template void Step<3>::number_slots();
template bool Step<2>::project_masses(bool);
template bool Step<3>::project_masses(bool);
template void Step<2>::project();
template void Step<3>::project();

}  // namespace mpmfast
