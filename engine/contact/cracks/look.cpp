/// Which sides of cracks the particles see at the nodes that they reach.

#include "engine/contact/cracks/cracks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "engine/errors.hpp"
#include "engine/geometry/crossing.hpp"
#include "engine/state/team.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kBlock = 16;  ///< segments that have a box together

template <int Dim>
Point2 in_plane(const Vec<Dim>& x) {
  return {x[0], x[1]};
}

template <int Dim>
bool overlap(const Vec<Dim>& low, const Vec<Dim>& high, const Vec<Dim>& other_low,
             const Vec<Dim>& other_high) {
  for (int d = 0; d < Dim; ++d)
    if (low[d] > other_high[d] || high[d] < other_low[d]) return false;
  return true;
}

}  // namespace

template <int Dim>
void Cracks<Dim>::Boxes::set(const std::vector<const Segment*>& segments) {
  const std::size_t n = (segments.size() + kLanes - 1) / kLanes * kLanes;
  all_low_.fill(kInfinity);
  all_high_.fill(-kInfinity);
  for (std::size_t d = 0; d < 2; ++d) {
    low_[d].assign(n, kInfinity);
    high_[d].assign(n, -kInfinity);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      low_[d][k] = segments[k]->low[static_cast<int>(d)];
      high_[d][k] = segments[k]->high[static_cast<int>(d)];
      all_low_[d] = std::min(all_low_[d], low_[d][k]);
      all_high_[d] = std::max(all_high_[d], high_[d][k]);
    }
  }
}

template <int Dim>
void Cracks<Dim>::Boxes::list_overlapping(const Point2& low, const Point2& high,
                                          std::vector<int>& out) const {
  out.clear();
  for (std::size_t d = 0; d < 2; ++d)
    if (!(all_low_[d] <= high[d] && all_high_[d] >= low[d])) return;
  for (std::size_t k = 0; k < low_[0].size(); k += kLanes) {
    const auto overlaps = [&](std::size_t d) {
      return (load_lanes(&low_[d][k]) <= high[d]) & (load_lanes(&high_[d][k]) >= low[d]);
    };
    for (unsigned bits = bits_of(overlaps(0) & overlaps(1)); bits != 0; bits &= bits - 1)
      out.push_back(static_cast<int>(k) + std::countr_zero(bits));
  }
}

template <int Dim>
void Cracks<Dim>::list_segments() {
  segments_.clear();
  boxes_.clear();
  all_ = {Vec<Dim>::Constant(kInfinity), Vec<Dim>::Constant(-kInfinity)};
  for (std::size_t c = 0; c < lines_.size(); ++c)
    for (std::size_t k = 1; k < lines_[c].points.size(); ++k) {
      const Vec<Dim>&from = lines_[c].points[k - 1], &to = lines_[c].points[k];
      const Vec<Dim> along = to - from;
      Vec<Dim> normal = Vec<Dim>::Zero();
      normal[0] = -along[1], normal[1] = along[0];
      segments_.push_back(
          {static_cast<int>(c), from, to, from.cwiseMin(to), from.cwiseMax(to), normal / along.norm()});
      if (segments_.size() % kBlock == 1) boxes_.push_back({segments_.back().low, segments_.back().high});
      boxes_.back()[0] = boxes_.back()[0].cwiseMin(segments_.back().low);
      boxes_.back()[1] = boxes_.back()[1].cwiseMax(segments_.back().high);
      all_ = {all_[0].cwiseMin(boxes_.back()[0]), all_[1].cwiseMax(boxes_.back()[1])};
    }
}

/// The segments that come near the nodes under a tile's window, in the order of the lines.
template <int Dim>
void Cracks<Dim>::list_around(const State<Dim>& state, const ParticleTile<Dim>& tile,
                              std::vector<const Segment*>& near) const {
  near.clear();
  Vec<Dim> low, high;
  for (int d = 0; d < Dim; ++d) {
    low[d] = state.grid.origin[d] + (tile.window[d] - 1) * state.grid.cell;
    high[d] = state.grid.origin[d] + (tile.window[d] + kWindowSide) * state.grid.cell;
  }
  if (!overlap<Dim>(all_[0], all_[1], low, high)) return;
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (!overlap<Dim>(boxes_[b][0], boxes_[b][1], low, high)) continue;
    for (std::size_t s = kBlock * b; s < std::min(segments_.size(), kBlock * (b + 1)); ++s) {
      const Segment& segment = segments_[s];
      if (lines_[static_cast<std::size_t>(segment.crack)].field == tile.field &&
          overlap<Dim>(segment.low, segment.high, low, high))
        near.push_back(&segment);
    }
  }
}

