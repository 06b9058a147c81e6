#pragma once

/// @file Branch-free exponential, logarithm and J^(−2/3) on a double or on Lanes, to a few units in the last
/// place. The compiler's own vector mathematics needs -ffast-math, which would switch off the checks for NaN.

#include "kernels/simd/lanes.hpp"

namespace mpmfast {

namespace detail {

inline constexpr double kRoundMagic = 6755399441055744.0;  ///< 1.5 · 2^52

inline std::int64_t bits_of(double x) {
  std::int64_t b;
  std::memcpy(&b, &x, sizeof b);
  return b;
}
inline IntLanes bits_of(Lanes x) {
  IntLanes b;
  std::memcpy(&b, &x, sizeof b);
  return b;
}
inline double from_bits(std::int64_t b) {
  double x;
  std::memcpy(&x, &b, sizeof x);
  return x;
}
inline Lanes from_bits(IntLanes b) {
  Lanes x;
  std::memcpy(&x, &b, sizeof x);
  return x;
}

}  // namespace detail

/// e^x. x is clamped to ±700, where the result neither overflows nor vanishes.
/// x = n ln 2 + r with |r| ≤ ½ ln 2; Taylor series of e^r to r^13 (remainder 4e-18); 2^n set in the exponent.
template <class V>
inline V exponential(V x) {
  x = smaller(larger(x, broadcast<V>(-700.0)), broadcast<V>(700.0));
  const V shifted = x * 1.4426950408889634074 + detail::kRoundMagic;
  const V n = shifted - detail::kRoundMagic;
  const V r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;  // ln 2 in two parts
  V s = broadcast<V>(1.0 / 6227020800.0);
  constexpr double inverse_factorial[] = {1.0 / 479001600.0,
                                          1.0 / 39916800.0,
                                          1.0 / 3628800.0,
                                          1.0 / 362880.0,
                                          1.0 / 40320.0,
                                          1.0 / 5040.0,
                                          1.0 / 720.0,
                                          1.0 / 120.0,
                                          1.0 / 24.0,
                                          1.0 / 6.0,
                                          0.5,
                                          1.0,
                                          1.0};
  for (double c : inverse_factorial) s = s * r + c;
  const auto exponent = (detail::bits_of(shifted) << 52) + detail::bits_of(broadcast<V>(1.0));
  return s * detail::from_bits(exponent);
}

/// ln x for normal positive x. x = m 2^e with m in [√½, √2); ln m = 2 atanh(s), s = (m − 1)/(m + 1), |s| ≤
/// 0.172.
template <class V>
__attribute__((no_sanitize("signed-integer-overflow")))  // of an x below zero, which has no logarithm
inline V
logarithm(V x) {
  constexpr std::int64_t sqrt_half = 0x3FE6A09E667F3BCD;
  const auto e = (detail::bits_of(x) - sqrt_half) >> 52;
  const auto m_bits = detail::bits_of(x) - (e << 52);
  const V m = detail::from_bits(m_bits);
  // An int64 exponent becomes a double by the magic number's bits: no 64-bit conversion instruction is
  // needed.
  const V exponent =
      detail::from_bits(e + detail::bits_of(broadcast<V>(detail::kRoundMagic))) - detail::kRoundMagic;
  const V s = (m - 1.0) / (m + 1.0), z = s * s;
  V t = broadcast<V>(1.0 / 23.0);
  for (int k = 21; k >= 3; k -= 2) t = t * z + 1.0 / k;
  return exponent * 0.693147180559945309417 + (s + s) * (t * z + 1.0);
}

/// 1/√x for normal positive x.
inline double inverse_root(double x) { return 1.0 / square_root(x); }
/// With AVX-512 from an estimate y within 2^−14: y (1 − e)^(−1/2) with e = 1 − x y², a series to e³ (leaving
/// less than 1e-16); a root and a division take several times as long.
inline Lanes inverse_root(Lanes x) {
#if defined(__AVX512F__)
  const Lanes y = _mm512_maskz_rsqrt14_pd(0xff, x), e = 1.0 - (x * y) * y;
  return y + y * e * (0.5 + e * (0.375 + e * 0.3125));
#else
  return 1.0 / square_root(x);
#endif
}

/// J^(−2/3), the isochoric factor of the neo-Hookean law, for normal positive J: the square of y = J^(−1/3).
/// The upper half of y's bits is first guessed as a line in that of J's (Moroz et al. 2021: within 3.5 %);
/// then y ← y (1 − e)^(−1/3) with e = 1 − J y³, a series to e⁴ (leaving |e| < 4e-6) and again to e² (below
/// 1e-17).
template <class V>
[[gnu::always_inline]] inline V isochoric_factor(V j) {
  constexpr double guess = detail::kRoundMagic + 1430188287.0;  // 0x553EF0FF
  const V upper =
      detail::from_bits((detail::bits_of(j) >> 32) + detail::bits_of(broadcast<V>(detail::kRoundMagic))) -
      detail::kRoundMagic;
  V y = detail::from_bits(detail::bits_of(guess - upper * (1.0 / 3.0)) << 32);
  V e = 1.0 - (j * y) * (y * y);
  y += y * (e * (1.0 / 3.0 + e * (2.0 / 9.0 + e * (14.0 / 81.0 + e * (35.0 / 243.0)))));
  e = 1.0 - (j * y) * (y * y);
  y += y * (e * (1.0 / 3.0 + e * (2.0 / 9.0)));
  return y * y;
}

}  // namespace mpmfast
