#pragma once

/// @file What every basis hands to the transfers: for a chunk of particles, the first node of the support and
/// the values S_pi and gradients G_pi (N20 Eq. 2, 12) on a small cube of nodes.

#include "kernels/dimension.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

/// Particles whose weights are staged at once: few enough that they stay in the first-level cache. In 2-D a
/// little more than the 64 of a tile at 4 a cell, so that a tile that gained a few is still one chunk.
template <int Dim>
inline constexpr int kChunk = Dim == 2 ? 80 : 16;

/// What a basis reads of a chunk of particles of one body.
template <int Dim>
struct ChunkGeometry {
  const double* position[Dim];    ///< [count], m
  const double* edge[Dim * Dim];  ///< [count], m; half-edge vectors of CPDI domains, row-major; else null
  double half_size[Dim];          ///< m, of the undeformed domain
  double origin[Dim];             ///< m, of node (0, …, 0)
  double inverse_cell;            ///< 1/m
  int window[Dim];                ///< coordinates of the first node of the tile's window
  int count;                      ///< ≤ kChunk
};

/// Which weights a pass needs: the others are not computed.
enum class Wanted { values, gradients, both };

/// The sort puts a particle into the tile where its support begins at this node of the window, or at one of
/// the kTileSide − 1 after it. Until the next sort it may drift as far as the window goes: with supports of 3
/// nodes by one node either way, of 4 by one downwards, of 5 not at all (a support that leaves the window is
/// seen, and sorted anew).
template <class Basis>
inline constexpr int kSortedOffset = Basis::kMaxSupport <= kWindowSide - kTileSide ? 1 : 0;

/// Weights of a chunk on K nodes a side, of any kind. Node n of a particle lies at window index first[k] +
/// window_offset(n).
template <int Dim, int K>
struct ChunkWeights {
  static constexpr int kDim = Dim, kSide = K, kNodes = power(K, Dim);
  static constexpr bool kProducts = false;
  int first[kChunk<Dim>];
  alignas(64) Real value[kNodes][kChunk<Dim>];  ///< S_pi
  /// G_pi, 1/m; in 2-D ∂/∂x and ∂/∂y of a particle side by side: sums want both at once.
  alignas(64) Real slope[Dim == 2 ? 1 : Dim][kNodes][kChunk<Dim>][Dim == 2 ? 2 : 1];

  Real gradient(int d, int n, int k) const { return Dim == 2 ? slope[0][n][k][d] : slope[d][n][k][0]; }

  double value_at(int n, int k) const { return value[n][k]; }
  double gradient_at(int d, int n, int k) const { return gradient(d, n, k); }
};

/// The same of weights that are products of one-dimensional functions, S_pi = Π_d N_d: the factors alone.
/// Sums over the nodes are then taken direction after direction (transfer/sums.hpp).
template <int Dim, int K>
struct ProductWeights {
  static constexpr int kDim = Dim, kSide = K, kNodes = power(K, Dim);
  static constexpr bool kProducts = true;
  int first[kChunk<Dim>];
  /// N_d on the K nodes along d and its derivative, 1/m, side by side: sums want both of a particle at once.
  alignas(64) Real factor[Dim][K][kChunk<Dim>][2];

  Real value(int d, int i, int k) const { return factor[d][i][k][0]; }
  Real slope(int d, int i, int k) const { return factor[d][i][k][1]; }

  double value_at(int n, int k) const {
    double product = 1;
    for (int d = 0; d < Dim; ++d, n /= K) product *= value(d, n % K, k);
    return product;
  }
  double gradient_at(int along, int n, int k) const {
    double product = 1;
    for (int d = 0; d < Dim; ++d, n /= K) product *= factor[d][n % K][k][d == along];
    return product;
  }
};

/// Index of the n-th node (x fastest) of a K-cube within the window, relative to its first node; or within
/// another cube of nodes.
template <int Dim, int K, int Side = kWindowSide>
constexpr int window_offset(int n) {
  int offset = 0, stride = 1;
  for (int d = 0; d < Dim; ++d) {
    offset += (n % K) * stride;
    n /= K;
    stride *= Side;
  }
  return offset;
}

/// Turns the first nodes (whole numbers) of some particles' supports on K nodes a side into window indices.
/// @return those of `among` whose supports lie in the window: the others must be sorted anew
template <int Dim, int K>
inline LaneSet locate_in_window(LaneSet among, const Lanes (&first)[Dim], const ChunkGeometry<Dim>& g,
                                int* index) {
  constexpr double kMost = kWindowSide - K + 0.5;
  Lanes at = broadcast<Lanes>(0.0);
  double stride = 1;
  for (int d = 0; d < Dim; ++d) {
    const Lanes offset = first[d] - static_cast<double>(g.window[d]);
    among = where_less(among, broadcast<Lanes>(-0.5), offset);  // not for NaN
    among = where_less(among, offset, broadcast<Lanes>(kMost));
    at += offset * stride;
    stride *= kWindowSide;
  }
  store_indices(index, at);
  return among;
}

}  // namespace mpmfast
