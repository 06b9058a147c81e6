#pragma once

/// @file The affine particle–grid transfers (APIC; Jiang, Schroeder, Selle, Teran, Stomakhin 2015): a
/// particle carries the slopes of the velocity about it,
///   C_p = B_p D_p⁻¹,  B_p = Σ_i S_pi v_i ⊗ (x_i − x_p),  D_p = Σ_i S_pi (x_i − x_p) ⊗ (x_i − x_p),
/// and gives m_i v_i = Σ_p S_pi M_p (V_p + C_p (x_i − x_p)). D_p = kSpread Δx² I where that sum is the same
/// everywhere, as with quadratic and cubic B-splines; other bases have no affine transfers. Angular momentum
/// Σ_p M_p (x_p × V_p + kSpread Δx² Σ_d e_d × C_p e_d) is conserved to round-off where particles move with
/// V_p.

#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// x_p − x_first in cells, for particle k of a chunk.
template <int Dim, int K>
inline void place_in_support(const ChunkWeights<Dim, K>& w, const ChunkGeometry<Dim>& g, int k,
                             double (&r)[Dim]) {
  int index = w.first[k];
  for (int d = 0; d < Dim; ++d) {
    r[d] = (g.position[d][k] - g.origin[d]) * g.inverse_cell - (g.window[d] + index % kWindowSide);
    index /= kWindowSide;
  }
}

/// Scatters a record that varies linearly over the nodes: window_i += S_pi (a + Σ_d s_d b_d) with s the steps
/// from the first node to i, summed up row by row.
template <int Dim, int K>
inline void scatter_linear(const ChunkWeights<Dim, K>& w, int k, Record a, const Record (&b)[Dim],
                           Record* window) {
  Record* target = window + w.first[k];
  Record plane = a;
  for (int z = 0; z < (Dim == 3 ? K : 1); ++z) {
    Record row = plane;
    for (int y = 0; y < K; ++y) {
      Record node = row;
#pragma GCC unroll 4
      for (int x = 0; x < K; ++x) {
        target[(z * kWindowSide + y) * kWindowSide + x] += w.value[(z * K + y) * K + x][k] * node;
        node += b[0];
      }
      row += b[1];
    }
    plane += b[Dim - 1];
  }
}

/// Gathers Σ_i S_pi s_d window_i for every direction d.
template <int Dim, int K>
inline void gather_moments(const ChunkWeights<Dim, K>& w, int k, const Record* window, Record (&out)[Dim]) {
  const Record* source = window + w.first[k];
  for (auto& o : out) o = Record{};
  for (int z = 0; z < (Dim == 3 ? K : 1); ++z) {
    Record plane{};
    for (int y = 0; y < K; ++y) {
      Record row{};
#pragma GCC unroll 4
      for (int x = 0; x < K; ++x) {
        const Record share =
            w.value[(z * K + y) * K + x][k] * source[(z * kWindowSide + y) * kWindowSide + x];
        row += share;
        out[0] += static_cast<double>(x) * share;
      }
      plane += row;
      out[1] += static_cast<double>(y) * row;
    }
    if constexpr (Dim == 3) out[2] += static_cast<double>(z) * plane;
  }
}

/// As project_tile, of particles that carry slopes. @param room a ProjectRoom
template <int Dim, class Basis, class Room>
bool project_affine_tile(const TileContext<Dim>& c, Room& room, const NodeColumns<1 + Dim>& out) {
  const ParticleView<Dim>& p = *c.particles;
  clear(room.mass_momentum);
  const bool inside = for_each_chunk<Dim, Basis, Wanted::values>(
      c, room.weights, [&](const auto& w, const auto& run, std::uint32_t begin, int count) {
        const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          const double m = p.mass[q];
          double r[Dim];
          place_in_support(w, g, k, r);
          Record at_first{m}, slope[Dim];
          for (int i = 0; i < Dim; ++i) at_first[1 + i] = m * p.velocity[i][q];
          for (int d = 0; d < Dim; ++d) {
            slope[d] = Record{};
            for (int i = 0; i < Dim; ++i) slope[d][1 + i] = m * c.grid->cell * p.slopes[Dim * i + d][q];
            at_first -= r[d] * slope[d];
          }
          scatter_linear(w, k, at_first, slope, room.mass_momentum.at[0]);
        }
      });
  if (inside) flush_window<Dim, 1 + Dim>(room.mass_momentum, c.tile->slot, out);
  return inside;
}

/// New slopes of a chunk from the window's nodal velocities, of which `mean` holds Σ_i S_pi v_i.
/// @param room has gathered[Dim][kChunk] and gradient[4 Dim][kChunk] to write to
template <int Dim, class Basis, int K, class Room>
inline void gather_slopes(const TileContext<Dim>& c, const ParticleRun<Dim>& run,
                          const ChunkWeights<Dim, K>& w, std::uint32_t begin, int count,
                          const Record* velocity, const Record (&mean)[kChunk<Dim>], Room& room) {
  const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
  const double scale = g.inverse_cell / Basis::kSpread;
  for (int k = 0; k < count; ++k) {
    double r[Dim];
    place_in_support(w, g, k, r);
    Record moment[Dim];
    gather_moments(w, k, velocity, moment);
    for (int d = 0; d < Dim; ++d) room.gathered[d][k] = scale * (moment[d] - r[d] * mean[k]);
  }
  unstack<Dim, Dim>(room.gathered, count, room.gradient);
  const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
  for (int i = 0; i < Dim; ++i)
    for (int d = 0; d < Dim; ++d)
      std::memcpy(c.particles->slopes[Dim * i + d] + begin, room.gradient[4 * d + i], bytes);
}

}  // namespace mpmfast