/// The ways from the particles of a tile to the nodes of their supports that cross cracks of their body.
template <int Dim>
void Cracks<Dim>::cross(const State<Dim>& state, const Supports<Dim>& supports, const ParticleTile<Dim>& tile,
                        Room& room, std::vector<Crossed>& out) const {
  const double cell = state.grid.cell;
  list_around(state, tile, room.near);
  if (room.near.empty()) return;
  room.boxes.set(room.near);
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      const Vec<Dim> x = state.particles.vector(Quantity::position, p);
      const auto [begin, nodes] = reach_ahead(supports, p, cell);
      const auto at = [&, first = begin](int d, int k) {
        return state.grid.origin[d] + (first[d] + k) * cell;
      };
      Point2 low, high;
      for (std::size_t d = 0; d < 2; ++d) {
        const int axis = static_cast<int>(d);
        low[d] = std::min(at(axis, 0), x[axis]);
        high[d] = std::max(at(axis, nodes[axis] - 1), x[axis]);
      }
      room.boxes.list_overlapping(low, high, room.reached);
      if (room.reached.empty()) continue;
      Ways& ways = room.ways;
      ways.start(in_plane<Dim>(x));
      for (int k = 0; k < nodes.prod(); ++k) ways.add({at(0, k % nodes[0]), at(1, k / nodes[0] % nodes[1])});
      const std::size_t own = out.size();
      const Segment* before = nullptr;
      Ways::Bits left_of_from = 0, left_of_to = 0;
      for (const int k : room.reached) {
        const Segment* segment = room.near[static_cast<std::size_t>(k)];
        const Point2 from = in_plane<Dim>(segment->from), to = in_plane<Dim>(segment->to);
        const bool goes_on = before && segment == before + 1 && before->crack == segment->crack;
        left_of_from = goes_on ? left_of_to : ways.left_of_ways(from);
        left_of_to = ways.left_of_ways(to);
        before = segment;
        if (left_of_from == left_of_to) continue;
        const auto [other, left] = ways.across(from, to);
        for (Ways::Bits crossed = (left_of_from ^ left_of_to) & other; crossed != 0; crossed &= crossed - 1) {
          const int bit = std::countr_zero(crossed), way = left >> bit & 1 ? 1 : -1;
          NodeIndex<Dim> node = begin;
          for (int d = 0, rest = bit; d < Dim; rest /= nodes[d++]) node[d] += rest % nodes[d];
          const auto known =
              std::find_if(out.begin() + static_cast<std::ptrdiff_t>(own), out.end(),
                           [&](const auto& one) { return one.node == node && one.crack == segment->crack; });
          if (known == out.end())
            out.push_back({p, node, segment->crack, way, segment->normal});
          else if ((known->way += way) == 0)  // there and back
            out.erase(known);
        }
      }
    }
  }
}

template <int Dim>
void Cracks<Dim>::list_crossed(const State<Dim>& state, const Supports<Dim>& supports) {
  const auto tiles = static_cast<std::int64_t>(state.tiling.tiles.size());
  crossed_.resize(static_cast<std::size_t>(tiles));
  share_out(tiles, state.threads, 8, [&](std::int64_t t) {
    const auto& tile = state.tiling.tiles[static_cast<std::size_t>(t)];
    auto& out = crossed_[static_cast<std::size_t>(t)];
    out.clear();
    if (first_side_[static_cast<std::size_t>(tile.field)] >= 0)
      cross(state, supports, tile, rooms_[static_cast<std::size_t>(own_number())], out);
  });
}

/// The nodes that any particle sees behind a crack.
template <int Dim>
void Cracks<Dim>::list_nodes(const State<Dim>& state) {
  NodeIndex<Dim> block;
  const auto key_in = [&](std::size_t tile) { return key_of(state.tiling.tiles[tile].field, block); };
  block_keys_.clear();
  for (std::size_t t = 0; t < crossed_.size(); ++t)
    for (const Crossed& one : crossed_[t]) {
      place_in_block(one.node, block);
      if (block_keys_.empty() || block_keys_.back() != key_in(t)) block_keys_.push_back(key_in(t));
    }
  std::sort(block_keys_.begin(), block_keys_.end());
  block_keys_.erase(std::unique(block_keys_.begin(), block_keys_.end()), block_keys_.end());
  blocks_.resize(block_keys_.size());
  for (auto& places : blocks_) places.fill(-1);
  nodes_.clear();
  for (std::size_t t = 0; t < crossed_.size(); ++t)
    for (const Crossed& one : crossed_[t]) {
      const auto local = static_cast<std::size_t>(place_in_block(one.node, block));
      const auto at =
          std::lower_bound(block_keys_.begin(), block_keys_.end(), key_in(t)) - block_keys_.begin();
      int& number = blocks_[static_cast<std::size_t>(at)][local];
      if (number < 0) {
        number = static_cast<int>(nodes_.size());
        nodes_.emplace_back();
      }
      CrackedNode<Dim>& node = nodes_[static_cast<std::size_t>(number)];
      std::size_t k = 0;
      while (k < node.crack.size() && node.crack[k] >= 0 && node.crack[k] != one.crack) ++k;
      if (k == node.crack.size()) {
        ++counters_.third;
        continue;
      }
      node.crack[k] = one.crack;
      node.ways[k] += one.way;
      node.normal[k] += one.normal;
    }
  for (CrackedNode<Dim>& node : nodes_)
    if (node.crack[1] >= 0 && node.crack[1] < node.crack[0]) {
      std::swap(node.crack[0], node.crack[1]);
      std::swap(node.ways[0], node.ways[1]);
      std::swap(node.normal[0], node.normal[1]);
    }
}

