/// Shape values and gradients of every basis: completeness, consistency, and an independent evaluation.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "kernels/basis/cpdi.hpp"
#include "kernels/basis/separable.hpp"
#include "kernels/views.hpp"

using namespace mpmfast;

namespace {

using Draw = std::mt19937_64;

double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

/// A chunk of particles around the first tile of a window, on a grid as scenes have them.
template <int Dim>
struct Chunk {
  double cell = 1e-3 / 70, half_size = 0.25;  ///< m; cells
  double origin[Dim];
  int window[Dim];
  std::array<std::vector<double>, Dim> position;
  std::array<std::vector<double>, Dim * Dim> edge;
  int count = 0;

  Chunk() {
    for (int d = 0; d < Dim; ++d) {
      origin[d] = 1.3e-5 * (d - 1);
      window[d] = 4 * (3 - 5 * d);
    }
  }

  /// @param r in cells from the window's first node; @param f deformation gradient
  void add(const Vec<Dim>& r, const Mat<Dim>& f) {
    const auto k = static_cast<std::size_t>(count++);
    const auto padded =
        static_cast<std::size_t>(count + 2 * kLanes);  // covers() reads a vector from any particle on
    for (auto& column : position) column.resize(padded, 0.0);
    for (auto& column : edge) column.resize(padded, 0.0);
    double rows[Dim * Dim], half[Dim], edges[Dim * Dim];
    for (int i = 0; i < Dim; ++i) {
      position[static_cast<std::size_t>(i)][k] = origin[i] + cell * (window[i] + r[i]);
      half[i] = half_size * cell;
      for (int j = 0; j < Dim; ++j) rows[Dim * i + j] = f(i, j);
    }
    convect_domain<Dim>(rows, half, 1.0 / cell, edges);
    for (std::size_t e = 0; e < Dim * Dim; ++e) edge[e][k] = edges[e];
  }

  ChunkGeometry<Dim> geometry() const {
    ChunkGeometry<Dim> g;
    for (std::size_t d = 0; d < Dim; ++d) {
      g.position[d] = position[d].data();
      g.half_size[d] = half_size * cell;
      g.origin[d] = origin[d];
      g.window[d] = window[d];
    }
    for (std::size_t e = 0; e < Dim * Dim; ++e) g.edge[e] = edge[e].data();
    g.inverse_cell = 1.0 / cell;
    g.count = count;
    return g;
  }

  /// In cells from the window's first node.
  Vec<Dim> place(int k) const {
    Vec<Dim> r;
    for (int d = 0; d < Dim; ++d)
      r[d] =
          (position[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)] - origin[d]) / cell - window[d];
    return r;
  }
  /// Half-edge vectors as columns, in cells.
  Mat<Dim> edges(int k) const {
    Mat<Dim> m;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        m(i, j) = edge[static_cast<std::size_t>(Dim * i + j)][static_cast<std::size_t>(k)] / cell;
    return m;
  }
};

/// Identity, or stretched, sheared and turned by `size`.
template <int Dim>
Mat<Dim> random_deformation(Draw& draw, double size) {
  Mat<Dim> f;
  do {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f(i, j) = (i == j) + uniform(draw, -size, size);
  } while (f.determinant() < 0.2);
  return f;
}

/// Supports begin in the window: 1.55 cells of space below let any domain of at most 0.999 cells in, with
/// half a cell beyond for quadratic functions.
template <int Dim>
Chunk<Dim> random_chunk(Draw& draw, double deformation, double stretch = 1.0) {
  Chunk<Dim> chunk;
  const int count = static_cast<int>(uniform(draw, 1, kChunk<Dim> + 1));
  for (int k = 0; k < count; ++k) {
    Vec<Dim> r;
    for (int d = 0; d < Dim; ++d) r[d] = uniform(draw, 1.55, 4.4);
    chunk.add(r, stretch * random_deformation<Dim>(draw, deformation));
  }
  return chunk;
}

/// Calls f(weights) on the support that the basis chooses.
template <class Basis, int Dim, class F>
void with_weights(const ChunkGeometry<Dim>& g, F f) {
  const auto workspace = std::make_unique<WeightWorkspace<Dim, Basis>>();
  if (Basis::stage(g, workspace->narrow)) return f(workspace->narrow);
  REQUIRE(Basis::stage(g, workspace->wide));
  f(workspace->wide);
}

