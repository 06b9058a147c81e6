#pragma once

/// @file Linear CPDI (Sadeghirad et al. 2011): the particle's domain is the parallelogram or parallelepiped with
/// half-edge vectors r_k, convected by F. The grid function is replaced by its multilinear interpolation from the
/// 2^Dim corners x_c = x_p + Σ_k s_ck r_k (s_ck = ±1), whose mean and mean gradient over the domain are exact:
///   S_pi = 2^−Dim Σ_c N_i(x_c),   G_pi = R^−T 2^−Dim Σ_c s_c N_i(x_c),   R = [r_1 … r_Dim].
/// In 2-D this is Sadeghirad's formula with full edge vectors.

#include <cmath>

#include "kernels/basis/weights.hpp"

namespace mpmfast {

template <int Dim>
struct LcpdiBasis {
  static constexpr int kMinSupport = 3, kMaxSupport = 4;
  static constexpr bool kConvected = true;
  /// Half extent, in cells, beyond which a domain is scaled down: 4 nodes a side then always suffice.
  static constexpr double kMaxExtent = 0.999;

  /// The half-edge vectors R = F diag(l), scaled as a whole where the domain would outgrow kMaxExtent cells.
  /// @param f row-major deformation gradient; @param edge row-major result, m
  template <class V>
  static void convect(const V (&f)[Dim * Dim], const double (&half_size)[Dim], double inverse_cell,
                      V (&edge)[Dim * Dim]) {
    V extent = broadcast<V>(0.0);
    for (int i = 0; i < Dim; ++i) {
      V reach = broadcast<V>(0.0);
      for (int j = 0; j < Dim; ++j) {
        edge[Dim * i + j] = f[Dim * i + j] * half_size[j];
        reach += magnitude(edge[Dim * i + j]);
      }
      extent = larger(extent, reach * inverse_cell);
    }
    const V scale = extent > kMaxExtent ? kMaxExtent / extent : broadcast<V>(1.0);
    for (auto& e : edge) e *= scale;
  }

  template <int K>
  static bool stage(const ChunkGeometry<Dim>& g, ChunkWeights<Dim, K>& out) {
    alignas(64) double first[Dim][kChunk<Dim>];
    for (int k = 0; k < g.count; k += kLanes) {
      Lanes r[Dim], edge[Dim][Dim];
      centre_and_edges(g, k, r, edge);
      for (int d = 0; d < Dim; ++d) {
        Lanes extent = broadcast<Lanes>(0.0);
        for (int j = 0; j < Dim; ++j) extent += magnitude(edge[d][j]);
        const Lanes node = floor_of(r[d] - extent);
        store_lanes(&first[d][k], node);
        r[d] -= node;
      }
      Lanes sum[1 + Dim][power(K, Dim)];  // Σ N, then Σ s_1 N … over the corners
      for (auto& row : sum)
        for (auto& v : row) v = broadcast<Lanes>(0.0);
      for (int c = 0; c < kCorners<Dim>; ++c) {
        Lanes hat[Dim][K];
        for (int d = 0; d < Dim; ++d) {
          Lanes x = r[d];
          for (int j = 0; j < Dim; ++j) x = (c >> j & 1) ? x + edge[d][j] : x - edge[d][j];
          for (int i = 0; i < K; ++i) hat[d][i] = larger(1.0 - magnitude(x - double(i)), broadcast<Lanes>(0.0));
        }
        for (int n = 0; n < out.kNodes; ++n) {
          Lanes value = hat[0][n % K] * hat[1][n / K % K];
          if constexpr (Dim == 3) value *= hat[2][n / (K * K)];
          sum[0][n] += value;
          for (int j = 0; j < Dim; ++j) sum[1 + j][n] = (c >> j & 1) ? sum[1 + j][n] + value : sum[1 + j][n] - value;
        }
      }
      Lanes inverse[Dim][Dim];
      invert(edge, inverse);
      constexpr double mean = 1.0 / kCorners<Dim>;
      for (int n = 0; n < out.kNodes; ++n) {
        store_lanes(&out.value[n][k], sum[0][n] * mean);
        for (int d = 0; d < Dim; ++d) {
          Lanes slope = inverse[0][d] * sum[1][n];
          for (int j = 1; j < Dim; ++j) slope += inverse[j][d] * sum[1 + j][n];
          store_lanes(&out.gradient[d][n][k], slope * (mean * g.inverse_cell));
        }
      }
    }
    return place_in_window<Dim, K>(first, g, out.first);
  }

