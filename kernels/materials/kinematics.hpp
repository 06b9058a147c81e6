#pragma once

/// @file Strain measures from the row-major deformation gradient, for a double or for Lanes. In 2-D, plane
/// strain: F_zz = 1. Symmetric tensors in the order xx, yy, zz, xy, yz, xz.

#include "kernels/constants.hpp"
#include "kernels/materials/matrix_exponential.hpp"
#include "kernels/simd/lanes.hpp"
#include "kernels/tensor.hpp"

namespace mpmfast {

template <int Dim, class V>
inline V determinant(const V (&f)[Dim * Dim]) {
  if constexpr (Dim == 2) {
    return f[0] * f[3] - f[1] * f[2];
  } else {
    return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
           f[2] * (f[3] * f[7] - f[4] * f[6]);
  }
}

/// A matrix row by row and its inverse; it must have one.
template <int Dim, class V>
inline void invert(const V (&f)[Dim * Dim], V (&inverse)[Dim * Dim]) {
  const V scale = 1.0 / determinant<Dim>(f);
  if constexpr (Dim == 2) {
    inverse[0] = scale * f[3];
    inverse[1] = -scale * f[1];
    inverse[2] = -scale * f[2];
    inverse[3] = scale * f[0];
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {  // the cofactor of (j, i); indices go round, which has its sign
        const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        inverse[3 * i + j] = scale * (f[3 * r + c] * f[3 * s + d] - f[3 * r + d] * f[3 * s + c]);
      }
  }
}

/// B = F Fᵀ.
template <int Dim, class V>
inline void left_cauchy_green(const V (&f)[Dim * Dim], V (&b)[kSymmetric<Dim>]) {
  if constexpr (Dim == 2) {
    b[0] = f[0] * f[0] + f[1] * f[1];
    b[1] = f[2] * f[2] + f[3] * f[3];
    b[2] = broadcast<V>(1.0);
    b[3] = f[0] * f[2] + f[1] * f[3];
  } else {
    b[0] = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
    b[1] = f[3] * f[3] + f[4] * f[4] + f[5] * f[5];
    b[2] = f[6] * f[6] + f[7] * f[7] + f[8] * f[8];
    b[3] = f[0] * f[3] + f[1] * f[4] + f[2] * f[5];
    b[4] = f[3] * f[6] + f[4] * f[7] + f[5] * f[8];
    b[5] = f[0] * f[6] + f[1] * f[7] + f[2] * f[8];
  }
}

/// dev(B) of a 3-D tensor, from differences: no stress comes of round-off where B = I, so that what rests
/// stays at rest to the last bit.
template <int Dim, class V>
inline void deviator(const V (&b)[kSymmetric<Dim>], V (&dev)[kSymmetric<Dim>]) {
  const V d01 = b[0] - b[1], d12 = b[1] - b[2], d20 = b[2] - b[0];
  dev[0] = (d01 - d20) * (1.0 / 3.0);
  dev[1] = (d12 - d01) * (1.0 / 3.0);
  dev[2] = (d20 - d12) * (1.0 / 3.0);
  for (int c = 3; c < kSymmetric<Dim>; ++c) dev[c] = b[c];
}

/// ε = sym(F) − I.
template <int Dim, class V>
inline void small_strain(const V (&f)[Dim * Dim], V (&e)[kSymmetric<Dim>]) {
  if constexpr (Dim == 2) {
    e[0] = f[0] - 1.0;
    e[1] = f[3] - 1.0;
    e[2] = broadcast<V>(0.0);
    e[3] = 0.5 * (f[1] + f[2]);
  } else {
    e[0] = f[0] - 1.0;
    e[1] = f[4] - 1.0;
    e[2] = f[8] - 1.0;
    e[3] = 0.5 * (f[1] + f[3]);
    e[4] = 0.5 * (f[5] + f[7]);
    e[5] = 0.5 * (f[2] + f[6]);
  }
}

/// A lower bound of the smallest eigenvalue of B over directions in the plane (2-D: exact) or in space.
/// 3-D: J² = b1 b2 b3 ≤ b1 ((I1 − b1)/2)² gives b1 ≥ 4J²/(I1 − b1)²; from b1 = 0 this rises to the bound.
/// Near isotropy it converges slowly, and the other bound, mean − 2p with 6p² = dev B : dev B, is the better
/// one.
template <int Dim, class V>
inline V smallest_stretch_squared(const V (&b)[kSymmetric<Dim>], V j) {
  if constexpr (Dim == 2) {
    const V mean = 0.5 * (b[0] + b[1]), half = 0.5 * (b[0] - b[1]);
    return mean - square_root(half * half + b[3] * b[3]);
  } else {
    const V i1 = b[0] + b[1] + b[2], j2 = 4.0 * j * j;
    V b1 = broadcast<V>(0.0);
    for (int k = 0; k < constants::kStretchIterations; ++k) b1 = quotient(j2, (i1 - b1) * (i1 - b1));
    const V mean = i1 * (1.0 / 3.0), d0 = b[0] - mean, d1 = b[1] - mean, d2 = b[2] - mean;
    const V deviator = d0 * d0 + d1 * d1 + d2 * d2 + 2.0 * (b[3] * b[3] + b[4] * b[4] + b[5] * b[5]);
    return larger(b1, mean - 2.0 * square_root(deviator * (1.0 / 6.0)));
  }
}

/// As `terms`: the whole exponential.
inline constexpr int kAllTerms = 0;
/// As `terms`: (I − Δt L)⁻¹, exact where L is the gradient at the end of the motion.
inline constexpr int kInverse = -1;

/// The largest eigenvalue of B over directions in the plane (2-D: exact) or an upper bound of it (3-D): mean
/// + 2p with 6p² = dev B : dev B.
template <int Dim, class V>
inline V largest_stretch_squared(const V (&b)[kSymmetric<Dim>]) {
  if constexpr (Dim == 2) {
    const V mean = 0.5 * (b[0] + b[1]), half = 0.5 * (b[0] - b[1]);
    return mean + square_root(half * half + b[3] * b[3]);
  } else {
    const V mean = (b[0] + b[1] + b[2]) * (1.0 / 3.0), d0 = b[0] - mean, d1 = b[1] - mean, d2 = b[2] - mean;
    const V deviator = d0 * d0 + d1 * d1 + d2 * d2 + 2.0 * (b[3] * b[3] + b[4] * b[4] + b[5] * b[5]);
    return mean + 2.0 * square_root(deviator * (1.0 / 6.0));
  }
}

/// a ← (I − a)⁻¹ − I; zero stays zero to the last bit.
template <int Dim, class V>
inline void invert_increment(V (&a)[Dim * Dim]) {
  // (I − a)⁻¹ − I = a adj(I − a)/det(I − a), and a adj(I − a) = a − det(a) I in the plane.
  if constexpr (Dim == 2) {
    const V det = determinant<2>(a), scale = 1.0 / (1.0 - a[0] - a[3] + det);
    a[0] = (a[0] - det) * scale;
    a[3] = (a[3] - det) * scale;
    a[1] = a[1] * scale;
    a[2] = a[2] * scale;
  } else {
    V y[9], adjugate[9], out[9];
    for (int i = 0; i < 9; ++i) y[i] = i % 4 == 0 ? 1.0 - a[i] : -a[i];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        adjugate[3 * i + j] = y[3 * r + c] * y[3 * s + d] - y[3 * r + d] * y[3 * s + c];
      }
    const V scale = 1.0 / (y[0] * adjugate[0] + y[1] * adjugate[3] + y[2] * adjugate[6]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        out[3 * i + j] =
            a[3 * i] * adjugate[j] + a[3 * i + 1] * adjugate[3 + j] + a[3 * i + 2] * adjugate[6 + j];
    for (int i = 0; i < 9; ++i) a[i] = out[i] * scale;
  }
}

/// The increment a of F ← (I + a) F over a step: Δt L [+ ½ Δt² L²], the exponential of the velocity gradient
/// to one or two terms, or all of it; or its inverse form, (I − Δt L)⁻¹ − I.
/// @param l row-major velocity gradient, 1/s
template <int Dim, class V>
[[gnu::always_inline]] inline void deformation_increment(const V (&l)[Dim * Dim], double dt, int terms,
                                                         V (&a)[Dim * Dim]) {
  if (terms == kAllTerms) {
    for (int i = 0; i < Dim * Dim; ++i) a[i] = broadcast<V>(i % (Dim + 1) == 0 ? 1.0 : 0.0);
    advance_by_exponential<Dim>(l, dt, a);
    for (int d = 0; d < Dim; ++d) a[(Dim + 1) * d] -= 1.0;
    return;
  }
  for (int i = 0; i < Dim * Dim; ++i) a[i] = dt * l[i];
  if (terms == kInverse) return invert_increment<Dim>(a);
  if (terms > 1) {
    V square[Dim * Dim];
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        V s = a[Dim * i] * a[j];
        for (int k = 1; k < Dim; ++k) s += a[Dim * i + k] * a[Dim * k + j];
        square[Dim * i + j] = s;
      }
    for (int i = 0; i < Dim * Dim; ++i) a[i] += 0.5 * square[i];
  }
}