/// Node coordinates within the window of a window index.
template <int Dim>
Vec<Dim> index_of_node(int index) {
  Vec<Dim> x;
  for (int d = 0; d < Dim; ++d, index /= kWindowSide) x[d] = index % kWindowSide;
  return x;
}

/// Values on the whole window, and gradients per cell.
template <int Dim>
struct Field {
  std::vector<double> value;
  std::vector<Vec<Dim>> gradient;
};

template <int Dim, int K, template <int, int> class Weights>
Field<Dim> on_window(const Weights<Dim, K>& w, int k, double cell) {
  Field<Dim> field{std::vector<double>(kWindowNodes<Dim>, 0.0),
                   std::vector<Vec<Dim>>(kWindowNodes<Dim>, Vec<Dim>::Zero())};
  for (int n = 0; n < w.kNodes; ++n) {
    const auto at = static_cast<std::size_t>(w.first[k] + window_offset<Dim, K>(n));
    REQUIRE(at < field.value.size());
    field.value[at] = w.value_at(n, k);
    for (int d = 0; d < Dim; ++d) field.gradient[at][d] = w.gradient_at(d, n, k) * cell;
  }
  return field;
}

double hat(double x) { return std::max(0.0, 1.0 - std::abs(x)); }

/// ∫ of the hat from −∞ to x.
double hat_integral(double x) {
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}

/// Cox and de Boor's recursion on whole and half knots, centred at 0.
double b_spline(double x, int degree) {
  if (degree == 0) return x >= -0.5 && x < 0.5 ? 1 : 0;
  const double half = 0.5 * (degree + 1);
  return ((x + half) * b_spline(x + 0.5, degree - 1) + (half - x) * b_spline(x - 0.5, degree - 1)) / degree;
}

/// One-dimensional value and slope at distance x, by other means than the kernels'.
struct Slow {
  double value, slope;
};
template <int Dim>
Slow slow(LinearBasis<Dim>, double x, double) {
  return {hat(x), std::abs(x) < 1 ? (x < 0 ? 1.0 : -1.0) : 0.0};
}
template <int Dim>
Slow slow(UGimpBasis<Dim>, double x, double l) {  // mean over the domain of the hat and of its derivative
  return {(hat_integral(x + l) - hat_integral(x - l)) / (2 * l), (hat(x + l) - hat(x - l)) / (2 * l)};
}
template <int Dim>
Slow slow(BSpline2Basis<Dim>, double x, double) {
  return {b_spline(x, 2), b_spline(x + 0.5, 1) - b_spline(x - 0.5, 1)};
}

template <int Dim>
Slow slow(BSpline3Basis<Dim>, double x, double) {
  return {b_spline(x, 3), b_spline(x + 0.5, 2) - b_spline(x - 0.5, 2)};
}

template <int Dim>
Slow hats_at(const Vec<Dim>& x, const Vec<Dim>& node) {
  double product = 1;
  for (int d = 0; d < Dim; ++d) product *= hat(x[d] - node[d]);
  return {product, 0};
}

/// The grid function of a CPDI basis at a corner.
template <int Dim>
double grid_function(LcpdiBasis<Dim>, const Vec<Dim>& x, const Vec<Dim>& node) {
  return hats_at<Dim>(x, node).value;
}
template <int Dim>
double grid_function(QcpdiBasis<Dim>, const Vec<Dim>& x, const Vec<Dim>& node) {
  double product = 1;
  for (int d = 0; d < Dim; ++d) product *= b_spline(x[d] - node[d], 2);
  return product;
}

