#pragma once

/// @file The stresses of particles, staged for the internal force.

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Row d of −V_p0 τ_p of a chunk as records. @param quad see stack()
template <int Dim, class R>
inline void stack_stress(const ParticleView<Dim>& p, int d, std::uint32_t begin, int count, R* out,
                         int quad) {
  stack<Dim>(count, out, quad, [&](int i, int k) {
    const double* stress = p.stress[symmetric_index<Dim>(i < Dim ? i : 0, d)];
    return -detail::load_row(p.volume + begin + k) * detail::load_row(stress + begin + k);
  });
}

}  // namespace mpmfast
