#pragma once

/// @file exp(A) of a small row-major matrix, on a double or on Lanes, free of branches.
///
/// With t = tr A / Dim and D = A − t I: exp(A) = e^t exp(D), so that det exp(A) = e^(tr A) as far as the
/// series of exp(D) has converged. By Cayley and Hamilton the powers of the traceless D stay in a small
/// space:
///   2-D: D² = q I with q = −det D, hence exp(D) = Σ q^n/(2n)! I + Σ q^n/(2n+1)! D (cosh and sinh, or cos and
///   sin);
///   3-D: D³ = q D + r I with q = ½ tr D², r = det D, hence D^n = a_n I + b_n D + c_n D² with
///   a_n+1 = r c_n, b_n+1 = a_n + q c_n, c_n+1 = b_n.
/// The series run to D^25: beyond |D| = 3, where no step of a simulation comes, the remainder exceeds
/// round-off.

#include "kernels/constants.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

namespace detail {

template <class V>
inline void traceless_exponential(const V (&d)[4], V (&e)[4]) {
  const V q = d[1] * d[2] - d[0] * d[3];
  V even = broadcast<V>(1.0), odd = broadcast<V>(1.0);
  for (int n = constants::kExponentialPowers - 1; n >= 2; n -= 2) {  // Horner, from the last term
    even = 1.0 + even * q * (1.0 / (n * (n - 1)));
    odd = 1.0 + odd * q * (1.0 / (n * (n + 1)));
  }
  for (int i = 0; i < 4; ++i) e[i] = odd * d[i];
  e[0] += even;
  e[3] += even;
}

template <class V>
inline void traceless_exponential(const V (&d)[9], V (&e)[9]) {
  V square[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      square[3 * i + j] = d[3 * i] * d[j] + d[3 * i + 1] * d[3 + j] + d[3 * i + 2] * d[6 + j];
  const V q = 0.5 * (square[0] + square[4] + square[8]);
  V r = broadcast<V>(0.0);  // det D = ⅓ tr D³ where tr D = 0
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r += (1.0 / 3.0) * square[3 * i + j] * d[3 * j + i];
  // D^n/n! = a I + b D + c D², from n = 2 on; their sums.
  V a = broadcast<V>(0.0), b = a, c = broadcast<V>(0.5);
  V identity = broadcast<V>(1.0), linear = identity, quadratic = c;
  for (int n = 3; n <= constants::kExponentialPowers; ++n) {
    const double share = 1.0 / n;
    const V next = r * c * share;
    c *= share;
    const V b_next = a * share + q * c;
    c = b * share;
    a = next;
    b = b_next;
    identity += a;
    linear += b;
    quadratic += c;
  }
  for (int i = 0; i < 9; ++i) e[i] = linear * d[i] + quadratic * square[i];
  for (int i = 0; i < 9; i += 4) e[i] += identity;
}

}  // namespace detail

/// @param a row-major; @param e exp(a)
template <int Dim, class V>
inline void matrix_exponential(const V (&a)[Dim * Dim], V (&e)[Dim * Dim]) {
  V mean = a[0];
  for (int i = 1; i < Dim; ++i) mean += a[(Dim + 1) * i];
  mean *= 1.0 / Dim;
  V d[Dim * Dim];
  for (int i = 0; i < Dim * Dim; ++i) d[i] = i % (Dim + 1) == 0 ? a[i] - mean : a[i];
  detail::traceless_exponential(d, e);
  const V dilation = exponential(mean);
  for (auto& v : e) v *= dilation;
}

/// F ← exp(Δt L) F. Kept out of line: the loops that call it hold the truncated forms, which must stay short.
template <int Dim, class V>
[[gnu::noinline]] void advance_by_exponential(const V (&l)[Dim * Dim], double dt, V (&f)[Dim * Dim]) {
  V a[Dim * Dim], e[Dim * Dim], old[Dim * Dim];
  for (int i = 0; i < Dim * Dim; ++i) {
    a[i] = dt * l[i];
    old[i] = f[i];
  }
  matrix_exponential<Dim>(a, e);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      V s = e[Dim * i] * old[j];
      for (int k = 1; k < Dim; ++k) s += e[Dim * i + k] * old[Dim * k + j];
      f[Dim * i + j] = s;
    }
}

}  // namespace mpmfast
