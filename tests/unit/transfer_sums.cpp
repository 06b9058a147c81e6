/// Sums over the nodes of a particle against the same sums node by node, and the force that is projected with
/// the masses against the force of a pass of its own.

#include <random>

#include "engine/step/passes.hpp"
#include "kernels/basis/cpdi.hpp"
#include "kernels/basis/separable.hpp"
#include "kernels/transfer/sums.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;
using Draw = std::mt19937_64;

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
  for (std::size_t i = 0; i < sizeof(R) / sizeof(double); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

template <class R>
R random_record(Draw& draw) {
  R r;
  for (std::size_t i = 0; i < sizeof(R) / sizeof(double); ++i) r[i] = number(draw);
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
  for (int n = 0; n < w.kNodes; ++n) {
    const auto at = static_cast<std::size_t>(w.first[k] + window_offset<Dim, K>(n));
    value += w.value_at(n, k) * field[at];
    values[at] = w.value_at(n, k) * a;
    for (int d = 0; d < Dim; ++d) {
      gradient[d] += w.gradient_at(d, n, k) * field[at];
      gradients[at] += w.gradient_at(d, n, k) * b[d];
    }
    both[at] = values[at] + gradients[at];
  }
  R out[Dim], alone[Dim];
  CHECK(difference(gather_values(w, k, field.data()), value) < 1e-14);
  CHECK(difference(gather(w, k, field.data(), out), value) < 1e-14);
  gather_gradients(w, k, field.data(), alone);
  for (int d = 0; d < Dim; ++d) {
    CHECK(difference(out[d], gradient[d]) < 1e-14);
    CHECK(difference(alone[d], gradient[d]) < 1e-14);
  }
  const auto check_scatter = [&](const std::vector<R>& expected, auto scatters) {
    std::vector<R> window(kWindowNodes<Dim>, R{});
    scatters(window.data());
    for (std::size_t i = 0; i < window.size(); ++i) REQUIRE(difference(window[i], expected[i]) < 1e-14);
  };
  check_scatter(values, [&](R* window) { scatter_values(w, k, a, window); });
  check_scatter(gradients, [&](R* window) { scatter_gradients(w, k, b, window); });
  check_scatter(both, [&](R* window) { scatter(w, k, a, b, window); });

  if constexpr (Dim == 2) {  // lanes: values where there are eight, then two of d/dx, two of d/dy
    constexpr int lanes = sizeof(R) / sizeof(double);
    const auto weight = [&](int lane, int n) {
      const int pair = (lane - (lanes - 4)) / 2;
      return lane < lanes - 4 ? w.value_at(n, k) : w.gradient_at(pair, n, k);
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
    CHECK(difference(gather_pairs(w, k, field.data()), sum) < 1e-14);
    check_scatter(pairs, [&](R* window) { scatter_pairs(w, k, a, window); });
  }
}

template <int Dim, class Basis>
void check_basis() {
  Draw draw(7);
  const Cloud<Dim> particles(draw);
  const auto room = std::make_unique<WeightRoom<Dim, Basis>>();
  REQUIRE(Basis::stage(particles.geometry(), room->narrow));
  REQUIRE(Basis::stage(particles.geometry(), room->wide));
  for (int k = 0; k < Cloud<Dim>::kCount; ++k) {
    check_sums<Record>(room->narrow, k, draw);
    check_sums<WideRecord>(room->wide, k, draw);
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

template <int Dim>
void check_force(const char* basis) {
  CAPTURE(std::string(basis));
  const Scene scene = scene_from(Dim == 2 ? R"(
space: plane_strain
grid: {size: [20 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, disk: {centre: [9 mm, 8 mm], radius: 5 mm}, material: m, velocity: [3 m/s, 4 m/s]}]
)"
                                          : R"(
space: 3d
grid: {size: [12 mm, 12 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: b, sphere: {centre: [6 mm, 6 mm, 6 mm], radius: 3 mm}, material: m,
     velocity: [3 m/s, 4 m/s, 5 m/s]}
)",
                                 {{"method.basis", basis}});
  Step<Dim> step(scene);
  auto& state = step.state();
  const auto passes = make_passes<Dim>(scene.method.basis);
  passes->sort(state);
  Draw draw(3);
  for (int c = 0; c < kSymmetric<Dim>; ++c)
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      state.particles.column(Quantity::kirchhoff_stress, c)[p] = number(draw);
  const auto clear = [&] {
    for (Nodal q : {Nodal::mass, Nodal::momentum, Nodal::force})
      for (int d = 0; d < Nodes<Dim>::components(q); ++d)
        std::fill_n(state.nodes.column(q, d), state.tiling.slots(), 0.0);
  };
  const auto rows = [&] {
    std::vector<std::vector<double>> all;
    for (Nodal q : {Nodal::mass, Nodal::momentum, Nodal::force})
      for (int d = 0; d < Nodes<Dim>::components(q); ++d)
        all.emplace_back(state.nodes.column(q, d), state.nodes.column(q, d) + state.tiling.slots());
    return all;
  };
  clear();
  REQUIRE(passes->project(state, false));
  passes->strain_and_force(state, 0, 1);
  const auto apart = rows();
  clear();
  REQUIRE(passes->project(state, true));
  const auto together = rows();
  for (std::size_t q = 0; q < apart.size(); ++q) CHECK(relative_difference(together[q], apart[q]) < 1e-13);
}

TEST_CASE("the force that is projected with mass and momentum is that of a pass of its own") {
  for (const char* basis : {"linear", "ugimp", "lcpdi", "qcpdi", "bspline2", "bspline3"}) {
    check_force<2>(basis);
    check_force<3>(basis);
  }
}

}  // namespace
}  // namespace mpmfast
