#pragma once

/// @file The affine particle–grid transfers (APIC; Jiang, Schroeder, Selle, Teran, Stomakhin 2015): a
/// particle carries the slopes of the velocity about it,
///   C_p = B_p D_p⁻¹,  B_p = Σ_i S_pi v_i ⊗ (x_i − x_p),  D_p = Σ_i S_pi (x_i − x_p) ⊗ (x_i − x_p),
/// and gives m_i v_i = Σ_p S_pi M_p (V_p + C_p (x_i − x_p)). D_p = kSpread Δx² I where that sum is the same
/// everywhere, as with quadratic and cubic B-splines; other bases have no affine transfers. Angular momentum
/// Σ_p M_p (x_p × V_p + kSpread Δx² Σ_d e_d × C_p e_d) is conserved to round-off where particles move with
/// V_p.

#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// x_p − x_first in cells, for particle k of a chunk.
template <int Dim, int K>
inline void index_in_support(const ProductWeights<Dim, K>& w, const ChunkGeometry<Dim>& g, int k,
                             Real (&r)[Dim]) {
  int index = w.first[k];
  for (int d = 0; d < Dim; ++d) {
    r[d] = static_cast<Real>((g.position[d][k] - g.origin[d]) * g.inverse_cell -
                             (g.window[d] + index % kWindowSide));
    index /= kWindowSide;
  }
}

/// Scatters a record that varies linearly over the nodes: window_i += S_pi (a + Σ_d s_d b_d) with s the steps
/// from the first node to i, summed up row by row.
template <int Dim, int K>
inline void scatter_linear(const ProductWeights<Dim, K>& w, int k, Record a, const Record (&b)[Dim],
                           Record* window) {
  Record plane = a, along_y = a;
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, Record* row) {
    if (y == 0) along_y = plane;
    const Real weight = (Dim == 3 ? w.value(Dim - 1, z, k) : Real{1}) * w.value(1, y, k);
    Record node = weight * along_y;
    const Record step = weight * b[0];
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) {
      row[x] += w.value(0, x, k) * node;
      node += step;
    }
    along_y += b[1];
    if (y == K - 1) plane += b[Dim - 1];
  });
}

/// Gathers Σ_i S_pi s_d window_i for every direction d.
template <int Dim, int K, class R>
inline void gather_moments(const ProductWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  for (auto& o : out) o = R{};
  R plane{};
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, const R* row) {
    const Real weight = (Dim == 3 ? w.value(Dim - 1, z, k) : Real{1}) * w.value(1, y, k);
    R sum = w.value(0, 0, k) * row[0], moment{};
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) {
      const R share = w.value(0, x, k) * row[x];
      sum += share;
      moment += static_cast<Real>(x) * share;
    }
    out[0] += weight * moment;
    plane += weight * sum;
    out[1] += static_cast<Real>(y) * (weight * sum);
    if (Dim == 3 && y == K - 1) {
      out[Dim - 1] += static_cast<Real>(z) * plane;
      plane = R{};
    }
  });
}

/// As project_tile, of particles that carry slopes. @param workspace a ProjectWorkspace
template <int Dim, class Basis, class Workspace>
bool project_affine_tile(const TileContext<Dim>& c, Workspace& workspace, const NodeColumns<1 + Dim>& out) {
  const ParticleView<Dim>& p = *c.particles;
  begin_sums(c, workspace.mass_momentum, out);
  const bool inside = for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values,
      [&](const auto& w, const auto& run, std::uint32_t begin, int count) {
        const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          const double m = p.mass[q];
          Real r[Dim];
          index_in_support(w, g, k, r);
          Record at_first{static_cast<Real>(m)}, slope[Dim];
          for (int i = 0; i < Dim; ++i) at_first[1 + i] = static_cast<Real>(m * p.velocity[i][q]);
          for (int d = 0; d < Dim; ++d) {
            slope[d] = Record{};
            for (int i = 0; i < Dim; ++i)
              slope[d][1 + i] = static_cast<Real>(m * c.grid->cell * p.slopes[Dim * i + d][q]);
            at_first -= r[d] * slope[d];
          }
          scatter_linear(w, k, at_first, slope, workspace.mass_momentum.at[0]);
        }
      });
  if (inside) end_sums(c, workspace.mass_momentum, out);
  return inside;
}

/// Scatters m (V + C (x_i − x_p)) of particle k, the slopes C gathered from the nodal velocities in `from`.
/// @param v  V = Σ_i S_pi v_i of the same
template <int Dim, class Basis, int K>
inline void scatter_affine(const TileContext<Dim>& c, const ParticleRun<Dim>& run,
                           const ProductWeights<Dim, K>& w, std::uint32_t begin, int count, int k, Real m,
                           Record v, const Record* from, Record* to) {
  const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
  Real r[Dim];
  index_in_support(w, g, k, r);
  Record moment[Dim];
  gather_moments(w, k, from, moment);
  Record at_first = m * v;
  for (int d = 0; d < Dim; ++d) {  // C Δx, a step of one cell
    moment[d] = (m / static_cast<Real>(Basis::kSpread)) * (moment[d] - r[d] * v);
    at_first -= r[d] * moment[d];
  }
  scatter_linear(w, k, at_first, moment, to);
}

/// New slopes of a chunk from the window's nodal velocities, of which from.value[0] holds Σ_i S_pi v_i.
/// @param from a GatherWorkspace; its slopes and `staging` are written over
template <int Dim, class Basis, int K, class Workspace>
inline void gather_slopes(const TileContext<Dim>& c, const ParticleRun<Dim>& run,
                          const ProductWeights<Dim, K>& w, std::uint32_t begin, int count, Workspace& from,
                          double (&staging)[4 * Dim][kChunk<Dim>]) {
  const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
  const auto scale = static_cast<Real>(g.inverse_cell / Basis::kSpread);
  for (int k = 0; k < count; ++k) {
    Real r[Dim];
    index_in_support(w, g, k, r);
    typename Workspace::Node moment[Dim];
    gather_moments(w, k, from.window.at[0], moment);
    for (int d = 0; d < Dim; ++d) from.slope[d][k] = scale * (moment[d] - r[d] * from.value[0][k]);
  }
  const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
  for (int d = 0; d < Dim; ++d) {
    unpack<Dim, Dim>(from.slope[d], count, &staging[4 * d]);
    for (int i = 0; i < Dim; ++i)
      std::memcpy(c.particles->slopes[Dim * i + d] + begin, staging[4 * d + i], bytes);
  }
}

}  // namespace mpmfast
