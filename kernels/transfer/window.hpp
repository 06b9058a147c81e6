#pragma once

/// @file The window: the nodes that one tile of particles can touch, as interleaved records in cache. Between
/// the window and the nodal columns (structure of arrays over slots) rows of four nodes are transposed.

#include <cstring>

#include "kernels/basis/weights.hpp"

namespace mpmfast {

/// Records that hold NC quantities of a node.
constexpr int records_for(int components) { return (components + 3) / 4; }

/// A window of NR records per node.
template <int Dim, int NR>
struct Window {
  Record at[NR][kWindowNodes<Dim>];
};

/// NC nodal columns, each indexed by slot.
template <int NC>
struct NodeColumns {
  double* column[NC];
};

namespace detail {

/// Calls f(slot, window index) for each row of four nodes of each tile under the window.
template <int Dim, class F>
inline void for_each_row(const int (&tile_slot)[kCorners<Dim>], F f) {
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    int base = 0, stride = 1;
    for (int d = 0; d < Dim; ++d) {
      base += (corner >> d & 1) * kTileSide * stride;
      stride *= kWindowSide;
    }
    for (int row = 0; row < kTileNodes<Dim> / kTileSide; ++row) {
      const int y = row % kTileSide, z = row / kTileSide;
      f(tile_slot[corner] + row * kTileSide, base + y * kWindowSide + z * kWindowSide * kWindowSide);
    }
  }
}

inline Record load_row(const double* p) {
  Record r;
  std::memcpy(&r, p, sizeof r);
  return r;
}

}  // namespace detail

template <int Dim, int NR>
inline void clear(Window<Dim, NR>& window) {
  std::memset(static_cast<void*>(&window), 0, sizeof window);
}

/// Fills the window from the columns. @param tile_slot first slot of each tile under the window
template <int Dim, int NC>
inline void load_window(const NodeColumns<NC>& columns, const int (&tile_slot)[kCorners<Dim>],
                        Window<Dim, records_for(NC)>& window) {
  detail::for_each_row<Dim>(tile_slot, [&](int slot, int at) {
    for (int r = 0; r < records_for(NC); ++r) {
      Record row[4];
      for (int c = 0; c < 4; ++c)
        row[c] = 4 * r + c < NC ? detail::load_row(columns.column[4 * r + c] + slot) : Record{};
      transpose(row[0], row[1], row[2], row[3]);
      for (int c = 0; c < 4; ++c) window.at[r][at + c] = row[c];
    }
  });
}

/// Adds the window to the columns. Tiles whose windows overlap must not run at the same time.
template <int Dim, int NC>
inline void flush_window(Window<Dim, records_for(NC)>& window, const int (&tile_slot)[kCorners<Dim>],
                         const NodeColumns<NC>& columns) {
  detail::for_each_row<Dim>(tile_slot, [&](int slot, int at) {
    for (int r = 0; r < records_for(NC); ++r) {
      Record row[4];
      for (int c = 0; c < 4; ++c) row[c] = window.at[r][at + c];
      transpose(row[0], row[1], row[2], row[3]);
      for (int c = 0; c < 4 && 4 * r + c < NC; ++c) {
        double* target = columns.column[4 * r + c] + slot;
        const Record sum = detail::load_row(target) + row[c];
        std::memcpy(target, &sum, sizeof sum);
      }
    }
  });
}

/// Scatters one record per particle with the basis' values: window_i += S_pi a_p.
template <int Dim, int K>
inline void scatter_values(const ChunkWeights<Dim, K>& w, int k, Record a, Record* window) {
  Record* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) target[window_offset<Dim, K>(n)] += w.value[n][k] * a;
}

/// Scatters with the basis' gradients: window_i += Σ_d G_pi,d b_d.
template <int Dim, int K>
inline void scatter_gradients(const ChunkWeights<Dim, K>& w, int k, const Record (&b)[Dim], Record* window) {
  Record* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    Record sum = target[window_offset<Dim, K>(n)];
    for (int d = 0; d < Dim; ++d) sum += w.gradient[d][n][k] * b[d];
    target[window_offset<Dim, K>(n)] = sum;
  }
}

/// Gathers Σ_i S_pi window_i.
template <int Dim, int K>
inline Record gather_values(const ChunkWeights<Dim, K>& w, int k, const Record* window) {
  const Record* source = window + w.first[k];
  Record sum[K] =
      {};  // a chain of additions for each node of a row, so that they need not wait for each other
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) sum[n % K] += w.value[n][k] * source[window_offset<Dim, K>(n)];
  for (int i = 1; i < K; ++i) sum[0] += sum[i];
  return sum[0];
}

/// Gathers Σ_i G_pi,d window_i for every direction d.
template <int Dim, int K>
inline void gather_gradients(const ChunkWeights<Dim, K>& w, int k, const Record* window, Record (&out)[Dim]) {
  const Record* source = window + w.first[k];
  for (int d = 0; d < Dim; ++d) out[d] = Record{};
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    const Record node = source[window_offset<Dim, K>(n)];
    for (int d = 0; d < Dim; ++d) out[d] += w.gradient[d][n][k] * node;
  }
}

/// The reverse: record k holds entry k of each of N arrays, then zeros. The arrays must be readable a record
/// further. (Built component by component, a record would be read back before its parts have left the store
/// buffer.)
template <int N>
inline void stack(const double* const (&in)[N], int count, Record* out) {
  static_assert(N <= 4);
  for (int k = 0; k < count; k += 4) {
    Record row[4];
    for (int c = 0; c < 4; ++c) row[c] = c < N ? detail::load_row(in[c < N ? c : 0] + k) : Record{};
    transpose(row[0], row[1], row[2], row[3]);
    for (int c = 0; c < 4; ++c) out[k + c] = row[c];
  }
}

/// Per-particle records turned into one array per component: out[4 r + c][k].
template <int Dim, int NR>
inline void unstack(Record (&in)[NR][kChunk<Dim>], int count, double (&out)[4 * NR][kChunk<Dim>]) {
  for (int r = 0; r < NR; ++r)
    for (int k = 0; k < count; k += 4) {
      Record a = in[r][k], b = in[r][k + 1], c = in[r][k + 2], d = in[r][k + 3];
      transpose(a, b, c, d);
      std::memcpy(&out[4 * r][k], &a, sizeof a);
      std::memcpy(&out[4 * r + 1][k], &b, sizeof b);
      std::memcpy(&out[4 * r + 2][k], &c, sizeof c);
      std::memcpy(&out[4 * r + 3][k], &d, sizeof d);
    }
}

}  // namespace mpmfast
