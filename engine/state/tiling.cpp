#include "engine/state/tiling.hpp"

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "engine/constants.hpp"
#include "engine/errors.hpp"

namespace mpmfast {

namespace {

constexpr int kMargin = 2;  ///< tiles beyond the domain on each side: supports and lost particles stay within

}  // namespace

template <int Dim>
void Tiling<Dim>::set_domain(const std::array<int, 3>& nodes) {
  for (int d = 0; d < Dim; ++d)
    span_[static_cast<std::size_t>(d)] = nodes[static_cast<std::size_t>(d)] / kTileSide + 1 + 2 * kMargin;
}

template <int Dim>
std::int64_t Tiling<Dim>::tile_index(const NodeIndex<Dim>& tile, int field, int fields) const {
  std::int64_t index = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    const int span = span_[static_cast<std::size_t>(d)];
    index = index * span + std::clamp(tile[d] + kMargin, 0, span - 1);  // what was thrown far lies on the rim
    if (d == Dim - 1) index = index * fields + field;
  }
  return index;
}

template <int Dim>
NodeIndex<Dim> Tiling<Dim>::coordinates(std::int64_t tile_index, int fields) const {
  NodeIndex<Dim> tile;
  for (int d = 0; d < Dim; ++d) {
    if (d == Dim - 1) tile_index /= fields;
    const int span = span_[static_cast<std::size_t>(d)];
    tile[d] = static_cast<int>(tile_index % span) - kMargin;
    tile_index /= span;
  }
  return tile;
}

template <int Dim>
void Tiling<Dim>::count_fields(const std::vector<int>& body_field) {
  fields_ = 1;
  for (const int field : body_field) fields_ = std::max(fields_, field + 1);
}

template <int Dim>
void Tiling<Dim>::start_keys(std::size_t n, const std::vector<int>& body_field) {
  bodies_ = kinds_ * static_cast<int>(body_field.size());
  count_fields(body_field);
  groups_ = first_side_.empty() ? 1 : kMostGroups;
  buffers_.key.resize(n);
  mapped_.clear();
  maps_.clear();
}

template <int Dim>
void Tiling<Dim>::build(Particles<Dim>& particles, const std::vector<int>& body_field) {
  order_maps();
  sort(particles);
  cut_runs(particles, body_field);
  number_slots();
  list_node_blocks();
}

template <int Dim>
void Tiling<Dim>::regroup(Particles<Dim>& particles, const std::vector<int>& body_field) {
  order_maps();
  sort_by_tile_index(particles);
  cut_runs(particles, body_field);
  number_slots();
  list_node_blocks();
}

namespace {

void require(bool holds) {
  if (!holds) throw FileError("the checkpoint is none of its scene: its tiles do not fit the particles");
}

/// Keys rise, stay below the last of the domain, and name the body of their particle.
/// @param bodies  of the keys: kinds of runs times bodies of the scene
template <int Dim>
void check_keys(const std::vector<std::uint64_t>& keys, const Particles<Dim>& particles, std::uint64_t kinds,
                std::uint64_t bodies, std::uint64_t tiles) {
  require(keys.size() == particles.size());
  constexpr std::uint64_t kCells = kTileNodes<Dim>;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    require(p == 0 || keys[p - 1] <= keys[p]);
    require(keys[p] / kCells / bodies < tiles && keys[p] / kCells % bodies / kinds == particles.body()[p]);
  }
}

/// No side but those that a field has.
template <int Dim>
void check_sides(const SideMap<Dim>& map, bool has_sides) {
  for (const std::int8_t side : map.side) require(side == 0 || (has_sides && side > 0 && side < 4));
}

}  // namespace

template <int Dim>
void Tiling<Dim>::visit(Archive& archive, Particles<Dim>& particles, const std::vector<int>& body_field) {
  archive.list("tiling/keys", buffers_.key);
  archive.number("tiling/bodies", bodies_);
  count_fields(body_field);
  std::uint64_t rows = 1, rows_and_fields = static_cast<std::uint64_t>(fields_);
  for (int d = 0; d < Dim; ++d) {
    const auto span = static_cast<std::uint64_t>(span_[static_cast<std::size_t>(d)]);
    if (d < Dim - 1) rows *= span;
    rows_and_fields *= span;
  }
  if (!first_side_.empty()) {
    groups_ = kMostGroups;
    archive.list("tiling/mapped", mapped_);
    maps_.resize(mapped_.size());
    archive.column("tiling/sides", reinterpret_cast<std::uint8_t*>(maps_.data()),
                   maps_.size() * sizeof(SideMap<Dim>));
  }
  if (!archive.reading()) return;
  const auto groups = static_cast<std::uint64_t>(groups_);
  for (std::size_t k = 0; k < mapped_.size(); ++k) {
    const std::uint64_t tile_index = mapped_[k] / groups;
    require(tile_index < rows_and_fields);
    check_sides(maps_[k], first_side_[tile_index / rows % static_cast<std::uint64_t>(fields_)] >= 0);
  }
  if (buffers_.key.empty()) return;
  require(bodies_ == kinds_ * static_cast<int>(body_field.size()));
  check_keys(buffers_.key, particles, static_cast<std::uint64_t>(kinds_), static_cast<std::uint64_t>(bodies_),
             rows_and_fields * groups);
  build(particles, body_field);
}

