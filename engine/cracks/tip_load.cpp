#include "engine/cracks/tip_load.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "engine/constants.hpp"
#include "engine/cracks/tip_contact.hpp"
#include "engine/cracks/tip_line.hpp"
#include "kernels/fracture/tip_integrals.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {

using namespace crack_constants;

namespace {

/// E′ of the body of a field, Pa.
template <int Dim>
double modulus_of(const State<Dim>& state, int field) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if (state.body_field[b] == field && !state.bodies[b].rigid)
      return std::visit(
          [&](const auto& law) { return plane_modulus(law, state.plane_kind == PlaneKind::plane_stress); },
          state.materials[static_cast<std::size_t>(state.bodies[b].material)]);
  return 0;
}

/// Radius of the domain of J, which must not contain the other end, m.
template <int Dim>
double radius_of(const CrackLine<Dim>& line, double wanted, double cell) {
  const double apart = (line.points.front() - line.points.back()).norm();
  return std::max(kLeastRadius * cell, std::min(wanted, kOtherEnd * apart));
}

/// The tip of a crack: its line from there on, and the direction in which it propagates.
struct Tip {
  TipLine line;
  Vec<2> direction;          ///< unit, out of the crack
  double bonded_length = 0;  ///< from the tip to the end of the line, m
};

/// The leading softening bond is the tip of a crack that grew. Without one the crack has grown no damage
/// yet, and its tip is the end before growth.
/// @param to_end  the line behind the end
template <int Dim>
Tip find_tip(const State<Dim>& state, const ContactList<Dim>& contacts, const CrackEnd& end, int crack,
             const TipLine& to_end, const Vec<2>& end_direction, double distance) {
  Tip tip{to_end, end_direction, 0};
  if (!end.grows || !(end.grown > 0)) return tip;
  const auto softening = length_to_softening(state, contacts, crack, to_end, distance);
  tip.bonded_length = std::min(softening.value_or(HUGE_VAL), end.grown);
  shorten(tip.line, tip.bonded_length);
  if (!(tip.bonded_length > 0)) return tip;
  TipLine ahead = to_end;
  shorten(ahead, std::max(0.0, tip.bonded_length - kDirection * state.grid.cell));
  if (ahead.front() != tip.line.front()) tip.direction = (ahead.front() - tip.line.front()).normalized();
  return tip;
}

/// Adds J and the stress intensities to a load.
/// @param within     radius of the domain of J, m
/// @param straight   length of the crack behind the tip without a turn, m
/// @param samples,tractions,line  in the axes of the tip
void integrate(const TipSamples& samples, const std::vector<TipTraction>& tractions, TipLine line,
               double within, double straight, double cell, TipLoad& load) {
  const TipPath path(std::move(line), within, kSmoothing * cell);
  TipIntegrals integrals(path, within, load.modulus, std::max(straight, kOutline * cell), cell);
  for (const TipSample& one : samples) integrals.add(one);
  for (const TipTraction& one : tractions) integrals.add(one);
  load.energy_release_rate = integrals.energy_release_rate();
  load.mode_ii = integrals.stress_intensities()[0];
  load.mode_i = integrals.stress_intensities()[1];
}

}  // namespace

template <int Dim>
TipLoad tip_load(State<Dim>& state, const ContactList<Dim>& contacts, const CrackLine<Dim>& line,
                 const TipLoadInput& input, TipSamples& samples) {
  const double cell = state.grid.cell, radius = radius_of(line, input.radius, cell);
  const CrackEnd& end = line.ends[input.end];
  const double searched = std::max(kSearchRadii * radius, kSearchCells * cell);
  const TipLine to_end = line_behind(line, input.end, 2 * searched);
  TipLoad load;
  load.direction = end_direction(to_end, cell, end.straight);
  Tip tip = find_tip(state, contacts, end, input.crack, to_end, load.direction, searched);
  load.bonded_length = tip.bonded_length;
  load.position = tip.line.front();

  const double to_outline = tip.bonded_length + kOutline * cell;  // the body must extend that far
  const double sampled = std::max(radius, to_outline + cell);
  list_samples(state, line.field, {load.position, sampled}, input.thickness, input.dt, input.gravity,
               samples);
  if (samples.empty()) {
    load.at_outline = true;
    return load;
  }
  subtract_mean_velocity(samples);
  load.modulus = modulus_of(state, line.field);
  load.traction = traction_behind(samples, to_end.front(), load.direction, end.straight, cell);

  Mat<2> axes;
  axes << tip.direction[0], tip.direction[1], -tip.direction[1], tip.direction[0];
  for (Vec<2>& x : tip.line) x = axes * (x - load.position);
  turn_to_axes(load.position, axes, samples);
  const double filled = filled_length(samples, sampled, cell);
  load.at_outline = filled < to_outline;
  if (filled == 0) return load;
  const auto tractions = side_tractions(state, contacts, input.crack, !input.bonded, input.thickness,
                                        input.dt, load.position, axes);
  integrate(samples, tractions, std::move(tip.line), std::min(radius, filled),
            end.straight - tip.bonded_length, cell, load);
  return load;
}

template TipLoad tip_load(State<2>&, const ContactList<2>&, const CrackLine<2>&, const TipLoadInput&,
                          TipSamples&);

}  // namespace mpmfast
