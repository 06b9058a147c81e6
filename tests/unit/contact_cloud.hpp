#pragma once

/// @file Clouds of contact nodes for tests: growable, padded as the kernels ask.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast::test {

template <int Dim>
struct Cloud {
  std::array<std::vector<double>, Dim> xi;
  std::vector<double> side;
  int count = 0;

  void add(const Vec<Dim>& x, double c) {
    const auto k = static_cast<std::size_t>(count++);
    const auto padded = static_cast<std::size_t>(padded_count(count));
    for (auto& column : xi) column.resize(padded, 0.0);
    side.resize(padded, 0.0);
    for (int d = 0; d < Dim; ++d) xi[static_cast<std::size_t>(d)][k] = x[d];
    side[k] = c;
  }

  CloudView<Dim> view() const {
    CloudView<Dim> v;
    for (std::size_t d = 0; d < Dim; ++d) v.xi[d] = xi[d].data();
    v.side = side.data();
    v.count = count;
    return v;
  }
};

using Draw = std::mt19937_64;

inline double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

template <int Dim>
Vec<Dim> random_direction(Draw& draw) {
  std::normal_distribution<double> gauss;
  Vec<Dim> n;
  for (int d = 0; d < Dim; ++d) n[d] = gauss(draw);
  return n.normalized();
}

/// A rotation whose first column is n.
template <int Dim>
Mat<Dim> rotation_to(const Vec<Dim>& n, Draw& draw) {
  Mat<Dim> r;
  r.col(0) = n;
  if constexpr (Dim == 2) {
    r.col(1) << -n[1], n[0];
    static_cast<void>(draw);
  } else {
    Vec<3> t = random_direction<3>(draw);
    t = (t - t.dot(n) * n).normalized();
    r.col(1) = t;
    r.col(2) = n.cross(t);
  }
  return r;
}

/// Angle between two directions, rad; exact for small angles too.
template <int Dim>
double angle_between(const Vec<Dim>& a, const Vec<Dim>& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * (a.normalized() - b.normalized()).norm()));
}

/// Two blocks that touch at a plane with normal `r.col(0)`, `offset` cells from the node: lattices of two
/// particles a cell side, aligned with the plane, each moved by up to `jitter` of their spacing; those inside
/// the box |ξ| < reach.
template <int Dim>
Cloud<Dim> touching_blocks(const Mat<Dim>& r, double offset, double jitter, double reach, Draw& draw) {
  constexpr double spacing = 0.5;
  constexpr int half = 6;
  Vec<Dim> phase;
  for (int d = 0; d < Dim; ++d) phase[d] = uniform(draw, 0, spacing);
  phase[0] = offset + 0.5 * spacing;  // the plane lies midway between two layers
  Cloud<Dim> cloud;
  for (int n = 0; n < power(2 * half, Dim); ++n) {
    Vec<Dim> y;
    for (int d = 0, rest = n; d < Dim; ++d, rest /= 2 * half)
      y[d] = spacing * (rest % (2 * half) - half) + phase[d] + spacing * uniform(draw, -jitter, jitter);
    const Vec<Dim> x = r * y;
    if (x.cwiseAbs().maxCoeff() < reach) cloud.add(x, n % (2 * half) < half ? -1.0 : 1.0);
  }
  return cloud;
}

}  // namespace mpmfast::test