template <int Dim>
NodeIndex<Dim> Tiling<Dim>::sorted_node(std::size_t p) const {
  NodeIndex<Dim> node = NodeIndex<Dim>::Zero();
  const auto at = static_cast<std::uint32_t>(p);
  for (const auto& tile : tiles)
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = runs[static_cast<std::size_t>(r)];
      if (at < run.begin || at >= run.end) continue;
      int cell = 0;
      while (at >= run.cell_begin[cell + 1]) ++cell;
      for (int d = 0; d < Dim; ++d, cell /= kTileSide) node[d] = tile.window[d] + 1 + cell % kTileSide;
      return node;
    }
  return node;
}

template <int Dim>
void Tiling<Dim>::cut_runs(const Particles<Dim>& particles, const std::vector<int>& body_field) {
  tiles.clear();
  runs.clear();
  tile_keys_.clear();
  const auto n = static_cast<std::uint32_t>(particles.size());
  const auto cells = static_cast<std::uint64_t>(kTileNodes<Dim>);
  std::uint64_t last_tile = ~std::uint64_t{0};
  for (std::uint32_t p = 0; p < n;) {
    const std::uint64_t run_key = buffers_.key[p] / cells,
                        tile_key = run_key / static_cast<std::uint64_t>(bodies_);
    ParticleRun<Dim> run;
    run.begin = p;
    run.body = particles.body()[p];
    run.on_surface = kinds_ > 1 && run_key % 2 == 1;
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
      run.cell_begin[cell] = p;
      while (p < n && buffers_.key[p] == run_key * cells + cell) ++p;
    }
    run.cell_begin[cells] = run.end = p;
    if (tile_key != last_tile) {
      ParticleTile<Dim> tile{};
      tile.field = body_field[static_cast<std::size_t>(run.body)];
      const auto groups = static_cast<std::uint64_t>(groups_);
      const NodeIndex<Dim> at = coordinates(static_cast<std::int64_t>(tile_key / groups), fields_);
      for (int d = 0; d < Dim; ++d) tile.window[d] = at[d] * kTileSide;
      tile.run_begin = tile.run_end = static_cast<int>(runs.size());
      tiles.push_back(tile);
      if (groups_ > 1) tile_keys_.push_back(tile_key);
      last_tile = tile_key;
    }
    runs.push_back(run);
    tiles.back().run_end = static_cast<int>(runs.size());
  }
  // Groups of a place write to the same nodes.
  for (std::size_t t = tile_keys_.size(), others = 0; t-- > 0;) {
    tiles[t].others = static_cast<int>(others);
    const auto tile_index_key = [&](std::size_t k) {
      return tile_keys_[k] / static_cast<std::uint64_t>(groups_);
    };
    others = t > 0 && tile_index_key(t) == tile_index_key(t - 1) ? others + 1 : 0;
  }
  colour_strips();
}

/// How many rows along x the tiles lie in, and how many of them in the longest.
template <int Dim>
auto Tiling<Dim>::rows_of_tiles() const -> Rows {
  Rows rows{0, 0};
  int length = 0;
  const ParticleTile<Dim>* last = nullptr;
  for (const auto& tile : tiles) {
    bool goes_on = last && tile.field == last->field;
    for (int d = 1; d < Dim; ++d) goes_on = goes_on && tile.window[d] == last->window[d];
    length = goes_on ? length + 1 : 1;
    rows.count += !goes_on;
    rows.longest = std::max(rows.longest, length);
    last = &tile;
  }
  return rows;
}

