#include "engine/contact/penalty/penalty.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "engine/contact/penalty/forces.hpp"
#include "engine/contact/penalty/ledger.hpp"

namespace mpmfast {

namespace {

std::size_t most_threads() { return static_cast<std::size_t>(omp_get_max_threads()); }

}  // namespace

template <int Dim>
Penalty<Dim>::Penalty(const Scene& scene, const Plan& plan, const State<Dim>& seeded)
    : active_(plan.penalty),
      surfaces_(&seeded.surfaces),
      pairs_(active_ ? penalty::make_body_pairs(scene, plan, seeded) : penalty::BodyPairs{}),
      detection_(seeded.surfaces, scene.grid.cell, most_threads()),
      contacts_(most_threads()),
      history_(penalty::kFacetPoints<Dim> * seeded.surfaces.facets.size()),
      forces_(seeded.surfaces.points(), Vec<Dim>::Zero()) {
  positions_.current = positions_.previous = forces_;
}

template <int Dim>
std::optional<Fold> Penalty<Dim>::find_contacts(const State<Dim>& state) {
  penalty::gather_positions(state, positions_.current);
  const auto folded = detection_.find(state, current(), pairs_, contacts_);
  if (!folded) return std::nullopt;
  const auto& body = surfaces_->body_of(*folded);
  return Fold{penalty::item(surfaces_->point_body, *folded),
              body.first_id + static_cast<std::uint32_t>(*folded - body.first)};
}

template <int Dim>
void Penalty<Dim>::compute_forces(const State<Dim>& state, const std::vector<Vec<Dim>>& pivots, double dt) {
  if (!positions_.known) positions_.previous = positions_.current;
  const double elapsed = positions_.known ? state.time - positions_.time_previous : 0;
  penalty::compute_contact_forces<Dim>({current(), previous(), elapsed, state.step}, pairs_, state.threads,
                                       contacts_, history_);
  penalty::assemble_point_forces(*surfaces_, contacts_, forces_);
  record(pivots, dt);
  positions_.previous = positions_.current;
  positions_.time_previous = state.time;
  positions_.known = true;
}

template <int Dim>
void Penalty<Dim>::record(const std::vector<Vec<Dim>>& pivots, double dt) {
  ledger_.reset(pivots.size(), pairs_.laws.size() - 1);
  penalty::record_contacts(*surfaces_, pairs_, contacts_, dt, ledger_);
  penalty::record_rigid_bodies(current(), previous(), pairs_, forces_, pivots, dt, ledger_);
  sums_.tangential_energy = penalty::tangential_energy(contacts_);
  sums_.points = 0;
  for (const auto& of_thread : contacts_) sums_.points += of_thread.points;
  sums_.points_peak = std::max<std::uint64_t>(sums_.points_peak, sums_.points);
}

template <int Dim>
double Penalty<Dim>::stored_energy(const State<Dim>& state) {
  if (!active_) return 0;
  find_contacts(state);
  return penalty::add_normal_energy(sums_.tangential_energy, contacts_);
}

template <int Dim>
double Penalty<Dim>::courant_limit() const {
  return active_ ? penalty::kCourantNumber / std::sqrt(1 + pairs_.springs.stiffness) : kInfinity;
}

template <int Dim>
std::size_t Penalty<Dim>::bytes() const {
  std::size_t sum =
      bytes_of(positions_.current, positions_.previous, forces_) + detection_.bytes() + history_.bytes();
  for (const auto& of_thread : contacts_) sum += bytes_of(of_thread.contacts, of_thread.forces);
  return sum;
}

/// The names in a checkpoint stay, so that older checkpoints can be read.
template <int Dim>
void Penalty<Dim>::visit(Archive& archive) {
  if (!active_) return;
  archive.number("penalty/time", positions_.time_previous);
  archive.flag("penalty/known", positions_.known);
  archive.number("penalty/stretch_energy", sums_.tangential_energy);
  archive.number("penalty/pressed_peak", sums_.points_peak);
  archive.column("penalty/positions", positions_.previous.data()->data(), Dim * positions_.previous.size());
  history_.visit(archive);
}

template class Penalty<2>;
template class Penalty<3>;

}  // namespace mpmfast
