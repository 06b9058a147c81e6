#include "engine/step/extension.hpp"

#include <algorithm>
#include <cmath>

#include "engine/constants.hpp"
#include "engine/state/thread_team.hpp"
#include "engine/step/bit_cube.hpp"
#include "kernels/basis/extension.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

namespace {

/// The values of each node become the sums of its shares in others, and of its own if it keeps that.
template <std::size_t kColumns, class Shared, class Share>
void sum_shares(const std::vector<Shared>& nodes, const std::vector<Share>& shares, bool keeps_own,
                int threads, const std::array<double*, kColumns>& x) {
  const auto n = static_cast<std::int64_t>(nodes.size());
  for_each_of(n, threads, constants::threads::kFewFollowing, [&](std::int64_t i) {
    const Shared& node = nodes[static_cast<std::size_t>(i)];
    std::array<double, kColumns> sum{};
    if (keeps_own)
      for (std::size_t c = 0; c < kColumns; ++c) sum[c] = x[c][node.slot];
    for (int k = node.begin; k < node.end; ++k) {
      const Share& share = shares[static_cast<std::size_t>(k)];
      for (std::size_t c = 0; c < kColumns; ++c) sum[c] += share.weight * x[c][share.slot];
    }
    for (std::size_t c = 0; c < kColumns; ++c) x[c][node.slot] = sum[c];
  });
}

/// Calls f with the columns of the quantities, as many at once as a vector has, the rest one by one.
template <int Dim, class F>
void for_columns(State<Dim>& state, std::initializer_list<Nodal> quantities, const F& f) {
  for (Nodal q : quantities)
    if (state.nodes.width(q) == Dim) {
      std::array<double*, Dim> x;
      for (int d = 0; d < Dim; ++d) x[static_cast<std::size_t>(d)] = state.nodes.column(q, d);
      f(x);
    } else {
      for (int d = 0; d < state.nodes.width(q); ++d) f(std::array<double*, 1>{state.nodes.column(q, d)});
    }
}

}  // namespace

template <int Dim>
Extension<Dim>::Extension(const Scene& scene, const Plan& plan)
    : scene_(&scene),
      occupation_(plan.occupation * cell_volume(scene)),
      degree_(facts(plan.basis).usual_support - 1) {
  if (!active()) return;
  for (int order = 0; order <= degree_; ++order) {
    auto& of_order = candidates_.emplace_back();
    const int per_side = 2 * kReach + 1 - order;
    for (int k = 0; k < power(per_side, Dim); ++k) {
      Candidate c{cube_node<Dim>(per_side, k), 0, {}};
      NodeIndex<Dim> from_first;
      for (int d = 0; d < Dim; ++d) {
        c.first[d] -= kReach;
        from_first[d] = -c.first[d];
        const double middle = c.first[d] + 0.5 * order;
        c.distance += middle * middle;
      }
      for (int n = 0; n < power(order + 1, Dim); ++n) {
        NodeIndex<Dim> at = cube_node<Dim>(order + 1, n);
        for (int d = 0; d < Dim; ++d) at[d] += c.first[d];
        const double weight = extension_weight<Dim>(order, n, from_first);
        if (weight != 0) c.parts.push_back({cube_index<Dim>(kAround, at), weight});
      }
      of_order.push_back(c);
    }
    std::stable_sort(of_order.begin(), of_order.end(),
                     [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  }
  for (int k = 0; k < power(kAround, Dim); ++k) {
    NodeIndex<Dim> tile = cube_node<Dim>(kAround, k), local = tile;
    for (int d = 0; d < Dim; ++d) {
      tile[d] /= kTileSide;
      local[d] %= kTileSide;
    }
    cube_nodes_.push_back({static_cast<std::uint8_t>(cube_index<Dim>(3, tile)),
                           static_cast<std::uint8_t>(cube_index<Dim>(kTileSide, local))});
  }
}

template <int Dim>
void Extension<Dim>::find_neighbours(const State<Dim>& state) {
  const auto& tiling = state.tiling;
  neighbours_.resize(tiling.node_tiles.size());
  enough_.assign(tiling.node_tiles.size(), 0);
  first_nodes_.resize(tiling.node_tiles.size());
  for (const auto& block : tiling.node_blocks)
    for (int t = block.begin; t < block.end; ++t) {
      first_nodes_[static_cast<std::size_t>(t)] = block.first_node;
      for (int m = 0; m < power(3, Dim); ++m) {
        int& found = neighbours_[static_cast<std::size_t>(t)][static_cast<std::size_t>(m)] = -1;
        if (block.neighbour[m] < 0) continue;
        const auto& other = tiling.node_blocks[static_cast<std::size_t>(block.neighbour[m])];
        for (int u = other.begin; u < other.end && found < 0; ++u)
          if (tiling.node_tiles[static_cast<std::size_t>(u)].field ==
              tiling.node_tiles[static_cast<std::size_t>(t)].field)
            found = u;
      }
    }
  stable_.assign(tiling.node_tiles.size(), 0);
  followed_at_.assign(static_cast<std::size_t>(tiling.slots()), -1);
}

template <int Dim>
void Extension<Dim>::find_space(double time) {
  for (int d = 0; d < Dim; ++d) space_[static_cast<std::size_t>(d)] = space_between_walls(*scene_, d, time);
}

/// Whether a node lies further out than the first row at or beyond a wall.
template <int Dim>
bool Extension<Dim>::is_beyond(int tile, int local) const {
  using constants::conditions::kRowTolerance;
  const NodeIndex<Dim>& first = first_nodes_[static_cast<std::size_t>(tile)];
  for (int d = 0; d < Dim; ++d, local /= kTileSide) {
    const auto& space = space_[static_cast<std::size_t>(d)];
    const int row = first[d] + local % kTileSide;
    if (row < std::floor(space.lower + kRowTolerance) || row > std::ceil(space.upper - kRowTolerance))
      return true;
  }
  return false;
}

/// Which cells of a tile have enough, a bit each: of what lies between the walls. The cell of first node I
/// is I + (q − 1)/2 … I + (q + 1)/2.
template <int Dim>
std::uint64_t Extension<Dim>::find_enough(const State<Dim>& state, int tile) const {
  using constants::extension::kLeastInside;
  const NodeIndex<Dim>& first = first_nodes_[static_cast<std::size_t>(tile)];
  std::array<std::array<double, kTileSide>, Dim> inside;  // of each cell's length, by axis
  for (int d = 0; d < Dim; ++d)
    for (int k = 0; k < kTileSide; ++k) {
      const auto& space = space_[static_cast<std::size_t>(d)];
      const double begin = first[d] + k + 0.5 * (degree_ - 1);
      const double length = std::min(begin + 1, space.upper) - std::max(begin, space.lower);
      inside[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)] = std::clamp(length, 0.0, 1.0);
    }
  const double* occupied = state.nodes.column(Nodal::occupied) + tile * kTileNodes<Dim>;
  std::uint64_t enough = 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    double share = 1;
    for (int d = 0, rest = local; d < Dim; ++d, rest /= kTileSide)
      share *= inside[static_cast<std::size_t>(d)][static_cast<std::size_t>(rest % kTileSide)];
    enough |= std::uint64_t{share > kLeastInside && occupied[local] > least() * share} << local;
  }
  return enough;
}

