#pragma once

/// @file Short vectors: Lanes holds one quantity of several particles, Row of four, Record four quantities of
/// one node, WideRecord eight. All are GCC vector types, so that arithmetic, comparison and ?: read as for a
/// number.

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif

using Lanes = double __attribute__((vector_size(8 * kLanes)));
using IntLanes = std::int64_t __attribute__((vector_size(8 * kLanes)));
using Row = double __attribute__((vector_size(32)));
using WideRow = double __attribute__((vector_size(64)));

/// What transfers weigh and sum in, between the columns, which are doubles.
#if defined(MPMFAST_SINGLE_TRANSFERS)
using Real = float;
#else
using Real = double;
#endif
using Record = Real __attribute__((vector_size(4 * sizeof(Real))));
using WideRecord = Real __attribute__((vector_size(8 * sizeof(Real))));
/// What holds N quantities of a node: wide records are for machines that have registers for them, others
/// would spill.
template <int N>
using RecordFor =
    std::conditional_t<(N > 4 && kLanes * sizeof(double) >= sizeof(WideRecord)), WideRecord, Record>;

template <class V>
struct LaneTraits;
template <>
struct LaneTraits<double> {
  using Int = std::int64_t;
  static constexpr int count = 1;
};
template <>
struct LaneTraits<Lanes> {
  using Int = IntLanes;
  static constexpr int count = kLanes;
};

inline Lanes load_lanes(const double* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store_lanes(double* p, Lanes v) { std::memcpy(p, &v, sizeof v); }
/// Rounded.
inline void store_lanes(float* p, Lanes v) {
  using Floats = float __attribute__((vector_size(4 * kLanes)));
  const Floats rounded = __builtin_convertvector(v, Floats);
  std::memcpy(p, &rounded, sizeof rounded);
}

/// a and b by turns: a₀, b₀, a₁, b₁ ….
template <class Number>
inline void store_pairs(Number* p, Lanes a, Lanes b) {
  const auto half = [&]<int... I>(int from, std::integer_sequence<int, I...>) {
    return from == 0 ? __builtin_shufflevector(a, b, (I / 2 + I % 2 * kLanes)...)
                     : __builtin_shufflevector(a, b, (kLanes / 2 + I / 2 + I % 2 * kLanes)...);
  };
  const auto lanes = std::make_integer_sequence<int, kLanes>();
  store_lanes(p, half(0, lanes));
  store_lanes(p + kLanes, half(1, lanes));
}

/// Whole numbers as int.
inline void store_indices(int* p, Lanes v) {
  using Indices = int __attribute__((vector_size(4 * kLanes)));
  const Indices whole = __builtin_convertvector(v, Indices);
  std::memcpy(p, &whole, sizeof whole);
}
/// Of a comparison, a bit for each lane, the first lowest: does it hold?
inline unsigned bits_of(IntLanes v) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(v), reinterpret_cast<__m512i>(v));
#elif defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(v)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= (v[i] != 0 ? 1u : 0u) << i;
  return bits;
#endif
}
/// In any lane?
inline bool any_of(IntLanes v) { return bits_of(v) != 0; }
/// The first n lanes, or all of them.
inline void store_first(double* p, Lanes v, int n) {
  if (n >= kLanes) return store_lanes(p, v);
#if defined(__AVX512F__)
  _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1u << n) - 1), v);
#else
  for (int i = 0; i < n; ++i) p[i] = v[i];
#endif
}

/// The same value in every lane (or the value itself).
template <class V, class Number>
inline V broadcast(Number x) {
  return x - V{};  // x + 0 is not x where that is -0: the compiler would have to add
}

template <class V>
inline V larger(V a, V b) {
  return a > b ? a : b;
}
template <class V>
inline V smaller(V a, V b) {
  return a < b ? a : b;
}
template <class V>
inline V magnitude(V a) {
  return a < 0.0 ? -a : a;
}

