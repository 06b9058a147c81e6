#pragma once

/// @file CPDI (Sadeghirad et al. 2011): the particle's domain is the parallelogram or parallelepiped with
/// half-edge vectors r_k, convected by F. The grid function is replaced by its multilinear interpolation from
/// the 2^Dim corners x_c = x_p + Σ_k s_ck r_k (s_ck = ±1), whose mean and mean gradient over the domain are
/// exact:
///   S_pi = 2^−Dim Σ_c N_i(x_c),   G_pi = R^−T 2^−Dim Σ_c s_c N_i(x_c),   R = [r_1 … r_Dim].
/// In 2-D and with linear N_i this is Sadeghirad's formula with full edge vectors. lCPDI has linear grid
/// functions, qCPDI quadratic B-splines (N20 §4.3), whose slopes do not jump where a corner crosses a node.

#include <cmath>

#include "kernels/basis/domain_limit.hpp"
#include "kernels/basis/weights.hpp"
#include "kernels/constants.hpp"

namespace mpmfast {

/// Linear grid functions.
struct HatCorner {
  static constexpr const char* kDescription =
      "linear functions over the domain convected with the deformation";
  static constexpr int kSupport = 2;   ///< nodes on which a point has weight
  static constexpr double kReach = 1;  ///< cells: the function is non-zero at smaller distances
  static constexpr double kLead = 0;   ///< the first of these nodes is floor(x − kLead)
  /// The function at distance t, in cells.
  template <class V>
  static V at(V t) {
    return larger(1.0 - magnitude(t), broadcast<V>(0.0));
  }
  /// On K nodes, of a point between the first and the last that is x beyond the second.
  template <int K, class V>
  static void on_nodes(V x, V (&weight)[K]) {
    if constexpr (K == 3) {
      weight[2] = larger(x, broadcast<V>(0.0));
      weight[0] = weight[2] - x;
      weight[1] = at(x);
    } else {
      for (int i = 0; i < K; ++i) weight[i] = at(x - double(i - 1));
    }
  }
};

/// Quadratic B-splines: ½(3/2 − |t|)², less 3/2 (½ − |t|)² in the middle piece, where that makes ¾ − t².
struct QuadraticCorner {
  static constexpr const char* kDescription =
      "quadratic B-splines over the domain convected with the deformation: smooth";
  static constexpr int kSupport = 3;
  static constexpr double kReach = 1.5;
  static constexpr double kLead = 0.5;
  template <class V>
  static V at(V t) {
    const V a = magnitude(t), outer = larger(1.5 - a, broadcast<V>(0.0)),
            inner = larger(0.5 - a, broadcast<V>(0.0));
    return 0.5 * outer * outer - 1.5 * inner * inner;
  }
  template <int K, class V>
  static void on_nodes(V x, V (&weight)[K]) {
    for (int i = 0; i < K; ++i) weight[i] = at(x - double(i - 1));
  }
};

/// @tparam Corner the one-dimensional grid function at the corners
template <int Dim, class Corner>
struct CpdiBasis {
  static constexpr int kMinSupport = Corner::kSupport + 1, kMaxSupport = Corner::kSupport + 2;
  static constexpr bool kConvected = true, kOverDomain = true;
  static constexpr double kGridReach = Corner::kReach;
  static constexpr double kSpread = 0;  ///< differs from domain to domain
  static constexpr const char* kDescription = Corner::kDescription;

  template <int K>
  using Weights = ChunkWeights<Dim, K>;