  /// 3 nodes a side while every domain of the chunk spans at most two cells, else 4.
  static int chunk_support(const ChunkGeometry<Dim>& g) {
    Lanes span = broadcast<Lanes>(0.0);
    for (int k = 0; k < g.count; k += kLanes) {
      Lanes r[Dim], edge[Dim][Dim];
      centre_and_edges(g, k, r, edge);
      for (int d = 0; d < Dim; ++d) {
        Lanes extent = broadcast<Lanes>(0.0);
        for (int j = 0; j < Dim; ++j) extent += magnitude(edge[d][j]);
        span = larger(span, floor_of(r[d] + extent) - floor_of(r[d] - extent));
      }
    }
    for (int i = 0; i < kLanes; ++i)
      if (span[i] > 1.0) return 4;
    return 3;
  }

  static NodeIndex<Dim> first_node(const ChunkGeometry<Dim>& g, int k) {
    NodeIndex<Dim> node;
    for (int d = 0; d < Dim; ++d) {
      double extent = 0;
      for (int j = 0; j < Dim; ++j) extent += std::abs(g.edge[Dim * d + j][k]);
      node[d] = static_cast<int>(std::floor((g.position[d][k] - g.origin[d] - extent) * g.inverse_cell + kEdge));
    }
    return node;
  }

  static Lanes coverage(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    Lanes r[Dim], edge[Dim][Dim];
    centre_and_edges(g, k, r, edge);
    Lanes best = broadcast<Lanes>(-1e300);
    for (int c = 0; c < kCorners<Dim>; ++c) {
      Lanes margin = broadcast<Lanes>(1e300);
      for (int d = 0; d < Dim; ++d) {
        Lanes x = r[d] - static_cast<double>(node[d]);
        for (int j = 0; j < Dim; ++j) x = (c >> j & 1) ? x + edge[d][j] : x - edge[d][j];
        margin = smaller(margin, 1.0 - kEdge - magnitude(x));
      }
      best = larger(best, margin);
    }
    return best;
  }
  static bool covers(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    return coverage(g, k, node)[0] > 0;
  }

 private:
  /// Centre and half-edge vectors in cells.
  static void centre_and_edges(const ChunkGeometry<Dim>& g, int k, Lanes (&r)[Dim], Lanes (&edge)[Dim][Dim]) {
    for (int d = 0; d < Dim; ++d) {
      r[d] = (load_lanes(g.position[d] + k) - g.origin[d]) * g.inverse_cell;
      for (int j = 0; j < Dim; ++j) edge[d][j] = load_lanes(g.edge[Dim * d + j] + k) * g.inverse_cell;
    }
  }

  static void invert(const Lanes (&a)[Dim][Dim], Lanes (&b)[Dim][Dim]) {
    if constexpr (Dim == 2) {
      const Lanes inverse = 1.0 / (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
      b[0][0] = a[1][1] * inverse;
      b[0][1] = -a[0][1] * inverse;
      b[1][0] = -a[1][0] * inverse;
      b[1][1] = a[0][0] * inverse;
    } else {
      const Lanes c0 = a[1][1] * a[2][2] - a[1][2] * a[2][1], c1 = a[1][2] * a[2][0] - a[1][0] * a[2][2],
                  c2 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
      const Lanes inverse = 1.0 / (a[0][0] * c0 + a[0][1] * c1 + a[0][2] * c2);
      b[0][0] = c0 * inverse;
      b[1][0] = c1 * inverse;
      b[2][0] = c2 * inverse;
      b[0][1] = (a[0][2] * a[2][1] - a[0][1] * a[2][2]) * inverse;
      b[1][1] = (a[0][0] * a[2][2] - a[0][2] * a[2][0]) * inverse;
      b[2][1] = (a[0][1] * a[2][0] - a[0][0] * a[2][1]) * inverse;
      b[0][2] = (a[0][1] * a[1][2] - a[0][2] * a[1][1]) * inverse;
      b[1][2] = (a[0][2] * a[1][0] - a[0][0] * a[1][2]) * inverse;
      b[2][2] = (a[0][0] * a[1][1] - a[0][1] * a[1][0]) * inverse;
    }
  }
};

}  // namespace mpmfast
