#include "engine/cracks/growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "engine/constants.hpp"
#include "engine/cracks/element.hpp"
#include "kernels/fracture/kink.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {

using namespace crack_constants;

namespace {

/// Extends a line at an end by a piece at an angle to the direction of the end.
template <int Dim>
void add_piece(CrackLine<Dim>& line, bool end, const Vec<2>& direction, double length, double angle) {
  Vec<Dim> next = line.point_from(end, 0);
  const double c = std::cos(angle), s = std::sin(angle);
  next[0] += length * (c * direction[0] - s * direction[1]);
  next[1] += length * (s * direction[0] + c * direction[1]);
  line.extend(end, next);
}

/// Rayleigh wave speed of the body of a crack, m/s.
double surface_wave_speed(const Scene& scene, const CrackSpec& crack, PlaneKind plane_kind) {
  const int material = element(scene.bodies, crack.body).material;
  return std::visit(
      [&](const auto& law) { return rayleigh_speed(law, plane_kind == PlaneKind::plane_stress); },
      element(scene.materials, material).model);
}

}  // namespace

GrowthStep decide_growth(const GrowthSpec& spec, const CrackEnd& end, const TipLoad& load, double strength,
                         double cell) {
  const bool grown = end.grown > 0, by_hoop_stress = spec.rule == GrowthRule::hoop_stress;
  // Ahead of a tip K_II : K_I = σ_tn : σ_nn. The tractions give this ratio also where bonds hold the sides.
  const double one = std::max(grown ? load.traction[1] : load.mode_i, 0.0),
               two = grown ? load.traction[0] : load.mode_ii;
  const bool may_turn = by_hoop_stress && end.straight >= kStraight * cell * (1 - kLengthRoundOff) &&
                        (!grown || one > kLeastTraction * strength);
  const double angle = may_turn ? kink_angle(one, two) : 0;
  if (grown) return {load.bonded_length <= kBondedLength * cell, angle};
  const double intensity = by_hoop_stress ? hoop_intensity(one, two, angle) : 0;
  const double rate =
      by_hoop_stress ? intensity * std::abs(intensity) / load.modulus : load.energy_release_rate;
  return {rate >= spec.toughness, angle};
}

template <int Dim>
std::optional<Vec<Dim>> nearest_on_lines(const std::vector<CrackLine<Dim>>& lines, int crack, bool end,
                                         const Vec<Dim>& x, double distance) {
  std::optional<Vec<Dim>> nearest;
  double least = distance;
  for (std::size_t c = 0; c < lines.size(); ++c) {
    const auto& points = lines[c].points;
    const bool own = static_cast<int>(c) == crack;
    if (lines[c].field != element(lines, crack).field) continue;
    double behind = 0;  // length from the end
    for (std::size_t m = 1; m < points.size(); ++m) {
      const std::size_t k = end ? points.size() - m : m;
      const Vec<Dim> along = points[k] - points[k - 1];
      behind += along.norm();
      if (own && behind < kOwnLine * distance) continue;
      const double share = std::clamp((x - points[k - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Vec<Dim> point = points[k - 1] + share * along;
      if (!((x - point).norm() < least)) continue;
      least = (x - point).norm();
      nearest = point;
    }
  }
  return nearest;
}

template <int Dim>
bool grow_end(const Scene& scene, const State<Dim>& state, int crack, bool end, const TipLoad& load,
              std::vector<CrackLine<Dim>>& lines) {
  const CrackSpec& spec = element(scene.cracks, crack);
  CrackLine<Dim>& line = element(lines, crack);
  CrackEnd& tip = line.ends[end];
  const double cell = state.grid.cell, piece = spec.growth.advance * cell;
  tip.due = state.time + piece / surface_wave_speed(scene, spec, state.plane_kind);
  if (load.at_outline) {
    add_piece(line, end, load.direction, kBeyondOutline * cell, 0);
    tip.grows = false;
    return true;
  }
  const double strength = std::get<Cohesive>(spec.law.acts).normal_strength;
  const GrowthStep step = decide_growth(spec.growth, tip, load, strength, cell);
  if (!step.grows) return false;
  add_piece(line, end, load.direction, piece, step.angle);
  if (const auto other = nearest_on_lines<Dim>(lines, crack, end, line.point_from(end, 0), kJoin * cell)) {
    line.move_end(end, *other);
    tip.grows = false;
  }
  tip.straight = std::abs(step.angle) > kTurn ? piece : tip.straight + piece;
  tip.grown += piece;
  tip.fresh = true;
  return true;
}

template <int Dim>
bool has_new_sides(const CrackLine<Dim>& line, const GridView<Dim>& grid, const NodeIndex<Dim>& node) {
  for (const bool end : {false, true}) {
    if (!line.ends[end].fresh) continue;
    const Vec<Dim>&tip = line.point_from(end, 0), &former = line.point_from(end, 1);
    Vec<Dim> from;
    for (int d = 0; d < Dim; ++d) from[d] = grid.origin[d] + node[d] * grid.cell - former[d];
    if (from.dot(tip - former) > 0 && from.norm() < kNewSides * grid.cell) return true;
  }
  return false;
}

template std::optional<Vec<2>> nearest_on_lines(const std::vector<CrackLine<2>>&, int, bool, const Vec<2>&,
                                                double);
template bool grow_end(const Scene&, const State<2>&, int, bool, const TipLoad&, std::vector<CrackLine<2>>&);
template bool has_new_sides(const CrackLine<2>&, const GridView<2>&, const NodeIndex<2>&);
template std::optional<Vec<3>> nearest_on_lines(const std::vector<CrackLine<3>>&, int, bool, const Vec<3>&,
                                                double);
template bool grow_end(const Scene&, const State<3>&, int, bool, const TipLoad&, std::vector<CrackLine<3>>&);
template bool has_new_sides(const CrackLine<3>&, const GridView<3>&, const NodeIndex<3>&);

}  // namespace mpmfast