/// F ← (I + a) F. (Always inline: among all the laws of one unit a compiler makes it a call, through memory.)
template <int Dim, class V>
[[gnu::always_inline]] inline void deform(const V (&a)[Dim * Dim], V (&f)[Dim * Dim]) {
  V g[Dim * Dim];
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      V s = f[Dim * i + j];
      for (int k = 0; k < Dim; ++k) s += a[Dim * i + k] * f[Dim * k + j];
      g[Dim * i + j] = s;
    }
  for (int i = 0; i < Dim * Dim; ++i) f[i] = g[i];
}

/// F ← (I + Δt L [+ ½ Δt² L²]) F, exp(Δt L) F or (I − Δt L)⁻¹ F. (Always inline, as deform.)
template <int Dim, class V>
[[gnu::always_inline]] inline void advance_deformation(const V (&l)[Dim * Dim], double dt, int terms,
                                                       V (&f)[Dim * Dim]) {
  if (terms == kAllTerms) return advance_by_exponential<Dim>(l, dt, f);
  V a[Dim * Dim];
  deformation_increment<Dim>(l, dt, terms, a);
  deform<Dim>(a, f);
}

/// Component of the symmetric tensor storage that holds (i, j).
template <int Dim>
constexpr int symmetric_index(int i, int j) {
  return i == j ? i : (Dim == 2 ? 3 : i + j == 1 ? 3 : i + j == 3 ? 4 : 5);
}

