/// The series of XPIC(m) and FMPM(m) (N20 Eq. 42 to 44).

#include <algorithm>

#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// series = m (v − v*), v* = Σ_{k=2..m} (−1)^k (v*_k + (m−1)/m Δv*_{k−1}), with v*_k = (m+1−k)/k S⁺S v*_{k−1}
/// and Δv*_k = (m−k)/k S⁺S Δv*_{k−1} (N20 Eq. 42 to 44); S⁺ is the extrapolation within a field, divided by
/// its mass. FMPM(m) (Nairn and Hammerquist 2021) takes the first m terms of M⁻¹p⁺ = Σ_k (I − S⁺S)^k v⁺, M
/// the full mass matrix, for the particles' velocity: this is m (v⁺ − v⁺*) with the same recursion. The
/// update adds a Δt to the series, hence it is taken off here.
template <int Dim>
void Step<Dim>::filter_velocities() {
  if (plan_.order < 2 || !filters()) return;
  const auto timed = clock_.enter(Task::filter);
  auto& nodes = state_.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const int m = plan_.order;
  // Without a contact node, Δv is zero everywhere.
  const bool paired = plan_.paired && !contact_.list().nodes.empty();
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      double *star = nodes.column(Nodal::star, d), *series = nodes.column(Nodal::series, d);
      const double *v = nodes.column(Nodal::velocity, d), *jump = nodes.column(Nodal::force, d);
      if (plan_.full_mass) std::copy(v + begin, v + end, star + begin);
      for (std::int64_t i = begin; i < end; ++i) series[i] = m * star[i] - (plan_.full_mass ? jump[i] : 0);
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

template void Step<2>::filter_velocities();
template void Step<3>::filter_velocities();

}  // namespace mpmfast