/// Completeness of all particles of a chunk to `tolerance`, in cells. @return worst error
template <class Basis, int Dim>
double incompleteness(const Chunk<Dim>& chunk) {
  double worst = 0;
  with_weights<Basis, Dim>(chunk.geometry(), [&](const auto& w) {
    for (int k = 0; k < chunk.count; ++k) {
      const auto field = on_window(w, k, chunk.cell);
      double sum = -1;
      Vec<Dim> mean = Vec<Dim>::Zero(), slope = Vec<Dim>::Zero();
      Mat<Dim> identity = -Mat<Dim>::Identity();
      for (int n = 0; n < kWindowNodes<Dim>; ++n) {
        const auto i = static_cast<std::size_t>(n);
        const Vec<Dim> x = index_of_node<Dim>(n) - chunk.place(k);
        sum += field.value[i];
        mean += field.value[i] * x;
        slope += field.gradient[i];
        identity += field.gradient[i] * x.transpose();
      }
      worst = std::max({worst, std::abs(sum), mean.norm(), slope.norm(), identity.norm()});
    }
  });
  return worst;
}

/// covers ⇔ S > `edge` on every node of the window; values that close to the edge of a support are not judged
/// unless edge > 0 says that they are round-off. The tile that first_node leads to has a window that holds
/// the support.
struct SupportErrors {
  int wrong = 0, outside = 0;
};
template <class Basis, int Dim>
void check_support(const Chunk<Dim>& chunk, double edge, SupportErrors& errors) {
  const auto g = chunk.geometry();
  with_weights<Basis, Dim>(g, [&](const auto& w) {
    const auto one = std::make_unique<WeightWorkspace<Dim, Basis>>();
    for (int k = 0; k < chunk.count; ++k) {
      const auto field = on_window(w, k, chunk.cell);
      for (int n = 0; n < kWindowNodes<Dim>; ++n) {
        NodeIndex<Dim> node = index_of_node<Dim>(n).template cast<int>();
        for (int d = 0; d < Dim; ++d) node[d] += chunk.window[d];
        const double s = field.value[static_cast<std::size_t>(n)];
        const bool covered = Basis::covers(g, k, node);
        errors.wrong += (s <= edge && covered) || (s > 1e-9 && !covered) || !(s >= 0);
      }
      // Where the sort puts the particle; another particle of the chunk may ask for the wide support.
      const NodeIndex<Dim> first = Basis::first_node(g, k);
      ChunkGeometry<Dim> alone = g;
      for (int d = 0; d < Dim; ++d)
        alone.window[d] = floor_div(first[d] - kSortedOffset<Basis>, kTileSide) * kTileSide;
      errors.outside += !Basis::stage(alone, one->wide);
      if (Basis::stage(g, one->narrow)) errors.outside += !Basis::stage(alone, one->narrow);
    }
  });
}

template <class Basis, int Dim>
void check_separable() {
  Draw draw(2);
  double worst = 0;
  for (const double half_size : {0.25, 0.5, 0.1}) {
    Chunk<Dim> chunk = random_chunk<Dim>(draw, 0.0);
    chunk.half_size = half_size;
    with_weights<Basis, Dim>(chunk.geometry(), [&](const auto& w) {
      for (int k = 0; k < chunk.count; ++k) {
        const auto field = on_window(w, k, chunk.cell);
        for (int n = 0; n < kWindowNodes<Dim>; ++n) {
          const Vec<Dim> x = chunk.place(k) - index_of_node<Dim>(n);
          double value = 1;
          Vec<Dim> gradient = Vec<Dim>::Ones();
          for (int d = 0; d < Dim; ++d) {
            const Slow one = slow(Basis{}, x[d], half_size);
            value *= one.value;
            for (int e = 0; e < Dim; ++e) gradient[e] *= e == d ? one.slope : one.value;
          }
          const auto i = static_cast<std::size_t>(n);
          worst = std::max({worst, std::abs(field.value[i] - value), (field.gradient[i] - gradient).norm()});
        }
      }
    });
  }
  CHECK(worst < 1e-11);
}