/// (I + a) b (I + a)ᵀ; plane strain leaves zz alone.
template <int Dim, class V>
inline void push_forward(const V (&a)[Dim * Dim], const V (&b)[kSymmetric<Dim>], V (&out)[kSymmetric<Dim>]) {
  V half[Dim * Dim];  // (I + a) b
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      V s = b[symmetric_index<Dim>(i, j)];
      for (int k = 0; k < Dim; ++k) s += a[Dim * i + k] * b[symmetric_index<Dim>(k, j)];
      half[Dim * i + j] = s;
    }
  for (int c = 0; c < kSymmetric<Dim>; ++c) out[c] = b[c];
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j) {
      V s = half[Dim * i + j];
      for (int k = 0; k < Dim; ++k) s += half[Dim * i + k] * a[Dim * j + k];
      out[symmetric_index<Dim>(i, j)] = s;
    }
}

/// d : d.
template <int Dim, class V>
inline V contraction(const V (&d)[kSymmetric<Dim>]) {
  V s = d[3] * d[3];
  for (int c = 4; c < kSymmetric<Dim>; ++c) s += d[c] * d[c];
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + 2.0 * s;
}

template <int Dim, class V>
inline V symmetric_determinant(const V (&d)[kSymmetric<Dim>]) {
  if constexpr (Dim == 2)
    return d[2] * (d[0] * d[1] - d[3] * d[3]);
  else
    return d[0] * (d[1] * d[2] - d[4] * d[4]) - d[3] * (d[3] * d[2] - d[4] * d[5]) +
           d[5] * (d[3] * d[4] - d[1] * d[5]);
}

}  // namespace mpmfast
