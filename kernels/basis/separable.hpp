#pragma once

/// @file Bases that are products of one-dimensional functions: linear, uGIMP, quadratic and cubic B-splines.
/// To add one: a struct with kDescription, kSupport, kSpread, first_node, weights and reach, an alias at the
/// end of the file, and its line in bases.hpp.

#include <cmath>

#include "kernels/basis/weights.hpp"
#include "kernels/constants.hpp"

namespace mpmfast {

/// Classic MPM: hat functions at the particle's point.
struct LinearFunction {
  static constexpr const char* kDescription = "classic: linear functions at the particle's point; a baseline";
  static constexpr int kSupport = 2;
  /// Σ_i w_i (r_i − r)² in cells², where it is the same for every r; else 0.
  static constexpr double kSpread = 0;
  /// Lowest node of the support for coordinate r in cells.
  template <class V>
  static V first_node(V r) {
    return floor_of(r);
  }
  /// Values and derivatives (per cell) on the support for s = r − first node; l: half-size in cells.
  template <class V>
  static void weights(V s, double, V (&w)[2], V (&g)[2]) {
    w[1] = s;
    w[0] = 1.0 - s;
    g[0] = broadcast<V>(-1.0);
    g[1] = broadcast<V>(1.0);
  }
  /// The function is non-zero for |r − r_i| below this; l: half-size in cells.
  static constexpr double reach(double) { return 1.0; }
};

/// uGIMP: the hat averaged over an undeformed domain of half-size l ≤ ½ cell (N20 Eq. 2 with a top-hat χ_p).
/// With s in [½, 3/2) the outer two nodes lie at distances a ≥ ½ ≥ l, where the average is 1 − a up to a = 1
/// − l and (1 + l − a)²/(4l) beyond; the middle one follows from the partition of unity.
struct UGimpFunction {
  static constexpr const char* kDescription =
      "generalised interpolation over the undeformed particle domain (default)";
  static constexpr int kSupport = 3;
  static constexpr double kSpread = 0;
  template <class V>
  static V first_node(V r) {
    return floor_of(r - 0.5);
  }
  template <class V>
  static void weights(V s, double l, V (&w)[3], V (&g)[3]) {
    const V below = outer(s, l, g[0]), above = outer(2.0 - s, l, g[2]);
    w[0] = below;
    w[2] = above;
    w[1] = 1.0 - below - above;
    g[0] = -g[0];
    g[1] = -(g[0] + g[2]);
  }
  static constexpr double reach(double l) { return 1.0 + l; }

 private:
  template <class V>
  static V outer(V a, double l, V& slope) {
    const V left = larger(1.0 + l - a, broadcast<V>(0.0));
    slope = a < 1.0 - l ? broadcast<V>(1.0) : left * (0.5 / l);
    return a < 1.0 - l ? 1.0 - a : left * left * (0.25 / l);
  }
};

/// Quadratic B-spline at the particle's point.
struct BSpline2Function {
  static constexpr const char* kDescription = "quadratic B-splines at the particle's point";
  static constexpr int kSupport = 3;
  static constexpr double kSpread = 0.25;
  template <class V>
  static V first_node(V r) {
    return floor_of(r - 0.5);
  }
  template <class V>
  static void weights(V s, double, V (&w)[3], V (&g)[3]) {
    const V below = 1.5 - s, above = s - 0.5, middle = s - 1.0;
    w[0] = 0.5 * below * below;
    w[1] = 0.75 - middle * middle;
    w[2] = 0.5 * above * above;
    g[0] = -below;
    g[1] = -2.0 * middle;
    g[2] = above;
  }
  static constexpr double reach(double) { return 1.5; }
};

/// Cubic B-spline at the particle's point.
struct BSpline3Function {
  static constexpr const char* kDescription = "cubic B-splines at the particle's point";
  static constexpr int kSupport = 4;
  static constexpr double kSpread = 1.0 / 3.0;
  template <class V>
  static V first_node(V r) {
    return floor_of(r) - 1.0;
  }
  template <class V>
  static void weights(V s, double, V (&w)[4], V (&g)[4]) {
    const V above = s - 1.0, below = 2.0 - s;  // distances from the two nodes around r
    const V above2 = above * above, below2 = below * below;
    w[0] = (1.0 / 6.0) * below2 * below;
    w[1] = (2.0 / 3.0) - above2 * (1.0 - 0.5 * above);
    w[2] = (2.0 / 3.0) - below2 * (1.0 - 0.5 * below);
    w[3] = (1.0 / 6.0) * above2 * above;
    g[0] = -0.5 * below2;
    g[1] = above * (1.5 * above - 2.0);
    g[2] = below * (2.0 - 1.5 * below);
    g[3] = 0.5 * above2;
  }
  static constexpr double reach(double) { return 2.0; }
};

/// Tensor product of a one-dimensional function.
template <int Dim, class Function>
struct SeparableBasis {
  static constexpr int kMinSupport = Function::kSupport, kMaxSupport = Function::kSupport;
  static constexpr bool kConvected = false;  ///< needs no half-edge vectors
  static constexpr bool kOverDomain = Function::reach(0.5) > Function::reach(0);
  static constexpr double kSpread = Function::kSpread, kGridReach = Function::reach(0);
  static constexpr const char* kDescription = Function::kDescription;

