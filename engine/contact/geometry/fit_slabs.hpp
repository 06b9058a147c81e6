#pragma once

/// @file Slabs of contact nodes. What a node keeps for the mean normals of the nodes around it is held for a
/// few slabs at once, instead of for all nodes of a large scene.

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Contact nodes are listed block after block, in the order of the blocks. A slab is a number of consecutive
/// blocks with nodes to fit. All nodes around those of a slab lie in slabs up to one that follows soon, a
/// layer of tiles later.
template <int Dim>
class FitSlabs {
 public:
  /// @param due   by contact node: it is fitted in this step
  /// @param many  false: one slab has all nodes
  void cut(const State<Dim>& state, const ContactList<Dim>& list, const std::vector<std::uint8_t>& due,
           bool many) {
    const std::size_t enough =
        many ? constants::threads::kSlabNodesPerThread * static_cast<std::size_t>(state.threads)
             : ~std::size_t{0};
    fitted_.clear();
    slabs_.clear();
    std::size_t nodes = 0;
    const auto& begin = list.block_begin;
    for (std::size_t g = 0; g + 1 < begin.size(); ++g) {
      const auto end = due.begin() + static_cast<std::ptrdiff_t>(begin[g + 1]);
      if (std::find(due.begin() + static_cast<std::ptrdiff_t>(begin[g]), end, std::uint8_t{1}) == end)
        continue;
      const int block = list.nodes[begin[g]].block;
      if (slabs_.empty() || nodes >= enough) {
        slabs_.push_back({fitted_.size(), 0, block, -1, 0});
        nodes = 0;
      }
      nodes += begin[g + 1] - begin[g];
      fitted_.push_back(g);
      Slab& slab = slabs_.back();
      slab.end = fitted_.size();
      const auto& around = state.tiling.node_blocks[static_cast<std::size_t>(block)].neighbour;
      slab.reach = std::max(slab.reach, *std::max_element(std::begin(around), std::end(around)));
    }
    at_once_ = 1;
    for (std::size_t s = 0, last = 0; s < slabs_.size(); ++s) {
      while (last + 1 < slabs_.size() && slabs_[last + 1].first_block <= slabs_[s].reach) ++last;
      slabs_[s].surrounded_by = std::max(last, s);
      at_once_ = std::max(at_once_, slabs_[s].surrounded_by - s + 1);
    }
  }

  std::size_t size() const { return slabs_.size(); }
  /// The slab after which all nodes around those of a slab have been fitted.
  std::size_t surrounded_by(std::size_t slab) const { return slabs_[slab].surrounded_by; }
  /// The number of slabs whose clouds are kept at a time.
  std::size_t at_once() const { return at_once_; }

  /// f(index, node) for the nodes of a slab, block after block, in parallel.
  template <class F>
  void for_each_node(std::size_t slab, const State<Dim>& state, const ContactList<Dim>& list, F f) {
    const std::size_t first = slabs_[slab].begin;
    share_out(shares_, static_cast<std::int64_t>(slabs_[slab].end - first), state.threads, 1,
              constants::threads::kFewFittedBlocks, [&](std::int64_t g) {
                const std::size_t block = fitted_[first + static_cast<std::size_t>(g)];
                for (std::size_t k = list.block_begin[block]; k < list.block_begin[block + 1]; ++k)
                  f(k, list.nodes[k]);
              });
  }

 private:
  struct Slab {
    std::size_t begin, end;  ///< into fitted_
    int first_block, reach;  ///< reach: the last block around it
    std::size_t surrounded_by;
  };
  std::vector<std::size_t> fitted_;  ///< into ContactList::block_begin: those with nodes to fit
  std::vector<Slab> slabs_;
  std::size_t at_once_ = 1;
  Shares shares_{omp_get_max_threads()};
};

}  // namespace mpmfast