/// A node is stable if a cell in its support has enough material. The cells of a spline, between its knots,
/// are known by the first node of the supports of what lies in them; the support of node I has I − q … I.
template <int Dim>
std::uint64_t Extension<Dim>::find_stable(int tile) const {
  std::uint64_t beyond = 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local)
    beyond |= std::uint64_t{is_beyond(tile, local)} << local;
  if (enough_[static_cast<std::size_t>(tile)] == kAll) return kAll & ~beyond;
  BitCube<Dim, 2 * kTileSide> enough;
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    int neighbour = 0, stride = 1;
    NodeIndex<Dim> offset;
    for (int d = 0; d < Dim; ++d, stride *= 3) {
      offset[d] = corner >> d & 1;
      neighbour += offset[d] * stride;
    }
    const int from = neighbours_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(neighbour)];
    if (from >= 0) enough.put(enough_[static_cast<std::size_t>(from)], offset);
  }
  enough.spread_up(degree_);
  NodeIndex<Dim> own;
  for (int d = 0; d < Dim; ++d) own[d] = 1;
  return enough.take(own) & ~beyond;
}

/// The first nodes of blocks of stable ones, in a tile and those around it.
template <int Dim>
void Extension<Dim>::find_blocks_around(int tile, int order, Around& blocks) const {
  BitCube<Dim, kAround> stable;
  for (int m = 0; m < power(3, Dim); ++m) {
    const int from = neighbours_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(m)];
    if (from >= 0) stable.put(stable_[static_cast<std::size_t>(from)], cube_node<Dim>(3, m));
  }
  stable.shrink_down(order);
  blocks = stable.row;
}

template <int Dim>
int Extension<Dim>::order_of(int slot) const {
  const auto at = std::lower_bound(lowered_.begin(), lowered_.end(), slot,
                                   [](const Lowered& l, int s) { return l.slot < s; });
  return at != lowered_.end() && at->slot == slot ? at->order : degree_;
}

