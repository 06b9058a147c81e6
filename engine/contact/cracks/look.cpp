/// Which sides of cracks the particles see at the nodes that they reach.

#include "engine/contact/cracks/cracks.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/errors.hpp"
#include "engine/geometry/crossing.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kBlock = 16;             ///< segments that have a box together
static_assert(Tiling<2>::kMostGroups <= 256);  // as group_ can say

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
void Cracks<Dim>::list_segments() {
  segments_.clear();
  boxes_.clear();
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
    }
}

/// The ways from the particles of a tile to the nodes of their supports that cross cracks of their body.
template <int Dim>
void Cracks<Dim>::cross(const State<Dim>& state, const Supports<Dim>& supports, const ParticleTile<Dim>& tile,
                        Room& room, std::vector<Crossed>& out) const {
  const auto place = [&](const NodeIndex<Dim>& node) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = state.grid.origin[d] + node[d] * state.grid.cell;
    return x;
  };
  NodeIndex<Dim> first;
  for (int d = 0; d < Dim; ++d) first[d] = tile.window[d] - 1;
  const Vec<Dim> low = place(first), high = place(first + NodeIndex<Dim>::Constant(kWindowSide + 1));
  auto& [near, reached] = room;
  near.clear();
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (!overlap<Dim>(boxes_[b][0], boxes_[b][1], low, high)) continue;
    for (std::size_t s = kBlock * b; s < std::min(segments_.size(), kBlock * (b + 1)); ++s) {
      const Segment& segment = segments_[s];
      if (lines_[static_cast<std::size_t>(segment.crack)].field == tile.field &&
          overlap<Dim>(segment.low, segment.high, low, high))
        near.push_back(&segment);
    }
  }
  if (near.empty()) return;
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      const Vec<Dim> x = state.particles.vector(Quantity::position, p);
      const NodeIndex<Dim> begin = supports.first(p);
      const Vec<Dim> lowest = place(begin).cwiseMin(x),
                     highest = place(begin + NodeIndex<Dim>::Constant(supports.nodes - 1)).cwiseMax(x);
      reached.clear();
      for (const Segment* segment : near)
        if (overlap<Dim>(segment->low, segment->high, lowest, highest)) reached.push_back(segment);
      if (reached.empty()) continue;
      const std::size_t own = out.size();
      const Point2 p_at = in_plane<Dim>(x);
      for (const Segment* segment : reached) {
        const Point2 from = in_plane<Dim>(segment->from), to = in_plane<Dim>(segment->to);
        const bool p_left = is_left(from, to, p_at);
        for (int k = 0; k < power(supports.nodes, Dim); ++k) {
          NodeIndex<Dim> node = begin;
          for (int d = 0, rest = k; d < Dim; ++d, rest /= supports.nodes) node[d] += rest % supports.nodes;
          const Point2 at = in_plane<Dim>(place(node));
          if (is_left(from, to, at) == p_left) continue;  // most
          const int way = crossing(p_at, at, from, to);
          if (way == 0) continue;
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
#pragma omp parallel for num_threads(state.threads) schedule(dynamic, 8)
  for (std::int64_t t = 0; t < tiles; ++t) {
    const auto& tile = state.tiling.tiles[static_cast<std::size_t>(t)];
    auto& out = crossed_[static_cast<std::size_t>(t)];
    out.clear();
    if (first_side_[static_cast<std::size_t>(tile.field)] >= 0)
      cross(state, supports, tile, rooms_[static_cast<std::size_t>(omp_get_thread_num())], out);
  }
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

/// The sides that the particles of a tile see. @return whether the tile tells otherwise
template <int Dim>
bool Cracks<Dim>::see(State<Dim>& state, const Supports<Dim>& supports, std::size_t t,
                      std::vector<Sides>& out) const {
  auto& tile = state.tiling.tiles[t];
  const SideMap<Dim>* map = state.tiling.sides_of(t);
  WindowNodes seen;
  tile.cracked = find_under(tile, seen);
  if (!tile.cracked && !map) return false;
  bool differs = false;
  auto next = crossed_[t].begin();
  const auto end = crossed_[t].end();
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      Sides sides{p, supports.first(p), {}};
      const auto own = next;
      while (next != end && next->particle == p) ++next;
      bool other = false;
      for (int k = 0; k < power(supports.nodes, Dim); ++k) {
        int w = 0;
        bool inside = true;
        NodeIndex<Dim> node = sides.first;
        for (int d = 0, rest = k, stride = 1; d < Dim; ++d, rest /= supports.nodes, stride *= kWindowSide) {
          node[d] += rest % supports.nodes;
          const int at = node[d] - tile.window[d];
          inside &= at >= 0 && at < kWindowSide;
          w += at * stride;
        }
        differs |= !inside;  // it is to be sorted anyway
        const CrackedNode<Dim>* cracked = inside ? seen[static_cast<std::size_t>(w)] : find(tile.field, node);
        int side = 0;
        for (int j = 0; cracked && j < CrackedNode<Dim>::kMost; ++j) {
          const int crack = cracked->crack[static_cast<std::size_t>(j)];
          if (crack < 0) break;
          bool left = cracked->is_left(j);
          for (auto one = own; one != next; ++one)
            if (one->node == node && one->crack == crack) left = one->way < 0;
          side |= (left ? 0 : 1) << j;
        }
        sides.side[static_cast<std::size_t>(k)] = static_cast<std::int8_t>(side);
        other |= side != 0;
        if (inside) differs |= (map ? map->side[static_cast<std::size_t>(w)] : 0) != side;
      }
      if (other) out.push_back(sides);
    }
  }
  return differs;
}

