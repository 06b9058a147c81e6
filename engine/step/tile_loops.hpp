#pragma once

/// @file Loops over the tiles of particles. A thread begins each of them with the same particles, as many as
/// the others have, and helps these when it is done.

#include <cstdint>
#include <vector>

#include "engine/state/function_ref.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim>
class TileLoops {
 public:
  explicit TileLoops(int most_threads);

  /// Calls f(context, thread, rigid) for each tile, colour after colour: windows of one colour do not
  /// overlap, and each slot adds up its tiles in the order of the colours, whatever the threads. Of a strip f
  /// must take all tiles or none, or sums that go on from one to the next are lost.
  void for_each_by_colour(State<Dim>& state, FunctionRef<void(const TileContext<Dim>&, int, bool)> f);

  /// Calls f(context, thread) for each tile that is of no rigid body, as particles lie: for what sums nothing
  /// up on nodes, where this is faster than by colours (a fifth of an update).
  void for_each_deformable(State<Dim>& state, FunctionRef<void(const TileContext<Dim>&, int)> f);

 private:
  /// The first tile of a thread's share; the number of tiles for the thread that there is not.
  std::int64_t first_tile(const State<Dim>& state, int thread) const;

  int most_threads_;
  std::vector<Shares> shares_;  ///< of the colours
};

extern template class TileLoops<2>;
extern template class TileLoops<3>;

}  // namespace mpmfast
