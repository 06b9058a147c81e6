#pragma once

/// @file The window: the nodes that one tile of particles can touch, as interleaved records in cache. Between
/// the window and the nodal columns (structure of arrays over slots) rows of four nodes, or two rows, are
/// transposed.

#include <cstring>

#include "kernels/basis/weights.hpp"

namespace mpmfast {

/// A window of NC quantities per node.
template <int Dim, int NC>
struct Window {
  using Node = RecordFor<NC>;
  static constexpr int kPerNode = sizeof(Node) / sizeof(Real);
  static constexpr int kRecords = (NC + kPerNode - 1) / kPerNode;
  alignas(64) Node at[kRecords][kWindowNodes<Dim>];
};

/// NC nodal columns, each indexed by slot; null where a place in the window has none.
template <int NC>
struct NodeColumns {
  double* column[NC];
};

namespace detail {

/// Calls f(slot, window index) for each N nodes side by side in a tile, rows of kTileSide, of each tile under
/// the window, or of every other one. In the window their rows are kWindowSide apart: node_at.
template <int Dim, int N, class F>
inline void for_each_block(const int (&tile_slot)[kCorners<Dim>], F f, int step = 1) {
  constexpr int kRows = N / kTileSide;
  static_assert(N % kTileSide == 0 && kTileSide % kRows == 0);
  for (int corner = 0; corner < kCorners<Dim>; corner += step) {
    int base = 0, stride = 1;
    for (int d = 0; d < Dim; ++d) {
      base += (corner >> d & 1) * kTileSide * stride;
      stride *= kWindowSide;
    }
    for (int row = 0; row < kTileNodes<Dim> / kTileSide; row += kRows) {
      const int y = row % kTileSide, z = row / kTileSide;
      f(tile_slot[corner] + row * kTileSide, base + y * kWindowSide + z * kWindowSide * kWindowSide);
    }
  }
}
/// Of the i-th of such nodes, from the index of the first.
constexpr int node_at(int first, int i) { return first + i % kTileSide + i / kTileSide * kWindowSide; }

inline Row load_row(const double* p) {
  Row r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void store_row(double* p, Row r) { std::memcpy(p, &r, sizeof r); }
inline Record load_record(const Real* p) {
  Record r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void store_record(Real* p, Record r) { std::memcpy(p, &r, sizeof r); }

// Four numbers of a column and those of transfers.
inline Record to_record(Row r) { return __builtin_convertvector(r, Record); }
inline Row to_row(Record r) { return __builtin_convertvector(r, Row); }

// As many as a record of a window has.
template <class Node>
inline Node load_column(const double* p) {
  std::conditional_t<std::is_same_v<Node, Record>, Row, WideRow> numbers;
  std::memcpy(&numbers, p, sizeof numbers);
  return __builtin_convertvector(numbers, Node);
}
template <class Node>
inline void add_to_column(double* p, Node of) {
  std::conditional_t<std::is_same_v<Node, Record>, Row, WideRow> numbers;
  std::memcpy(&numbers, p, sizeof numbers);
  numbers += __builtin_convertvector(of, decltype(numbers));
  std::memcpy(p, &numbers, sizeof numbers);
}

}  // namespace detail

template <int Dim, int NC>
inline void clear(Window<Dim, NC>& window) {
  std::memset(static_cast<void*>(&window), 0, sizeof window);
}

/// Fills the window from the columns. @param tile_slot first slot of each tile under the window
template <int Dim, int NC>
inline void load_rows(const NodeColumns<NC>& columns, const int (&tile_slot)[kCorners<Dim>],
                      Window<Dim, NC>& window) {
  using Node = typename Window<Dim, NC>::Node;
  constexpr int N = Window<Dim, NC>::kPerNode;
  detail::for_each_block<Dim, N>(tile_slot, [&](int slot, int at) {
#pragma GCC unroll 4
    for (int r = 0; r < window.kRecords; ++r) {
      Node row[N];
      for (int c = 0; c < N; ++c)
        row[c] = N * r + c < NC ? detail::load_column<Node>(columns.column[N * r + c] + slot) : Node{};
      transpose(row);
      for (int i = 0; i < N; ++i) window.at[r][detail::node_at(at, i)] = row[i];
    }
  });
}

/// Adds the window, or with a step of 2 the half that is lower along x, to the columns. Tiles whose windows
/// overlap must not run at the same time.
template <int Dim, int NC>
inline void flush_rows(const Window<Dim, NC>& window, const int (&tile_slot)[kCorners<Dim>],
                       const NodeColumns<NC>& columns, int step = 1) {
  using Node = typename Window<Dim, NC>::Node;
  constexpr int N = Window<Dim, NC>::kPerNode;
  detail::for_each_block<Dim, N>(
      tile_slot,
      [&](int slot, int at) {
#pragma GCC unroll 4
        for (int r = 0; r < window.kRecords; ++r) {
          Node row[N];
          for (int i = 0; i < N; ++i) row[i] = window.at[r][detail::node_at(at, i)];
          transpose(row);
          for (int c = 0; c < N && N * r + c < NC; ++c) {
            double* column = columns.column[N * r + c];
            if (column) detail::add_to_column(column + slot, row[c]);
          }
        }
      },
      step);
}

/// The same node by node, for tiles whose nodes take sides.
template <int Dim, int NC>
[[gnu::noinline, gnu::cold]] void load_nodes(const NodeColumns<NC>& columns, const int* node_slot,
                                             Window<Dim, NC>& window) {
  for (int at = 0; at < kWindowNodes<Dim>; ++at)
    for (int c = 0; c < window.kRecords * window.kPerNode; ++c)
      window.at[c / window.kPerNode][at][c % window.kPerNode] =
          c < NC ? static_cast<Real>(columns.column[c][node_slot[at]]) : Real{0};
}
template <int Dim, int NC>
[[gnu::noinline, gnu::cold]] void flush_nodes(const Window<Dim, NC>& window, const int* node_slot,
                                              const NodeColumns<NC>& columns) {
  for (int c = 0; c < NC; ++c)
    for (int at = 0; columns.column[c] && at < kWindowNodes<Dim>; ++at)
      columns.column[c][node_slot[at]] +=
          static_cast<double>(window.at[c / window.kPerNode][at][c % window.kPerNode]);
}

/// Fills the window of a tile (ParticleTile), and adds it to the columns.
template <int Dim, int NC, class Tile>
inline void load_window(const NodeColumns<NC>& columns, const Tile& tile, Window<Dim, NC>& window) {
  if (tile.node_slot) [[unlikely]]
    return load_nodes<Dim>(columns, tile.node_slot, window);
  load_rows(columns, tile.slot, window);
}
template <int Dim, int NC, class Tile>
inline void flush_window(const Window<Dim, NC>& window, const Tile& tile, const NodeColumns<NC>& columns) {
  if (tile.node_slot) [[unlikely]]
    return flush_nodes<Dim>(window, tile.node_slot, columns);
  flush_rows(window, tile.slot, columns);
}

/// Asks for the rows under the half of a tile's window that is lower (0) or upper (1) along x, long before
/// they are read. (Always inline, as FetchAhead.)
template <int Dim, int NC, class Tile>
[[gnu::always_inline]] inline void fetch_rows(const NodeColumns<NC>& columns, const Tile& tile, int half) {
  constexpr int kLine = 64 / sizeof(double);
  if (tile.node_slot) return;
  for (int corner = half; corner < kCorners<Dim>; corner += 2)
    for (const double* column : columns.column)
      for (int k = 0; k < kTileNodes<Dim>; k += kLine)
        if (column) __builtin_prefetch(column + tile.slot[corner] + k);
}

// Sums along a strip of tiles: what a tile and the next one both add to stays in the window from one to the
// other. (In 2-D: in 3-D to move half a window costs as much as it saves.)

/// Are the nodes of the upper half of the window of `tile` those of the lower half of that of `next`?
template <int Dim, class Tile>
inline bool goes_on(const Tile& tile, const Tile& next) {
  bool same = Dim == 2 && !tile.node_slot && !next.node_slot;
  for (int corner = 0; corner < kCorners<Dim>; corner += 2)
    same &= tile.slot[corner + 1] == next.slot[corner];
  return same;
}

/// Readies a window for the sums of a tile. @param c a TileContext
template <int Dim, int NC, class Context>
inline void begin_sums(const Context& c, Window<Dim, NC>& window, const NodeColumns<NC>& columns) {
  if (!c.goes_on_from) clear(window);
  if constexpr (Dim == 2) fetch_rows<Dim>(columns, *c.tile, 0);
}

/// Adds to the columns what is complete.
template <int Dim, int NC, class Context>
inline void end_sums(const Context& c, Window<Dim, NC>& window, const NodeColumns<NC>& columns) {
  if (!c.goes_on_to) return flush_window(window, *c.tile, columns);
  flush_rows(window, c.tile->slot, columns, 2);
  constexpr std::size_t half = kTileSide * sizeof window.at[0][0];
  for (auto& records : window.at)
    for (int row = 0; row < kWindowNodes<Dim>; row += kWindowSide) {
      std::memcpy(records + row, records + row + kTileSide, half);
      std::memset(static_cast<void*>(records + row + kTileSide), 0, half);
    }
}

/// Records of a chunk from what is known by component: entry c < N of record k is lane 0 of value(c, k), that
/// of record k + 1 lane 1, and so on; the rest of four entries is zero. (Built component by component, a
/// record would be read back before its parts have left the store buffer.)
/// @param value called for k = 0, 4, 8, …; @param quad which four entries of the records to set
template <int N, class R, class F>
inline void pack(int count, R* out, int quad, const F& value) {
  static_assert(N <= 4);
  for (int k = 0; k < count; k += 4) {
    Record row[4];
    for (int c = 0; c < 4; ++c) row[c] = c < N ? detail::to_record(value(c, k)) : Record{};
    transpose(row);
    for (int c = 0; c < 4; ++c) detail::store_record(reinterpret_cast<Real*>(out + k + c) + 4 * quad, row[c]);
  }
}

/// The reverse: the first N entries of the records, one array each, out[c][k]; N is rounded up to fours.
template <int Dim, int N, class R>
inline void unpack(const R* in, int count, double (*out)[kChunk<Dim>]) {
  for (int c = 0; c < N; c += 4)
    for (int k = 0; k < count; k += 4) {
      Record row[4];
      for (int i = 0; i < 4; ++i) row[i] = detail::load_record(reinterpret_cast<const Real*>(in + k + i) + c);
      transpose(row);
      for (int i = 0; i < 4; ++i) detail::store_row(&out[c + i][k], detail::to_row(row[i]));
    }
}

}  // namespace mpmfast
