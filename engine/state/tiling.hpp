#pragma once

/// @file Who sits where: particles sorted by row of tiles, velocity field, tile, body and cell; the slots of
/// the nodes they touch.
///
/// A particle whose support begins at node b belongs to the particle tile t = floor((b − 1)/4) of its field,
/// so that it starts at offset b − 4t = 1 … 4 of the tile's window of 8 nodes a side, and may drift by a cell
/// before the next sort. The window covers 2^Dim node tiles. A node tile exists for a field only where a
/// particle tile of it needs one: memory follows the particles, not nodes × fields. Slots are numbered by
/// (tile index, field), so the fields of one tile index are neighbours: a block.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/archive.hpp"
#include "engine/state/particles.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// What sides of cracks the particles of a group see at the nodes of their window (engine/cracks).
template <int Dim>
struct SideMap {
  std::array<std::int8_t, kWindowNodes<Dim>> side;
};

/// A tile of nodes of one field.
template <int Dim>
struct NodeTile {
  std::int64_t tile_index;  ///< Tiling::tile_index of its coordinates
  int field;
  int particle_tile[kCorners<Dim>];  ///< corner c: the particle tile that lies c below; −1: none
};

/// The node tiles of all fields at one tile index.
template <int Dim>
struct NodeBlock {
  int begin, end;                ///< into node_tiles
  NodeIndex<Dim> first_node;     ///< coordinates of its lowest node
  int neighbour[power(3, Dim)];  ///< blocks around it (x fastest, itself in the middle); −1: none
};

/// Particle tiles that lie side by side in a field, and so their particles: into Tiling::tiles.
struct Strip {
  int begin, end;
};

/// What the sort works with; kept from one to the next.
struct SortBuffers {
  static constexpr int kDigit = 11;  ///< bits a radix pass
  using DigitOffsets = std::array<std::uint32_t, 1u << kDigit>;
  std::vector<DigitOffsets> next;         ///< where the next key of each digit goes, by thread
  std::vector<std::uint64_t> key, spare;  ///< spare: of the keys, then of each column that is put in order
  std::vector<std::uint32_t> order, order_spare;
  std::vector<std::array<std::uint32_t, 2>> ranges;  ///< where `order` has them: from, to

  std::size_t bytes() const {
    return (key.capacity() + spare.capacity()) * sizeof(std::uint64_t) +
           (order.capacity() + order_spare.capacity()) * sizeof(std::uint32_t) +
           next.capacity() * sizeof(DigitOffsets) + ranges.capacity() * sizeof(ranges[0]);
  }
};

template <int Dim>
class Tiling {
 public:
  /// @param nodes  nodes of the domain along each axis; particles may be one cell beyond
  void set_domain(const std::array<int, 3>& nodes);
  /// Boundary points lie in runs of their own, behind those of the particles inside.
  void part_surfaces() { kinds_ = 2; }

  /// Where particles go is to be known after each sort.
  void follow_moves() { follows_ = true; }
  /// The number that a particle has since the last sort, by the one that it had before.
  std::uint32_t moved(std::uint32_t before) const { return stayed_ ? before : buffers_.order_spare[before]; }

  /// Fields that are the sides of another behind cracks: the first of each, −1 where it has none.
  void set_sides(const std::vector<int>& first_side) { first_side_ = first_side; }

  /// Makes space for the keys of n particles of bodies in these velocity fields, all in group 0.
  void start_keys(std::size_t n, const std::vector<int>& body_field);
  /// Where a particle belongs, by the coordinates of its first support node. From the highest digit: index
  /// of the particle tile on the last axis, field, its place among those of this index, group, body, whether
  /// it is a boundary point, cell within the tile. (The last axis first: what meets lies near, and threads
  /// that share out particles and slots each in their order have the same region of both.) Different
  /// particles may have theirs set at once.
  void set_key(std::size_t particle, const NodeIndex<Dim>& first_node, int field, int body, bool on_surface) {
    NodeIndex<Dim> tile;
    int cell = 0;
    for (int d = Dim - 1; d >= 0; --d) {
      const int b = first_node[d] - 1;
      tile[d] = floor_div(b, kTileSide);
      cell = cell * kTileSide + (b - tile[d] * kTileSide);
    }
    auto key = static_cast<std::uint64_t>(tile_index(tile, field, fields_));
    key = key * static_cast<std::uint64_t>(groups_) * static_cast<std::uint64_t>(bodies_) +
          static_cast<std::uint64_t>(kinds_ * body + on_surface);
    buffers_.key[particle] = key * kTileNodes<Dim> + static_cast<std::uint64_t>(cell);
  }
  /// Sorts the particles by their keys and numbers the slots.
  /// @param body_field  velocity field of each body
  void build(Particles<Dim>& particles, const std::vector<int>& body_field);

