/// Clouds of nodes against a look at every particle.

#include "kernels/basis/cpdi.hpp"
#include "kernels/basis/separable.hpp"
#include "kernels/contact/collect.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A block whose particles are strained and turned, in a step's memory.
template <int Dim>
std::string block(const char* basis) {
  std::string text = Dim == 2 ? R"(
space: plane_strain
grid: {origin: [-8 m, -8 m], size: [24 m, 24 m], cell: 1 m}
bodies: [{name: block, box: {from: [0 m, 0 m], to: [7 m, 9 m]}, material: m}]
)"
                              : R"(
space: 3d
grid: {origin: [-6 m, -6 m, -6 m], size: [18 m, 18 m, 18 m], cell: 1 m}
bodies: [{name: block, box: {from: [0 m, 0 m, 0 m], to: [3 m, 4 m, 5 m]}, material: m}]
)";
  text += "time: {end: 1 s}\n";
  text += "materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}\n";
  return text + "method: {basis: " + basis + "}\n";
}

template <int Dim>
void distort(State<Dim>& state) {
  Mat<Dim> f = Mat<Dim>::Identity();
  f(0, 0) = 0.8;
  f(0, 1) = 0.3;
  f(1, 0) = -0.1;
  const ParticleView<Dim> view = state.view();
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    const Vec<Dim> x = f * state.particles.vector(Quantity::position, p);
    for (int d = 0; d < Dim; ++d) {
      view.position[d][p] = x[d];
      for (int j = 0; j < Dim; ++j) view.deformation[Dim * d + j][p] = f(d, j);
    }
  }
}

/// Compares the clouds of every node of every block, with the particles near the whole block and near that
/// node alone. @return particles in all clouds
template <int Dim, class Basis>
int compare(const State<Dim>& state) {
  const DomainView<Dim> domains = state.domains();
  const auto& tiling = state.tiling;
  const auto context = [&](const ParticleTile<Dim>& tile) {
    return TileContext<Dim, DomainView<Dim>>{&domains, &tile, tiling.runs.data(), state.bodies.data(),
                                             &state.grid};
  };
  int found = 0;
  for (const auto& block : tiling.node_blocks)
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const NodeIndex<Dim> node = tiling.node(block, local);
      std::vector<Vec<Dim>> expected;
      for (int t : tiling.node_tiles[static_cast<std::size_t>(block.begin)].particle_tile) {
        if (t < 0) continue;
        const auto& tile = tiling.tiles[static_cast<std::size_t>(t)];
        for (int r = tile.run_begin; r < tile.run_end; ++r) {
          const auto& run = tiling.runs[static_cast<std::size_t>(r)];
          for (std::uint32_t p = run.begin; p < run.end; ++p)
            if (Basis::covers(chunk_geometry(context(tile), run, p, 1), 0, node))
              expected.push_back(state.particles.vector(Quantity::position, p));
        }
      }
      for (const bool alone : {true, false}) {
        const NodeBox<Dim> box{alone ? node : tiling.node(block, 0),
                               alone ? node : tiling.node(block, kTileNodes<Dim> - 1)};
        Candidates<Dim> candidates;
        for (int t : tiling.node_tiles[static_cast<std::size_t>(block.begin)].particle_tile)
          if (t >= 0)
            add_candidates<Dim, Basis>(context(tiling.tiles[static_cast<std::size_t>(t)]), box, candidates);
        CloudWorkspace<Dim> workspace;
        for (const auto& piece : candidates.pieces)
          append_covering<Dim, Basis>(candidates, piece, state.grid.inverse_cell, node, workspace);
        REQUIRE(workspace.count == static_cast<int>(expected.size()));
        workspace.pad();
        const auto cloud = workspace.columns(0, workspace.count);
        for (int k = 0; k < cloud.count; ++k)
          for (int d = 0; d < Dim; ++d) {
            const double x = expected[static_cast<std::size_t>(k)][d];
            const double xi = (x - state.grid.origin[d]) * state.grid.inverse_cell - node[d];
            CHECK(std::abs(cloud.xi[d][k] - xi) < 1e-14);  // one rounding apart: coordinates up to 24
          }
      }
      found += static_cast<int>(expected.size());
    }
  return found;
}

/// The clouds of a distorted block after two steps: particles drifted since the sort.
template <int Dim, class Basis>
int clouds(const char* basis) {
  const Scene scene = scene_from(block<Dim>(basis));
  Step<Dim> step(scene);
  distort(step.state());
  const double dt = step.stable_dt();
  for (std::size_t p = 0; p < step.state().particles.size(); ++p)
    step.state().particles.column(Quantity::velocity, 0)[p] = 0.2 / dt;
  step.advance(dt);
  step.advance(dt);
  return compare<Dim, Basis>(step.state());
}

TEST_CASE("clouds hold the particles that cover their node, in order") {
  CHECK(clouds<2, LinearBasis<2>>("linear") > 1000);
  CHECK(clouds<2, UGimpBasis<2>>("ugimp") > 1000);
  CHECK(clouds<2, LcpdiBasis<2>>("lcpdi") > 1000);
  CHECK(clouds<2, QcpdiBasis<2>>("qcpdi") > 1000);
  CHECK(clouds<2, BSpline3Basis<2>>("bspline3") > 1000);
  CHECK(clouds<3, UGimpBasis<3>>("ugimp") > 1000);
  CHECK(clouds<3, LcpdiBasis<3>>("lcpdi") > 1000);
}

TEST_CASE("chosen lanes are written side by side") {
  Lanes v, limit = broadcast<Lanes>(0.0);
  for (int i = 0; i < kLanes; ++i) v[i] = i + 1;
  for (unsigned wanted = 0; wanted < 1u << kLanes; ++wanted) {
    for (int i = 0; i < kLanes; ++i) limit[i] = wanted >> i & 1 ? 0.0 : 100.0;
    const unsigned bits = lane_bits(v > limit);
    CHECK(bits == wanted);
    double out[kLanes];
    store_chosen(out, v, bits);
    int at = 0;
    for (int i = 0; i < kLanes; ++i)
      if (wanted >> i & 1) CHECK(out[at++] == i + 1);
  }
  CHECK(first_lanes(0) == 0);
  CHECK(first_lanes(kLanes) == (1u << kLanes) - 1);
}

}  // namespace
}  // namespace mpmfast
