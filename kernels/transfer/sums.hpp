#pragma once

/// @file Sums over the nodes of one particle: scatters window_i += S_pi a + Σ_d G_pi,d b_d and gathers
/// Σ_i S_pi window_i, Σ_i G_pi,d window_i. A record (all that is known of a node) goes in one vector. Weights
/// that are products are summed direction by direction, which needs a third fewer weights in 2-D and a sixth
/// in 3-D: rows along x, of these planes, of these the whole support.

#include "kernels/basis/weights.hpp"

namespace mpmfast {

namespace detail {

/// Calls f(z, y, row) with the nodes of each row of a support on K nodes a side.
template <int Dim, int K, class R, class F>
inline void for_each_support_row(R* first, const F& f) {
#pragma GCC unroll 4
  for (int z = 0; z < (Dim == 3 ? K : 1); ++z)
#pragma GCC unroll 5
    for (int y = 0; y < K; ++y) f(z, y, first + (z * kWindowSide + y) * kWindowSide);
}

/// Which lanes of a record of pairs go with ∂/∂x (0) and ∂/∂y (1).
template <class R>
inline auto pair_lanes(int d) {
  constexpr int lanes = sizeof(R) / sizeof(Real);
  std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t> __attribute__((vector_size(sizeof(R))))
  mask{};
  for (int i = 0; i < 2; ++i) mask[lanes - 4 + 2 * d + i] = -1;
  return mask;
}

}  // namespace detail

/// Calls f(k) for each particle of a chunk, neighbours not one after the other: they lie in the same cell,
/// and each would wait for what the one before it adds to a node.
template <class F>
inline void for_each_apart(int count, const F& f) {
  const int half = (count + 1) / 2;
  for (int k = 0; k + half < count; ++k) {
    f(k);
    f(k + half);
  }
  if (count % 2) f(half - 1);
}

/// Number of records that hold the gradient of a vector.
template <int Dim>
inline constexpr int kGradientRecords = Dim == 2 ? 1 : Dim;

// Weights of any kind, node by node.

template <int Dim, int K, class R>
inline void scatter_values(const ChunkWeights<Dim, K>& w, int k, R a, R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) target[window_offset<Dim, K>(n)] += w.value[n][k] * a;
}

template <int Dim, int K, class R>
inline void scatter_gradients(const ChunkWeights<Dim, K>& w, int k, const R (&b)[Dim], R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    R sum = target[window_offset<Dim, K>(n)];
    for (int d = 0; d < Dim; ++d) sum += w.gradient[d][n][k] * b[d];
    target[window_offset<Dim, K>(n)] = sum;
  }
}

template <int Dim, int K, class R>
inline void scatter(const ChunkWeights<Dim, K>& w, int k, R a, const R (&b)[Dim], R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    R sum = target[window_offset<Dim, K>(n)] + w.value[n][k] * a;
    for (int d = 0; d < Dim; ++d) sum += w.gradient[d][n][k] * b[d];
    target[window_offset<Dim, K>(n)] = sum;
  }
}

template <int Dim, int K, class R>
inline R gather_values(const ChunkWeights<Dim, K>& w, int k, const R* window) {
  const R* source = window + w.first[k];
  R sum[K] = {};  // a chain of additions for each node of a row, so that they need not wait for each other
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) sum[n % K] += w.value[n][k] * source[window_offset<Dim, K>(n)];
  for (int i = 1; i < K; ++i) sum[0] += sum[i];
  return sum[0];
}

template <int Dim, int K, class R>
inline void gather_gradients(const ChunkWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  const R* source = window + w.first[k];
  for (int d = 0; d < Dim; ++d) out[d] = R{};
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    const R node = source[window_offset<Dim, K>(n)];
    for (int d = 0; d < Dim; ++d) out[d] += w.gradient[d][n][k] * node;
  }
}

/// Values and gradients. @return Σ_i S_pi window_i
template <int Dim, int K, class R>
inline R gather(const ChunkWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  gather_gradients(w, k, window, out);
  return gather_values(w, k, window);
}

template <class R, int K>
inline R pair_weight(const ChunkWeights<2, K>& w, int n, int k) {
  const R x = detail::pair_lanes<R>(0) ? broadcast<R>(w.gradient[0][n][k]) : broadcast<R>(w.value[n][k]);
  return detail::pair_lanes<R>(1) ? broadcast<R>(w.gradient[1][n][k]) : x;
}

template <int K, class R>
inline void scatter_pairs(const ChunkWeights<2, K>& w, int k, R a, R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) target[window_offset<2, K>(n)] += pair_weight<R>(w, n, k) * a;
}

template <int K, class R>
inline R gather_pairs(const ChunkWeights<2, K>& w, int k, const R* window) {
  const R* source = window + w.first[k];
  R sum[K] = {};
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) sum[n % K] += pair_weight<R>(w, n, k) * source[window_offset<2, K>(n)];
  for (int i = 1; i < K; ++i) sum[0] += sum[i];
  return sum[0];
}