  /// On kMinSupport nodes a side while the corners of every domain of the chunk begin their supports at two
  /// neighbouring nodes at most, else on kMaxSupport. The lanes beyond the chunk must not count: another
  /// thread may be moving those particles, and sums over more and over fewer nodes round differently.
  /// (Not inline: long, called once a chunk, and the same in all passes.)
  /// @return false if K nodes are not enough, or a support leaves the window (which it then does on more,
  /// too)
  template <Wanted W = Wanted::both, int K>
  [[gnu::noinline]] static bool stage(const ChunkGeometry<Dim>& g, ChunkWeights<Dim, K>& out) {
    bool suits = true;
    constexpr double mean = 1.0 / kCorners<Dim>;
    for (int k = 0; k < g.count; k += kLanes) {
      Lanes r[Dim], edge[Dim][Dim], first[Dim];
      centre_and_edges(g, k, r, edge);
      const LaneSet all = leading_lanes(g.count - k);
      LaneSet fits = all;
      for (int d = 0; d < Dim; ++d) {
        Lanes extent = broadcast<Lanes>(0.0);
        for (int j = 0; j < Dim; ++j) extent += magnitude(edge[d][j]);
        const Lanes lowest = r[d] - extent - Corner::kLead;
        first[d] = floor_of(lowest);
        if constexpr (kSortedOffset<CpdiBasis> == 0) {
          // There is no space for what round-off lets stick out: a weight below 1e-17 is left out instead.
          const double window = g.window[d];
          first[d] = first[d] < window ? floor_of(lowest + 2 * constants::kSupportEdge) : first[d];
        }
        r[d] -= first[d];
        if constexpr (K < kMaxSupport)
          fits = where_less(fits, r[d] + extent, broadcast<Lanes>(Corner::kLead + 2));
      }
      fits = locate_in_window<Dim, K>(fits, first, g, out.first + k);
      suits &= same_lanes(fits, all);
      Lanes weight[kCorners<Dim>][Dim][K];
      for (int c = 0; c < kCorners<Dim>; ++c)
        for (int d = 0; d < Dim; ++d) {
          Lanes x = r[d] - 1.0;
          for (int j = 0; j < Dim; ++j) x = (c >> j & 1) ? x + edge[d][j] : x - edge[d][j];
          Corner::on_nodes(x, weight[c][d]);
        }
      Lanes inverse[Dim][Dim];
      if constexpr (W != Wanted::values) {
        invert(edge, inverse);
        for (auto& row : inverse)
          for (auto& v : row) v *= mean * g.inverse_cell;
      }
      if constexpr (Dim == 2)
        sum_in_plane<W>(weight, inverse, k, out);
      else
        sum_in_space<W>(weight, inverse, k, out);
    }
    return suits;
  }

  static NodeIndex<Dim> first_node(const ChunkGeometry<Dim>& g, int k) {
    NodeIndex<Dim> node;
    for (int d = 0; d < Dim; ++d) {
      double extent = 0;
      for (int j = 0; j < Dim; ++j) extent += std::abs(g.edge[Dim * d + j][k]);
      const double lowest = (g.position[d][k] - g.origin[d] - extent) * g.inverse_cell - Corner::kLead;
      node[d] = node_at(std::floor(lowest + constants::kSupportEdge));
    }
    return node;
  }

  /// Along axis d, no function further from the particle's centre than this is non-zero on it; cells.
  static Lanes reach(const ChunkGeometry<Dim>& g, int k, int d) {
    Lanes extent = broadcast<Lanes>(0.0);
    for (int j = 0; j < Dim; ++j) extent += magnitude(load_lanes(g.edge[Dim * d + j] + k));
    return extent * g.inverse_cell + Corner::kReach;
  }

  static Lanes coverage(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    Lanes r[Dim], edge[Dim][Dim];
    centre_and_edges(g, k, r, edge);
    Lanes best = broadcast<Lanes>(-constants::kUnbounded);
    for (int c = 0; c < kCorners<Dim>; ++c) {
      Lanes margin = broadcast<Lanes>(constants::kUnbounded);
      for (int d = 0; d < Dim; ++d) {
        Lanes x = r[d] - static_cast<double>(node[d]);
        for (int j = 0; j < Dim; ++j) x = (c >> j & 1) ? x + edge[d][j] : x - edge[d][j];
        margin = smaller(margin, Corner::kReach - constants::kSupportEdge - magnitude(x));
      }
      best = larger(best, margin);
    }
    return best;
  }
  static bool covers(const ChunkGeometry<Dim>& g, int k, const NodeIndex<Dim>& node) {
    return coverage(g, k, node)[0] > 0;
  }

 private:
  /// S and G of each node from the functions at the corners. With v_c = N_x N_y the sums Σ s_c v_c along both
  /// edges are the sum and the difference of v_3 − v_0 and v_1 − v_2, so that G takes four products.
  template <Wanted W, int K>
  static void sum_in_plane(const Lanes (&weight)[4][2][K], const Lanes (&inverse)[2][2], int k,
                           ChunkWeights<2, K>& out) {
    constexpr double mean = 1.0 / kCorners<2>;
    Lanes along[2], across[2];
    for (int d = 0; W != Wanted::values && d < 2; ++d) {
      along[d] = inverse[0][d] + inverse[1][d];
      across[d] = inverse[0][d] - inverse[1][d];
    }
#pragma GCC unroll 16
    for (int n = 0; n < K * K; ++n) {
      const auto x = [&](int c) { return weight[c][0][n % K]; };
      const auto y = [&](int c) { return weight[c][1][n / K]; };
      const Lanes v0 = x(0) * y(0), v2 = x(2) * y(2);
      if constexpr (W == Wanted::values)
        store_lanes(&out.value[n][k], mean * (v0 + x(1) * y(1) + x(2) * y(2) + x(3) * y(3)));
      if constexpr (W == Wanted::both)
        store_lanes(&out.value[n][k], mean * ((v0 + x(3) * y(3)) + (v2 + x(1) * y(1))));
      if constexpr (W != Wanted::values) {
        const Lanes one = x(3) * y(3) - v0, other = x(1) * y(1) - v2;
        store_pairs(out.slope[0][n][k], along[0] * one + across[0] * other,
                    along[1] * one + across[1] * other);
      }
    }
  }