/// The sides that particles see. @return whether the tiles tell otherwise
template <int Dim>
bool Cracks<Dim>::list_sides(State<Dim>& state, const Supports<Dim>& supports) {
  const auto tiles = static_cast<std::int64_t>(crossed_.size());
  sides_.resize(crossed_.size());
  int differs = 0;
#pragma omp parallel for num_threads(state.threads) schedule(dynamic, 8) reduction(| : differs)
  for (std::int64_t t = 0; t < tiles; ++t) {
    auto& out = sides_[static_cast<std::size_t>(t)];
    out.clear();
    differs |= see(state, supports, static_cast<std::size_t>(t), out) ? 1 : 0;
  }
  return differs != 0;
}

template <int Dim>
bool Cracks<Dim>::look(State<Dim>& state, const Supports<Dim>& supports) {
  if (!active()) return false;
  drifted_ = 0;
  list_segments();
  list_crossed(state, supports);
  list_nodes(state);
  const bool differs = list_sides(state, supports);
  counters_.sorts += differs;
  return differs;
}

template <int Dim>
void Cracks<Dim>::group(State<Dim>& state, const Supports<Dim>& supports,
                        const std::function<NodeIndex<Dim>(std::size_t)>& sorted_node) {
  group_.assign(state.particles.size(), 0);
  struct Place {
    int field;
    NodeIndex<Dim> tile;
    std::vector<SideMap<Dim>> maps;
  };
  std::map<std::uint64_t, Place> places;
  const auto group_one = [&](const Sides& sides) {
    const int field = state.body_field[state.particles.body()[sides.particle]];
    NodeIndex<Dim> tile;
    const NodeIndex<Dim> at = sorted_node(sides.particle);
    for (int d = 0; d < Dim; ++d) tile[d] = floor_div(at[d] - 1, kTileSide);
    Place& place = places.try_emplace(key_of(field, tile), Place{field, tile, {}}).first->second;
    const auto for_each_node = [&](const auto& f) {
      bool good = true;
      for (int k = 0; good && k < power(supports.nodes, Dim); ++k) {
        std::size_t w = 0, stride = 1;
        for (int d = 0, rest = k; d < Dim; ++d, rest /= supports.nodes, stride *= kWindowSide)
          w +=
              static_cast<std::size_t>(sides.first[d] + rest % supports.nodes - tile[d] * kTileSide) * stride;
        good = f(w, sides.side[static_cast<std::size_t>(k)]);
      }
      return good;
    };
    std::size_t group = 0;
    const auto fits = [&](const SideMap<Dim>& map) {
      return for_each_node([&](std::size_t w, std::int8_t side) {
        return map.side[w] == SideMap<Dim>::kNone || map.side[w] == side;
      });
    };
    while (group < place.maps.size() && !fits(place.maps[group])) ++group;
    if (group == place.maps.size()) {
      if (group + 1 == static_cast<std::size_t>(Tiling<Dim>::kMostGroups))
        throw RunFailure("too many cracks within a few cells");
      place.maps.emplace_back();
      place.maps.back().side.fill(SideMap<Dim>::kNone);
    }
    for_each_node([&](std::size_t w, std::int8_t side) {
      place.maps[group].side[w] = side;
      return true;
    });
    group_[sides.particle] = static_cast<std::uint8_t>(group + 1);
  };
  for (const auto& of_tile : sides_)
    for (const Sides& sides : of_tile) group_one(sides);
  for (const auto& [key, place] : places) state.tiling.set_groups(place.field, place.tile, place.maps);
}

template <int Dim>
void Cracks<Dim>::mark(State<Dim>& state) const {
  WindowNodes seen;
  for (auto& tile : state.tiling.tiles) tile.cracked = find_under(tile, seen);
}

// Here: the members that this file defines.
template class Cracks<2>;
template class Cracks<3>;

}  // namespace mpmfast