/// Long strips read memory as it lies, short ones leave more threads something to do. Where there are enough
/// rows, a strip is one of them, or of many tiles several, some 32 of a colour, and half the colours do: what
/// a row shares with the one before it is still near. Else they begin at multiples of their length.
template <int Dim>
void Tiling<Dim>::colour_strips() {
  using namespace constants::tiling;
  const Rows all = rows_of_tiles();
  const int count = static_cast<int>(tiles.size()),
            length = std::clamp(count / (kCorners<Dim> * kStripsOfColour), kShortestStrip, kLongestStrip);
  const bool whole = all.count >= kFewestRows * kCorners<Dim> / 2;
  // In the plane the rows of other fields lie between those of one.
  const bool several = whole && count >= kManyTiles && (Dim == 3 || fields_ == 1);
  const int rows = several ? (2 * length + all.longest - 1) / all.longest : 1;
  for (auto& colour : colours) colour.clear();
  NodeIndex<Dim> last;
  int last_field = -1;
  Strip* strip = nullptr;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    NodeIndex<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = tiles[t].window[d] / kTileSide;
    at[0] = whole ? 0 : floor_div(at[0], length);
    at[1] = floor_div(at[1], rows);
    if (!strip || tiles[t].field != last_field || at != last) {
      unsigned colour = 0;
      for (int d = 0; d < Dim; ++d) colour |= static_cast<unsigned>(at[d] & 1) << d;
      strip = &colours[colour].emplace_back(Strip{static_cast<int>(t), 0});
    }
    strip->end = static_cast<int>(t) + 1;
    last = at;
    last_field = tiles[t].field;
  }
}

template <int Dim>
int Tiling<Dim>::find(std::int64_t tile_index, int field) const {
  const auto before = [](const NodeTile<Dim>& t, const std::pair<std::int64_t, int>& key) {
    return t.tile_index != key.first ? t.tile_index < key.first : t.field < key.second;
  };
  const auto it =
      std::lower_bound(node_tiles.begin(), node_tiles.end(), std::pair{tile_index, field}, before);
  return it != node_tiles.end() && it->tile_index == tile_index && it->field == field
             ? static_cast<int>(it - node_tiles.begin())
             : -1;
}

template <int Dim>
bool Tiling<Dim>::within(const NodeIndex<Dim>& tile) const {
  bool within = true;
  for (int d = 0; d < Dim; ++d)
    within &= tile[d] >= -kMargin && tile[d] < span_[static_cast<std::size_t>(d)] - kMargin;
  return within;
}

template <int Dim>
int Tiling<Dim>::slot(const NodeIndex<Dim>& node, int field) const {
  NodeIndex<Dim> tile;
  int local = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    tile[d] = floor_div(node[d], kTileSide);
    local = local * kTileSide + (node[d] - tile[d] * kTileSide);
  }
  const int found = within(tile) ? find(tile_index(tile), field) : -1;
  return found < 0 ? -1 : found * kTileNodes<Dim> + local;
}

template <int Dim>
void Tiling<Dim>::order_maps() {
  if (std::is_sorted(mapped_.begin(), mapped_.end())) return;
  std::vector<std::size_t> order(mapped_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return mapped_[a] < mapped_[b]; });
  std::vector<std::uint64_t> keys;
  std::vector<SideMap<Dim>> maps;
  for (const std::size_t k : order) {
    keys.push_back(mapped_[k]);
    maps.push_back(maps_[k]);
  }
  mapped_.swap(keys);
  maps_.swap(maps);
}

template <int Dim>
const SideMap<Dim>* Tiling<Dim>::sides_of(std::size_t tile) const {
  if (tile_keys_.empty()) return nullptr;
  const auto found = std::lower_bound(mapped_.begin(), mapped_.end(), tile_keys_[tile]);
  const bool mapped = found != mapped_.end() && *found == tile_keys_[tile];
  return mapped ? &maps_[static_cast<std::size_t>(found - mapped_.begin())] : nullptr;
}

/// Calls f(corner, place, field) for each node tile under the window of a tile.
template <int Dim>
template <class F>
void Tiling<Dim>::for_each_node_tile(std::size_t t, const F& f) const {
  const auto& tile = tiles[t];
  const SideMap<Dim>* sides = sides_of(t);
  for (int c = 0; c < kCorners<Dim>; ++c) {
    NodeIndex<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = tile.window[d] / kTileSide + (c >> d & 1);
    f(c, tile_index(at), tile.field);
    if (!sides) continue;
    unsigned seen = 0;
    for (int w = 0; w < kWindowNodes<Dim>; ++w) {
      int corner = 0;
      for (int d = 0, rest = w; d < Dim; ++d, rest /= kWindowSide)
        corner |= static_cast<int>(rest % kWindowSide >= kTileSide) << d;
      const int side = sides->side[static_cast<std::size_t>(w)];
      if (corner == c && side > 0) seen |= 1u << side;
    }
    for (int side = 1; side < 4; ++side)
      if (seen >> side & 1)
        f(c, tile_index(at), first_side_[static_cast<std::size_t>(tile.field)] + side - 1);
  }
}