  template <Wanted W, int K>
  static void sum_in_space(const Lanes (&weight)[8][3][K], const Lanes (&inverse)[3][3], int k,
                           ChunkWeights<3, K>& out) {
    constexpr double mean = 1.0 / kCorners<3>;
    Lanes plane[power(K, 2)][8];  // N_x N_y
    for (int c = 0; c < 8; ++c)
      for (int n = 0; n < K * K; ++n) plane[n][c] = weight[c][0][n % K] * weight[c][1][n / K];
    for (int n = 0; n < out.kNodes; ++n) {
      Lanes value[8], sum[4];
      for (int c = 0; c < 8; ++c) value[c] = plane[n % (K * K)][c] * weight[c][2][n / (K * K)];
      add_corners(value, sum);
      if constexpr (W != Wanted::gradients) store_lanes(&out.value[n][k], sum[0] * mean);
      if constexpr (W != Wanted::values)
        for (int d = 0; d < 3; ++d) {
          Lanes slope = inverse[0][d] * sum[1];
          for (int j = 1; j < 3; ++j) slope += inverse[j][d] * sum[1 + j];
          store_lanes(out.slope[d][n][k], slope);
        }
    }
  }

  /// Σ v_c and Σ s_cj v_c over the corners: direction after direction, neighbours are replaced by their sum
  /// and their difference; a difference needs only be summed from there on.
  static void add_corners(Lanes (&v)[8], Lanes (&sum)[4]) {
#pragma GCC unroll 4
    for (int j = 0; j < 3; ++j) {
      const int half = 8 >> (j + 1);
#pragma GCC unroll 8
      for (int c = 0; c < half; ++c) {
        const Lanes difference = v[2 * c + 1] - v[2 * c];
        sum[1 + j] = c == 0 ? difference : sum[1 + j] + difference;
        v[c] = v[2 * c] + v[2 * c + 1];
      }
    }
    sum[0] = v[0];
  }

  /// Centre and half-edge vectors in cells.
  static void centre_and_edges(const ChunkGeometry<Dim>& g, int k, Lanes (&r)[Dim], Lanes (&edge)[Dim][Dim]) {
    for (int d = 0; d < Dim; ++d) {
      r[d] = (load_lanes(g.position[d] + k) - g.origin[d]) * g.inverse_cell;
      for (int j = 0; j < Dim; ++j) edge[d][j] = load_lanes(g.edge[Dim * d + j] + k) * g.inverse_cell;
    }
  }

  static void invert(const Lanes (&a)[Dim][Dim], Lanes (&b)[Dim][Dim]) {
    if constexpr (Dim == 2) {
      const Lanes inverse = 1.0 / (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
      b[0][0] = a[1][1] * inverse;
      b[0][1] = -a[0][1] * inverse;
      b[1][0] = -a[1][0] * inverse;
      b[1][1] = a[0][0] * inverse;
    } else {
      const Lanes c0 = a[1][1] * a[2][2] - a[1][2] * a[2][1], c1 = a[1][2] * a[2][0] - a[1][0] * a[2][2],
                  c2 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
      const Lanes inverse = 1.0 / (a[0][0] * c0 + a[0][1] * c1 + a[0][2] * c2);
      b[0][0] = c0 * inverse;
      b[1][0] = c1 * inverse;
      b[2][0] = c2 * inverse;
      b[0][1] = (a[0][2] * a[2][1] - a[0][1] * a[2][2]) * inverse;
      b[1][1] = (a[0][0] * a[2][2] - a[0][2] * a[2][0]) * inverse;
      b[2][1] = (a[0][1] * a[2][0] - a[0][0] * a[2][1]) * inverse;
      b[0][2] = (a[0][1] * a[1][2] - a[0][2] * a[1][1]) * inverse;
      b[1][2] = (a[0][2] * a[1][0] - a[0][0] * a[1][2]) * inverse;
      b[2][2] = (a[0][0] * a[1][1] - a[0][1] * a[1][0]) * inverse;
    }
  }
};

template <int Dim>
using LcpdiBasis = CpdiBasis<Dim, HatCorner>;
template <int Dim>
using QcpdiBasis = CpdiBasis<Dim, QuadraticCorner>;

}  // namespace mpmfast
