#pragma once

/// @file The stresses of particles, staged for the internal force.

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/strain_chunk.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// −V_p0 τ_p of a chunk as records: row by row, in 2-D both rows as one record of pairs.
/// @param quad see pack()
template <int Dim, class R>
inline void pack_stress(const ParticleView<Dim>& p, const ChunkStress<Dim>& of, std::uint32_t begin,
                        int count, int quad, R (*out)[kChunk<Dim>]) {
  constexpr int entries = Dim == 2 ? 4 : Dim;
  for (int r = 0; r < kGradientRecords<Dim>; ++r)
    pack<entries>(count, out[r], quad, [&](int c, int k) {
      const double* stress = of.component[symmetric_index<Dim>(c % Dim, r + c / Dim % Dim)];
      return -detail::load_row(p.volume + begin + k) * detail::load_row(stress + k);
    });
}

/// window_i += Σ_p Σ_d G_pi,d (row d of the staged stress of particle p of a chunk).
/// @param beside  called with each particle
template <int Dim, class Weights, class F = NothingBeside>
inline void scatter_stress(const Weights& w, int count, const Record (*stress)[kChunk<Dim>], Record* window,
                           const F& beside = {}) {
  if constexpr (Dim == 2)
    scatter_chunk_pairs(w, count, stress[0], window, beside);
  else
    for_each_apart(count, [&](int k) {
      beside(k);
      scatter_gradients(w, k, {stress[0][k], stress[1][k], stress[2][k]}, window);
    });
}

}  // namespace mpmfast
