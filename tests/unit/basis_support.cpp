// What a chunk's support depends on, and on what not.

#include <doctest/doctest.h>

#include <memory>

#include "kernels/basis/cpdi.hpp"
#include "kernels/views.hpp"

namespace mpmfast {
namespace {

/// Of a chunk that lies in its window.
template <class Basis>
bool narrow_suffices(const ChunkGeometry<2>& g) {
  const auto workspace = std::make_unique<WeightWorkspace<2, Basis>>();
  REQUIRE(Basis::stage(g, workspace->wide));
  return Basis::stage(g, workspace->narrow);
}

TEST_CASE(
    "particles beyond the end of a chunk do not choose its support: another thread may be moving them") {
  constexpr int kCapacity = 4 * kLanes;
  alignas(64) double x[2][kCapacity], edge[4][kCapacity];
  for (int k = 0; k < kCapacity; ++k) {
    x[0][k] = x[1][k] = 2.3;
    edge[0][k] = edge[3][k] = k < 3 ? 0.25 : 0.99;  // narrow in the chunk, wide after it
    edge[1][k] = edge[2][k] = 0;
  }
  ChunkGeometry<2> g{};
  for (int d = 0; d < 2; ++d) g.position[d] = x[d];
  for (int e = 0; e < 4; ++e) g.edge[e] = edge[e];
  g.inverse_cell = 1;
  g.count = 3;
  CHECK(narrow_suffices<LcpdiBasis<2>>(g));
  CHECK(narrow_suffices<QcpdiBasis<2>>(g));
  g.count = 4;
  CHECK(!narrow_suffices<LcpdiBasis<2>>(g));
  CHECK(!narrow_suffices<QcpdiBasis<2>>(g));
}

}  // namespace
}  // namespace mpmfast