namespace {

/// Of a window, the nodes that are right of their first and second crack, as a map tells.
template <int Dim>
using Told = std::array<WindowBits<Dim>, 2>;

template <int Dim>
Told<Dim> told_by(const SideMap<Dim>* map) {
  Told<Dim> right;
  for (std::size_t w = 0; map && w < map->side.size(); ++w)
    for (std::size_t j = 0; j < 2; ++j) right[j][w] = map->side[w] >> j & 1;
  return right;
}

/// Number of a node in a window; −1: it is outside.
template <int Dim>
int place_in_window(const NodeIndex<Dim>& node, const ParticleTile<Dim>& tile) {
  int w = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    const int at = node[d] - tile.window[d];
    if (at < 0 || at >= kWindowSide) return -1;
    w = w * kWindowSide + at;
  }
  return w;
}

/// Of the nodes from the first on, so many along each axis, those of a window.
template <int Dim>
WindowBits<Dim> reached_of(const NodeIndex<Dim>& first, const NodeIndex<Dim>& nodes,
                           const ParticleTile<Dim>& tile) {
  WindowBits<Dim> bits;
  for (int k = 0; k < nodes.prod(); ++k) {
    NodeIndex<Dim> node = first;
    for (int d = 0, rest = k; d < Dim; rest /= nodes[d++]) node[d] += rest % nodes[d];
    const int w = place_in_window(node, tile);
    if (w >= 0) bits.set(static_cast<std::size_t>(w));
  }
  return bits;
}

}  // namespace

/// The nodes right of their first and second crack: sides of what no way crosses to.
template <int Dim>
std::array<WindowBits<Dim>, 2> Cracks<Dim>::uncrossed(const WindowNodes& under) {
  std::array<WindowBits<Dim>, 2> right;
  for (std::size_t w = 0; w < under.size(); ++w)
    for (std::size_t j = 0; under[w] && j < right.size(); ++j)
      right[j][w] = under[w]->crack[j] >= 0 && !under[w]->is_left(static_cast<int>(j));
  return right;
}

/// The sides that the particles of a tile see.
template <int Dim>
Seen Cracks<Dim>::see(const State<Dim>& state, const Supports<Dim>& supports, std::size_t t,
                      std::vector<Sides>& out) const {
  const auto& tile = state.tiling.tiles[t];
  const SideMap<Dim>* map = state.tiling.sides_of(t);
  WindowNodes under;
  if (!find_under(tile, under) && !map) return Seen::same;
  const Told<Dim> right = uncrossed(under), told = told_by(map);
  Seen seen = Seen::same;
  const Crossed *next = crossed_[t].data(), *end = next + crossed_[t].size();
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      const NodeIndex<Dim> first = supports.first(p, 0);
      if (place_in_window(first, tile) < 0 ||
          place_in_window<Dim>(first + NodeIndex<Dim>::Constant(supports.nodes - 1), tile) < 0)
        seen = Seen::outside;
      const Reach ahead = reach_ahead(supports, p, state.grid.cell);
      Sides sides{p, reached_of(ahead.first, ahead.nodes, tile), {}};
      for (std::size_t j = 0; j < right.size(); ++j) sides.right[j] = right[j] & sides.reach;
      for (; next != end && next->particle == p; ++next) {
        const int w = place_in_window(next->node, tile);
        for (std::size_t j = 0; w >= 0 && j < right.size(); ++j)
          if (under[static_cast<std::size_t>(w)]->crack[j] == next->crack)
            sides.right[j][static_cast<std::size_t>(w)] = next->way > 0;
      }
      const auto other = (sides.right[0] ^ told[0]) | (sides.right[1] ^ told[1]);
      if ((other & sides.reach).any()) seen = std::max(seen, Seen::parted);
      if ((sides.right[0] | sides.right[1]).any()) out.push_back(sides);
    }
  }
  return seen;
}

