#pragma once

/// @file Extended B-splines (K24 §3.3) as two passes over nodes. Particles see ordinary splines. Where a node
/// of a field has no cell with enough of its material in its support, it has no freedom of its own: its value
/// follows a block of nodes that have, v_J = Σ_I E_IJ v_I, and what particles give it goes to them, f_I +=
/// Σ_J E_IJ f_J. That is N_I + Σ_J E_IJ N_J in place of N_I (K24 Eq. 25, 26): Σ_I E_IJ = 1 keeps momentum,
/// the exactness for linears angular momentum.
///
/// A wall continues the material: of a cell that it cuts, what lies inside counts, so that the row that the
/// wall holds keeps its freedom. Rows further out follow along a straight line, 2, −1: the mirror image of
/// what lies inside, with the wall's velocity at that row. Along a parabola, 3, −3, 1, they would move the
/// material at the wall by what its motion bends.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "engine/conditions/wall_row.hpp"
#include "engine/constants.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Of all steps.
struct ExtensionCounters {
  std::uint64_t nodes = 0;  ///< that followed others
  /// Of these, but beyond walls: with an exactness below the basis's, for want of a block near or of a mass;
  /// and those that followed none and kept their own freedom, beside `nodes`.
  std::uint64_t lowered = 0, alone = 0;
};

template <int Dim>
class Extension {
 public:
  Extension(const Scene& scene, const Plan& plan);

  bool active() const { return occupation_ > 0; }
  /// After a sort: slots have new numbers.
  void invalidate_nodes() { stale_ = true; }

  /// Lists the nodes that follow others in this step, from `occupied` and `mass` as projected.
  void find(const State<Dim>& state);

  /// Gives what particles gave to the nodes that follow (masses, momenta, forces) to those they follow.
  void restrict_columns(State<Dim>& state, std::initializer_list<Nodal> quantities) const;
  /// Lets the nodes that follow have their values, velocities or what is added to them.
  void prolong(State<Dim>& state, std::initializer_list<Nodal> quantities) const;

  /// A node and its share in another.
  struct Share {
    int slot;
    double weight;
  };
  /// A node with its shares, of the nodes that it follows or of those that follow it.
  struct Shared {
    int slot, begin, end;
    int order;  ///< of the polynomials that are exact (of nodes that follow)
  };
  const std::vector<Shared>& following() const { return following_; }
  const std::vector<Share>& shares() const { return shares_; }
  /// Of its lists, as they are now.
  std::size_t bytes() const;
  const ExtensionCounters& counters() const { return counters_; }

  /// A block that a node follows begins at most so many nodes below it and ends at most so many above.
  static constexpr int kReach = kTileSide;

 private:
  static constexpr int kAround = 3 * kTileSide;  ///< a tile and its neighbours, along a side
  using Around = std::array<std::uint16_t, power(kAround, Dim - 1)>;  ///< rows along x, a bit a node
  static constexpr std::uint64_t kAll = ~std::uint64_t{0} >> (64 - kTileNodes<Dim>);
  /// A node of a block: its place less that of the node that follows, in the cube around a tile, and its
  /// share.
  struct Part {
    int offset;
    double weight;
  };
  /// A block that a node may follow.
  struct Candidate {
    NodeIndex<Dim> first;     ///< of its nodes, from the node that follows
    double distance;          ///< squared, from the node to the block's middle, in cells
    std::vector<Part> parts;  ///< whose shares are not 0
  };
  /// A node of the cube around a tile: the neighbour whose it is, and its number there.
  struct CubeNode {
    std::uint8_t neighbour, local;
  };
  struct Lowered {
    int slot, order;
  };
  struct Found {
    std::vector<Shared> following;
    std::vector<Share> shares;
    std::uint64_t lowered{}, alone{};
    std::size_t nodes_before{}, shares_before{};  ///< of the portions before
  };

  /// A share that is met to round-off is not passed, m³.
  double least() const { return occupation_ * (1 + constants::extension::kOccupationRoundOff); }
  void find_neighbours(const State<Dim>& state);
  void find_space(double time);
  bool is_beyond(int tile, int local) const;
  std::uint64_t find_enough(const State<Dim>& state, int tile) const;
  std::uint64_t find_stable(int tile) const;
  void find_blocks_around(int tile, int order, Around& blocks) const;
  void list_tile(const State<Dim>& state, int tile, Found& found) const;
  bool follow_block(int tile, int local, int order, const Around& blocks, Found& found) const;
  void list_all(const State<Dim>& state);
  void list_followed();
  bool lower_orders(const State<Dim>& state);
  int order_of(int slot) const;

  const Scene* scene_;
  double occupation_;  ///< m³: of a cell that has enough material; 0: splines are not extended
  int degree_;
  std::array<Interval, Dim> space_;  ///< between the walls now, in cells from the grid's origin
  std::vector<std::vector<Candidate>> candidates_;          ///< by order, the nearest first
  std::vector<CubeNode> cube_nodes_;                        ///< of the cube around a tile
  std::vector<std::array<int, power(3, Dim)>> neighbours_;  ///< by node tile, of its field; −1: none
  std::vector<NodeIndex<Dim>> first_nodes_;                 ///< by node tile
  std::vector<std::uint64_t> enough_, stable_;              ///< by node tile: cells, nodes, a bit each
  std::vector<Found> found_;                                ///< by portion of the tiles
  std::vector<Shared> following_, followed_;
  std::vector<Share> shares_, takers_;  ///< of following_, of followed_
  std::vector<int> followed_at_;        ///< by slot; −1: none follows it
  std::vector<Lowered> lowered_;        ///< in this step, by slot
  ExtensionCounters counters_;
  bool stale_ = true;
};

extern template class Extension<2>;
extern template class Extension<3>;

}  // namespace mpmfast
