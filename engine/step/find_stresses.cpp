/// Stresses that no column has, because forces alone asked for them.

#include <utility>

#include "engine/constants.hpp"
#include "engine/state/slots.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// Wave speeds stay those that the step had: the run must not depend on who looks. Its time is that of the
/// reader.
template <int Dim>
void Step<Dim>::find_stresses() {
  if (!std::exchange(stresses_wait_, false)) return;
  const ParticleView<Dim> view = state_.view();
  const auto& body = state_.particles.body();
  const auto find = [&](std::int64_t first, std::int64_t end_of_block) {
    const auto last = static_cast<std::size_t>(end_of_block);
    for (auto begin = static_cast<std::size_t>(first), end = begin; begin < last; begin = end) {
      while (end < last && body[end] == body[begin]) ++end;
      const BodyView<Dim>& of = state_.bodies[body[begin]];
      if (of.rigid) continue;
      std::visit(
          [&]<class Law>(const Law& law) {
            if constexpr (!Evolving<Law>)
              if (stress_can_wait<Law>(view))
                stress_chunk<Dim>(view, law, static_cast<std::uint32_t>(begin),
                                  static_cast<int>(end - begin));
          },
          state_.materials[static_cast<std::size_t>(of.material)]);
    }
  };
  for_each_block(static_cast<std::int64_t>(state_.particles.size()), constants::threads::kStressesAtOnce,
                 state_.threads, find);
}

template void Step<2>::find_stresses();
template void Step<3>::find_stresses();

}  // namespace mpmfast
