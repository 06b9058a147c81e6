#pragma once

/// @file Loops over the tiles of particles. A thread begins each of them with the same particles, as many as
/// the others have, and helps these when it is done.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "engine/state/team.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim>
class TileLoops {
 public:
  explicit TileLoops(int most_threads) : most_threads_(most_threads) {
    for (int c = 0; c < kCorners<Dim>; ++c) shares_.emplace_back(most_threads);
  }

  /// Calls f(context, thread, rigid) for each tile, colour after colour: windows of one colour do not
  /// overlap, and each slot adds up its tiles in the order of the colours, whatever the threads. Of a strip f
  /// must take all tiles or none, or sums that go on from one to the next are lost.
  template <class F>
  void for_each_by_colour(State<Dim>& state, const F& f) {
    const ParticleView<Dim> view = state.view();
    const auto& tiles = state.tiling.tiles;
    const auto& colours = state.tiling.colours;
    for (std::size_t colour = 0; colour < colours.size(); ++colour)
      shares_[colour].cut_at(state.threads, 1, [&](int thread) {
        const auto& strips = colours[colour];
        const auto before = [](const Strip& strip, std::int64_t tile) { return strip.begin < tile; };
        return std::lower_bound(strips.begin(), strips.end(), first_tile(state, thread), before) -
               strips.begin();
      });
    on_threads(state.threads, [&](const Member& me) {
      bool first = true;
      for (std::size_t colour = 0; colour < colours.size(); ++colour) {
        if (colours[colour].empty()) continue;
        if (!std::exchange(first, false)) me.wait_for_all();
        shares_[colour].for_each(me.thread, [&](std::int64_t k) {
          const Strip& strip = colours[colour][static_cast<std::size_t>(k)];
          const auto* const end = tiles.data() + strip.end;
          TileContext<Dim> c = context(state, view, strip.begin);
          const bool rigid = is_rigid(state, *c.tile);
          for (; c.tile != end; ++c.tile) {
            c.next = c.tile + 1 == end ? nullptr : c.tile + 1;
            c.goes_on_from = std::exchange(c.goes_on_to, c.next && goes_on<Dim>(*c.tile, *c.next));
            fetch_next_tile(c);
            f(c, me.thread, rigid);
          }
        });
      }
    });
  }

  /// Calls f(context, thread) for each tile that is of no rigid body, as particles lie: for what sums nothing
  /// up on nodes, where this is faster than by colours (a fifth of an update).
  template <class F>
  void for_each_deformable(State<Dim>& state, const F& f) {
    constexpr std::int64_t kAtOnce = 4;
    const ParticleView<Dim> view = state.view();
    const auto& tiles = state.tiling.tiles;
    shares_[0].cut_at(state.threads, kAtOnce, [&](int thread) { return first_tile(state, thread); });
    on_threads(state.threads, [&](const Member& me) {
      shares_[0].for_each(me.thread, [&](std::int64_t t) {
        TileContext<Dim> c = context(state, view, t);
        if (is_rigid(state, *c.tile)) return;
        if (c.tile != &tiles.back()) c.next = c.tile + 1;
        fetch_next_tile(c);
        f(c, me.thread);
      });
    });
  }

 private:
  /// The first tile of a thread's share; the number of tiles for the thread that there is not.
  std::int64_t first_tile(const State<Dim>& state, int thread) const {
    const auto& tiles = state.tiling.tiles;
    const auto& runs = state.tiling.runs;
    const auto first = state.particles.size() * static_cast<std::size_t>(thread) /
                       static_cast<std::size_t>(std::min(state.threads, most_threads_));
    const auto before = [&](const ParticleTile<Dim>& tile, std::size_t particle) {
      return runs[static_cast<std::size_t>(tile.run_begin)].begin < particle;
    };
    return std::lower_bound(tiles.begin(), tiles.end(), first, before) - tiles.begin();
  }

  static TileContext<Dim> context(const State<Dim>& state, const ParticleView<Dim>& view, std::int64_t tile) {
    return {&view, &state.tiling.tiles[static_cast<std::size_t>(tile)], state.tiling.runs.data(),
            state.bodies.data(), &state.grid};
  }

  static bool is_rigid(const State<Dim>& state, const ParticleTile<Dim>& tile) {
    return state.field_rigid[static_cast<std::size_t>(tile.field)];
  }

  int most_threads_;
  std::vector<Shares> shares_;  ///< of the colours
};

}  // namespace mpmfast
