/// The series of XPIC(m) and FMPM(m) (N20 Eq. 42 to 44).

#include <algorithm>

#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// XPIC(m): series = m (v − v*), v* = Σ_{k=2..m} (−1)^k (v*_k + (m−1)/m Δv*_{k−1}), with v*_k = (m+1−k)/k S⁺S
/// v*_{k−1} and Δv*_k = (m−k)/k S⁺S Δv*_{k−1} (N20 Eq. 42 to 44); S⁺ is the extrapolation within a field,
/// divided by its mass.
template <int Dim>
void Step<Dim>::filter_velocities(double dt) {
  if (plan_.order < 2 || !filters()) return;
  const auto timed = clock_.enter(Task::filter);
  if (plan_.full_mass) return filter_full_mass(dt);
  auto& nodes = state_.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const int m = plan_.order;
  // Without a contact node, Δv is zero everywhere.
  const bool paired = plan_.paired && !contact_.list().nodes.empty();
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      const double* star = nodes.column(Nodal::star, d);
      double* series = nodes.column(Nodal::series, d);
      for (std::int64_t i = begin; i < end; ++i) series[i] = m * star[i];
    }
  });
  for (int k = 2; k <= m; ++k) {
    for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
      for (int d = 0; d < (paired ? 2 : 1) * Dim; ++d)
        std::fill(nodes.column(Nodal::next, d) + begin, nodes.column(Nodal::next, d) + end, 0.0);
    });
    passes_->xpic(state_, paired);
    restrict_columns({Nodal::next});
    const double sign = k % 2 == 0 ? m : -m;  // with the factor m of Eq. 41
    const double share = static_cast<double>(m - 1) / m;
    const double star_factor = static_cast<double>(m + 1 - k) / k,
                 change_factor = static_cast<double>(m - k) / k;
    for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
      for (int d = 0; d < Dim; ++d) {
        double *star = nodes.column(Nodal::star, d), *series = nodes.column(Nodal::series, d);
        const double* next = nodes.column(Nodal::next, d);
        divide_by_mass(mass, next, star_factor, begin, end, star);
        for (std::int64_t i = begin; i < end; ++i) series[i] -= sign * star[i];
        if (!paired) continue;
        double* change = nodes.column(Nodal::star, Dim + d);
        const double* change_next = nodes.column(Nodal::next, Dim + d);
        for (std::int64_t i = begin; i < end; ++i) series[i] -= sign * share * change[i];
        divide_by_mass(mass, change_next, change_factor, begin, end, change);
      }
    });
    prolong({Nodal::star});
  }
  prolong({Nodal::series});
}

/// FMPM(m) (Nairn and Hammerquist 2021), with contact and conditions in each order (Nairn 2026). Let p be the
/// nodal momenta without the normal impulses of the second correction, M the lumped and M̃ the full mass
/// matrix. From v_1 = v⁺ on,
///
///   v_{k+1} = C(v_k + M⁻¹(p − M̃ v_k)),   M̃ v = M S⁺S v,
///
/// where C corrects by contact without friction, and by conditions. Each order finds the whole normal impulse
/// of contact anew, and the particles take that of the last order alone. Friction is a force of the second
/// correction, within p. Without contact and conditions C = 1, and v_m is the sum of the first m terms of
/// M̃⁻¹p = Σ_k (I − S⁺S)^k M⁻¹p. With C each order is a step of a projected gradient descent towards the
/// velocities that minimise ½(v − M̃⁻¹p)ᵀM̃(v − M̃⁻¹p) under the conditions of contact. A tie makes C the mean
/// by mass of the two fields; two tied fields are then one field to round-off.
template <int Dim>
void Step<Dim>::filter_full_mass(double dt) {
  auto& nodes = state_.nodes;
  const double* mass = nodes.column(Nodal::mass);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      std::copy_n(nodes.column(Nodal::velocity, d) + begin, end - begin,
                  nodes.column(Nodal::star, d) + begin);
      std::copy_n(nodes.column(Nodal::momentum, d) + begin, end - begin,
                  nodes.column(Nodal::series, d) + begin);
    }
  });
  contact_.begin_orders(state_, Nodal::series);
  for (int k = 2; k <= plan_.order; ++k) {
    for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
      for (int d = 0; d < Dim; ++d) std::fill_n(nodes.column(Nodal::next, d) + begin, end - begin, 0.0);
    });
    passes_->xpic(state_, false);
    restrict_columns({Nodal::next});
    for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
      for (int d = 0; d < Dim; ++d) {
        const double *star = nodes.column(Nodal::star, d), *next = nodes.column(Nodal::next, d),
                     *momentum = nodes.column(Nodal::series, d);
        double* trial = nodes.column(Nodal::momentum, d);
        for (std::int64_t tile = begin; tile < end; tile += kTileNodes<Dim>) {
          if (is_rigid_slot(tile)) continue;
          for (std::int64_t i = tile; i < tile + kTileNodes<Dim>; ++i)
            trial[i] = momentum[i] + (mass[i] * star[i] - next[i]);
        }
      }
    });
    contact_.correct_order(state_);
    find_velocities(Nodal::star);
    conditions_.hold_order(state_, dt, k == plan_.order);
    prolong({Nodal::star});
  }
  contact_.end_orders(state_);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      const double *star = nodes.column(Nodal::star, d), *jump = nodes.column(Nodal::force, d);
      double* series = nodes.column(Nodal::series, d);
      for (std::int64_t i = begin; i < end; ++i) series[i] = star[i] - jump[i];  // the update adds a Δt
    }
  });
  prolong({Nodal::series});
}

// Here: the members that this file defines.
template void Step<2>::filter_velocities(double);
template void Step<3>::filter_velocities(double);
template void Step<2>::filter_full_mass(double);
template void Step<3>::filter_full_mass(double);

}  // namespace mpmfast