template <class Basis, int Dim>
void check_slopes_by_difference() {
  Draw draw(3);
  const double h = 1e-5;
  double worst = 0;
  Chunk<Dim> here;
  for (int k = 0; k < kChunk<Dim> / (1 + 2 * Dim); ++k) {
    Vec<Dim> r;
    for (int d = 0; d < Dim; ++d) r[d] = uniform(draw, 1.6, 4.4);
    here.add(r, Mat<Dim>::Identity());
    for (int d = 0; d < Dim; ++d)
      for (const double step : {h, -h}) here.add(r + step * Vec<Dim>::Unit(d), Mat<Dim>::Identity());
  }
  with_weights<Basis, Dim>(here.geometry(), [&](const auto& w) {
    for (int k = 0; k < here.count; k += 1 + 2 * Dim) {
      const auto field = on_window(w, k, here.cell);
      for (int d = 0; d < Dim; ++d) {
        const auto up = on_window(w, k + 1 + 2 * d, here.cell), down = on_window(w, k + 2 + 2 * d, here.cell);
        for (std::size_t n = 0; n < field.value.size(); ++n) {
          const double slope = (up.value[n] - down.value[n]) / (2 * h);
          // A kink of the slope within the step leaves an error of the step's size.
          worst = std::max(worst, std::abs(field.gradient[n][d] - slope));
        }
      }
    }
  });
  CHECK(worst < 2 * h);
}

template <int Dim>
Vec<Dim> corner(const Vec<Dim>& r, const Mat<Dim>& edges, int c) {
  Vec<Dim> x = r;
  for (int j = 0; j < Dim; ++j) x += (c >> j & 1 ? 1.0 : -1.0) * edges.col(j);
  return x;
}

}  // namespace

#define BASES                                                                                      \
  LinearBasis<2>, UGimpBasis<2>, BSpline2Basis<2>, BSpline3Basis<2>, LcpdiBasis<2>, QcpdiBasis<2>, \
      LinearBasis<3>, UGimpBasis<3>, BSpline2Basis<3>, BSpline3Basis<3>, LcpdiBasis<3>, QcpdiBasis<3>
#define CPDI_BASES LcpdiBasis<2>, QcpdiBasis<2>, LcpdiBasis<3>, QcpdiBasis<3>

namespace {
template <class Basis>
struct DimensionOf;
template <int Dim, class Function>
struct DimensionOf<SeparableBasis<Dim, Function>> : std::integral_constant<int, Dim> {};
template <int Dim, class Corner>
struct DimensionOf<CpdiBasis<Dim, Corner>> : std::integral_constant<int, Dim> {};
}  // namespace

// Positions a few cells from the origin: their round-off stays below 1e-14 cells.
TEST_CASE_TEMPLATE("partition of unity and linear completeness", Basis, BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(1);
  for (int k = 0; k < 40; ++k) {
    CHECK(incompleteness<Basis>(random_chunk<Dim>(draw, 0.0)) < 1e-13);
    CHECK(incompleteness<Basis>(random_chunk<Dim>(draw, 0.5)) < 1e-13);
    CHECK(incompleteness<Basis>(random_chunk<Dim>(draw, 0.5, 2.5)) < 1e-13);
  }
}

TEST_CASE_TEMPLATE("covers says where S > 0, first_node gives a tile whose window holds the support", Basis,
                   BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(4);
  SupportErrors errors;
  for (int k = 0; k < 400; ++k) {
    Chunk<Dim> chunk;
    Vec<Dim> r;
    for (int d = 0; d < Dim; ++d) r[d] = uniform(draw, 1.55, 4.4);
    chunk.add(r, random_deformation<Dim>(draw, 0.4) * uniform(draw, 0.5, 3));
    check_support<Basis>(chunk, 0.0, errors);
  }
  CHECK(errors.wrong == 0);
  CHECK(errors.outside == 0);
}

// Fresh bodies: particles in the middle of cells, supports and domains that end on nodes and grid lines.
// Round-off must neither put a particle into a tile whose window misses its support nor decide which nodes it
// is near.
TEST_CASE_TEMPLATE("regular lattices: round-off does not decide on tiles and clouds", Basis, BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  SupportErrors errors;
  for (const double cell : {1e-3 / 70, 5e-3, 0.1, 1.0 / 3})
    for (int per_side = 1; per_side <= 4; ++per_side)
      for (int k = 0; k < 200; ++k) {
        Chunk<Dim> chunk;
        chunk.cell = cell;
        chunk.half_size = 0.5 / per_side;
        Vec<Dim> r;
        for (int d = 0; d < Dim; ++d) {
          chunk.window[d] = 4 * ((7 * k) % 41 + d);
          r[d] = 2 + (k + d) % 3 + ((k / 3 + d) % per_side + 0.5) / per_side;
        }
        chunk.add(r, Mat<Dim>::Identity());
        check_support<Basis>(chunk, 1e-12, errors);
      }
  CHECK(errors.wrong == 0);
  CHECK(errors.outside == 0);
}