/// The sides that particles see.
template <int Dim>
Seen Cracks<Dim>::list_sides(State<Dim>& state, const Supports<Dim>& supports) {
  const auto tiles = static_cast<std::int64_t>(crossed_.size());
  sides_.resize(crossed_.size());
  std::vector<Seen> seen(crossed_.size());
  share_out(tiles, state.threads, 8, [&](std::int64_t t) {
    const auto at = static_cast<std::size_t>(t);
    sides_[at].clear();
    seen[at] = see(state, supports, at, sides_[at]);
  });
  return std::accumulate(seen.begin(), seen.end(), Seen::same, [](Seen a, Seen b) { return std::max(a, b); });
}

template <int Dim>
Seen Cracks<Dim>::look(State<Dim>& state, const Supports<Dim>& supports) {
  drifted_ = 0;
  list_segments();
  list_crossed(state, supports);
  list_nodes(state);
  return list_sides(state, supports);
}

template <int Dim>
void Cracks<Dim>::group(State<Dim>& state) {
  ++counters_.groupings;
  auto& tiling = state.tiling;
  tiling.start_groups();
  struct Group {
    WindowBits<Dim> reach;
    Told<Dim> right;
  };
  std::vector<Group> groups;
  std::vector<SideMap<Dim>> maps;
  WindowNodes under;
  /// The first of the groups whose particles see the same sides as one does, or a new one.
  const auto group_in = [&](const Sides& sides) {
    std::size_t g = 0;
    const auto fits = [&](const Group& group) {
      const auto other = (group.right[0] ^ sides.right[0]) | (group.right[1] ^ sides.right[1]);
      return (other & group.reach & sides.reach).none();
    };
    while (g < groups.size() && !fits(groups[g])) ++g;
    if (g == groups.size()) groups.emplace_back();
    groups[g].reach |= sides.reach;
    for (std::size_t j = 0; j < 2; ++j) groups[g].right[j] |= sides.right[j];
    return static_cast<int>(g);
  };
  for (std::size_t first = 0, next = 0; first < tiling.tiles.size(); first = next) {
    next = first + 1 + static_cast<std::size_t>(tiling.tiles[first].others);
    groups.clear();
    for (std::size_t t = first; t < next; ++t)
      for (const Sides& sides : sides_[t]) tiling.set_group(sides.particle, 1 + group_in(sides));
    if (groups.empty()) continue;
    if (groups.size() >= static_cast<std::size_t>(Tiling<Dim>::kMostGroups))
      throw RunFailure("too many cracks within a few cells");
    find_under(tiling.tiles[first], under);
    const Told<Dim> beyond = uncrossed(under);  // what none of a group reaches
    maps.resize(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto& [reach, right] = groups[g];
      for (std::size_t w = 0; w < maps[g].side.size(); ++w) {
        const Told<Dim>& told = reach[w] ? right : beyond;
        maps[g].side[w] = static_cast<std::int8_t>(told[0][w] + 2 * told[1][w]);
      }
    }
    tiling.set_groups(tiling.tiles[first], maps);
  }
  tiling.regroup(state.particles, state.body_field);
}

template <int Dim>
void Cracks<Dim>::mark(State<Dim>& state, const Supports<Dim>& supports) const {
  auto& tiling = state.tiling;
  const auto tiles = static_cast<std::int64_t>(tiling.tiles.size());
  share_out(tiles, state.threads, 8, [&](std::int64_t t) {
    auto& tile = tiling.tiles[static_cast<std::size_t>(t)];
    WindowNodes under;
    tile.cracked = false;
    if (!find_under(tile, under)) return;
    WindowBits<Dim> cracked;
    for (std::size_t w = 0; w < under.size(); ++w) cracked[w] = under[w] != nullptr;
    const std::uint32_t begin = tiling.runs[static_cast<std::size_t>(tile.run_begin)].begin,
                        end = tiling.runs[static_cast<std::size_t>(tile.run_end - 1)].end;
    for (std::uint32_t p = begin; p < end && !tile.cracked; ++p) {
      const Reach ahead = reach_ahead(supports, p, state.grid.cell);
      tile.cracked = (reached_of(ahead.first, ahead.nodes, tile) & cracked).any();
    }
  });
}

// Here: the members that this file defines.
template class Cracks<2>;
template class Cracks<3>;

}  // namespace mpmfast