  /// After a sort, groups of particles that see the same sides of cracks, from 1 on; group 0 sees no other
  /// than side 0. First of all, every particle goes to that.
  void start_groups();
  /// The sides that the groups of a tile's place see, from group 1 on.
  void set_groups(const ParticleTile<Dim>& tile, const std::vector<SideMap<Dim>>& maps);
  static constexpr int kMostGroups = 256;  ///< of one place
  void set_group(std::size_t particle, int group) {
    std::uint64_t& key = buffers_.key[particle];
    const std::uint64_t rest = group_span();
    const auto groups = static_cast<std::uint64_t>(groups_);
    key = (key / (rest * groups) * groups + static_cast<std::uint64_t>(group)) * rest + key % rest;
  }
  /// Puts the particles of each place in order of their groups, and numbers the slots. They stay where they
  /// were sorted to but for that.
  void regroup(Particles<Dim>& particles, const std::vector<int>& body_field);

  /// Takes the particles out for which `leaves(index)`, calling it once for each in their order. The others
  /// keep theirs; tiles and slots are void until the next build. No memory is asked for after a sort.
  template <class Leaves>
  void take_out(Particles<Dim>& particles, const Leaves& leaves) {
    buffers_.order.clear();
    buffers_.order.reserve(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p)
      if (!leaves(p)) buffers_.order.push_back(static_cast<std::uint32_t>(p));
    keep_ordered(particles);
  }

  /// The sides that the particles of a tile see; null: of no crack.
  const SideMap<Dim>* sides_of(std::size_t tile) const;

  /// The first support node that particle p had when last sorted, to within a node on each side: by its index
  /// now; that of no node where it was not sorted yet.
  NodeIndex<Dim> sorted_node(std::size_t p) const;

  /// The keys of the last sort, from which all the rest follows: sums depend on when that was.
  /// @param particles  as they were sorted, in the order that they have now
  void visit(Archive& archive, Particles<Dim>& particles, const std::vector<int>& body_field);

  std::vector<ParticleTile<Dim>> tiles;
  std::vector<ParticleRun<Dim>> runs;
  std::vector<NodeTile<Dim>> node_tiles;
  std::vector<NodeBlock<Dim>> node_blocks;
  /// Strips whose windows do not overlap. (Colours of single tiles would pass over every other one: in 2-D
  /// half a kilobyte of each column, and what the processor fetched ahead of it.)
  std::array<std::vector<Strip>, kCorners<Dim>> colours;

  int slots() const { return static_cast<int>(node_tiles.size()) * kTileNodes<Dim>; }
  /// Nodes of blocks, whatever the number of fields on them.
  std::size_t block_nodes() const { return node_blocks.size() * kTileNodes<Dim>; }
  std::size_t bytes() const;

  /// Coordinates of the local-th node of a block.
  NodeIndex<Dim> node(const NodeBlock<Dim>& block, int local) const {
    NodeIndex<Dim> n = block.first_node;
    for (int d = 0; d < Dim; ++d) {
      n[d] += local % kTileSide;
      local /= kTileSide;
    }
    return n;
  }
  /// Slot of a field on the node of these coordinates; −1: it has none there.
  int slot(const NodeIndex<Dim>& node, int field) const;

 private:
  bool within(const NodeIndex<Dim>& tile) const;
  /// The number of a tile's place, row by row along x, the last axis slowest. Of particle tiles with their
  /// field: in each row of the last axis, the places of one field after those of another.
  std::int64_t tile_index(const NodeIndex<Dim>& tile, int field = 0, int fields = 1) const;
  NodeIndex<Dim> coordinates(std::int64_t tile_index, int fields = 1) const;
  int find(std::int64_t tile_index, int field) const;
  void count_fields(const std::vector<int>& body_field);
  /// Keys of one group at one place.
  std::uint64_t group_span() const {
    return static_cast<std::uint64_t>(bodies_) * static_cast<std::uint64_t>(kTileNodes<Dim>);
  }
  void sort(Particles<Dim>& particles);
  void sort_by_tile_index(Particles<Dim>& particles);
  void put_in_order(Particles<Dim>& particles);
  void note_moves(std::size_t particles);
  void keep_ordered(Particles<Dim>& particles);
  void cut_runs(const Particles<Dim>& particles, const std::vector<int>& body_field);
  struct Rows {
    int count, longest;  ///< longest: in tiles
  };
  Rows rows_of_tiles() const;
  void colour_strips();
  void number_slots();
  void number_sides();
  void order_maps();
  template <class F>
  void for_each_node_tile(std::size_t tile, const F& f) const;
  void list_node_blocks();

  std::array<int, 3> span_{1, 1, 1};  ///< tiles along each axis, with a margin
  SortBuffers buffers_;
  int kinds_ = 1;   ///< of runs that a body may have in a tile
  int bodies_ = 1;  ///< times kinds_
  int fields_ = 1;  ///< that particles have
  int groups_ = 1;
  bool follows_ = false, stayed_ = true;  ///< stayed: the last sort found all in order
  std::vector<int> first_side_;           ///< by field; empty: no cracks
  std::vector<std::uint64_t> mapped_;     ///< keys of the tiles with maps, as `tiles` lie: rising
  std::vector<SideMap<Dim>> maps_;        ///< likewise
  std::vector<std::uint64_t> tile_keys_;  ///< as `tiles`, in scenes with cracks
  std::vector<int> node_slots_;           ///< of the windows with maps
};

extern template class Tiling<2>;
extern template class Tiling<3>;

}  // namespace mpmfast
