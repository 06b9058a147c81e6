#pragma once

/// @file Cracked nodes: nodes that at least one particle of their body reaches through a crack.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/cracks/crossings.hpp"
#include "engine/state/archive.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// The cracks near a node, in the order of their numbers.
template <int Dim>
struct CrackedNode {
  static constexpr int kMost = 2;  ///< cracks that a node distinguishes
  std::array<int, kMost> crack{-1, -1};
  std::array<int, kMost> crossings{0, 0};  ///< to the left of the crack, less those to its right
  /// Sums of the unit normals of the crossed segments, to the left.
  std::array<Vec<Dim>, kMost> normal{Vec<Dim>::Zero(), Vec<Dim>::Zero()};

  /// Does the node lie on the left of its k-th crack?
  bool is_left(std::size_t k) const { return crossings[k] >= 0; }
};

/// The cracked nodes of all fields, stored by tiles of nodes.
template <int Dim>
class CrackedNodes {
 public:
  /// By node of a window; null: the node is not cracked.
  using Window = std::array<const CrackedNode<Dim>*, kWindowNodes<Dim>>;

  /// Replaces the nodes by those of new crossings.
  /// @param crossings  by tile
  /// @return crossings of a third crack of a node, which are left out
  std::uint64_t build(const std::vector<ParticleTile<Dim>>& tiles,
                      const std::vector<std::vector<CrackCrossing<Dim>>>& crossings);

  /// @return null where the node is not cracked
  const CrackedNode<Dim>* find(int field, const NodeIndex<Dim>& node) const;
  /// The nodes under the window of a tile. @return whether the window has a tile with cracked nodes
  bool find_window(const ParticleTile<Dim>& tile, Window& window) const;

  /// Reads or writes the nodes. A file with numbers that do not fit is refused.
  /// @param cracks  number of cracks of the scene
  void visit(Archive& archive, int cracks);

 private:
  using Block = std::array<int, kTileNodes<Dim>>;  ///< indices into nodes_; −1: not cracked

  const Block* find_block(int field, const NodeIndex<Dim>& block) const;
  void list_blocks(const std::vector<ParticleTile<Dim>>& tiles,
                   const std::vector<std::vector<CrackCrossing<Dim>>>& crossings);
  CrackedNode<Dim>& node_of(int field, const NodeIndex<Dim>& node);
  void visit_blocks(Archive& archive);

  std::vector<CrackedNode<Dim>> nodes_;
  std::vector<std::uint64_t> block_keys_;  ///< of the tiles with cracked nodes, rising
  std::vector<Block> blocks_;              ///< as block_keys_
};

}  // namespace mpmfast