/// The slot of each node under the windows where nodes take sides.
template <int Dim>
void Tiling<Dim>::number_sides() {
  std::size_t mapped = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) mapped += sides_of(t) != nullptr;
  node_slots_.resize(mapped * kWindowNodes<Dim>);
  int* next = node_slots_.data();
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const SideMap<Dim>* sides = sides_of(t);
    tiles[t].node_slot = sides ? next : nullptr;
    if (!sides) continue;
    for (int w = 0; w < kWindowNodes<Dim>; ++w) {
      const int side = sides->side[static_cast<std::size_t>(w)];
      NodeIndex<Dim> node;
      for (int d = 0, rest = w; d < Dim; ++d, rest /= kWindowSide)
        node[d] = tiles[t].window[d] + rest % kWindowSide;
      const int field = tiles[t].field;
      next[w] = slot(node, side == 0 ? field : first_side_[static_cast<std::size_t>(field)] + side - 1);
    }
    next += kWindowNodes<Dim>;
  }
}

template <int Dim>
void Tiling<Dim>::number_slots() {
  node_tiles.clear();
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for_each_node_tile(t, [&](int, std::int64_t at, int field) {
      NodeTile<Dim> node_tile{at, field, {}};
      for (int& p : node_tile.particle_tile) p = -1;
      node_tiles.push_back(node_tile);
    });
  std::sort(node_tiles.begin(), node_tiles.end(), [](const auto& a, const auto& b) {
    return a.tile_index != b.tile_index ? a.tile_index < b.tile_index : a.field < b.field;
  });
  const auto same = [](const auto& a, const auto& b) {
    return a.tile_index == b.tile_index && a.field == b.field;
  };
  node_tiles.erase(std::unique(node_tiles.begin(), node_tiles.end(), same), node_tiles.end());
  // Tiles lie in order, and so does what is found for each of their corners, but for other fields between.
  std::array<int, kCorners<Dim>> last;
  last.fill(-1);
  const auto find_on = [&](int c, std::int64_t at, int field) {
    using constants::tiling::kTilesAhead;
    int& here = last[static_cast<std::size_t>(c)];
    for (int k = here + 1; k < std::min(here + 1 + kTilesAhead, static_cast<int>(node_tiles.size())); ++k) {
      const auto& node_tile = node_tiles[static_cast<std::size_t>(k)];
      if (node_tile.tile_index == at && node_tile.field == field) return here = k;
    }
    return here = find(at, field);
  };
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for_each_node_tile(t, [&](int c, std::int64_t at, int field) {
      const int found = find_on(c, at, field);
      if (field == tiles[t].field) tiles[t].slot[c] = found * kTileNodes<Dim>;
      int& first = node_tiles[static_cast<std::size_t>(found)].particle_tile[c];
      if (first < 0) first = static_cast<int>(t);
    });
  number_sides();
}

template <int Dim>
void Tiling<Dim>::list_node_blocks() {
  node_blocks.clear();
  for (int t = 0; t < static_cast<int>(node_tiles.size());) {
    NodeBlock<Dim> block{};
    block.begin = t;
    const std::int64_t at = node_tiles[static_cast<std::size_t>(t)].tile_index;
    while (t < static_cast<int>(node_tiles.size()) &&
           node_tiles[static_cast<std::size_t>(t)].tile_index == at)
      ++t;
    block.end = t;
    block.first_node = coordinates(at) * kTileSide;
    node_blocks.push_back(block);
  }
  const auto tile_index_of = [&](const NodeBlock<Dim>& s) {
    return node_tiles[static_cast<std::size_t>(s.begin)].tile_index;
  };
  // Blocks lie in order of their tile indices, and so do their neighbours on one side: one walk for each
  // side.
  for (int k = 0; k < power(3, Dim); ++k) {
    NodeIndex<Dim> side;
    int digits = k;
    for (int d = 0; d < Dim; ++d, digits /= 3) side[d] = digits % 3 - 1;
    std::size_t next = 0;
    for (auto& block : node_blocks) {
      const NodeIndex<Dim> at = block.first_node / kTileSide + side;
      block.neighbour[k] = -1;
      if (!within(at)) continue;
      const std::int64_t wanted = tile_index(at);
      while (next < node_blocks.size() && tile_index_of(node_blocks[next]) < wanted) ++next;
      if (next < node_blocks.size() && tile_index_of(node_blocks[next]) == wanted)
        block.neighbour[k] = static_cast<int>(next);
    }
  }
}

/// Each corner of a tile's window lists a node tile, before those that are the same become one.
template <int Dim>
std::size_t Tiling<Dim>::bytes() const {
  const std::size_t listed = std::max(node_tiles.size(), kCorners<Dim> * tiles.size());
  return tiles.size() * sizeof(ParticleTile<Dim>) + runs.size() * sizeof(ParticleRun<Dim>) +
         listed * sizeof(NodeTile<Dim>) + node_blocks.size() * sizeof(NodeBlock<Dim>) +
         (mapped_.size() + tile_keys_.size()) * sizeof(std::uint64_t) + maps_.size() * sizeof(SideMap<Dim>) +
         node_slots_.size() * sizeof(int) + buffers_.bytes();
}

template class Tiling<2>;
template class Tiling<3>;

}  // namespace mpmfast
