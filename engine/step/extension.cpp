#include "engine/step/extension.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "kernels/basis/extension.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

namespace {

/// Strides of a cube of nodes.
template <int Dim>
int cube_index(int side, const NodeIndex<Dim>& at) {
  int index = 0;
  for (int d = Dim - 1; d >= 0; --d) index = index * side + at[d];
  return index;
}

template <int Dim>
NodeIndex<Dim> cube_node(int side, int index) {
  NodeIndex<Dim> at;
  for (int d = 0; d < Dim; ++d, index /= side) at[d] = index % side;
  return at;
}

/// In each line of a cube along each axis, an entry becomes what `merge` makes of it and of the one `step`
/// further on (beyond the end: of 0), `times` times, in place.
template <int Dim, class Cube, class Merge>
void sweep(Cube& cube, int side, int step, int times, Merge merge) {
  int stride = 1;
  for (int d = 0; d < Dim; ++d, stride *= side)
    for (int t = 0; t < times; ++t)
      for (int k = 0; k < static_cast<int>(cube.size()); ++k) {
        const int index = step > 0 ? k : static_cast<int>(cube.size()) - 1 - k;
        const int at = index / stride % side + step;
        const bool within = at >= 0 && at < side;
        auto& own = cube[static_cast<std::size_t>(index)];
        own = merge(own, within ? cube[static_cast<std::size_t>(index + step * stride)] : std::uint8_t{0});
      }
}

/// The value of each node becomes the sum of its shares in others, and of its own if it keeps that.
template <class Shared, class Share>
void sum_shares(const std::vector<Shared>& nodes, const std::vector<Share>& shares, bool keeps_own,
                int threads, double* x) {
  const auto n = static_cast<std::int64_t>(nodes.size());
#pragma omp parallel for num_threads(threads) schedule(static) if (n > 1000)
  for (std::int64_t i = 0; i < n; ++i) {
    const Shared& node = nodes[static_cast<std::size_t>(i)];
    double sum = keeps_own ? x[node.slot] : 0;
    for (int k = node.begin; k < node.end; ++k) {
      const Share& share = shares[static_cast<std::size_t>(k)];
      sum += share.weight * x[share.slot];
    }
    x[node.slot] = sum;
  }
}

}  // namespace

