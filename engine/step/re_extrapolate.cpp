/// The velocities that particles give back to the grid, for strains that come last, and what moves particles
/// then.

#include <algorithm>

#include "engine/constants.hpp"
#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// v′ = S⁺V_new, with contact and conditions: what the strain that comes last is taken from.
template <int Dim>
void Step<Dim>::re_extrapolate() {
  if (!plan_.re_extrapolate) return;
  auto& nodes = state_.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const auto timed = clock_.enter(Task::re_extrapolate);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    if (nodes.has(Nodal::compression_weight))
      std::fill_n(nodes.column(Nodal::compression_weight) + begin, end - begin, 0.0);
    for (int d = 0; d < Dim; ++d) {
      double* momentum = nodes.column(Nodal::momentum, d);
      for (std::int64_t tile = begin; tile < end; tile += kTileNodes<Dim>)
        if (!is_rigid_slot(tile)) std::fill_n(momentum + tile, kTileNodes<Dim>, 0.0);
      if (update_rule() != ParticleUpdate::xpic) continue;
      double* star = nodes.column(Nodal::star, d);
      const double *series = nodes.column(Nodal::series, d), *jump = nodes.column(Nodal::force, d);
      for (std::int64_t i = begin; i < end; ++i) star[i] = series[i] + jump[i];
    }
  });
  passes_->re_extrapolate(state_, update_rule());
  restrict_columns({Nodal::momentum});
  if (nodes.has(Nodal::compression_weight)) restrict_columns({Nodal::compression_weight});
  correct_contact_re_extrapolated();
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d)
      divide_by_mass(mass, nodes.column(Nodal::momentum, d), 1, begin, end,
                     nodes.column(Nodal::re_extrapolated, d));
  });
  impose_on_re_extrapolated();
  prolong({Nodal::re_extrapolated});
}

template <int Dim>
void Step<Dim>::impose_on_re_extrapolated() {
  if (scene_->boundaries.empty()) return;
  const auto timed = clock_.enter(Task::impose);
  conditions_.impose_velocity(state_, Nodal::re_extrapolated);
}

/// The particles of FLIP, XPIC and FMPM move with v′, which strains them too, and as far as they are pressed
/// with v⁺. By v⁺ they leave F by (a − S⁺S a) Δt² a step. Under tension that tears a body, by what comes
/// between its particles so; under pressure it is what ends the noise that they make, and that grows with v′
/// (theory.md, "What moves the particles"). Nodes where surfaces meet keep v⁺, since v′ of a pair that forces
/// part has the approach that its particles keep. So do held nodes in scenes with a wall `at: plane`, whose
/// lines give v′ a noise of its own.
template <int Dim>
void Step<Dim>::find_moving_velocities() {
  if (!plan_.moves_as_strained()) return;
  const auto timed = clock_.enter(Task::moving_velocities);
  auto& nodes = state_.nodes;
  kept_slots_.clear();
  if (plan_.contact) {
    contact_.list_separable_slots(state_.threads, kept_slots_);
    contact_.average_compression(state_);
  }
  const auto meeting = static_cast<std::int64_t>(kept_slots_.size());
  conditions_.share_compression_weight(state_);
  conditions_.list_held_slots(kept_slots_);
  const auto kept = static_cast<std::int64_t>(kept_slots_.size());
  kept_velocities_.resize(kept_slots_.size());
  for_each_of(kept, state_.threads, constants::threads::kFewCopies, [&](std::int64_t k) {
    const auto at = static_cast<std::size_t>(k);
    if (kept_slots_[at] >= 0) kept_velocities_[at] = nodes.vector(Nodal::velocity, kept_slots_[at]);
  });
  const double *mass = nodes.column(Nodal::mass),
               *compression_weight = nodes.column(Nodal::compression_weight);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      const double* strained = nodes.column(Nodal::re_extrapolated, d);
      double* moves = nodes.column(Nodal::velocity, d);
      for (std::int64_t i = begin; i < end; i += kLanes) {
        const Lanes m = load_lanes(mass + i), v = load_lanes(strained + i);
        const Lanes share = m > 0.0 ? load_lanes(compression_weight + i) / m : 0.0;
        store_lanes(moves + i, v + share * (load_lanes(moves + i) - v));
      }
    }
  });
  const auto restore = [&](std::int64_t k) {
    const auto at = static_cast<std::size_t>(k);
    if (kept_slots_[at] >= 0) nodes.set(Nodal::velocity, kept_slots_[at], kept_velocities_[at]);
  };
  for_each_of(meeting, state_.threads, constants::threads::kFewCopies, restore);
  for (std::int64_t k = meeting; k < kept; ++k) restore(k);  // some for the second time
  prolong({Nodal::velocity});
}

// Here: the members that this file defines.
template void Step<2>::re_extrapolate();
template void Step<3>::re_extrapolate();
template void Step<2>::impose_on_re_extrapolated();
template void Step<3>::impose_on_re_extrapolated();
template void Step<2>::find_moving_velocities();
template void Step<3>::find_moving_velocities();

}  // namespace mpmfast
