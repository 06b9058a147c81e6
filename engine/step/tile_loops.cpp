#include "engine/step/tile_loops.hpp"

#include <algorithm>
#include <utility>

#include "engine/constants.hpp"
#include "engine/state/thread_team.hpp"
#include "kernels/transfer/window.hpp"

namespace mpmfast {

namespace {

template <int Dim>
TileContext<Dim> context_of(const State<Dim>& state, const ParticleView<Dim>& view, std::int64_t tile) {
  return {&view, &state.tiling.tiles[static_cast<std::size_t>(tile)], state.tiling.runs.data(),
          state.bodies.data(), &state.grid};
}

template <int Dim>
bool is_rigid(const State<Dim>& state, const ParticleTile<Dim>& tile) {
  return state.field_rigid[static_cast<std::size_t>(tile.field)];
}

}  // namespace

template <int Dim>
TileLoops<Dim>::TileLoops(int most_threads) : most_threads_(most_threads) {
  for (int c = 0; c < kCorners<Dim>; ++c) shares_.emplace_back(most_threads);
}

template <int Dim>
void TileLoops<Dim>::for_each_by_colour(State<Dim>& state,
                                        FunctionRef<void(const TileContext<Dim>&, int, bool)> f) {
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
  on_threads(state.threads, [&](const TeamThread& me) {
    bool first = true;
    for (std::size_t colour = 0; colour < colours.size(); ++colour) {
      if (colours[colour].empty()) continue;
      if (!std::exchange(first, false)) me.wait_for_all();
      shares_[colour].for_each(me.thread, [&](std::int64_t k) {
        const Strip& strip = colours[colour][static_cast<std::size_t>(k)];
        const auto* const end = tiles.data() + strip.end;
        TileContext<Dim> c = context_of(state, view, strip.begin);
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

template <int Dim>
void TileLoops<Dim>::for_each_deformable(State<Dim>& state,
                                         FunctionRef<void(const TileContext<Dim>&, int)> f) {
  const ParticleView<Dim> view = state.view();
  const auto& tiles = state.tiling.tiles;
  shares_[0].cut_at(state.threads, constants::threads::kTilesAtOnce,
                    [&](int thread) { return first_tile(state, thread); });
  on_threads(state.threads, [&](const TeamThread& me) {
    shares_[0].for_each(me.thread, [&](std::int64_t t) {
      TileContext<Dim> c = context_of(state, view, t);
      if (is_rigid(state, *c.tile)) return;
      if (c.tile != &tiles.back()) c.next = c.tile + 1;
      fetch_next_tile(c);
      f(c, me.thread);
    });
  });
}

template <int Dim>
std::int64_t TileLoops<Dim>::first_tile(const State<Dim>& state, int thread) const {
  const auto& tiles = state.tiling.tiles;
  const auto& runs = state.tiling.runs;
  const auto first = state.particles.size() * static_cast<std::size_t>(thread) /
                     static_cast<std::size_t>(std::min(state.threads, most_threads_));
  const auto before = [&](const ParticleTile<Dim>& tile, std::size_t particle) {
    return runs[static_cast<std::size_t>(tile.run_begin)].begin < particle;
  };
  return std::lower_bound(tiles.begin(), tiles.end(), first, before) - tiles.begin();
}

template class TileLoops<2>;
template class TileLoops<3>;

}  // namespace mpmfast