template <int Dim>
Extension<Dim>::Extension(const Scene& scene, const Plan& plan)
    : occupation_(plan.occupation * cell_volume(scene)), degree_(facts(plan.basis).usual_support - 1) {
  if (!active()) return;
  for (int order = 0; order <= degree_; ++order) {
    auto& of_order = candidates_.emplace_back();
    const int places = 2 * kReach + 1 - order;
    for (int k = 0; k < power(places, Dim); ++k) {
      Candidate c{cube_node<Dim>(places, k), 0};
      for (int d = 0; d < Dim; ++d) {
        c.first[d] -= kReach;
        const double middle = c.first[d] + 0.5 * order;
        c.distance += middle * middle;
      }
      of_order.push_back(c);
    }
    std::stable_sort(of_order.begin(), of_order.end(),
                     [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  }
}

template <int Dim>
void Extension<Dim>::find_neighbours(const State<Dim>& state) {
  const auto& tiling = state.tiling;
  neighbours_.resize(tiling.node_tiles.size());
  full_.assign(tiling.node_tiles.size(), 0);
  for (const auto& stack : tiling.stacks)
    for (int t = stack.begin; t < stack.end; ++t)
      for (int m = 0; m < power(3, Dim); ++m) {
        int& found = neighbours_[static_cast<std::size_t>(t)][static_cast<std::size_t>(m)] = -1;
        if (stack.neighbour[m] < 0) continue;
        const auto& other = tiling.stacks[static_cast<std::size_t>(stack.neighbour[m])];
        for (int u = other.begin; u < other.end && found < 0; ++u)
          if (tiling.node_tiles[static_cast<std::size_t>(u)].field ==
              tiling.node_tiles[static_cast<std::size_t>(t)].field)
            found = u;
      }
  stable_.assign(static_cast<std::size_t>(tiling.slots()), 0);
  followed_at_.assign(static_cast<std::size_t>(tiling.slots()), -1);
}

/// Of all cells of a tile.
template <int Dim>
bool Extension<Dim>::has_enough(const State<Dim>& state, int tile) const {
  const double* occupied = state.nodes.column(Nodal::occupied) + tile * kTileNodes<Dim>;
  int enough = 0;
  for (int local = 0; local < kTileNodes<Dim>; ++local) enough += occupied[local] > least();
  return enough == kTileNodes<Dim>;
}

/// A node is stable if a cell in its support has enough material. The cells of a spline, between its knots,
/// are known by the first node of the supports of what lies in them; the support of node I has I − q … I.
template <int Dim>
void Extension<Dim>::mark_stable(const State<Dim>& state, int tile) {
  std::uint8_t* const stable = &stable_[static_cast<std::size_t>(tile * kTileNodes<Dim>)];
  if (full_[static_cast<std::size_t>(tile)]) {
    std::fill_n(stable, kTileNodes<Dim>, std::uint8_t{1});
    return;
  }
  constexpr int side = 2 * kTileSide;
  std::array<std::uint8_t, power(side, Dim)> enough{};
  const double* occupied = state.nodes.column(Nodal::occupied);
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    int neighbour = 0, stride = 1;
    NodeIndex<Dim> first;
    for (int d = 0; d < Dim; ++d, stride *= 3) {
      const int upper = corner >> d & 1;
      neighbour += upper * stride;
      first[d] = upper * kTileSide;
    }
    const int from = neighbours_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(neighbour)];
    if (from < 0) continue;
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      NodeIndex<Dim> at = cube_node<Dim>(kTileSide, local);
      for (int d = 0; d < Dim; ++d) at[d] += first[d];
      enough[static_cast<std::size_t>(cube_index<Dim>(side, at))] =
          occupied[from * kTileNodes<Dim> + local] > least();
    }
  }
  sweep<Dim>(enough, side, -1, degree_,
             [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    NodeIndex<Dim> at = cube_node<Dim>(kTileSide, local);
    for (int d = 0; d < Dim; ++d) at[d] += kTileSide;
    stable[local] = enough[static_cast<std::size_t>(cube_index<Dim>(side, at))];
  }
}

/// The stable nodes of a tile and of those around it.
template <int Dim>
void Extension<Dim>::look_around(int tile, Around& stable) const {
  stable.fill(0);
  for (int m = 0; m < power(3, Dim); ++m) {
    const int from = neighbours_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(m)];
    if (from < 0) continue;
    const NodeIndex<Dim> place = cube_node<Dim>(3, m);
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      NodeIndex<Dim> at = cube_node<Dim>(kTileSide, local);
      for (int d = 0; d < Dim; ++d) at[d] += place[d] * kTileSide;
      stable[static_cast<std::size_t>(cube_index<Dim>(kAround, at))] =
          stable_[static_cast<std::size_t>(from * kTileNodes<Dim> + local)];
    }
  }
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
  NodeIndex<Dim> own = cube_node<Dim>(kTileSide, local);
  for (int d = 0; d < Dim; ++d) own[d] += kTileSide;
  const auto& candidates = candidates_[static_cast<std::size_t>(order)];
  const auto is_block = [&](const Candidate& c) {
    NodeIndex<Dim> at = own;
    for (int d = 0; d < Dim; ++d) at[d] += c.first[d];
    return blocks[static_cast<std::size_t>(cube_index<Dim>(kAround, at))] != 0;
  };
  const auto nearest = std::find_if(candidates.begin(), candidates.end(), is_block);
  if (nearest == candidates.end()) return false;
  int ties = 0;
  auto end = nearest;
  for (; end != candidates.end() && end->distance < nearest->distance + 1e-9; ++end) ties += is_block(*end);
  Shared node{tile * kTileNodes<Dim> + local, static_cast<int>(found.shares.size()), 0, order};
  for (auto c = nearest; c != end; ++c) {
    if (!is_block(*c)) continue;
    for (int n = 0; n < power(order + 1, Dim); ++n) {
      const NodeIndex<Dim> in_block = cube_node<Dim>(order + 1, n);
      NodeIndex<Dim> place, of_tile, from_first;
      for (int d = 0; d < Dim; ++d) {
        const int at = own[d] + c->first[d] + in_block[d];
        place[d] = at / kTileSide;
        of_tile[d] = at % kTileSide;
        from_first[d] = -c->first[d];
      }
      const int other =
          neighbours_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(cube_index<Dim>(3, place))];
      const double weight = extension_weight<Dim>(order, n, from_first) / ties;
      if (weight != 0)
        found.shares.push_back({other * kTileNodes<Dim> + cube_index<Dim>(kTileSide, of_tile), weight});
    }
  }
  node.end = static_cast<int>(found.shares.size());
  found.following.push_back(node);
  return true;
}