TEST_CASE_TEMPLATE("separable bases equal an independent evaluation", Basis, LinearBasis<2>, UGimpBasis<2>,
                   BSpline2Basis<2>, BSpline3Basis<2>, LinearBasis<3>, UGimpBasis<3>, BSpline2Basis<3>,
                   BSpline3Basis<3>) {
  check_separable<Basis, DimensionOf<Basis>::value>();
}

TEST_CASE_TEMPLATE("gradients of smooth separable bases are the slopes of the values", Basis, UGimpBasis<2>,
                   BSpline2Basis<2>, BSpline3Basis<2>, UGimpBasis<3>, BSpline2Basis<3>, BSpline3Basis<3>) {
  check_slopes_by_difference<Basis, DimensionOf<Basis>::value>();
}

TEST_CASE_TEMPLATE("CPDI: values are the corners' mean, gradients the mean gradient of their interpolant",
                   Basis, CPDI_BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(5);
  double worst = 0;
  for (int repeat = 0; repeat < 10; ++repeat) {
    const auto chunk = random_chunk<Dim>(draw, 0.4, repeat % 2 ? 2.5 : 1.0);
    with_weights<Basis, Dim>(chunk.geometry(), [&](const auto& w) {
      for (int k = 0; k < chunk.count; ++k) {
        const auto field = on_window(w, k, chunk.cell);
        const Mat<Dim> edges = chunk.edges(k), to_space = edges.inverse().transpose();
        for (int n = 0; n < kWindowNodes<Dim>; ++n) {
          const Vec<Dim> node = index_of_node<Dim>(n);
          double at[kCorners<Dim>], value = 0;
          for (int c = 0; c < kCorners<Dim>; ++c) {
            at[c] = grid_function(Basis{}, corner<Dim>(chunk.place(k), edges, c), node);
            value += at[c] / kCorners<Dim>;
          }
          // The multilinear interpolant's gradient, integrated by two Gauss points a side.
          Vec<Dim> gradient = Vec<Dim>::Zero();
          for (int q = 0; q < kCorners<Dim>; ++q) {
            Vec<Dim> local = Vec<Dim>::Zero();
            for (int j = 0; j < Dim; ++j)
              for (int c = 0; c < kCorners<Dim>; ++c) {
                double product = at[c];
                for (int i = 0; i < Dim; ++i) {
                  const double sign = c >> i & 1 ? 1.0 : -1.0, s = (q >> i & 1 ? 1.0 : -1.0) / std::sqrt(3.0);
                  product *= i == j ? 0.5 * sign : 0.5 * (1 + sign * s);
                }
                local[j] += product;
              }
            gradient += to_space * local / kCorners<Dim>;
          }
          const auto i = static_cast<std::size_t>(n);
          worst = std::max({worst, std::abs(field.value[i] - value),
                            (field.gradient[i] - gradient).norm() / (1 + to_space.norm())});
        }
      }
    });
  }
  CHECK(worst < 1e-11);
}

TEST_CASE("lCPDI: gradients are those of Sadeghirad et al. in 2-D") {
  Draw draw(6);
  const auto chunk = random_chunk<2>(draw, 0.4, 1.5);
  with_weights<LcpdiBasis<2>, 2>(chunk.geometry(), [&](const auto& w) {
    for (int k = 0; k < chunk.count; ++k) {
      const auto field = on_window(w, k, chunk.cell);
      const Vec<2> r1 = 2 * chunk.edges(k).col(0), r2 = 2 * chunk.edges(k).col(1);
      const double volume = r1[0] * r2[1] - r1[1] * r2[0];
      for (int n = 0; n < kWindowNodes<2>; ++n) {
        const Vec<2> x = chunk.place(k), node = index_of_node<2>(n);
        const double n1 = hats_at<2>(x - 0.5 * r1 - 0.5 * r2, node).value,
                     n2 = hats_at<2>(x + 0.5 * r1 - 0.5 * r2, node).value;
        const double n3 = hats_at<2>(x + 0.5 * r1 + 0.5 * r2, node).value,
                     n4 = hats_at<2>(x - 0.5 * r1 + 0.5 * r2, node).value;
        const Vec<2> gradient = ((n1 - n3) * Vec<2>(r1[1] - r2[1], r2[0] - r1[0]) +
                                 (n2 - n4) * Vec<2>(r1[1] + r2[1], -r1[0] - r2[0])) /
                                (2 * volume);
        CHECK((field.gradient[static_cast<std::size_t>(n)] - gradient).norm() < 1e-11);
      }
    }
  });
}

