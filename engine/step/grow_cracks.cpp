/// Loads at crack tips, and growth of cracks.

#include "engine/step/step.hpp"

namespace mpmfast {

template <int Dim>
TipLoad Step<Dim>::tip_load(int crack, bool end) {
  if constexpr (Dim == 2) {
    const CrackLine<Dim>& line = cracks_.lines()[static_cast<std::size_t>(crack)];
    const TipLoadInput input{
        crack,
        end,
        scene_->cracks[static_cast<std::size_t>(crack)].contour * scene_->grid.cell,
        scene_->thickness,
        dt_,
        std::holds_alternative<Cohesive>(scene_->cracks[static_cast<std::size_t>(crack)].law.acts),
        loads_.acceleration(line.field)};
    return mpmfast::tip_load(state_, contact_.list(), line, input, tip_samples_);
  } else {
    return {};
  }
}

template <int Dim>
void Step<Dim>::grow_cracks() {
  if (!cracks_.growth_due(state_.time)) return;
  const auto timed = clock_.enter(Task::grow_cracks);
  find_stresses();
  cracks_.grow(state_, [&](int crack, bool end) { return tip_load(crack, end); });
}

// Here: the members that this file defines.
template TipLoad Step<2>::tip_load(int, bool);
template TipLoad Step<3>::tip_load(int, bool);
template void Step<2>::grow_cracks();
template void Step<3>::grow_cracks();

}  // namespace mpmfast