template <int Dim>
void Extension<Dim>::list_tile(const State<Dim>& state, int tile, Found& found) const {
  if (full_[static_cast<std::size_t>(tile)]) return;  // all of its nodes are stable
  const double* mass = state.nodes.column(Nodal::mass);
  Around blocks;
  int of_order = -1;  // of `blocks`
  for (int local = 0; local < kTileNodes<Dim>; ++local) {
    const int slot = tile * kTileNodes<Dim> + local;
    if (!(mass[slot] > 0) || stable_[static_cast<std::size_t>(slot)]) continue;
    bool follows = false;
    int order = order_of(slot);
    for (; order >= 0 && !follows; --order) {
      if (of_order != order) {
        look_around(tile, blocks);
        sweep<Dim>(blocks, kAround, 1, order,
                   [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a & b); });
        of_order = order;
      }
      follows = follow_block(tile, local, order, blocks, found);
    }
    found.alone += !follows;
    found.lowered += follows && order + 1 < degree_;
  }
}

template <int Dim>
void Extension<Dim>::list_all(const State<Dim>& state) {
  const auto tiles = static_cast<int>(state.tiling.node_tiles.size());
  found_.resize(static_cast<std::size_t>(state.threads));
  for (auto& found : found_) {
    found.following.clear();
    found.shares.clear();
    found.lowered = found.alone = 0;
  }
#pragma omp parallel num_threads(state.threads)
  {
    Found& found = found_[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(static)  // in order: the lists of the threads follow each other
    for (int t = 0; t < tiles; ++t)
      if (!state.field_rigid[static_cast<std::size_t>(
              state.tiling.node_tiles[static_cast<std::size_t>(t)].field)])
        list_tile(state, t, found);
  }
  following_.clear();
  shares_.clear();
  for (const auto& found : found_) {
    const int before = static_cast<int>(shares_.size());
    for (Shared node : found.following) {
      node.begin += before;
      node.end += before;
      following_.push_back(node);
    }
    shares_.insert(shares_.end(), found.shares.begin(), found.shares.end());
  }
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
    if (thrown <= kMostThrown * sum) continue;
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
  const auto tiles = static_cast<int>(state.tiling.node_tiles.size());
#pragma omp parallel num_threads(state.threads)
  {
#pragma omp for schedule(static)
    for (int t = 0; t < tiles; ++t) full_[static_cast<std::size_t>(t)] = has_enough(state, t);
#pragma omp for schedule(static)
    for (int t = 0; t < tiles; ++t) mark_stable(state, t);
  }
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
void Extension<Dim>::restrict_columns(State<Dim>& state, Nodal q) const {
  for (int d = 0; d < state.nodes.width(q); ++d) {
    double* x = state.nodes.column(q, d);
    sum_shares(followed_, takers_, true, state.threads, x);
    for (const Shared& node : following_) x[node.slot] = 0;
  }
}

template <int Dim>
void Extension<Dim>::prolong(State<Dim>& state, Nodal q) const {
  for (int d = 0; d < state.nodes.width(q); ++d)
    sum_shares(following_, shares_, false, state.threads, state.nodes.column(q, d));
}

template class Extension<2>;
template class Extension<3>;

}  // namespace mpmfast
