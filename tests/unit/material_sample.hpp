#pragma once

/// @file One particle of an evolving law, strained step by step.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "kernels/dimension.hpp"
#include "kernels/materials/metal.hpp"

namespace mpmfast::test {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// One particle that is strained step by step.
template <int Dim, class Law>
struct Sample {
  Law law;
  double f[Dim * Dim]{}, tau[kSymmetric<Dim>]{}, c2 = 0;
  MaterialState<Dim, double> state = resting_state<Dim, double>(law.start_temperature);

  explicit Sample(const Law& l) : law(l) {
    for (int d = 0; d < Dim; ++d) f[(Dim + 1) * d] = 1;
  }
  double volume() const { return determinant<Dim>(f); }
  /// Strains by F ← exp(dt L) F (two terms of it), and returns the work ∫ τ:d dt by the mean stress.
  double strain(const Mat<Dim>& gradient, double dt) {
    double l[Dim * Dim], a[Dim * Dim], old[kSymmetric<Dim>];
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) l[Dim * i + j] = gradient(i, j);
    for (int c = 0; c < kSymmetric<Dim>; ++c) old[c] = tau[c];
    const double before = volume();
    deformation_increment<Dim>(l, dt, 2, a);
    deform<Dim>(a, f);
    law.template advance<Dim>(StrainStep<Dim, double>{a, f, before, volume(), gradient.trace(), dt}, state,
                              tau, c2);
    double work = 0;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        const int c = symmetric_index<Dim>(i, j);
        work += 0.5 * (old[c] + tau[c]) * gradient(i, j) * dt;
      }
    state.volume_ratio = volume();
    return work;
  }
  Mat<3> stress() const {
    Mat<3> t = Vec<3>(tau[0], tau[1], tau[2]).asDiagonal();
    t(0, 1) = t(1, 0) = tau[3];
    if constexpr (Dim == 3) {
      t(1, 2) = t(2, 1) = tau[4];
      t(0, 2) = t(2, 0) = tau[5];
    }
    return t;
  }
  double von_mises() const {
    const Mat<3> t = stress();
    return std::sqrt(1.5) * (t - t.trace() / 3 * Mat<3>::Identity()).norm();
  }
  double energy() const { return law.template energy<Dim>(f, state); }
};

template <int Dim>
Mat<Dim> random_matrix(std::mt19937_64& draw, double size) {
  Mat<Dim> m;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) m(i, j) = std::uniform_real_distribution<double>(-size, size)(draw);
  return m;
}

}  // namespace mpmfast::test