  template <int K>
  using Weights = ProductWeights<Dim, K>;

  /// Stages the weights of a chunk. @return false if a support leaves the window.
  template <Wanted W = Wanted::both, int K>
  static bool stage(const ChunkGeometry<Dim>& g, ProductWeights<Dim, K>& out) {
    static_assert(K == Function::kSupport);
    bool inside = true;
    for (int k = 0; k < g.count; k += kLanes) {
      Lanes node[Dim];
      for (int d = 0; d < Dim; ++d) {
        Lanes value[K], slope[K];
        const Lanes r = (load_lanes(g.position[d] + k) - g.origin[d]) * g.inverse_cell;
        node[d] = Function::first_node(r);
        Function::weights(r - node[d], g.half_size[d] * g.inverse_cell, value, slope);
        for (int i = 0; i < K; ++i)
          store_pairs(out.factor[d][i][k], value[i],
                      W == Wanted::values ? Lanes{} : slope[i] * g.inverse_cell);
      }
      const LaneSet all = leading_lanes(g.count - k);
      inside &= same_lanes(locate_in_window<Dim, K>(all, node, g, out.first + k), all);
    }
    return inside;
  }

  /// Lowest node (coordinates) of the support of particle k.
  static NodeIndex<Dim> first_node(const ChunkGeometry<Dim>& g, int k) {
    NodeIndex<Dim> node;
    for (int d = 0; d < Dim; ++d)
      node[d] = node_at(
          Function::first_node((g.position[d][k] - g.origin[d]) * g.inverse_cell + constants::kSupportEdge));
    return node;
  }

  /// Along axis d, the function is zero further from the particle than this; cells.
  static Lanes reach(const ChunkGeometry<Dim>& g, int, int d) {
    return broadcast<Lanes>(Function::reach(g.half_size[d] * g.inverse_cell));
  }

  /// For particles k … k + kLanes − 1: is S_pi non-zero at the node with these coordinates?
  /// @return positive where it is
  static Lanes coverage(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    Lanes margin = broadcast<Lanes>(constants::kUnbounded);
    for (int d = 0; d < Dim; ++d) {
      const Lanes r = (load_lanes(g.position[d] + k) - g.origin[d]) * g.inverse_cell;
      const double reach = Function::reach(g.half_size[d] * g.inverse_cell) - constants::kSupportEdge;
      margin = smaller(margin, reach - magnitude(r - static_cast<double>(node[d])));
    }
    return margin;
  }
  static bool covers(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    return coverage(g, k, node)[0] > 0;
  }
};

template <int Dim>
using LinearBasis = SeparableBasis<Dim, LinearFunction>;
template <int Dim>
using UGimpBasis = SeparableBasis<Dim, UGimpFunction>;
template <int Dim>
using BSpline2Basis = SeparableBasis<Dim, BSpline2Function>;
template <int Dim>
using BSpline3Basis = SeparableBasis<Dim, BSpline3Function>;

}  // namespace mpmfast