// One instruction each, and the same results; the compiler does not see it for fear of NaN. (maskz: g++ 12
// warns falsely of the plain ones, GCC bug 105593.)
#if defined(__AVX512F__)
inline Lanes larger(Lanes a, Lanes b) { return _mm512_maskz_max_pd(0xff, a, b); }
inline Lanes smaller(Lanes a, Lanes b) { return _mm512_maskz_min_pd(0xff, a, b); }
inline Lanes magnitude(Lanes a) { return _mm512_abs_pd(a); }
#elif defined(__AVX__)
inline Lanes larger(Lanes a, Lanes b) { return _mm256_max_pd(a, b); }
inline Lanes smaller(Lanes a, Lanes b) { return _mm256_min_pd(a, b); }
inline Lanes magnitude(Lanes a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
#endif

inline double square_root(double x) { return __builtin_sqrt(x); }
/// With AVX-512 to a unit in the last place, from an estimate y of 1/√x within 2^−14: x y (1 − e)^(−1/2) with
/// e = 1 − x y², a series to e³ (leaving less than 1e-16): the root itself takes several times as long.
inline Lanes square_root(Lanes x) {
#if defined(__AVX512F__)
  const Lanes y = _mm512_maskz_rsqrt14_pd(0xff, x), r = x * y, e = 1.0 - r * y;
  return x == 0.0 ? x : r + r * e * (0.5 + e * (0.375 + e * 0.3125));
#else
  Lanes r{};
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrt(x[i]);
  return r;
#endif
}

inline double quotient(double a, double b) { return a / b; }
/// a/b; with AVX-512 to two units in the last place, from an estimate y of 1/b within 2^−14: a y (1 + e + e²
/// + e³), e = 1 − b y, for b that is neither tiny (1e-300) nor huge.
inline Lanes quotient(Lanes a, Lanes b) {
#if defined(__AVX512F__)
  const Lanes y = _mm512_maskz_rcp14_pd(0xff, b), e = 1.0 - b * y, q = a * y;
  return q + q * (e + e * e * (1.0 + e));
#else
  return a / b;
#endif
}

/// Largest integer not above x, as a double; |x| < 2^51.
template <class V>
inline V floor_of(V x) {
  constexpr double magic = 6755399441055744.0;  // 1.5 · 2^52: adding it rounds to the nearest integer
  V nearest = (x + magic) - magic;
  return nearest > x ? nearest - 1.0 : nearest;
}

// Lanes as a set, for guards: a machine that has registers for sets narrows one by one instruction a
// comparison.
#if defined(__AVX512F__)
using LaneSet = __mmask8;
inline LaneSet leading_lanes(int n) { return static_cast<LaneSet>(n >= kLanes ? 0xff : (1u << n) - 1); }
/// Those of `among` where a < b; never where one is not a number.
inline LaneSet where_less(LaneSet among, Lanes a, Lanes b) {
  return _mm512_mask_cmp_pd_mask(among, a, b, _CMP_LT_OQ);
}
inline bool same_lanes(LaneSet a, LaneSet b) { return a == b; }
#else
using LaneSet = IntLanes;
inline LaneSet where_less(LaneSet among, Lanes a, Lanes b) { return among & (a < b); }
inline bool same_lanes(LaneSet a, LaneSet b) { return !any_of(a ^ b); }
inline LaneSet leading_lanes(int n) {
  IntLanes lane;
  for (int i = 0; i < kLanes; ++i) lane[i] = i;
  return lane < static_cast<std::int64_t>(n);
}
#endif

/// Mask of the first n lanes, or of all.
inline IntLanes lanes_before(int n) {
  IntLanes lane;
  for (int i = 0; i < kLanes; ++i) lane[i] = i;
  return lane < static_cast<std::int64_t>(n);
}

inline double sum_of(double x) { return x; }
inline double sum_of(Lanes x) {
  double s = 0;
  for (int i = 0; i < kLanes; ++i) s += x[i];
  return s;
}

/// The lanes a distance that is a power of two away change places.
template <int Distance>
inline Lanes swap_lanes(Lanes x) {
  const auto swap = [&]<int... I>(std::integer_sequence<int, I...>) {
    return __builtin_shufflevector(x, x, (I ^ Distance)...);
  };
  return swap(std::make_integer_sequence<int, kLanes>());
}

/// The sums of neighbouring lanes, those of a before those of b.
inline Lanes add_neighbours(Lanes a, Lanes b) {
  const auto add = [&]<int... I>(std::integer_sequence<int, I...>) {
    return __builtin_shufflevector(a, b, (2 * I)...) + __builtin_shufflevector(a, b, (2 * I + 1)...);
  };
  return add(std::make_integer_sequence<int, kLanes>());
}

inline double largest_of(Lanes x) {
  if constexpr (kLanes > 4) x = larger(x, swap_lanes<4>(x));
  if constexpr (kLanes > 2) x = larger(x, swap_lanes<2>(x));
  return larger(x, swap_lanes<1>(x))[0];
}

/// Transposes four records in place: row i of the result holds component i of each.
inline void transpose(Record (&row)[4]) {
  const Record ab_even = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6),
               ab_odd = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const Record cd_even = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6),
               cd_odd = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  row[2] = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  row[3] = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// The same of eight wide records.
inline void transpose(WideRecord (&row)[8]) {
  WideRecord pairs[8], fours[8];
  for (int i = 0; i < 8; i += 2) {  // components of two records side by side
    pairs[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto every_other = [](WideRecord a, WideRecord b, WideRecord& even, WideRecord& odd) {
    even = __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
    odd = __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
  };
  for (int i = 0; i < 8; i += 4)
    for (int odd = 0; odd < 2; ++odd)
      every_other(pairs[i + odd], pairs[i + odd + 2], fours[i + odd], fours[i + odd + 2]);
  for (int c = 0; c < 4; ++c) every_other(fours[c], fours[c + 4], row[c], row[c + 4]);
}

}  // namespace mpmfast

#pragma GCC diagnostic pop
