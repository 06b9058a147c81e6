#pragma once

/// @file Gathers the point cloud of a contact node from the tile and cell order of the particles.

#include <cstdint>
#include <vector>

#include "kernels/contact/cloud.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Room for the cloud of one node; one per thread, grown only by clouds larger than any before.
template <int Dim>
struct CloudRoom {
  std::vector<double> xi[Dim];  ///< relative to the node, cells
  std::vector<double> side;
  std::vector<double> radius;  ///< ellipsoid radius along the normal, cells
  std::vector<double> deformation[Dim * Dim];
  std::vector<double> half_size[Dim];  ///< cells
  std::vector<int> owner;              ///< which of the node's fields
  int count = 0;

  /// Room for n particles and a vector beyond.
  void reserve(int n) {
    const auto needed = static_cast<std::size_t>(padded_count(n) + kLanes);
    if (side.size() >= needed) return;
    const auto grow = [&](auto& column) { column.resize(2 * needed); };
    for (auto& c : xi) grow(c);
    for (auto& c : deformation) grow(c);
    for (auto& c : half_size) grow(c);
    grow(side);
    grow(radius);
    grow(owner);
  }
  CloudView<Dim> view() const {
    CloudView<Dim> v;
    for (int d = 0; d < Dim; ++d) v.xi[d] = xi[d].data();
    v.side = side.data();
    v.count = count;
    return v;
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
            const auto at = static_cast<std::size_t>(room.count++);
            for (int d = 0; d < Dim; ++d) {
              room.xi[d][at] = (p.position[d][q] - c.grid->origin[d]) * c.grid->inverse_cell - node[d];
              room.half_size[d][at] = half_size[d] * c.grid->inverse_cell;
            }
            for (int e = 0; e < Dim * Dim; ++e) room.deformation[e][at] = p.deformation[e][q];
            room.owner[at] = owner;
          }
        }
      }
  }
}

}  // namespace mpmfast
