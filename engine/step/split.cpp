/// Particles whose domains have become too long (engine/state/splitting.hpp).

#include <numeric>

#include "engine/constants.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// Looks when particles have gone an eighth of a cell since the last look: the ends of a domain move with
/// them, so its edge has grown by a quarter at most. Particles are made here alone, before they are sorted.
template <int Dim>
void Step<Dim>::split_if_due() {
  const double cell = state_.grid.cell;
  if (plan_.split_edge <= 0 ||
      (state_.step > 0 && unchecked_path_ < constants::splitting::kCheckDistance * cell))
    return;
  unchecked_path_ = 0;
  const SplitRule rule{plan_.split_edge * cell, plan_.body_splits};
  const auto timed = clock_.enter(Task::split);
  const SplitCounters found = count_long_edges(state_, rule);
  splits_.held = found.held;
  if (found.splits == 0) return;
  std::vector<std::uint32_t> changed;
  for (int k = 0; k < Dim; ++k) {
    const std::vector<std::uint32_t> parents = long_along(state_, rule, k);
    changed.insert(changed.end(), parents.begin(), parents.end());
    changed.resize(changed.size() + parents.size());
    std::iota(changed.end() - std::ssize(parents), changed.end(),
              static_cast<std::uint32_t>(halve(state_, parents, k)));
    splits_.splits += parents.size();
  }
  passes_->shape_domains(state_, changed);
  contact_.invalidate_fits();
  sort_due_ = true;
}

template void Step<2>::split_if_due();
template void Step<3>::split_if_due();

}  // namespace mpmfast
