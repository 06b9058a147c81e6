#pragma once

/// @file The contact normal of widest margin: the plane that parts two clouds and stays as far from both as
/// it can, which is the limit of logistic regression for a vanishing penalty and endless iterations. It is
/// normal to the line between the nearest points of the two convex hulls, found by the algorithm of Gilbert,
/// Johnson and Keerthi (1988). The planes of flat surfaces come out exactly, however few particles of one of
/// them the cloud holds, where a regression of few iterations leans towards the centroids.

#include <cmath>
#include <limits>

#include "kernels/constants.hpp"
#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/support.hpp"

namespace mpmfast {

template <int Dim>
struct Margin {
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, from a to b; zero where the hulls meet or a class is empty
  double distance{};                   ///< between the hulls, cells
  int iterations{};                    ///< passes over the cloud
};

namespace detail {

/// The entry of each class that lies furthest along side · direction; −1: a class is empty.
template <int Dim>
struct Support {
  int a, b;

  Support(const CloudView<Dim>& cloud, const Vec<Dim>& direction) {
    SupportSearch of_a, of_b;
    for (int k = 0; k < cloud.count; k += kLanes) {
      const Lanes side = load_lanes(cloud.side + k);
      Lanes s = load_lanes(cloud.xi[0] + k) * direction[0];
      for (int d = 1; d < Dim; ++d) s += load_lanes(cloud.xi[d] + k) * direction[d];
      s *= side;
      of_a.take(s, side < 0.0);
      of_b.take(s, side > 0.0);
    }
    a = of_a.found().at;
    b = of_b.found().at;
  }
};

/// Up to Dim + 1 points of the difference of the hulls, and the point of their hull nearest to the origin.
template <int Dim>
class Simplex {
 public:
  const Vec<Dim>& nearest() const { return nearest_; }
  int size() const { return count_; }

  /// Adds a point and keeps the smallest face that holds the new nearest point.
  /// @return false if the nearest point did not come nearer (round-off)
  bool add(const Vec<Dim>& point) {
    point_[count_++] = point;
    double best = count_ == 1 ? std::numeric_limits<double>::infinity() : nearest_.squaredNorm();
    int face = 0;
    for (int chosen = 1; chosen < (1 << count_); ++chosen) {
      if (!(chosen >> (count_ - 1) & 1)) continue;  // faces without the new point were judged before
      Vec<Dim> candidate;
      if (!nearest_on(chosen, candidate) || !(candidate.squaredNorm() < best)) continue;
      best = candidate.squaredNorm();
      nearest_ = candidate;
      face = chosen;
    }
    if (face == 0) return false;
    int kept = 0;
    for (int i = 0; i < count_; ++i)
      if (face >> i & 1) point_[kept++] = point_[i];
    count_ = kept;
    return true;
  }

 private:
  /// The point of the plane through the chosen points that is nearest to the origin.
  /// @return whether it lies among them
  bool nearest_on(int chosen, Vec<Dim>& out) const {
    int index[Dim + 1] = {}, n = 0;
    for (int i = 0; i < count_; ++i)
      if (chosen >> i & 1) index[n++] = i;
    const Vec<Dim>& origin = point_[index[0]];
    if (n == 1) {
      out = origin;
      return true;
    }
    if (n == 2) return nearest_on_line(origin, point_[index[1]], out);
    Vec<Dim> edge[Dim], right = Vec<Dim>::Zero(), share = Vec<Dim>::Zero();
    Mat<Dim> gram = Mat<Dim>::Identity();
    for (int i = 1; i < n; ++i) {
      edge[i - 1] = point_[index[i]] - origin;
      right[i - 1] = -edge[i - 1].dot(origin);
      for (int j = 1; j <= i; ++j) gram(i - 1, j - 1) = gram(j - 1, i - 1) = edge[i - 1].dot(edge[j - 1]);
    }
    if (!solve(gram, right, n - 1, share)) return false;
    double rest = 1;
    out = origin;
    for (int i = 1; i < n; ++i) {
      if (share[i - 1] < 0) return false;
      rest -= share[i - 1];
      out += share[i - 1] * edge[i - 1];
    }
    return rest >= 0;
  }

  static bool nearest_on_line(const Vec<Dim>& from, const Vec<Dim>& to, Vec<Dim>& out) {
    const Vec<Dim> edge = to - from;
    const double share = -edge.dot(from) / edge.squaredNorm();
    if (!(share >= 0 && share <= 1)) return false;  // also for points that coincide
    out = from + share * edge;
    return true;
  }

  /// Elimination without pivoting: the matrix is a Gram matrix. @return false if it is singular
  static bool solve(Mat<Dim> a, Vec<Dim> b, int n, Vec<Dim>& x) {
    for (int j = 0; j < n; ++j) {
      if (!(a(j, j) > constants::kLeastGramPivot * a.diagonal().maxCoeff())) return false;
      for (int i = j + 1; i < n; ++i) {
        const double factor = a(i, j) / a(j, j);
        for (int k = j; k < n; ++k) a(i, k) -= factor * a(j, k);
        b[i] -= factor * b[j];
      }
    }
    for (int j = n - 1; j >= 0; --j) {
      x[j] = b[j];
      for (int k = j + 1; k < n; ++k) x[j] -= a(j, k) * x[k];
      x[j] /= a(j, j);
    }
    return true;
  }

  Vec<Dim> point_[Dim + 1], nearest_ = Vec<Dim>::Zero();
  int count_ = 0;
};

}  // namespace detail

/// The normal of widest margin of a cloud.
/// @param guess  a direction from a to b to begin with, not zero: the last step's normal, or the centroids'
/// difference
/// @param smallest  hulls nearer than this count as meeting, cells: their direction would be noise
template <int Dim>
inline Margin<Dim> widest_margin(const CloudView<Dim>& cloud, const Vec<Dim>& guess,
                                 double smallest = constants::kLeastHullDistance) {
  const auto entry = [&](int k) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = cloud.xi[d][k];
    return x;
  };
  Margin<Dim> result;
  detail::Simplex<Dim> simplex;
  Vec<Dim> v = -guess;  // from the hull of b to that of a
  while (result.iterations < constants::kHullPasses) {
    const detail::Support<Dim> support(cloud, v);
    ++result.iterations;
    if (support.a < 0 || support.b < 0) return result;
    const Vec<Dim> w = entry(support.a) - entry(support.b);
    // |v|² − v·w bounds the square of the distance to the solution.
    if (simplex.size() > 0 && v.squaredNorm() - v.dot(w) <= constants::kHullTolerance * v.squaredNorm())
      break;
    if (simplex.size() > Dim || !simplex.add(w)) break;
    v = simplex.nearest();
    if (!(v.squaredNorm() > smallest * smallest) || simplex.size() > Dim) return result;
  }
  result.distance = v.norm();
  result.normal = -v / result.distance;
  return result;
}

}  // namespace mpmfast
