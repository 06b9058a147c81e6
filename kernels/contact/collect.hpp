#pragma once

/// @file Gathers the point clouds of contact nodes from the tile and cell order of the particles: once the
/// particles near a whole tile of nodes, then out of these the cloud of each node.

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/constants.hpp"
#include "kernels/contact/cloud.hpp"
#include "kernels/contact/separation.hpp"
#include "kernels/simd/compress.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Workspace for clouds, one after the other; one per thread, grown only by clouds larger than any before.
template <int Dim>
struct CloudWorkspace {
  std::vector<double> xi[Dim];           ///< relative to the node, cells
  std::vector<double> shape[Dim * Dim];  ///< as CloudColumns::shape; those in use
  std::vector<double> number;            ///< of the particles, if asked for
  int shapes = 0;                        ///< how many are in use
  bool numbered = false;
  std::size_t begin = 0;  ///< where the cloud in hand begins
  int count = 0;          ///< its particles

  /// Space for n particles of the cloud in hand and a vector beyond.
  void reserve(int n) {
    const std::size_t needed = begin + static_cast<std::size_t>(padded_count(n) + kLanes);
    if (xi[0].size() >= needed) return;
    const std::size_t capacity = needed + needed / 4 + constants::kCloudReserve;
    for (auto& c : xi) c.resize(capacity);
    for (int e = 0; e < shapes; ++e) shape[e].resize(capacity);
    if (numbered) number.resize(capacity);
  }

  /// Fills what is read beyond the last particle with entries that do not count.
  void pad() {
    reserve(count + kLanes);
    for (int k = count; k < padded_count(count); ++k) {
      const std::size_t at = begin + static_cast<std::size_t>(k);
      for (int d = 0; d < Dim; ++d) xi[d][at] = 0;
    }
  }

  /// Appends the particles [first, end) of another cloud, without their domains.
  void append_positions(const CloudColumns<Dim>& cloud, int first, int end) {
    reserve(count + end - first + kLanes);
    const std::size_t at = begin + static_cast<std::size_t>(count);
    const auto copy = [&](const double* from, std::vector<double>& to) {
      for (int k = first; k < end; k += kLanes)
        store_lanes(&to[at + static_cast<std::size_t>(k - first)], load_lanes(from + k));
    };
    for (int d = 0; d < Dim; ++d) copy(cloud.xi[d], xi[d]);
    count += end - first;
  }

  CloudColumns<Dim> columns(std::size_t first, int particles) const {
    CloudColumns<Dim> c{};
    for (int d = 0; d < Dim; ++d) c.xi[d] = xi[d].data() + first;
    for (int e = 0; e < shapes; ++e) c.shape[e] = shape[e].data() + first;
    if (numbered) c.number = number.data() + first;
    c.count = particles;
    return c;
  }
};

/// The nodes between two corners, both included.
template <int Dim>
struct NodeBox {
  NodeIndex<Dim> low, high;
};

/// Candidates of one body in one tile. It begins at a multiple of kLanes; up to the next piece, the columns
/// hold entries that reach no node.
template <int Dim>
struct CandidatePiece {
  int field, begin, count;
  double half_size[Dim];  ///< m, of the undeformed domains
};

/// Particles whose supports may reach some node of a box, in pieces; those of one velocity field follow each
/// other.
template <int Dim>
struct Candidates {
  std::vector<CandidatePiece<Dim>> pieces;
  std::vector<double> position[Dim];      ///< m, from the grid's origin
  std::vector<double> domain[Dim * Dim];  ///< m; half-edge vectors of CPDI domains, else not written
  std::vector<double> shape[Dim * Dim];   ///< of the domains F diag(R0), as the extent asks, cells
  std::vector<double> reach[Dim];         ///< of the support, cells
  std::vector<double> number;             ///< of the particles, if asked for
  std::optional<Extent> extent;           ///< that separations go by; none: no shapes
  bool numbered = false;
  int count = 0;

  int shapes() const { return extent ? shape_size<Dim>(*extent) : 0; }
  void clear() {
    pieces.clear();
    count = 0;
  }
  /// Space for n more and two vectors beyond.
  void reserve(int n) {
    const auto needed = static_cast<std::size_t>(count + n + 2 * kLanes);
    if (reach[0].size() >= needed) return;
    const auto grow = [&](auto& columns) {
      for (auto& column : columns) column.resize(2 * needed);
    };
    grow(position);
    grow(domain);
    grow(reach);
    for (int e = 0; e < shapes(); ++e) shape[e].resize(2 * needed);
    if (numbered) number.resize(2 * needed);
  }

  /// Writes the shapes of the chosen ones of some domains after the last candidate.
  void store_shapes(const Lanes (&edges)[Dim * Dim], unsigned bits) {
    const auto store = [&]<Extent E>() {
      Lanes found[shape_size<Dim>(E)];
      domain_shape<E, Dim>(edges, found);
      for (int e = 0; e < shape_size<Dim>(E); ++e)
        store_chosen(&shape[e][static_cast<std::size_t>(count)], found[e], bits);
    };
    switch (*extent) {
      case Extent::radial:
        return store.template operator()<Extent::radial>();
      case Extent::ellipsoid:
        return store.template operator()<Extent::ellipsoid>();
      case Extent::parallelepiped:
        return store.template operator()<Extent::parallelepiped>();
    }
  }
};

