#include "engine/cracks/cracks.hpp"

#include <omp.h>

#include <cstddef>

#include "engine/cracks/growth.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

using crack_constants::kTilesPerShare;

template <int Dim>
Cracks<Dim>::Cracks(const Scene& scene, const Plan& plan)
    : scene_(&scene),
      fields_(plan.first_side),
      lines_(make_crack_lines<Dim>(scene, plan)),
      search_(static_cast<std::size_t>(omp_get_max_threads())) {}

template <int Dim>
void Cracks<Dim>::find_all_crossings(const State<Dim>& state, const Supports<Dim>& supports) {
  const auto& tiles = state.tiling.tiles;
  crossings_.resize(tiles.size());
  share_out(static_cast<std::int64_t>(tiles.size()), state.threads, kTilesPerShare, [&](std::int64_t t) {
    auto& out = element(crossings_, t);
    out.clear();
    if (fields_.cracked(element(tiles, t).field))
      find_crossings(state, supports, element(tiles, t), segments_, element(search_, thread_index()), out);
  });
}

template <int Dim>
SideChange Cracks<Dim>::classify(const State<Dim>& state, const Supports<Dim>& supports) {
  const auto& tiling = state.tiling;
  age_.since_last = 0;
  segments_.build(lines_);
  find_all_crossings(state, supports);
  counters_.third += nodes_.build(tiling.tiles, crossings_);
  sides_.resize(crossings_.size());
  std::vector<SideChange> changes(crossings_.size(), SideChange::none);
  share_out(static_cast<std::int64_t>(crossings_.size()), state.threads, kTilesPerShare, [&](std::int64_t t) {
    auto& out = element(sides_, t);
    out.clear();
    const ParticleTile<Dim>& tile = element(tiling.tiles, t);
    if (fields_.cracked(tile.field))
      element(changes, t) =
          classify_tile(state, supports, nodes_, tile, tiling.sides_of(static_cast<std::size_t>(t)),
                        element(crossings_, t), out);
  });
  return changes.empty() ? SideChange::none : *std::max_element(changes.begin(), changes.end());
}

template <int Dim>
void Cracks<Dim>::group(State<Dim>& state) {
  ++counters_.groupings;
  group_by_sides(state, nodes_, sides_);
}

template <int Dim>
void Cracks<Dim>::mark_tiles(State<Dim>& state, const Supports<Dim>& supports) const {
  auto& tiles = state.tiling.tiles;
  share_out(static_cast<std::int64_t>(tiles.size()), state.threads, kTilesPerShare, [&](std::int64_t t) {
    ParticleTile<Dim>& tile = element(tiles, t);
    tile.cracked = fields_.cracked(tile.field) && reaches_crack(state, supports, nodes_, tile);
  });
}

template <int Dim>
CrackContact<Dim> Cracks<Dim>::parting(const State<Dim>& state, const NodeIndex<Dim>& node, int a, int b,
                                       bool alone) const {
  const int side_a = fields_.side(state.field_base, a), side_b = fields_.side(state.field_base, b);
  const int k = crack_between(side_a, side_b, alone);
  if (k < 0) return {};
  return contact_at(nodes_.find(element(state.field_base, a), node), k, side_a, side_b);
}

template <int Dim>
void Cracks<Dim>::move(const State<Dim>& state, double dt) {
  for (std::size_t c = 0; c < lines_.size(); ++c) {
    for (CrackEnd& end : lines_[c].ends) end.fresh = false;
    move_line(state, nodes_, fields_, static_cast<int>(c), dt, lines_[c], motion_);
  }
}

template <int Dim>
bool Cracks<Dim>::growth_due(double time) const {
  for (const CrackLine<Dim>& line : lines_)
    for (const CrackEnd& end : line.ends)
      if (end.grows && time >= end.due) return true;
  return false;
}

template <int Dim>
void Cracks<Dim>::grow(const State<Dim>& state, const std::function<TipLoad(int, bool)>& load_of) {
  for (int c = 0; c < static_cast<int>(lines_.size()); ++c)
    for (const bool end : {false, true}) {
      const CrackEnd& tip = element(lines_, c).ends[end];
      if (!tip.grows || state.time < tip.due) continue;
      if (grow_end(*scene_, state, c, end, load_of(c, end), lines_)) age_.since_last = HUGE_VAL;
    }
}

template <int Dim>
bool Cracks<Dim>::is_fresh(const State<Dim>& state, int crack, const NodeIndex<Dim>& node) const {
  return has_new_sides(element(lines_, crack), state.grid, node);
}

template <int Dim>
void Cracks<Dim>::visit(Archive& archive) {
  visit_crack_lines(archive, lines_);
  archive.number("cracks/drifted", age_.since_last);
  archive.number("cracks/moved", age_.since_start);
  require_checkpoint(archive, age_.since_last >= 0 && std::isfinite(age_.since_start), "cracks/drifted");
  nodes_.visit(archive, static_cast<int>(lines_.size()));
}

template class Cracks<2>;
template class Cracks<3>;

}  // namespace mpmfast