TEST_CASE_TEMPLATE("CPDI: the narrow and the wide support give the same weights", Basis, CPDI_BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(7);
  int narrow = 0, wide = 0;
  double worst = 0;
  for (int repeat = 0; repeat < 60; ++repeat) {
    const auto chunk = random_chunk<Dim>(draw, 0.05, uniform(draw, 0.5, 2.5));
    const auto g = chunk.geometry();
    const auto workspace = std::make_unique<WeightWorkspace<Dim, Basis>>();
    (Basis::stage(g, workspace->narrow) ? narrow : wide) += 1;
    REQUIRE(Basis::stage(g, workspace->wide));
    with_weights<Basis, Dim>(g, [&](const auto& w) {
      for (int k = 0; k < chunk.count; ++k) {
        const auto a = on_window(w, k, chunk.cell), b = on_window(workspace->wide, k, chunk.cell);
        for (std::size_t n = 0; n < a.value.size(); ++n) {
          worst =
              std::max({worst, std::abs(a.value[n] - b.value[n]), (a.gradient[n] - b.gradient[n]).norm()});
        }
      }
    });
  }
  CHECK(worst < 1e-13);
  CHECK(narrow > 0);
  CHECK(wide > 0);
}

/// The longest half-diagonal of a domain with these half-edges.
template <int Dim>
double half_diagonal(const Mat<Dim>& edges) {
  double longest = 0;
  for (int c = 0; c < power(2, Dim - 1); ++c) {
    Vec<Dim> sign = Vec<Dim>::Ones();
    for (int j = 1; j < Dim; ++j) sign[j] = (c >> (j - 1) & 1) ? -1 : 1;
    longest = std::max(longest, (edges * sign).norm());
  }
  return longest;
}

template <int Dim>
Mat<Dim> random_turn(Draw& draw) {
  Mat<3> turn = Eigen::AngleAxisd(uniform(draw, 0, 6.28), Vec<3>::UnitZ()).toRotationMatrix();
  if constexpr (Dim == 3)
    turn = turn * Eigen::AngleAxisd(uniform(draw, 0, 6.28), Vec<3>::UnitX()).toRotationMatrix();
  return turn.topLeftCorner<Dim, Dim>();
}

template <int Dim>
Mat<Dim> edges_of(const Mat<Dim>& f) {
  Chunk<Dim> chunk;
  chunk.add(Vec<Dim>::Constant(2.5), f);
  return chunk.edges(0);
}

TEST_CASE_TEMPLATE("CPDI: edges follow F until the domain is too long or too thin", Basis, CPDI_BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(8);
  int kept = 0, bounded = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    const Mat<Dim> f = random_deformation<Dim>(draw, 0.7) * uniform(draw, 0.5, 5);
    const Mat<Dim> free = 0.25 * f, found = edges_of<Dim>(f);
    CHECK(half_diagonal<Dim>(found) < constants::kMostHalfDiagonal * (1 + 1e-12));
    CHECK(found.determinant() * free.determinant() > 0);
    double product = 1;
    for (int j = 0; j < Dim; ++j) product *= free.col(j).norm();
    const bool thin = std::abs(free.determinant()) < constants::kLeastSine * product;
    if (!thin && half_diagonal<Dim>(free) < constants::kMostHalfDiagonal * (Dim == 2 ? 1 : 0.5)) {
      ++kept;
      CHECK((found - free).norm() < 1e-13 * free.norm());
    }
    if (!thin && half_diagonal<Dim>(free) < constants::kMostHalfDiagonal) continue;
    ++bounded;
    const Mat<Dim> products = found.transpose() * found;  // edges are orthogonal
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < j; ++k) CHECK(std::abs(products(j, k)) < 1e-9);
    // Second moments are those of the free domain where the new one is short enough.
    if (found.squaredNorm() < 0.99 * constants::kMostHalfDiagonal * constants::kMostHalfDiagonal)
      CHECK((found * found.transpose() - free * free.transpose()).norm() < 1e-9);
  }
  CHECK(kept > 10);
  CHECK(bounded > 20);
}

