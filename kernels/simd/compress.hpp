#pragma once

/// @file Selecting lanes: masks as bits, and the chosen lanes side by side.

#include <bit>

#include "kernels/simd/lanes.hpp"

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#include <immintrin.h>
#define MPMFAST_COMPRESS_LANES 1
#else
#define MPMFAST_COMPRESS_LANES 0
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// Bit i: lane i of a comparison holds.
inline unsigned lane_bits(IntLanes mask) {
#if MPMFAST_COMPRESS_LANES
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#else
  unsigned bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= static_cast<unsigned>(mask[i] & 1) << i;
  return bits;
#endif
}

/// The first n lanes, 0 ≤ n ≤ kLanes.
constexpr unsigned first_lanes(int n) { return (1u << n) - 1; }

/// Writes the lanes of `bits` side by side; up to kLanes places from p on are overwritten.
inline void store_chosen(double* p, Lanes v, unsigned bits) {
#if MPMFAST_COMPRESS_LANES
  // In a register: to memory, the instruction itself is slow on some processors.
  store_lanes(p, reinterpret_cast<Lanes>(
                     _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), reinterpret_cast<__m512d>(v))));
#else
  for (; bits; bits &= bits - 1) *p++ = v[std::countr_zero(bits)];
#endif
}

}  // namespace mpmfast

#undef MPMFAST_COMPRESS_LANES
#pragma GCC diagnostic pop