// Weights that are products. (Factors that several rows need are copied: next to stores into the window they
// would be read again for each.)

/// With a plane A = w_z a + g_z b_z, B = w_z b: row P = w_y A + g_y B_y, Q = w_y B_x, node w_x P + g_x Q.
template <int Dim, int K, class R>
inline void scatter(const ProductWeights<Dim, K>& w, int k, R a, const R (&b)[Dim], R* window) {
  R plane = a, along_x = b[0], along_y = b[1], value[2][K], slope[2][K];
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < K; ++i) {
      value[d][i] = broadcast<R>(w.value[d][i][k]);
      slope[d][i] = broadcast<R>(w.slope[d][i][k]);
    }
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, R* row) {
    if (Dim == 3 && y == 0) {
      const Real value_z = w.value[Dim - 1][z][k];
      plane = value_z * a + w.slope[Dim - 1][z][k] * b[Dim - 1];
      along_x = value_z * b[0];
      along_y = value_z * b[1];
    }
    const R p = value[1][y] * plane + slope[1][y] * along_y, q = value[1][y] * along_x;
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) row[x] = row[x] + value[0][x] * p + slope[0][x] * q;
  });
}

template <int Dim, int K, class R>
inline void scatter_gradients(const ProductWeights<Dim, K>& w, int k, const R (&b)[Dim], R* window) {
  scatter(w, k, R{}, b, window);
}

template <int Dim, int K, class R>
inline void scatter_values(const ProductWeights<Dim, K>& w, int k, R a, R* window) {
  R plane = a, value_x[K];
  for (int x = 0; x < K; ++x) value_x[x] = broadcast<R>(w.value[0][x][k]);
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, R* row) {
    if (Dim == 3 && y == 0) plane = w.value[Dim - 1][z][k] * a;
    const R p = w.value[1][y][k] * plane;
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) row[x] += value_x[x] * p;
  });
}

/// Rows Σ_x w_x v and Σ_x g_x v, summed over y with w_y and g_y, and these over z likewise.
template <int Dim, int K, class R>
inline R gather(const ProductWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  R value{}, plane{}, plane_x{}, plane_y{};
  for (R& o : out) o = R{};
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, const R* row) {
    R sum = w.value[0][0][k] * row[0], slope = w.slope[0][0][k] * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) {
      sum += w.value[0][x][k] * row[x];
      slope += w.slope[0][x][k] * row[x];
    }
    plane += w.value[1][y][k] * sum;
    plane_x += w.value[1][y][k] * slope;
    plane_y += w.slope[1][y][k] * sum;
    if (y < K - 1) return;
    if constexpr (Dim == 3) {
      value += w.value[2][z][k] * plane;
      out[0] += w.value[2][z][k] * plane_x;
      out[1] += w.value[2][z][k] * plane_y;
      out[2] += w.slope[2][z][k] * plane;
      plane = plane_x = plane_y = R{};
    } else {
      value = plane;
      out[0] = plane_x;
      out[1] = plane_y;
    }
  });
  return value;
}

template <int Dim, int K, class R>
inline void gather_gradients(const ProductWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  gather(w, k, window, out);
}

template <int Dim, int K, class R>
inline R gather_values(const ProductWeights<Dim, K>& w, int k, const R* window) {
  R value{}, plane{};
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, const R* row) {
    R sum = w.value[0][0][k] * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) sum += w.value[0][x][k] * row[x];
    plane += w.value[1][y][k] * sum;
    if (y < K - 1) return;
    value += Dim == 3 ? w.value[Dim - 1][z][k] * plane : plane;
    plane = R{};
  });
  return value;
}

/// The factor along d on node i of a record's lanes: the slope where they go with ∂/∂x_d, else the value.
template <class R, int K>
inline R pair_factor(const ProductWeights<2, K>& w, int d, int i, int k) {
  return detail::pair_lanes<R>(d) ? broadcast<R>(w.slope[d][i][k]) : broadcast<R>(w.value[d][i][k]);
}

template <int K, class R>
inline void scatter_pairs(const ProductWeights<2, K>& w, int k, R a, R* window) {
  R along_x[K];
  for (int x = 0; x < K; ++x) along_x[x] = pair_factor<R>(w, 0, x, k);
  detail::for_each_support_row<2, K>(window + w.first[k], [&](int, int y, R* row) {
    const R p = pair_factor<R>(w, 1, y, k) * a;
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) row[x] += along_x[x] * p;
  });
}

template <int K, class R>
inline R gather_pairs(const ProductWeights<2, K>& w, int k, const R* window) {
  R along_x[K], all{};
  for (int x = 0; x < K; ++x) along_x[x] = pair_factor<R>(w, 0, x, k);
  detail::for_each_support_row<2, K>(window + w.first[k], [&](int, int y, const R* row) {
    R sum = along_x[0] * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) sum += along_x[x] * row[x];
    all += pair_factor<R>(w, 1, y, k) * sum;
  });
  return all;
}

}  // namespace mpmfast
