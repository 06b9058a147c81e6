/// Sums over the nodes of a particle against the same sums node by node, in the precision of the transfers
/// (compiled in both).

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "kernels/basis/cpdi.hpp"
#include "kernels/basis/separable.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/views.hpp"

namespace mpmfast {
namespace {

using Draw = std::mt19937_64;

/// 1e-14 in doubles.
constexpr double kTolerance = 45 * std::numeric_limits<Real>::epsilon();

double number(Draw& draw) { return std::uniform_real_distribution<double>(-1, 1)(draw); }

/// Particles anywhere in the first tile of a window at the origin, with cells of 1 and undeformed domains.
template <int Dim>
struct Cloud {
  static constexpr int kCount = 13;
  std::vector<double> position[Dim], edge[Dim * Dim];

  explicit Cloud(Draw& draw) {
    for (int d = 0; d < Dim; ++d)
      for (int k = 0; k < kCount + kLanes; ++k) position[d].push_back(3 + number(draw));
    for (int e = 0; e < Dim * Dim; ++e) edge[e].assign(kCount + kLanes, e % (Dim + 1) == 0 ? 0.25 : 0.0);
  }
  ChunkGeometry<Dim> geometry() const {
    ChunkGeometry<Dim> g{};
    for (int d = 0; d < Dim; ++d) g.position[d] = position[d].data(), g.half_size[d] = 0.25;
    for (int e = 0; e < Dim * Dim; ++e) g.edge[e] = edge[e].data();
    g.inverse_cell = 1;
    g.count = kCount;
    return g;
  }
};

template <class R>
double difference(R a, R b) {
  double largest = 0;
  for (std::size_t i = 0; i < sizeof(R) / sizeof(Real); ++i)
    largest = std::max<double>(largest, std::abs(a[i] - b[i]));
  return largest;
}

template <class R>
R random_record(Draw& draw) {
  R r;
  for (std::size_t i = 0; i < sizeof(R) / sizeof(Real); ++i) r[i] = static_cast<Real>(number(draw));
  return r;
}

template <class R, int Dim, int K, template <int, int> class Weights>
void check_sums(const Weights<Dim, K>& w, int k, Draw& draw) {
  std::vector<R> field(kWindowNodes<Dim>);
  for (R& node : field) node = random_record<R>(draw);
  const R a = random_record<R>(draw);
  R b[Dim];
  for (R& row : b) row = random_record<R>(draw);
  R value{}, gradient[Dim] = {};
  std::vector<R> values(kWindowNodes<Dim>, R{}), gradients = values, both = values;
  double unity = 0;
  for (int n = 0; n < w.kNodes; ++n) {
    const auto at = static_cast<std::size_t>(w.first[k] + window_offset<Dim, K>(n));
    const auto s = static_cast<Real>(w.value_at(n, k));
    unity += s;
    value += s * field[at];
    values[at] = s * a;
    for (int d = 0; d < Dim; ++d) {
      const auto g = static_cast<Real>(w.gradient_at(d, n, k));
      gradient[d] += g * field[at];
      gradients[at] += g * b[d];
    }
    both[at] = values[at] + gradients[at];
  }
  CHECK(std::abs(unity - 1) < kTolerance);
  R out[Dim], alone[Dim];
  CHECK(difference(gather_values(w, k, field.data()), value) < kTolerance);
  CHECK(difference(gather(w, k, field.data(), out), value) < kTolerance);
  gather_gradients(w, k, field.data(), alone);
  for (int d = 0; d < Dim; ++d) {
    CHECK(difference(out[d], gradient[d]) < kTolerance);
    CHECK(difference(alone[d], gradient[d]) < kTolerance);
  }
  const auto check_scatter = [&](const std::vector<R>& expected, auto scatters) {
    std::vector<R> window(kWindowNodes<Dim>, R{});
    scatters(window.data());
    for (std::size_t i = 0; i < window.size(); ++i) REQUIRE(difference(window[i], expected[i]) < kTolerance);
  };
  check_scatter(values, [&](R* window) { scatter_values(w, k, a, window); });
  check_scatter(gradients, [&](R* window) { scatter_gradients(w, k, b, window); });
  check_scatter(both, [&](R* window) { scatter(w, k, a, b, window); });

  if constexpr (Dim == 2) {  // lanes: values where there are eight, then two of d/dx, two of d/dy
    constexpr int lanes = sizeof(R) / sizeof(Real);
    const auto weight = [&](int lane, int n) {
      const int pair = (lane - (lanes - 4)) / 2;
      return static_cast<Real>(lane < lanes - 4 ? w.value_at(n, k) : w.gradient_at(pair, n, k));
    };
    R sum{};
    std::vector<R> pairs(kWindowNodes<Dim>, R{});
    for (int n = 0; n < w.kNodes; ++n) {
      const auto at = static_cast<std::size_t>(w.first[k] + window_offset<Dim, K>(n));
      for (int i = 0; i < lanes; ++i) {
        sum[i] += weight(i, n) * field[at][i];
        pairs[at][i] = weight(i, n) * a[i];
      }
    }
    CHECK(difference(gather_pairs(w, k, field.data()), sum) < kTolerance);
    check_scatter(pairs, [&](R* window) { scatter_pairs(w, k, a, window); });
  }
}

/// A chunk is the sum of its particles; some that follow each other lie in one cell, others do not.
template <class R, int Dim, int K, template <int, int> class Weights>
void check_chunk(const Weights<Dim, K>& w, int count, Draw& draw) {
  std::vector<R> field(kWindowNodes<Dim>), a(static_cast<std::size_t>(count)), out = a;
  for (R& node : field) node = random_record<R>(draw);
  for (R& one : a) one = random_record<R>(draw);
  const auto check_scatter = [&](auto chunk, auto one) {
    std::vector<R> window = field, expected = field;
    chunk(window.data());
    for (int k = 0; k < count; ++k) one(k, a[static_cast<std::size_t>(k)], expected.data());
    for (std::size_t i = 0; i < window.size(); ++i) REQUIRE(difference(window[i], expected[i]) < kTolerance);
  };
  check_scatter([&](R* window) { scatter_chunk_values(w, count, a.data(), window); },
                [&](int k, R one, R* window) { scatter_values(w, k, one, window); });
  if constexpr (Dim == 2) {
    check_scatter([&](R* window) { scatter_chunk_pairs(w, count, a.data(), window); },
                  [&](int k, R one, R* window) { scatter_pairs(w, k, one, window); });
    gather_chunk_pairs(w, count, field.data(), out.data());
    for (int k = 0; k < count; ++k)
      CHECK(difference(out[static_cast<std::size_t>(k)], gather_pairs(w, k, field.data())) < kTolerance);
  }
}

template <int Dim, class Basis>
void check_basis() {
  Draw draw(7);
  const Cloud<Dim> particles(draw);
  const auto workspace = std::make_unique<WeightWorkspace<Dim, Basis>>();
  REQUIRE(Basis::stage(particles.geometry(), workspace->narrow));
  REQUIRE(Basis::stage(particles.geometry(), workspace->wide));
  for (int k = 0; k < Cloud<Dim>::kCount; ++k) {
    check_sums<Record>(workspace->narrow, k, draw);
    check_sums<WideRecord>(workspace->wide, k, draw);
  }
  for (int count : {1, 2, Cloud<Dim>::kCount}) {
    check_chunk<Record>(workspace->narrow, count, draw);
    check_chunk<WideRecord>(workspace->wide, count, draw);
  }
}

TEST_CASE("scatters and gathers are the sums over the nodes that they stand for") {
  check_basis<2, LinearBasis<2>>();
  check_basis<2, UGimpBasis<2>>();
  check_basis<2, BSpline3Basis<2>>();
  check_basis<2, LcpdiBasis<2>>();
  check_basis<3, LinearBasis<3>>();
  check_basis<3, UGimpBasis<3>>();
  check_basis<3, BSpline3Basis<3>>();
  check_basis<3, LcpdiBasis<3>>();
}

}  // namespace
}  // namespace mpmfast
