// The window of a tile is what the nodal columns hold of its nodes, and goes back to the same ones (in the
// precision of the transfers: compiled in both).

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "kernels/transfer/window.hpp"

namespace mpmfast {
namespace {

/// What a window is loaded for, with its nodes in tiles that lie anywhere.
template <int Dim>
struct Tile {
  int slot[kCorners<Dim>];
  const int* node_slot = nullptr;
};

/// The slot of a node of the window.
template <int Dim>
int slot_of(const Tile<Dim>& tile, int at) {
  int corner = 0, local = 0, stride = 1;
  for (int d = 0; d < Dim; ++d, at /= kWindowSide, stride *= kTileSide) {
    corner |= at % kWindowSide / kTileSide << d;
    local += at % kTileSide * stride;
  }
  return tile.slot[corner] + local;
}

template <int Dim, int NC>
void check_window() {
  constexpr int kTiles = 2 * kCorners<Dim>, kSlots = kTiles * kTileNodes<Dim>;
  std::vector<std::vector<double>> numbers(NC, std::vector<double>(kSlots));
  NodeColumns<NC> columns;
  for (int c = 0; c < NC; ++c) {
    for (int slot = 0; slot < kSlots; ++slot)
      numbers[static_cast<std::size_t>(c)][static_cast<std::size_t>(slot)] = 1000 * c + slot;
    columns.column[c] = numbers[static_cast<std::size_t>(c)].data();
  }
  Tile<Dim> tile;
  for (int corner = 0; corner < kCorners<Dim>;
       ++corner)  // 5 and the number of tiles have no divisor in common
    tile.slot[corner] = (3 + 5 * corner) % kTiles * kTileNodes<Dim>;

  const auto window = std::make_unique<Window<Dim, NC>>();
  load_window(columns, tile, *window);
  const auto entry = [&](int at, int c) -> Real {
    return window->at[c / window->kPerNode][at][c % window->kPerNode];
  };
  for (int at = 0; at < kWindowNodes<Dim>; ++at)
    for (int c = 0; c < window->kRecords * window->kPerNode; ++c)
      REQUIRE(double{entry(at, c)} == (c < NC ? 1000 * c + slot_of(tile, at) : 0));

  // It is added to all nodes of its tiles, and to no other; a column that is not wanted is left alone.
  double* const unwanted = std::exchange(columns.column[NC / 2], nullptr);
  flush_window(*window, tile, columns);
  columns.column[NC / 2] = unwanted;
  std::vector<int> times(kSlots, 1);
  for (int at = 0; at < kWindowNodes<Dim>; ++at) ++times[static_cast<std::size_t>(slot_of(tile, at))];
  for (int c = 0; c < NC; ++c)
    for (int slot = 0; slot < kSlots; ++slot)
      REQUIRE(columns.column[c][slot] ==
              (1000 * c + slot) * (c == NC / 2 ? 1 : times[static_cast<std::size_t>(slot)]));
}

TEST_CASE("a window holds the columns of its nodes, and is added to them and no others") {
  check_window<2, 1>();
  check_window<2, 3>();
  check_window<2, 8>();
  check_window<2, 10>();
  check_window<3, 4>();
  check_window<3, 7>();
  check_window<3, 9>();
}

}  // namespace
}  // namespace mpmfast
