#pragma once

/// @file Sums over the nodes of one particle: scatters window_i += S_pi a + Σ_d G_pi,d b_d and gathers
/// Σ_i S_pi window_i, Σ_i G_pi,d window_i. A record (all that is known of a node) goes in one vector. Weights
/// that are products are summed direction by direction, which needs a third fewer weights in 2-D and a sixth
/// in 3-D: rows along x, of these planes, of these the whole support.

#include "kernels/basis/weights.hpp"

namespace mpmfast {

namespace detail {

/// Calls f(z, y, row) with the nodes of each row of a support on K nodes a side.
/// @tparam Side  nodes a side of the cube that they lie in
template <int Dim, int K, int Side = kWindowSide, class R, class F>
inline void for_each_support_row(R* first, const F& f) {
#pragma GCC unroll 4
  for (int z = 0; z < (Dim == 3 ? K : 1); ++z)
#pragma GCC unroll 5
    for (int y = 0; y < K; ++y) f(z, y, first + (z * Side + y) * Side);
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

// One load brings two numbers that lie side by side: sums wait for loads.

/// The first of two numbers, or the second in the lanes that go with ∂/∂x_d.
template <class R>
inline R by_pairs(int d, const Real (&two)[2]) {
#if defined(__AVX512F__) && !defined(MPMFAST_SINGLE_TRANSFERS)
  if constexpr (sizeof(R) == sizeof(__m512d)) {
    const __m512d both = _mm512_maskz_broadcast_f64x2(0xff, _mm_loadu_pd(two));
    return d == 0 ? _mm512_maskz_permute_pd(0xff, both, 0x30) : _mm512_maskz_permute_pd(0xff, both, 0xc0);
  }
#endif
#if defined(__AVX__) && !defined(MPMFAST_SINGLE_TRANSFERS)
  if constexpr (sizeof(R) == sizeof(__m256d)) {
    const __m256d both = _mm256_broadcast_pd(reinterpret_cast<const __m128d*>(two));
    return d == 0 ? _mm256_permute_pd(both, 0x3) : _mm256_permute_pd(both, 0xc);
  }
#endif
  return pair_lanes<R>(d) ? broadcast<R>(two[1]) : broadcast<R>(two[0]);
}

/// A number, and in the lanes that go with ∂/∂x and ∂/∂y those of a gradient.
template <class R>
inline R by_pairs(Real value, const Real (&gradient)[2]) {
#if defined(__AVX512F__) && !defined(MPMFAST_SINGLE_TRANSFERS)
  if constexpr (sizeof(R) == sizeof(__m512d))
    return _mm512_mask_permute_pd(broadcast<R>(value), 0xf0,
                                  _mm512_maskz_broadcast_f64x2(0xff, _mm_loadu_pd(gradient)), 0xc0);
#endif
#if defined(__AVX__) && !defined(MPMFAST_SINGLE_TRANSFERS)
  if constexpr (sizeof(R) == sizeof(__m256d))
    return _mm256_permute_pd(_mm256_broadcast_pd(reinterpret_cast<const __m128d*>(gradient)), 0xc);
#endif
  const R x = pair_lanes<R>(0) ? broadcast<R>(gradient[0]) : broadcast<R>(value);
  return pair_lanes<R>(1) ? broadcast<R>(gradient[1]) : x;
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

template <int Side, int Dim, int K, class R>
inline void add_values(const ChunkWeights<Dim, K>& w, int k, R a, R* first) {
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) first[window_offset<Dim, K, Side>(n)] += w.value[n][k] * a;
}

template <int Dim, int K, class R>
inline void scatter_gradients(const ChunkWeights<Dim, K>& w, int k, const R (&b)[Dim], R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    R sum = target[window_offset<Dim, K>(n)];
    for (int d = 0; d < Dim; ++d) sum += w.gradient(d, n, k) * b[d];
    target[window_offset<Dim, K>(n)] = sum;
  }
}

template <int Dim, int K, class R>
inline void scatter(const ChunkWeights<Dim, K>& w, int k, R a, const R (&b)[Dim], R* window) {
  R* target = window + w.first[k];
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) {
    R sum = target[window_offset<Dim, K>(n)] + w.value[n][k] * a;
    for (int d = 0; d < Dim; ++d) sum += w.gradient(d, n, k) * b[d];
    target[window_offset<Dim, K>(n)] = sum;
  }
}

template <int Side, int Dim, int K, class R>
inline R sum_of_values(const ChunkWeights<Dim, K>& w, int k, const R* first) {
  R sum[K] = {};  // a chain of additions for each node of a row, so that they need not wait for each other
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) sum[n % K] += w.value[n][k] * first[window_offset<Dim, K, Side>(n)];
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
    for (int d = 0; d < Dim; ++d) out[d] += w.gradient(d, n, k) * node;
  }
}