/// The nearest block of stable nodes, or the mean of those that are equally near: what is symmetric stays so.
/// @param blocks  the first nodes of blocks of that order
template <int Dim>
bool Extension<Dim>::follow_block(int tile, int local, int order, const Around& blocks, Found& found) const {
  using constants::extension::kEqualDistances;
  NodeIndex<Dim> own = cube_node<Dim>(kTileSide, local);
  for (int d = 0; d < Dim; ++d) own[d] += kTileSide;
  const auto& candidates = candidates_[static_cast<std::size_t>(order)];
  const auto is_block = [&](const Candidate& c) {
    int row = 0;
    for (int d = Dim - 1; d > 0; --d) row = row * kAround + own[d] + c.first[d];
    return (blocks[static_cast<std::size_t>(row)] >> (own[0] + c.first[0]) & 1) != 0;
  };
  const auto nearest = std::find_if(candidates.begin(), candidates.end(), is_block);
  if (nearest == candidates.end()) return false;
  int ties = 0;
  auto end = nearest;
  for (; end != candidates.end() && end->distance < nearest->distance + kEqualDistances; ++end)
    ties += is_block(*end);
  Shared node{tile * kTileNodes<Dim> + local, static_cast<int>(found.shares.size()), 0, order};
  const auto& around = neighbours_[static_cast<std::size_t>(tile)];
  const int here = cube_index<Dim>(kAround, own);
  for (auto c = nearest; c != end; ++c) {
    if (!is_block(*c)) continue;
    for (const Part& part : c->parts) {
      const CubeNode& in_cube = cube_nodes_[static_cast<std::size_t>(here + part.offset)];
      found.shares.push_back(
          {around[in_cube.neighbour] * kTileNodes<Dim> + in_cube.local, part.weight / ties});
    }
  }
  node.end = static_cast<int>(found.shares.size());
  found.following.push_back(node);
  return true;
}

template <int Dim>
void Extension<Dim>::list_tile(const State<Dim>& state, int tile, Found& found) const {
  const std::uint64_t stable = stable_[static_cast<std::size_t>(tile)];
  if (stable == kAll) return;
  const double* mass = state.nodes.column(Nodal::mass);
  Around blocks;
  int of_order = -1;  // of `blocks`
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    const int slot = tile * kTileNodes<Dim> + local;
    if ((stable >> local & 1) != 0 || !(mass[slot] > 0)) continue;
    bool follows = false;
    int order = order_of(slot);
    if (is_beyond(tile, local)) order = std::min(order, 1);
    for (; order >= 0 && !follows; --order) {
      if (of_order != order) {
        find_blocks_around(tile, order, blocks);
        of_order = order;
      }
      follows = follow_block(tile, local, order, blocks, found);
    }
    found.alone += !follows;
    found.lowered += follows && order + 1 < degree_ && !is_beyond(tile, local);
  }
}

template <int Dim>
void Extension<Dim>::list_all(const State<Dim>& state) {
  const auto& tiles = state.tiling.node_tiles;
  const int portions = constants::threads::kPortionsPerThread * state.threads;
  found_.resize(static_cast<std::size_t>(portions));
  const auto first_of = [&](int portion) {
    return static_cast<int>(tiles.size() * static_cast<std::size_t>(portion) /
                            static_cast<std::size_t>(portions));
  };
  share_out(portions, state.threads, 1, [&](std::int64_t portion) {
    Found& found = found_[static_cast<std::size_t>(portion)];
    found.following.clear();
    found.shares.clear();
    found.lowered = found.alone = 0;
    for (int t = first_of(static_cast<int>(portion)); t < first_of(static_cast<int>(portion) + 1); ++t)
      if (!state.field_rigid[static_cast<std::size_t>(tiles[static_cast<std::size_t>(t)].field)])
        list_tile(state, t, found);
  });
  std::size_t nodes = 0, shares = 0;
  for (auto& found : found_) {
    found.nodes_before = nodes;
    found.shares_before = shares;
    nodes += found.following.size();
    shares += found.shares.size();
  }
  following_.resize(nodes);
  shares_.resize(shares);
  for_each_of(portions, state.threads, 1, [&](std::int64_t portion) {
    const Found& found = found_[static_cast<std::size_t>(portion)];
    const auto before = static_cast<int>(found.shares_before);
    auto at = following_.begin() + static_cast<std::ptrdiff_t>(found.nodes_before);
    for (const Shared& node : found.following)
      *at++ = {node.slot, before + node.begin, before + node.end, node.order};
    std::copy(found.shares.begin(), found.shares.end(),
              shares_.begin() + static_cast<std::ptrdiff_t>(found.shares_before));
  });
}

