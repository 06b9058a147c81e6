#include "engine/cracks/cracked_nodes.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/cracks/element.hpp"

namespace mpmfast {

namespace {

/// The tile of nodes in which a node lies, and the number of the node in it, x fastest.
template <int Dim>
struct InBlock {
  NodeIndex<Dim> block;
  std::size_t local = 0;
};

template <int Dim>
InBlock<Dim> in_block(const NodeIndex<Dim>& node) {
  InBlock<Dim> out;
  int local = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    out.block[d] = floor_div(node[d], kTileSide);
    local = local * kTileSide + (node[d] - out.block[d] * kTileSide);
  }
  out.local = static_cast<std::size_t>(local);
  return out;
}

/// A number for a tile of nodes of a field: the field in the highest bits, then the coordinates.
template <int Dim>
std::uint64_t key_of(int field, const NodeIndex<Dim>& block) {
  constexpr int kBits = 20, kShift = 1 << (kBits - 1);  // coordinates may be negative
  auto key = static_cast<std::uint64_t>(field);
  for (int d = 0; d < Dim; ++d) key = key << kBits | static_cast<std::uint64_t>(block[d] + kShift);
  return key;
}

/// Adds a crossing to its node. @return whether the node has place for its crack
template <int Dim>
bool add(CrackedNode<Dim>& node, const CrackCrossing<Dim>& crossing) {
  std::size_t k = 0;
  while (k < node.crack.size() && node.crack[k] >= 0 && node.crack[k] != crossing.crack) ++k;
  if (k == node.crack.size()) return false;
  node.crack[k] = crossing.crack;
  node.crossings[k] += crossing.direction;
  node.normal[k] += crossing.normal;
  return true;
}

template <int Dim>
void sort_cracks(CrackedNode<Dim>& node) {
  if (node.crack[1] < 0 || node.crack[1] >= node.crack[0]) return;
  std::swap(node.crack[0], node.crack[1]);
  std::swap(node.crossings[0], node.crossings[1]);
  std::swap(node.normal[0], node.normal[1]);
}

}  // namespace

template <int Dim>
auto CrackedNodes<Dim>::find_block(int field, const NodeIndex<Dim>& block) const -> const Block* {
  const std::uint64_t key = key_of<Dim>(field, block);
  if (block_keys_.empty() || key < block_keys_.front() || key > block_keys_.back()) return nullptr;
  const auto found = std::lower_bound(block_keys_.begin(), block_keys_.end(), key);
  if (found == block_keys_.end() || *found != key) return nullptr;
  return &element(blocks_, found - block_keys_.begin());
}

template <int Dim>
const CrackedNode<Dim>* CrackedNodes<Dim>::find(int field, const NodeIndex<Dim>& node) const {
  const auto [block, local] = in_block<Dim>(node);
  const Block* found = find_block(field, block);
  return found && (*found)[local] >= 0 ? &element(nodes_, (*found)[local]) : nullptr;
}

template <int Dim>
bool CrackedNodes<Dim>::find_window(const ParticleTile<Dim>& tile, Window& window) const {
  window.fill(nullptr);
  if (nodes_.empty()) return false;
  bool any = false;
  for (int c = 0; c < kCorners<Dim>; ++c) {
    NodeIndex<Dim> block;
    int base = 0;
    for (int d = 0, stride = 1; d < Dim; ++d, stride *= kWindowSide) {
      block[d] = tile.window[d] / kTileSide + (c >> d & 1);
      base += (c >> d & 1) * kTileSide * stride;
    }
    const Block* found = find_block(tile.field, block);
    if (!found) continue;
    any = true;
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const int number = element(*found, local);
      if (number < 0) continue;
      int w = base;
      for (int d = 0, rest = local, stride = 1; d < Dim; ++d, rest /= kTileSide, stride *= kWindowSide)
        w += rest % kTileSide * stride;
      element(window, w) = &element(nodes_, number);
    }
  }
  return any;
}

