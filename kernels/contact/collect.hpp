#pragma once

/// @file Gathers the point cloud of a contact node from the tile and cell order of the particles.

#include <cstdint>
#include <vector>

#include "kernels/contact/cloud.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Columns of one cloud in its room, valid until the room grows.
template <int Dim>
struct CloudColumns {
  const double* xi[Dim];
  const double* edge[Dim * Dim];
  const int* owner;
  int count;
};

/// Room for clouds, one after the other; one per thread, grown only by clouds larger than any before.
template <int Dim>
struct CloudRoom {
  std::vector<double> xi[Dim];          ///< relative to the node, cells
  std::vector<double> edge[Dim * Dim];  ///< half-edge vectors of the domain, F diag(R0), row-major, cells
  std::vector<int> owner;               ///< which of the node's fields; −1 in the padding
  std::size_t begin = 0;                ///< where the cloud in hand begins
  int count = 0;                        ///< its particles

  /// Room for n particles of the cloud in hand and a vector beyond.
  void reserve(int n) {
    const std::size_t needed = begin + static_cast<std::size_t>(padded_count(n) + kLanes);
    if (owner.size() >= needed) return;
    const auto grow = [&](auto& column) { column.resize(2 * needed); };
    for (auto& c : xi) grow(c);
    for (auto& c : edge) grow(c);
    grow(owner);
  }

  /// Fills what is read beyond the last particle with entries that do not count.
  void pad() {
    reserve(count + kLanes);
    for (int k = count; k < padded_count(count); ++k) {
      const std::size_t at = begin + static_cast<std::size_t>(k);
      owner[at] = -1;
      for (int d = 0; d < Dim; ++d) {
        xi[d][at] = 0;
        for (int j = 0; j < Dim; ++j) edge[Dim * d + j][at] = d == j ? 1 : 0;
      }
    }
  }

  CloudColumns<Dim> columns(std::size_t first, int particles) const {
    CloudColumns<Dim> c;
    for (int d = 0; d < Dim; ++d) c.xi[d] = xi[d].data() + first;
    for (int e = 0; e < Dim * Dim; ++e) c.edge[e] = edge[e].data() + first;
    c.owner = owner.data() + first;
    c.count = particles;
    return c;
  }
};

/// Appends the particles of one tile whose basis functions cover the node. @param owner of the tile's field
///
/// A particle that was sorted into cell o now begins its support at o − 1 … o + 1 (the next sort comes before
/// it drifts further), so only cells o with node − kMaxSupport ≤ o ≤ node + 1 need a look (node and o within
/// the window).
template <int Dim, class Basis>
inline void collect_tile(const TileContext<Dim>& c, const NodeIndex<Dim>& node, int owner,
                         CloudRoom<Dim>& room) {
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (int d = 0; d < Dim; ++d) {
    const int at = node[d] - c.tile->window[d] - kSortedOffset<Basis>;  // where cell numbers start
    low[d] = at - Basis::kMaxSupport > 0 ? at - Basis::kMaxSupport : 0;
    high[d] = at + 1 < kTileSide - 1 ? at + 1 : kTileSide - 1;
    if (low[d] > high[d]) return;
  }
  const ParticleView<Dim>& p = *c.particles;
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r) {
    const ParticleRun<Dim>& run = c.runs[r];
    const double* half_size = c.bodies[run.body].half_size;
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const int row = (z * kTileSide + y) * kTileSide;
        const std::uint32_t begin = run.cell_begin[row + low[0]], end = run.cell_begin[row + high[0] + 1];
        if (begin == end) continue;
        room.reserve(room.count + static_cast<int>(end - begin));
        const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, static_cast<int>(end - begin));
        for (int k = 0; k < g.count; k += kLanes) {
          const Lanes margin = Basis::coverage(g, k, node);
          for (int lane = 0; lane < kLanes && k + lane < g.count; ++lane) {
            if (!(margin[lane] > 0)) continue;
            const std::uint32_t q = begin + static_cast<std::uint32_t>(k + lane);
            const std::size_t at = room.begin + static_cast<std::size_t>(room.count++);
            for (int d = 0; d < Dim; ++d)
              room.xi[d][at] = (p.position[d][q] - c.grid->origin[d]) * c.grid->inverse_cell - node[d];
            for (int e = 0; e < Dim * Dim; ++e)
              room.edge[e][at] = p.deformation[e][q] * (half_size[e % Dim] * c.grid->inverse_cell);
            room.owner[at] = owner;
          }
        }
      }
  }
}

}  // namespace mpmfast