/// Values and gradients. @return Σ_i S_pi window_i
template <int Dim, int K, class R>
inline R gather(const ChunkWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  gather_gradients(w, k, window, out);
  return sum_of_values<kWindowSide>(w, k, window + w.first[k]);
}

template <class R, int K>
inline R pair_weight(const ChunkWeights<2, K>& w, int n, int k) {
  return detail::by_pairs<R>(w.value[n][k], w.slope[0][n][k]);
}

template <int Side, int K, class R>
inline void add_pairs(const ChunkWeights<2, K>& w, int k, R a, R* first) {
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n) first[window_offset<2, K, Side>(n)] += pair_weight<R>(w, n, k) * a;
}

template <int Side, int K, class R>
inline R sum_of_pairs(const ChunkWeights<2, K>& w, int k, const R* first) {
  R sum[K] = {};
#pragma GCC unroll 64
  for (int n = 0; n < w.kNodes; ++n)
    sum[n % K] += pair_weight<R>(w, n, k) * first[window_offset<2, K, Side>(n)];
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
      value[d][i] = broadcast<R>(w.value(d, i, k));
      slope[d][i] = broadcast<R>(w.slope(d, i, k));
    }
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, R* row) {
    if (Dim == 3 && y == 0) {
      const Real value_z = w.value(Dim - 1, z, k);
      plane = value_z * a + w.slope(Dim - 1, z, k) * b[Dim - 1];
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

template <int Side, int Dim, int K, class R>
inline void add_values(const ProductWeights<Dim, K>& w, int k, R a, R* first) {
  R plane = a, value_x[K];
  for (int x = 0; x < K; ++x) value_x[x] = broadcast<R>(w.value(0, x, k));
  detail::for_each_support_row<Dim, K, Side>(first, [&](int z, int y, R* row) {
    if (Dim == 3 && y == 0) plane = w.value(Dim - 1, z, k) * a;
    const R p = w.value(1, y, k) * plane;
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) row[x] += value_x[x] * p;
  });
}

template <int Dim, int K, class R>
inline R gather(const ProductWeights<Dim, K>& w, int k, const R* window, R (&out)[Dim]) {
  R value{}, plane{}, plane_x{}, plane_y{};
  for (R& o : out) o = R{};
  detail::for_each_support_row<Dim, K>(window + w.first[k], [&](int z, int y, const R* row) {
    R sum = w.value(0, 0, k) * row[0], slope = w.slope(0, 0, k) * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) {
      sum += w.value(0, x, k) * row[x];
      slope += w.slope(0, x, k) * row[x];
    }
    plane += w.value(1, y, k) * sum;
    plane_x += w.value(1, y, k) * slope;
    plane_y += w.slope(1, y, k) * sum;
    if (y < K - 1) return;
    if constexpr (Dim == 3) {
      value += w.value(2, z, k) * plane;
      out[0] += w.value(2, z, k) * plane_x;
      out[1] += w.value(2, z, k) * plane_y;
      out[2] += w.slope(2, z, k) * plane;
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

template <int Side, int Dim, int K, class R>
inline R sum_of_values(const ProductWeights<Dim, K>& w, int k, const R* first) {
  R value{}, plane{};
  detail::for_each_support_row<Dim, K, Side>(first, [&](int z, int y, const R* row) {
    R sum = w.value(0, 0, k) * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) sum += w.value(0, x, k) * row[x];
    plane += w.value(1, y, k) * sum;
    if (y < K - 1) return;
    value += Dim == 3 ? w.value(Dim - 1, z, k) * plane : plane;
    plane = R{};
  });
  return value;
}

/// The factor along d on node i of a record's lanes: the slope where they go with ∂/∂x_d, else the value.
template <class R, int K>
inline R pair_factor(const ProductWeights<2, K>& w, int d, int i, int k) {
  return detail::by_pairs<R>(d, w.factor[d][i][k]);
}

template <int Side, int K, class R>
inline void add_pairs(const ProductWeights<2, K>& w, int k, R a, R* first) {
  R along_x[K];
  for (int x = 0; x < K; ++x) along_x[x] = pair_factor<R>(w, 0, x, k);
  detail::for_each_support_row<2, K, Side>(first, [&](int, int y, R* row) {
    const R p = pair_factor<R>(w, 1, y, k) * a;
#pragma GCC unroll 4
    for (int x = 0; x < K; ++x) row[x] += along_x[x] * p;
  });
}

template <int Side, int K, class R>
inline R sum_of_pairs(const ProductWeights<2, K>& w, int k, const R* first) {
  R along_x[K], all{};
  for (int x = 0; x < K; ++x) along_x[x] = pair_factor<R>(w, 0, x, k);
  detail::for_each_support_row<2, K, Side>(first, [&](int, int y, const R* row) {
    R sum = along_x[0] * row[0];
#pragma GCC unroll 4
    for (int x = 1; x < K; ++x) sum += along_x[x] * row[x];
    all += pair_factor<R>(w, 1, y, k) * sum;
  });
  return all;
}

// Of one particle, in the window.

template <class Weights, class R>
inline void scatter_values(const Weights& w, int k, R a, R* window) {
  add_values<kWindowSide>(w, k, a, window + w.first[k]);
}
template <class Weights, class R>
inline void scatter_pairs(const Weights& w, int k, R a, R* window) {
  add_pairs<kWindowSide>(w, k, a, window + w.first[k]);
}
template <class Weights, class R>
inline R gather_values(const Weights& w, int k, const R* window) {
  return sum_of_values<kWindowSide>(w, k, window + w.first[k]);
}
template <class Weights, class R>
inline R gather_pairs(const Weights& w, int k, const R* window) {
  return sum_of_pairs<kWindowSide>(w, k, window + w.first[k]);
}

// Of the particles of a chunk. In 2-D the nodes of a support stay in registers over particles that follow
// each other in one cell: else each would wait for what the one before it added. (In 3-D arithmetic takes
// longer than that; of domains that need more nodes they would not fit.)

namespace detail {

template <class Weights>
inline constexpr bool kStay = Weights::kDim == 2 && (Weights::kProducts || Weights::kSide == 3);

/// Calls f(k, nodes) for the particles of a chunk in the plane. @tparam kWrites  the nodes are changed
template <bool kWrites, class Weights, class R, class F>
inline void for_each_in_support(const Weights& w, int count, R* window, const F& f) {
  constexpr int K = Weights::kSide;
  for (int k = 0; k < count;) {
    const int first = w.first[k];
    R* at = window + first;
    std::remove_const_t<R> nodes[K * K];
#pragma GCC unroll 25
    for (int n = 0; n < K * K; ++n) nodes[n] = at[window_offset<2, K>(n)];
    do f(k, nodes);
    while (++k < count && w.first[k] == first);
    if constexpr (kWrites) {
#pragma GCC unroll 25
      for (int n = 0; n < K * K; ++n) at[window_offset<2, K>(n)] = nodes[n];
    }
  }
}

}  // namespace detail

/// Nothing is done beside the sums of a particle.
struct NothingBeside {
  void operator()(int) const {}
};

/// @param beside  called with each particle of the chunk, as those below
template <class Weights, class R, class F = NothingBeside>
inline void scatter_chunk_values(const Weights& w, int count, const R* a, R* window, const F& beside = {}) {
  if constexpr (detail::kStay<Weights>)
    detail::for_each_in_support<true>(w, count, window, [&](int k, R* nodes) {
      beside(k);
      add_values<Weights::kSide>(w, k, a[k], nodes);
    });
  else
    for_each_apart(count, [&](int k) {
      beside(k);
      scatter_values(w, k, a[k], window);
    });
}

template <class Weights, class R, class F = NothingBeside>
inline void scatter_chunk_pairs(const Weights& w, int count, const R* a, R* window, const F& beside = {}) {
  if constexpr (detail::kStay<Weights>)
    detail::for_each_in_support<true>(w, count, window, [&](int k, R* nodes) {
      beside(k);
      add_pairs<Weights::kSide>(w, k, a[k], nodes);
    });
  else
    for_each_apart(count, [&](int k) {
      beside(k);
      scatter_pairs(w, k, a[k], window);
    });
}

/// Calls f(k, Σ_i S_pi window_i).
template <class Weights, class R, class F>
inline void gather_chunk_values(const Weights& w, int count, const R* window, const F& f) {
  if constexpr (detail::kStay<Weights>)
    detail::for_each_in_support<false>(
        w, count, window, [&](int k, const R* nodes) { f(k, sum_of_values<Weights::kSide>(w, k, nodes)); });
  else
    for (int k = 0; k < count; ++k) f(k, gather_values(w, k, window));
}

template <class Weights, class R>
inline void gather_chunk_pairs(const Weights& w, int count, const R* window, R* out) {
  if constexpr (detail::kStay<Weights>)
    detail::for_each_in_support<false>(
        w, count, window, [&](int k, const R* nodes) { out[k] = sum_of_pairs<Weights::kSide>(w, k, nodes); });
  else
    for (int k = 0; k < count; ++k) out[k] = gather_pairs(w, k, window);
}

}  // namespace mpmfast
