// Cubes of nodes: their numbering, and a bit for each.
#pragma once

#include <array>
#include <cstdint>

#include "engine/state/tiling.hpp"

namespace mpmfast {

/// Strides of a cube of nodes.
template <int Dim>
int cube_index(int side, const NodeIndex<Dim>& at) {
  int index = 0;
  for (int d = Dim - 1; d >= 0; --d) index = index * side + at[d];
  return index;
}

template <int Dim>
NodeIndex<Dim> cube_node(int side, int index) {
  NodeIndex<Dim> at;
  for (int d = 0; d < Dim; ++d, index /= side) at[d] = index % side;
  return at;
}

/// A cube of nodes as rows along x of a bit each: rows of kSide bits, kSide^(Dim − 1) of them.
template <int Dim, int kSide>
struct BitCube {
  static constexpr int kRows = power(kSide, Dim - 1);
  std::array<std::uint16_t, static_cast<std::size_t>(kRows)> row{};

  /// Puts in a tile's nodes, a bit each (x fastest). @param place  of the tile in the cube, in tiles
  void put(std::uint64_t nodes, const NodeIndex<Dim>& tile) {
    for (int r = 0; r < kTileNodes<Dim> / kTileSide; ++r)
      at(tile, r) |=
          static_cast<std::uint16_t>((nodes >> (r * kTileSide) & kNodesOfRow) << (tile[0] * kTileSide));
  }
  std::uint64_t take(const NodeIndex<Dim>& tile) {
    std::uint64_t nodes = 0;
    for (int r = 0; r < kTileNodes<Dim> / kTileSide; ++r)
      nodes |= std::uint64_t{at(tile, r) >> (tile[0] * kTileSide) & kNodesOfRow} << (r * kTileSide);
    return nodes;
  }
  /// Each becomes what any of it and the `count` below it along each axis is.
  void spread_up(int count) {
    for (auto& r : row)
      for (int t = 0; t < count; ++t) r = static_cast<std::uint16_t>(r | r << 1);
    for_each_line([&](int first, int stride) {
      for (int t = 0; t < count; ++t)
        for (int k = kSide - 1; k > 0; --k) {
          auto& own = at(first + k * stride);
          own = static_cast<std::uint16_t>(own | at(first + (k - 1) * stride));
        }
    });
  }
  /// Each becomes what all of it and the `count` above it along each axis are.
  void shrink_down(int count) {
    for (auto& r : row)
      for (int t = 0; t < count; ++t) r = static_cast<std::uint16_t>(r & r >> 1);
    for_each_line([&](int first, int stride) {
      for (int t = 0; t < count; ++t) {
        for (int k = 0; k + 1 < kSide; ++k) {
          auto& own = at(first + k * stride);
          own = static_cast<std::uint16_t>(own & at(first + (k + 1) * stride));
        }
        at(first + (kSide - 1) * stride) = 0;
      }
    });
  }

 private:
  static constexpr std::uint64_t kNodesOfRow = (1u << kTileSide) - 1;

  /// Of rows, along each axis but x: calls line(first, stride).
  template <class Line>
  static void for_each_line(const Line& line) {
    for (int stride = 1; stride < kRows; stride *= kSide)
      for (int r = 0; r < kRows; ++r)
        if (r / stride % kSide == 0) line(r, stride);
  }
  std::uint16_t& at(int r) { return row[static_cast<std::size_t>(r)]; }
  /// The r-th row of the tile.
  std::uint16_t& at(const NodeIndex<Dim>& tile, int r) {
    int index = 0, stride = 1;
    for (int d = 1; d < Dim; ++d, r /= kTileSide, stride *= kSide)
      index += (tile[d] * kTileSide + r % kTileSide) * stride;
    return at(index);
  }
};

}  // namespace mpmfast