TEST_CASE_TEMPLATE("CPDI: slopes do not grow with the shear of a domain", Basis, CPDI_BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  Draw draw(11);
  double largest = 0;
  for (const double shear : {0.0, 1.0, 2.0, 4.0, 10.0, 40.0})
    for (int repeat = 0; repeat < 40; ++repeat) {
      Mat<Dim> f = Mat<Dim>::Identity();
      f(0, 1) = shear;
      f = random_turn<Dim>(draw) * f * random_turn<Dim>(draw);
      Chunk<Dim> chunk;
      chunk.add(Vec<Dim>::NullaryExpr([&] { return uniform(draw, 2, 3); }), f);
      with_weights<Basis, Dim>(chunk.geometry(), [&](const auto& w) {
        double sum = 0;
        for (const Vec<Dim>& g : on_window(w, 0, chunk.cell).gradient) sum += g.norm();
        largest = std::max(largest, sum);
      });
    }
  // Σ_i |G_pi| of a square is at most 3.1 in the plane and 3.7 in space, in units of 1/Δx; three times that
  // at the shear from which on domains are rectangles. Domains that are not replaced have 75 to 1400 at 40.
  CHECK(largest < (Dim == 2 ? 9.5 : 12));
}

TEST_CASE("gradients of qCPDI have no kink where a corner crosses a node, those of lCPDI do") {
  // A domain that crosses two cells in steps of h; the largest second difference of any gradient, per cell.
  const double h = 0.01;
  const auto kink = [&](auto basis) {
    using Basis = decltype(basis);
    Draw draw(9);
    const Mat<2> f = random_deformation<2>(draw, 0.3);
    double largest = 0;
    Field<2> last, now;
    for (double x = 2; x < 4; x += h) {
      Chunk<2> chunk;
      chunk.add(Vec<2>(x, 3.1 - 0.1 * x), f);
      with_weights<Basis, 2>(chunk.geometry(), [&](const auto& w) {
        const auto next = on_window(w, 0, chunk.cell);
        for (std::size_t n = 0; n < last.gradient.size(); ++n)
          largest = std::max(largest, (next.gradient[n] - 2 * now.gradient[n] + last.gradient[n]).norm());
        last = now;
        now = next;
      });
    }
    return largest;
  };
  // Half-edges of a quarter of a cell divide differences of the corners' values, of which N'' is 2 at most in
  // qCPDI (measured 4 h²), and whose slope jumps by up to 2 in lCPDI (measured 2.2 h).
  CHECK(kink(QcpdiBasis<2>{}) < 10 * h * h);
  CHECK(kink(LcpdiBasis<2>{}) > h);
}

TEST_CASE_TEMPLATE("a support that leaves the window is reported, and a position that is no number too",
                   Basis, BASES) {
  constexpr int Dim = DimensionOf<Basis>::value;
  for (int d = 0; d < Dim; ++d)
    for (const double away : {-3.0, 8.5, std::nan("")}) {
      Chunk<Dim> chunk;
      chunk.add(Vec<Dim>::Constant(3.4), Mat<Dim>::Identity());
      const auto workspace = std::make_unique<WeightWorkspace<Dim, Basis>>();
      CHECK(Basis::stage(chunk.geometry(), workspace->narrow));
      Vec<Dim> r = Vec<Dim>::Constant(3.4);
      r[d] = away;
      chunk.add(r, Mat<Dim>::Identity());
      CHECK(!Basis::stage(chunk.geometry(), workspace->narrow));
    }
}