/// Appends one run of particles [begin, end) as a piece.
template <int Dim, class Basis>
inline void add_candidates(const TileContext<Dim, DomainView<Dim>>& c, const ParticleRun<Dim>& run,
                           std::uint32_t begin, std::uint32_t end, const NodeBox<Dim>& box,
                           Candidates<Dim>& out) {
  const int particles = static_cast<int>(end - begin);
  out.reserve(particles);
  CandidatePiece<Dim> piece{c.tile->field, out.count, 0, {}};
  const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, particles);
  for (int d = 0; d < Dim; ++d) piece.half_size[d] = g.half_size[d];
  for (int k = 0; k < particles; k += kLanes) {
    Lanes shift[Dim], reach[Dim];
    IntLanes near = ~IntLanes{};
    for (int d = 0; d < Dim; ++d) {
      shift[d] = load_lanes(g.position[d] + k) - g.origin[d];
      reach[d] = Basis::reach(g, k, d);
      const Lanes r = shift[d] * g.inverse_cell;
      near &= (r + reach[d] > static_cast<double>(box.low[d])) &
              (r - reach[d] < static_cast<double>(box.high[d]));
    }
    const unsigned bits = lane_bits(near) & first_lanes(particles - k < kLanes ? particles - k : kLanes);
    if (!bits) continue;
    const auto at = static_cast<std::size_t>(out.count);
    for (int d = 0; d < Dim; ++d) {
      store_chosen(&out.position[d][at], shift[d], bits);
      store_chosen(&out.reach[d][at], reach[d], bits);
    }
    if constexpr (Basis::kConvected)
      for (int e = 0; e < Dim * Dim; ++e) store_chosen(&out.domain[e][at], load_lanes(g.edge[e] + k), bits);
    if (out.extent) {
      Lanes edges[Dim * Dim];
      for (int e = 0; e < Dim * Dim; ++e) {
        const double scale = g.half_size[e % Dim] * g.inverse_cell;
        edges[e] = load_lanes(c.particles->deformation[e] + begin + k) * scale;
        if (const double* share = c.particles->domain_share[e % Dim])
          edges[e] *= load_lanes(share + begin + k);
      }
      out.store_shapes(edges, bits);
    }
    if (out.numbered) {
      Lanes number;
      for (int i = 0; i < kLanes; ++i) number[i] = static_cast<double>(begin) + k + i;
      store_chosen(&out.number[at], number, bits);
    }
    out.count += std::popcount(bits);
  }
  piece.count = out.count - piece.begin;
  if (piece.count == 0) return;
  for (int d = 0; d < Dim; ++d)
    store_lanes(&out.reach[d][static_cast<std::size_t>(out.count)], broadcast<Lanes>(-1.0));
  out.count = piece.begin + padded_count(piece.count);
  out.pieces.push_back(piece);
}

/// Appends the particles of one tile that may reach a node of the box.
///
/// A particle that was sorted into cell o now begins its support at o − 1 … o + 1 (the next sort comes before
/// it drifts further), so only cells o with low − kMaxSupport ≤ o ≤ high + 1 need a look (nodes and o within
/// the window). Cells are kept by the last axis: what lies between is consecutive.
template <int Dim, class Basis>
inline void add_candidates(const TileContext<Dim, DomainView<Dim>>& c, const NodeBox<Dim>& box,
                           Candidates<Dim>& out) {
  constexpr int last = Dim - 1, stride = kTileNodes<Dim> / kTileSide;
  const int start = c.tile->window[last] + kSortedOffset<Basis>;  // where cell numbers start
  const int low = box.low[last] - start - Basis::kMaxSupport, high = box.high[last] - start + 1;
  const int first = low > 0 ? low : 0, end = high < kTileSide - 1 ? high + 1 : kTileSide;
  if (first >= end) return;
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r) {
    const ParticleRun<Dim>& run = c.runs[r];
    const std::uint32_t from = run.cell_begin[first * stride], to = run.cell_begin[end * stride];
    if (from < to) add_candidates<Dim, Basis>(c, run, from, to, box, out);
  }
}

/// Appends the particles of one piece whose basis functions cover the node.
template <int Dim, class Basis>
inline void append_covering(const Candidates<Dim>& from, const CandidatePiece<Dim>& piece,
                            double inverse_cell, const NodeIndex<Dim>& node, CloudWorkspace<Dim>& workspace) {
  workspace.reserve(workspace.count + piece.count + kLanes);
  ChunkGeometry<Dim> g{};
  const auto begin = static_cast<std::size_t>(piece.begin);
  for (int d = 0; d < Dim; ++d) {
    g.position[d] = from.position[d].data() + begin;
    g.half_size[d] = piece.half_size[d];
  }
  for (int e = 0; e < Dim * Dim; ++e) g.edge[e] = from.domain[e].data() + begin;
  g.inverse_cell = inverse_cell;
  g.count = piece.count;
  for (int k = 0; k < piece.count; k += kLanes) {
    Lanes xi[Dim];
    IntLanes near = ~IntLanes{};
    for (int d = 0; d < Dim; ++d) {
      xi[d] = load_lanes(g.position[d] + k) * inverse_cell - static_cast<double>(node[d]);
      near &= magnitude(xi[d]) < load_lanes(&from.reach[d][begin + static_cast<std::size_t>(k)]);
    }
    if (!lane_bits(near)) continue;
    const unsigned bits = lane_bits(near & (Basis::coverage(g, k, node) > 0.0));
    const std::size_t at = workspace.begin + static_cast<std::size_t>(workspace.count);
    for (int d = 0; d < Dim; ++d) store_chosen(&workspace.xi[d][at], xi[d], bits);
    for (int e = 0; e < workspace.shapes; ++e)
      store_chosen(&workspace.shape[e][at], load_lanes(&from.shape[e][begin + static_cast<std::size_t>(k)]),
                   bits);
    if (workspace.numbered)
      store_chosen(&workspace.number[at], load_lanes(&from.number[begin + static_cast<std::size_t>(k)]),
                   bits);
    workspace.count += std::popcount(bits);
  }
}

}  // namespace mpmfast
