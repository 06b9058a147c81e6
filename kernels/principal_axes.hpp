#pragma once

/// @file Principal axes of a small matrix: its singular value decomposition A = U Σ Vᵀ.

#include <cmath>

#include "kernels/constants.hpp"

namespace mpmfast {

/// Turns the columns of a matrix into each other until they are orthogonal, A ← A V = U Σ, by one-sided
/// Jacobi rotations (Hestenes 1958). Their lengths are the singular values, in no order; each is as accurate
/// as the entries of A, however much smaller than the others.
/// @param a row-major; @param v row-major result, a rotation
template <int Dim>
inline void turn_to_principal_axes(double (&a)[Dim * Dim], double (&v)[Dim * Dim]) {
  for (int e = 0; e < Dim * Dim; ++e) v[e] = e % (Dim + 1) == 0 ? 1 : 0;
  bool turned = true;
  for (int sweep = 0; sweep < constants::kJacobiSweeps && turned; ++sweep) {
    turned = false;
    for (int j = 0; j < Dim; ++j)
      for (int k = j + 1; k < Dim; ++k) {
        double first = 0, second = 0, dot = 0;
        for (int i = 0; i < Dim * Dim; i += Dim) {
          first += a[i + j] * a[i + j];
          second += a[i + k] * a[i + k];
          dot += a[i + j] * a[i + k];
        }
        if (!(std::abs(dot) > constants::kJacobiRoundOff * std::sqrt(first * second))) continue;
        turned = true;
        const double ratio = (second - first) / (2 * dot);
        const double tangent = std::copysign(1 / (std::abs(ratio) + std::sqrt(1 + ratio * ratio)), ratio);
        const double cosine = 1 / std::sqrt(1 + tangent * tangent), sine = cosine * tangent;
        for (double* m : {a, v})
          for (int i = 0; i < Dim * Dim; i += Dim) {
            const double x = m[i + j], y = m[i + k];
            m[i + j] = cosine * x - sine * y;
            m[i + k] = sine * x + cosine * y;
          }
      }
  }
}

}  // namespace mpmfast