template <int Dim>
void CrackedNodes<Dim>::list_blocks(const std::vector<ParticleTile<Dim>>& tiles,
                                    const std::vector<std::vector<CrackCrossing<Dim>>>& crossings) {
  block_keys_.clear();
  for (std::size_t t = 0; t < crossings.size(); ++t)
    for (const CrackCrossing<Dim>& one : crossings[t]) {
      const std::uint64_t key = key_of<Dim>(tiles[t].field, in_block<Dim>(one.node).block);
      if (block_keys_.empty() || block_keys_.back() != key) block_keys_.push_back(key);
    }
  std::sort(block_keys_.begin(), block_keys_.end());
  block_keys_.erase(std::unique(block_keys_.begin(), block_keys_.end()), block_keys_.end());
  blocks_.resize(block_keys_.size());
  for (Block& block : blocks_) block.fill(-1);
}

/// The node of a listed block; it is added where it was not cracked yet.
template <int Dim>
CrackedNode<Dim>& CrackedNodes<Dim>::node_of(int field, const NodeIndex<Dim>& node) {
  const auto [block, local] = in_block<Dim>(node);
  const auto at = std::lower_bound(block_keys_.begin(), block_keys_.end(), key_of<Dim>(field, block));
  int& number = element(blocks_, at - block_keys_.begin())[local];
  if (number < 0) {
    number = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
  }
  return element(nodes_, number);
}

template <int Dim>
std::uint64_t CrackedNodes<Dim>::build(const std::vector<ParticleTile<Dim>>& tiles,
                                       const std::vector<std::vector<CrackCrossing<Dim>>>& crossings) {
  list_blocks(tiles, crossings);
  nodes_.clear();
  std::uint64_t left_out = 0;
  for (std::size_t t = 0; t < crossings.size(); ++t)
    for (const CrackCrossing<Dim>& one : crossings[t])
      if (!add(node_of(tiles[t].field, one.node), one)) ++left_out;
  for (CrackedNode<Dim>& node : nodes_) sort_cracks(node);
  return left_out;
}

template <int Dim>
void CrackedNodes<Dim>::visit_blocks(Archive& archive) {
  archive.list("cracks/blocks", block_keys_);
  blocks_.resize(block_keys_.size());
  std::vector<int> numbers;
  for (const Block& block : blocks_) numbers.insert(numbers.end(), block.begin(), block.end());
  archive.column("cracks/places", numbers.data(), numbers.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    std::copy_n(numbers.data() + b * kTileNodes<Dim>, kTileNodes<Dim>, blocks_[b].begin());
}

template <int Dim>
void CrackedNodes<Dim>::visit(Archive& archive, int cracks) {
  constexpr std::size_t kMost = CrackedNode<Dim>::kMost;
  visit_blocks(archive);
  std::vector<int> cracked;  // of each node and each of its cracks: the crack, the crossings
  std::vector<double> normals;
  for (const CrackedNode<Dim>& node : nodes_)
    for (std::size_t k = 0; k < kMost; ++k) {
      cracked.insert(cracked.end(), {node.crack[k], node.crossings[k]});
      normals.insert(normals.end(), node.normal[k].data(), node.normal[k].data() + Dim);
    }
  archive.list("cracks/told", cracked);
  require_checkpoint(archive, cracked.size() % (2 * kMost) == 0, "cracks/told");
  normals.resize(cracked.size() / 2 * Dim);
  archive.column("cracks/normals", normals.data(), normals.size());
  nodes_.resize(cracked.size() / (2 * kMost));
  const auto nodes = static_cast<int>(nodes_.size());
  for (const Block& block : blocks_)
    for (const int number : block)
      require_checkpoint(archive, number >= -1 && number < nodes, "cracks/places");
  for (std::size_t n = 0, at = 0; n < nodes_.size(); ++n)
    for (std::size_t k = 0; k < kMost; ++k, ++at) {
      nodes_[n].crack[k] = cracked[2 * at];
      nodes_[n].crossings[k] = cracked[2 * at + 1];
      std::copy_n(normals.data() + Dim * at, Dim, nodes_[n].normal[k].data());
      require_checkpoint(archive,
                         cracked[2 * at] >= -1 && cracked[2 * at] < cracks && nodes_[n].normal[k].allFinite(),
                         "cracks/told");
    }
}

template class CrackedNodes<2>;
template class CrackedNodes<3>;

}  // namespace mpmfast
