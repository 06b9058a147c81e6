#pragma once

/// @file Who sits where: particles sorted by velocity field, tile, body and cell; the slots of the nodes they
/// touch.
///
/// A particle whose support begins at node b belongs to the particle tile t = floor((b − 1)/4) of its field,
/// so that it starts at offset b − 4t = 1 … 4 of the tile's window of 8 nodes a side, and may drift by a cell
/// before the next sort. The window covers 2^Dim node tiles. A node tile exists for a field only where a
/// particle tile of it needs one: memory follows the particles, not nodes × fields. Slots are numbered by
/// (place, field), so the fields of a place are neighbours: a stack.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/particles.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// A tile of nodes of one field.
template <int Dim>
struct NodeTile {
  std::int64_t place;  ///< Tiling::place of its coordinates
  int field;
  int particle_tile[kCorners<Dim>];  ///< corner c: the particle tile that lies c below; −1: none
};

/// The node tiles of all fields at one place.
template <int Dim>
struct Stack {
  int begin, end;                ///< into node_tiles
  NodeIndex<Dim> first_node;     ///< coordinates of its lowest node
  int neighbour[power(3, Dim)];  ///< stacks around it (x fastest, itself in the middle); −1: none
};

/// What the sort works with; kept from one to the next.
struct SortBuffers {
  static constexpr int kDigit = 11;  ///< bits a radix pass
  using Places = std::array<std::uint32_t, 1u << kDigit>;
  std::vector<Places> next;  ///< where the next key of each digit goes, by thread
  std::vector<std::uint64_t> key, key_spare;
  std::vector<std::uint32_t> order, order_spare;
  Column<double> column;  ///< to swap for one that is put in order
  Column<std::uint32_t> id;
  Column<std::uint16_t> body;

  std::size_t bytes() const {
    return (key.capacity() + key_spare.capacity()) * sizeof(std::uint64_t) +
           (order.capacity() + order_spare.capacity()) * sizeof(std::uint32_t) + column.bytes() + id.bytes() +
           body.bytes() + next.capacity() * sizeof(Places);
  }
};

template <int Dim>
class Tiling {
 public:
  /// @param nodes  nodes of the domain along each axis; particles may be one cell beyond
  void set_domain(const std::array<int, 3>& nodes);

  /// Sorts the particles and numbers the slots.
  /// @param first_node  coordinates of each particle's first support node, [Dim][particles]
  /// @param body_field  velocity field of each body
  void build(Particles<Dim>& particles, const std::array<std::vector<int>, Dim>& first_node,
             const std::vector<int>& body_field);

  std::vector<ParticleTile<Dim>> tiles;
  std::vector<ParticleRun<Dim>> runs;
  std::vector<NodeTile<Dim>> node_tiles;
  std::vector<Stack<Dim>> stacks;
  std::array<std::vector<int>, kCorners<Dim>> colours;  ///< particle tiles whose windows do not overlap

  int slots() const { return static_cast<int>(node_tiles.size()) * kTileNodes<Dim>; }
  /// Nodes of stacks, whatever the number of fields on them.
  std::size_t places() const { return stacks.size() * kTileNodes<Dim>; }
  std::size_t bytes() const;

  /// Coordinates of the local-th node of a stack.
  NodeIndex<Dim> node(const Stack<Dim>& stack, int local) const {
    NodeIndex<Dim> n = stack.first_node;
    for (int d = 0; d < Dim; ++d) {
      n[d] += local % kTileSide;
      local /= kTileSide;
    }
    return n;
  }

 private:
  std::int64_t place(const NodeIndex<Dim>& tile) const;
  NodeIndex<Dim> coordinates(std::int64_t place) const;
  int find(std::int64_t place, int field) const;
  void sort(Particles<Dim>& particles, const std::array<std::vector<int>, Dim>& first_node,
            const std::vector<int>& body_field);
  void cut_runs(const Particles<Dim>& particles, const std::vector<int>& body_field);
  void number_slots();
  void stack_up();

  std::array<int, 3> span_{1, 1, 1};  ///< tiles along each axis, with a margin
  SortBuffers buffers_;
  int bodies_ = 1;
};

extern template class Tiling<2>;
extern template class Tiling<3>;

}  // namespace mpmfast
