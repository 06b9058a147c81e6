/// Cracks that grow at their ends. A piece that is put is bonded (SurfaceLaw of the crack): what its sides
/// take to part is the toughness, which else would be left to waves that nothing stops.

#include <algorithm>
#include <cmath>

#include "engine/contact/cracks/cracks.hpp"
#include "engine/contact/cracks/tip_load.hpp"
#include "kernels/fracture/kink.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {

namespace {

/// Cells that a crack goes straight on before it may turn again: from less nobody can tell what it carries.
constexpr double kStraight = 3;
/// So many cells a growing crack leads the bonds that soften: these say when it goes on.
constexpr double kLead = 4;
constexpr double kCarries = 0.1;  // of the strength
constexpr double kMeets = 1;      // cells: nearer than that an end goes into another crack
constexpr double kBeyond = 2;     // cells: so far goes a crack that has come to the outline

}  // namespace

template <int Dim>
bool Cracks<Dim>::growth_due(double time) const {
  for (const CrackLine<Dim>& line : lines_)
    for (const CrackEnd& end : line.ends)
      if (end.grows && time >= end.due) return true;
  return false;
}

template <int Dim>
void Cracks<Dim>::grow(const State<Dim>& state, const std::function<TipLoad(int, bool)>& load_of) {
  for (std::size_t c = 0; c < lines_.size(); ++c)
    for (const bool end : {false, true}) {
      const CrackEnd& one = lines_[c].ends[end];
      if (one.grows && state.time >= one.due)
        grow(state, static_cast<int>(c), end, load_of(static_cast<int>(c), end));
    }
}

/// By one piece at most, and then not before a wave along its sides has come so far: no crack is faster.
template <int Dim>
void Cracks<Dim>::grow(const State<Dim>& state, int crack, bool end, const TipLoad& load) {
  const CrackSpec& spec = scene_->cracks[static_cast<std::size_t>(crack)];
  CrackLine<Dim>& line = lines_[static_cast<std::size_t>(crack)];
  CrackEnd& tip = line.ends[end];
  const BodySpec& body = scene_->bodies[static_cast<std::size_t>(spec.body)];
  const double cell = state.grid.cell, piece = spec.growth.advance * cell;
  const double speed =
      std::visit([&](const auto& law) { return rayleigh_speed(law, state.depth == Depth::relaxed); },
                 scene_->materials[static_cast<std::size_t>(body.material)].model);
  const auto put = [&](double length, double angle) {
    Vec<Dim> next = end ? line.points.back() : line.points.front();
    const double c = std::cos(angle), s = std::sin(angle);
    next[0] += length * (c * load.ahead[0] - s * load.ahead[1]);
    next[1] += length * (s * load.ahead[0] + c * load.ahead[1]);
    for (auto* points : {&line.points, &line.sides[0], &line.sides[1]})
      points->insert(end ? points->end() : points->begin(), next);
    drifted_ = HUGE_VAL;  // look anew
  };
  tip.due = state.time + piece / speed;
  if (load.through) {
    put(kBeyond * cell, 0);
    tip.grows = false;
    return;
  }
  const bool grown = tip.grown > 0, by_hoop = spec.growth.rule == GrowthRule::hoop_stress;
  // Ahead of a crack K_II : K_I = σ_tn : σ_nn, which tells it also where bonds hold the sides together.
  const double one = std::max(grown ? load.across[1] : load.opening, 0.0),
               two = grown ? load.across[0] : load.sliding;
  // What hardly carries anything does not tell where to.
  const double strength = std::get<Cohesive>(spec.law.acts).normal_strength;
  const bool may_turn =
      by_hoop && tip.straight >= kStraight * cell * (1 - 1e-6) && (!grown || one > kCarries * strength);
  const double angle = may_turn ? kink_angle(one, two) : 0;
  const double intensity = by_hoop ? hoop_intensity(one, two, angle) : 0;
  const double drives = by_hoop ? intensity * std::abs(intensity) / load.modulus : load.release;
  if (grown ? load.lead > kLead * cell : !(drives >= spec.growth.toughness)) return;
  constexpr double kTurn = 0.01;  // rad
  put(piece, angle);
  // Into another crack, or into itself, it goes and rests.
  Vec<Dim>& now = end ? line.points.back() : line.points.front();
  if (const auto other = meets(crack, end, now, kMeets * cell)) {
    now = *other;
    for (auto& side : line.sides) (end ? side.back() : side.front()) = now;
    tip.grows = false;
  }
  tip.straight = std::abs(angle) > kTurn ? piece : tip.straight + piece;
  tip.grown += piece;
  tip.fresh = true;
}

template <int Dim>
std::optional<Vec<Dim>> Cracks<Dim>::meets(int crack, bool end, const Vec<Dim>& x, double nearer) const {
  std::optional<Vec<Dim>> nearest;
  double least = nearer;
  for (std::size_t c = 0; c < lines_.size(); ++c) {
    const auto& points = lines_[c].points;
    const bool own = static_cast<int>(c) == crack;
    if (lines_[c].field != lines_[static_cast<std::size_t>(crack)].field) continue;
    double back = 0;  // from the end
    for (std::size_t m = 1; m < points.size(); ++m) {
      const std::size_t k = end ? points.size() - m : m;
      const Vec<Dim> way = points[k] - points[k - 1];
      back += way.norm();
      if (own && back < 4 * nearer) continue;
      const double share = std::clamp((x - points[k - 1]).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const Vec<Dim> at = points[k - 1] + share * way;
      if (!((x - at).norm() < least)) continue;
      least = (x - at).norm();
      nearest = at;
    }
  }
  return nearest;
}

/// Was the material around a place whole when the last step ended, and is now beside a piece that was put?
template <int Dim>
bool Cracks<Dim>::is_fresh(const State<Dim>& state, int crack, const NodeIndex<Dim>& node) const {
  constexpr double kNear = 3;  // cells
  const CrackLine<Dim>& line = lines_[static_cast<std::size_t>(crack)];
  const auto& points = line.points;
  for (const bool end : {false, true}) {
    if (!line.ends[end].fresh) continue;
    const Vec<Dim>&tip = end ? points.back() : points.front(),
          &before = end ? points[points.size() - 2] : points[1];
    Vec<Dim> from;
    for (int d = 0; d < Dim; ++d) from[d] = state.grid.origin[d] + node[d] * state.grid.cell - before[d];
    if (from.dot(tip - before) > 0 && from.norm() < kNear * state.grid.cell) return true;
  }
  return false;
}

// Here: the members that this file defines.
template bool Cracks<2>::growth_due(double) const;
template bool Cracks<3>::growth_due(double) const;
template void Cracks<2>::grow(const State<2>&, const std::function<TipLoad(int, bool)>&);
template void Cracks<3>::grow(const State<3>&, const std::function<TipLoad(int, bool)>&);
template bool Cracks<2>::is_fresh(const State<2>&, int, const NodeIndex<2>&) const;
template bool Cracks<3>::is_fresh(const State<3>&, int, const NodeIndex<3>&) const;
template std::optional<Vec<2>> Cracks<2>::meets(int, bool, const Vec<2>&, double) const;
template std::optional<Vec<3>> Cracks<3>::meets(int, bool, const Vec<3>&, double) const;
template void Cracks<2>::grow(const State<2>&, int, bool, const TipLoad&);
template void Cracks<3>::grow(const State<3>&, int, bool, const TipLoad&);

}  // namespace mpmfast