/// The same by the nodes that are followed: each can then sum up by itself, in one order.
template <int Dim>
void Extension<Dim>::list_followed() {
  followed_.clear();
  for (const Share& share : shares_) {
    int& at = followed_at_[static_cast<std::size_t>(share.slot)];
    if (at < 0) {
      at = static_cast<int>(followed_.size());
      followed_.push_back({share.slot, 0, 0, 0});
    }
    ++followed_[static_cast<std::size_t>(at)].end;
  }
  int sum = 0;
  for (Shared& node : followed_) {
    node.begin = sum;
    sum += node.end;
    node.end = node.begin;
  }
  takers_.resize(shares_.size());
  for (const Shared& node : following_)
    for (int k = node.begin; k < node.end; ++k) {
      const Share& share = shares_[static_cast<std::size_t>(k)];
      Shared& to = followed_[static_cast<std::size_t>(followed_at_[static_cast<std::size_t>(share.slot)])];
      takers_[static_cast<std::size_t>(to.end++)] = {node.slot, share.weight};
    }
  for (const Shared& node : followed_) followed_at_[static_cast<std::size_t>(node.slot)] = -1;
}

/// Bounds what nodes pass on, by kMostThrown. Negative weights can take too much mass from a node, and far
/// ones can spread too much (K24 is silent). Nodes of negative weight then follow with one order less, until
/// the bound holds: with order 0 no weight is negative.
template <int Dim>
bool Extension<Dim>::lower_orders(const State<Dim>& state) {
  const double* mass = state.nodes.column(Nodal::mass);
  std::vector<int> takers;
  for (const Shared& node : followed_) {
    double sum = mass[node.slot], thrown = 0;
    for (int k = node.begin; k < node.end; ++k) {
      const Share& taker = takers_[static_cast<std::size_t>(k)];
      sum += taker.weight * mass[taker.slot];
      thrown += taker.weight * taker.weight * mass[taker.slot];
    }
    if (thrown <= constants::extension::kMostThrown * sum) continue;
    for (int k = node.begin; k < node.end; ++k)
      if (takers_[static_cast<std::size_t>(k)].weight < 0)
        takers.push_back(takers_[static_cast<std::size_t>(k)].slot);
  }
  if (takers.empty()) return false;
  std::sort(takers.begin(), takers.end());
  takers.erase(std::unique(takers.begin(), takers.end()), takers.end());
  for (const Shared& node : following_) {
    if (!std::binary_search(takers.begin(), takers.end(), node.slot)) continue;
    const auto known =
        std::find_if(lowered_.begin(), lowered_.end(), [&](const Lowered& l) { return l.slot == node.slot; });
    if (known != lowered_.end())
      known->order = node.order - 1;
    else
      lowered_.push_back({node.slot, node.order - 1});
  }
  std::sort(lowered_.begin(), lowered_.end(),
            [](const Lowered& a, const Lowered& b) { return a.slot < b.slot; });
  return true;
}

template <int Dim>
void Extension<Dim>::find(const State<Dim>& state) {
  if (stale_) find_neighbours(state);
  stale_ = false;
  lowered_.clear();
  find_space(state.time);
  const auto tiles = static_cast<int>(state.tiling.node_tiles.size());
  for_each_of(tiles, state.threads, constants::threads::kFewBusyBlocks, [&](std::int64_t t) {
    enough_[static_cast<std::size_t>(t)] = find_enough(state, static_cast<int>(t));
  });
  for_each_of(tiles, state.threads, constants::threads::kFewBusyBlocks, [&](std::int64_t t) {
    stable_[static_cast<std::size_t>(t)] = find_stable(static_cast<int>(t));
  });
  do {
    list_all(state);
    list_followed();
  } while (lower_orders(state));
  counters_.nodes += following_.size();
  for (const auto& found : found_) {
    counters_.lowered += found.lowered;
    counters_.alone += found.alone;
  }
}

template <int Dim>
void Extension<Dim>::restrict_columns(State<Dim>& state, std::initializer_list<Nodal> quantities) const {
  for_columns(state, quantities, [&](const auto& x) {
    sum_shares(followed_, takers_, true, state.threads, x);
    for (const Shared& node : following_)
      for (double* column : x) column[node.slot] = 0;
  });
}

template <int Dim>
void Extension<Dim>::prolong(State<Dim>& state, std::initializer_list<Nodal> quantities) const {
  for_columns(state, quantities,
              [&](const auto& x) { sum_shares(following_, shares_, false, state.threads, x); });
}

template <int Dim>
std::size_t Extension<Dim>::bytes() const {
  std::size_t sum = bytes_of(neighbours_, first_nodes_, enough_, stable_, following_, followed_, shares_,
                             takers_, followed_at_, lowered_);
  for (const Found& found : found_) sum += bytes_of(found.following, found.shares);
  return sum;
}

template class Extension<2>;
template class Extension<3>;

}  // namespace mpmfast
