// Particles sorted at random, over and over, against plain maps from places to particles; columns and tables
// of quantities against their sizes.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "engine/errors.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {
namespace {

using Draw = std::mt19937_64;

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

using TileIndex = std::array<int, 3>;  ///< of a tile: last axis, ..., x; unused ones zero

/// What is known of one particle.
template <int Dim>
struct Record {
  std::uint32_t id = 0;
  int body = 0, field = 0, group = 0;
  bool on_surface = false;
  std::array<int, Dim> begin{};  ///< first support node

  static int floored(int b) { return b >= 0 ? b / 4 : -((3 - b) / 4); }
  std::array<int, Dim> tile() const {
    std::array<int, Dim> out;
    for (std::size_t d = 0; d < Dim; ++d) out[d] = floored(begin[d] - 1);
    return out;
  }
  int cell() const {
    int out = 0, stride = 1;
    for (std::size_t d = 0; d < Dim; ++d, stride *= 4) out += stride * (begin[d] - 1 - 4 * tile()[d]);
    return out;
  }
  /// Last axis, field, the others down to x.
  auto at() const {
    const auto t = tile();
    if constexpr (Dim == 2)
      return std::tuple(t[1], field, t[0], 0);
    else
      return std::tuple(t[2], field, t[1], t[0]);
  }
  auto order() const { return std::tuple(at(), group, body, on_surface, cell()); }
};

template <int Dim>
TileIndex tile_index_of(const std::array<int, Dim>& tile) {
  TileIndex out{};
  for (std::size_t d = 0; d < Dim; ++d) out[Dim - 1 - d] = tile[d];
  return out;
}

/// All tables of a tiling, whose particles are known in their order.
template <int Dim>
class Checked {
 public:
  Checked(const Tiling<Dim>& tiling, Particles<Dim>& particles, std::vector<Record<Dim>> sorted,
          std::vector<int> first_side, std::map<std::pair<int, int>, SideMap<Dim>> maps)
      : tiling_(tiling),
        particles_(particles),
        sorted_(std::move(sorted)),
        first_side_(std::move(first_side)),
        maps_(std::move(maps)) {
    check_particles();
    check_tiles();
    check_node_tiles();
    check_blocks();
  }

  /// Maps are told by the number of their tile's place in order, and their group.
  static std::vector<std::size_t> tile_numbers(const std::vector<Record<Dim>>& sorted) {
    std::vector<std::size_t> out;
    for (std::size_t p = 0; p < sorted.size(); ++p)
      out.push_back(p == 0 ? 0 : out.back() + (sorted[p].at() != sorted[p - 1].at()));
    return out;
  }

 private:
  void check_particles() {
    REQUIRE(particles_.size() == sorted_.size());
    for (std::size_t p = 0; p < sorted_.size(); ++p) {
      REQUIRE(particles_.id()[p] == sorted_[p].id);
      REQUIRE(particles_.body()[p] == sorted_[p].body);
      for (int d = 0; d < Dim; ++d)
        REQUIRE(particles_.column(Quantity::position, d)[p] == 10.0 * sorted_[p].id + d);
      const NodeIndex<Dim> node = tiling_.sorted_node(p);
      for (int d = 0; d < Dim; ++d) REQUIRE(node[d] == sorted_[p].begin[static_cast<std::size_t>(d)]);
    }
    REQUIRE(tiling_.sorted_node(sorted_.size()) == NodeIndex<Dim>::Zero());
  }

  void check_tiles() {
    const auto numbers = tile_numbers(sorted_);
    std::size_t t = 0, r = 0, p = 0;
    while (p < sorted_.size()) {
      const Record<Dim>& first = sorted_[p];
      REQUIRE(t < tiling_.tiles.size());
      const auto& tile = tiling_.tiles[t];
      REQUIRE(tile.field == first.field);
      REQUIRE(tile.run_begin == static_cast<int>(r));
      for (int d = 0; d < Dim; ++d) REQUIRE(tile.window[d] == 4 * first.tile()[static_cast<std::size_t>(d)]);
      const auto same_tile = [&](const Record<Dim>& x) {
        return x.at() == first.at() && x.group == first.group;
      };
      while (p < sorted_.size() && same_tile(sorted_[p])) {
        const Record<Dim>& start = sorted_[p];
        REQUIRE(r < tiling_.runs.size());
        const auto& run = tiling_.runs[r++];
        REQUIRE(run.begin == p);
        REQUIRE(run.body == start.body);
        REQUIRE(run.on_surface == start.on_surface);
        std::vector<std::uint32_t> count(kTileNodes<Dim>, 0);
        while (p < sorted_.size() && same_tile(sorted_[p]) && sorted_[p].body == start.body &&
               sorted_[p].on_surface == start.on_surface)
          ++count[static_cast<std::size_t>(sorted_[p++].cell())];
        std::uint32_t from = run.begin;
        for (std::size_t c = 0; c < count.size(); from += count[c++]) REQUIRE(run.cell_begin[c] == from);
        REQUIRE(run.cell_begin[kTileNodes<Dim>] == p);
        REQUIRE(run.end == p);
      }
      REQUIRE(tile.run_end == static_cast<int>(r));
      std::set<int> later;
      for (std::size_t q = p; q < sorted_.size() && sorted_[q].at() == first.at(); ++q)
        later.insert(sorted_[q].group);
      REQUIRE(tile.others == static_cast<int>(later.size()));
      const auto map = maps_.find({static_cast<int>(numbers[p - 1]), first.group});
      const SideMap<Dim>* got = tiling_.sides_of(t);
      REQUIRE((got != nullptr) == (map != maps_.end()));
      if (got) REQUIRE(got->side == map->second.side);
      seen_.push_back({first, got});
      ++t;
    }
    REQUIRE(tiling_.tiles.size() == t);
    REQUIRE(tiling_.runs.size() == r);
  }

  void check_node_tiles() {
    std::map<std::pair<TileIndex, int>, std::array<int, kCorners<Dim>>>
        wanted;  // first particle tile by corner
    const auto need = [&](const TileIndex& at, int field, std::size_t c, std::size_t t) {
      std::array<int, kCorners<Dim>> none;
      none.fill(-1);
      int& first = wanted.insert({{at, field}, none}).first->second[c];
      if (first < 0) first = static_cast<int>(t);
    };
    for (std::size_t t = 0; t < seen_.size(); ++t)
      for (std::size_t c = 0; c < kCorners<Dim>; ++c) {
        auto at = seen_[t].first.tile();
        for (std::size_t d = 0; d < Dim; ++d) at[d] += static_cast<int>(c >> d & 1);
        const TileIndex tile_index = tile_index_of<Dim>(at);
        const int field = seen_[t].first.field;
        need(tile_index, field, c, t);
        if (!seen_[t].second) continue;
        for (std::size_t w = 0; w < kWindowNodes<Dim>; ++w) {
          bool below = true;
          std::size_t rest = w;
          for (std::size_t d = 0; d < Dim; ++d, rest /= 8)
            below = below && ((rest % 8 >= 4) == ((c >> d & 1) == 1));
          const int side = seen_[t].second->side[w];
          if (below && side > 0)
            need(tile_index, first_side_[static_cast<std::size_t>(field)] + side - 1, c, t);
        }
      }
    REQUIRE(tiling_.node_tiles.size() == wanted.size());
    REQUIRE(tiling_.slots() == static_cast<int>(wanted.size()) * kTileNodes<Dim>);
    std::size_t n = 0;
    for (const auto& [key, first] : wanted) {
      const auto& got = tiling_.node_tiles[n];
      REQUIRE(got.field == key.second);
      for (std::size_t c = 0; c < kCorners<Dim>; ++c) REQUIRE(got.particle_tile[c] == first[c]);
      number_[key] = static_cast<int>(n++);
    }
    for (std::size_t t = 0; t < seen_.size(); ++t) {
      for (std::size_t c = 0; c < kCorners<Dim>; ++c) {
        auto at = seen_[t].first.tile();
        for (std::size_t d = 0; d < Dim; ++d) at[d] += static_cast<int>(c >> d & 1);
        REQUIRE(tiling_.tiles[t].slot[c] ==
                number_.at({tile_index_of<Dim>(at), seen_[t].first.field}) * kTileNodes<Dim>);
      }
      const int* const slots = tiling_.tiles[t].node_slot;
      REQUIRE((slots != nullptr) == (seen_[t].second != nullptr));
      for (int w = 0; slots && w < kWindowNodes<Dim>; ++w) {
        const int side = seen_[t].second->side[static_cast<std::size_t>(w)], field = seen_[t].first.field;
        std::array<int, Dim> node;
        int rest = w;
        for (std::size_t d = 0; d < Dim; ++d, rest /= 8) node[d] = tiling_.tiles[t].window[d] + rest % 8;
        REQUIRE(slots[w] ==
                slot_of(node, side == 0 ? field : first_side_[static_cast<std::size_t>(field)] + side - 1));
      }
    }
  }

  int slot_of(const std::array<int, Dim>& node, int field) const {
    std::array<int, Dim> tile;
    int local = 0, stride = 1;
    for (std::size_t d = 0; d < Dim; ++d, stride *= 4) {
      tile[d] = Record<Dim>::floored(node[d]);
      local += stride * (node[d] - 4 * tile[d]);
    }
    const auto found = number_.find({tile_index_of<Dim>(tile), field});
    return found == number_.end() ? -1 : found->second * kTileNodes<Dim> + local;
  }

  void check_blocks() {
    std::map<TileIndex, int> blocks;
    for (const auto& [key, n] : number_) blocks.insert({key.first, static_cast<int>(blocks.size())});
    REQUIRE(tiling_.node_blocks.size() == blocks.size());
    REQUIRE(tiling_.block_nodes() == blocks.size() * kTileNodes<Dim>);
    int begin = 0;
    for (const auto& [tile_index, s] : blocks) {
      const auto& block = tiling_.node_blocks[static_cast<std::size_t>(s)];
      int fields = 0;
      for (const auto& [key, n] : number_) fields += key.first == tile_index;
      REQUIRE(block.begin == begin);
      REQUIRE(block.end == (begin += fields));
      for (int d = 0; d < Dim; ++d)
        REQUIRE(block.first_node[d] == 4 * tile_index[static_cast<std::size_t>(Dim - 1 - d)]);
      for (int k = 0; k < power(3, Dim); ++k) {
        TileIndex beside = tile_index;
        for (int d = 0, rest = k; d < Dim; ++d, rest /= 3)
          beside[static_cast<std::size_t>(Dim - 1 - d)] += rest % 3 - 1;
        const auto found = blocks.find(beside);
        REQUIRE(block.neighbour[k] == (found == blocks.end() ? -1 : found->second));
      }
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const NodeIndex<Dim> node = tiling_.node(block, local);
        std::array<int, Dim> at;
        for (std::size_t d = 0; d < Dim; ++d) {
          at[d] = node[static_cast<int>(d)];
          REQUIRE(at[d] == block.first_node[static_cast<int>(d)] + (d == 0   ? local % 4
                                                                    : d == 1 ? local / 4 % 4
                                                                             : local / 16));
        }
        for (int field = 0; field < 4; ++field) REQUIRE(tiling_.slot(node, field) == slot_of(at, field));
      }
    }
  }

  struct Seen {
    Record<Dim> first;
    const SideMap<Dim>* second;
  };
  const Tiling<Dim>& tiling_;
  Particles<Dim>& particles_;
  std::vector<Record<Dim>> sorted_;
  std::vector<int> first_side_;
  std::map<std::pair<int, int>, SideMap<Dim>> maps_;
  std::vector<Seen> seen_;
  std::map<std::pair<TileIndex, int>, int> number_;
};

/// Keeps what is written to it in memory.
class Memory : public Archive {
 public:
  bool reads = false;
  std::map<std::string, std::vector<unsigned char>> content;
  std::map<std::string, std::size_t> sizes;

  bool reading() const override { return reads; }

 protected:
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    const std::size_t bytes = n * (kind == NumberKind::whole64 ? 8 : kind == NumberKind::signed32 ? 4 : 1);
    if (reads) {
      REQUIRE(content[name].size() == bytes);
      if (bytes > 0) std::memcpy(values, content[name].data(), bytes);
    } else {
      const auto* const from = static_cast<const unsigned char*>(values);
      content[name].assign(from, from + bytes);
      sizes[name] = n;
    }
  }
  std::size_t length(const std::string& name) override { return sizes[name]; }
};

template <int Dim>
void check_sorts(int seed, bool cracked) {
  CAPTURE(seed);
  Draw draw(static_cast<std::uint64_t>(seed));
  const bool surfaces = seed % 2 == 0;
  std::array<int, 3> nodes{};
  for (std::size_t d = 0; d < Dim; ++d) nodes[d] = whole(draw, 5, Dim == 2 ? 26 : 14);
  const std::vector<int> body_field{0, whole(draw, 0, 1), 1};
  // Of field 1, whose sides are fields 2 to 4.
  const std::vector<int> first_side = cracked ? std::vector<int>{-1, 2, -1, -1, -1} : std::vector<int>{};
  Tiling<Dim> tiling;
  Particles<Dim> particles;
  tiling.set_domain(nodes);
  if (surfaces) tiling.part_surfaces();
  if (cracked) tiling.set_sides(first_side);
  tiling.follow_moves();
  std::size_t n = static_cast<std::size_t>(whole(draw, 40, 200));
  particles.allocate(n, {Quantity::position, Quantity::mass});
  std::vector<Record<Dim>> records(n);
  std::array<int, Dim> corner;
  for (std::size_t d = 0; d < Dim; ++d) corner[d] = whole(draw, -3, nodes[d] - 3);
  for (std::size_t p = 0; p < n; ++p) {
    Record<Dim>& r = records[p];
    r.id = static_cast<std::uint32_t>(p + 7);
    r.body = whole(draw, 0, 2);
    r.field = body_field[static_cast<std::size_t>(r.body)];
    r.on_surface = surfaces && whole(draw, 0, 2) == 0;
    particles.id()[p] = r.id;
    particles.body()[p] = static_cast<std::uint16_t>(r.body);
    for (int d = 0; d < Dim; ++d) particles.column(Quantity::position, d)[p] = 10.0 * r.id + d;
    // Half of them together, the others anywhere.
    for (std::size_t d = 0; d < Dim; ++d)
      r.begin[d] =
          p % 2 ? std::min(nodes[d] + 2, corner[d] + whole(draw, 0, 5)) : whole(draw, -3, nodes[d] + 2);
  }
  for (int round = 0; round < 4; ++round) {
    CAPTURE(round);
    for (auto& r : records) {
      r.group = 0;
      if (round > 0 && whole(draw, 0, 3) == 0)
        for (std::size_t d = 0; d < Dim; ++d)
          r.begin[d] = std::clamp(r.begin[d] + whole(draw, -2, 2), -3, nodes[d] + 2);
    }
    tiling.start_keys(n, body_field);
    for (std::size_t p = 0; p < n; ++p) {
      NodeIndex<Dim> begin;
      for (std::size_t d = 0; d < Dim; ++d) begin[static_cast<int>(d)] = records[p].begin[d];
      tiling.set_key(p, begin, records[p].field, records[p].body, records[p].on_surface);
    }
    const auto before = records;
    const auto sort = [&](auto build) {
      const auto old = records;
      std::stable_sort(records.begin(), records.end(),
                       [](const auto& a, const auto& b) { return a.order() < b.order(); });
      build();
      for (std::size_t p = 0; p < n; ++p)
        REQUIRE(records[tiling.moved(static_cast<std::uint32_t>(p))].id == old[p].id);
    };
    sort([&] { tiling.build(particles, body_field); });
    Checked<Dim>(tiling, particles, records, first_side, {});
    std::map<std::pair<int, int>, SideMap<Dim>> maps;
    if (cracked) {
      // Some places of field 1 get groups, in the order of a hash; every tile is one place yet.
      tiling.start_groups();
      std::vector<std::size_t> order(tiling.tiles.size());
      for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
      std::shuffle(order.begin(), order.end(), draw);
      for (const std::size_t t : order) {
        const auto tile = tiling.tiles[t];
        if (tile.field != 1 || whole(draw, 0, 2) == 0) continue;
        std::vector<SideMap<Dim>> of_groups(static_cast<std::size_t>(whole(draw, 1, 3)));
        const std::uint32_t begin = tiling.runs[static_cast<std::size_t>(tile.run_begin)].begin,
                            end = tiling.runs[static_cast<std::size_t>(tile.run_end - 1)].end;
        for (std::size_t g = 0; g < of_groups.size(); ++g) {
          for (auto& side : of_groups[g].side)
            side = static_cast<std::int8_t>(whole(draw, 0, 9) == 0 ? whole(draw, 1, 3) : 0);
          maps[{static_cast<int>(t), static_cast<int>(g) + 1}] = of_groups[g];
        }
        tiling.set_groups(tile, of_groups);
        for (std::uint32_t p = begin; p < end; ++p) {
          records[p].group = whole(draw, 0, static_cast<int>(of_groups.size()));
          tiling.set_group(p, records[p].group);
        }
      }
      sort([&] { tiling.regroup(particles, body_field); });
      Checked<Dim>(tiling, particles, records, first_side, maps);
    }
    // What is written gives the same tables to another that knows the scene.
    Memory memory;
    tiling.visit(memory, particles, body_field);
    memory.reads = true;
    const auto another = [&] {
      Tiling<Dim> out;
      out.set_domain(nodes);
      if (surfaces) out.part_surfaces();
      if (cracked) out.set_sides(first_side);
      return out;
    };
    Tiling<Dim> again = another();
    again.visit(memory, particles, body_field);
    Checked<Dim>(again, particles, records, first_side, maps);
    const auto refused = [&](const std::string& name, std::size_t at, std::uint64_t value,
                             std::size_t bytes) {
      Memory wrong = memory;
      std::memcpy(wrong.content[name].data() + at * bytes, &value, bytes);
      Tiling<Dim> other = another();
      CHECK_THROWS_AS(other.visit(wrong, particles, body_field), FileError);
    };
    if (round == 0) {
      refused("tiling/keys", n - 1, ~std::uint64_t{0} / 2, 8);
      refused("tiling/keys", 0, ~std::uint64_t{0} / 2, 8);
      refused("tiling/bodies", 0, 7, 4);
      if (!maps.empty()) {
        refused("tiling/sides", 5, 4, 1);
        refused("tiling/sides", 5, 255, 1);
        refused("tiling/mapped", 0, ~std::uint64_t{0} / 2, 8);
      }
    }
    // Some leave.
    std::vector<Record<Dim>> stay;
    std::vector<std::size_t> asked;
    tiling.take_out(particles, [&](std::size_t p) {
      asked.push_back(p);
      const bool leaves = records[p].id % 5 == static_cast<std::uint32_t>(round);
      if (!leaves) stay.push_back(records[p]);
      return leaves;
    });
    REQUIRE(asked.size() == n);
    for (std::size_t p = 0; p < n; ++p) REQUIRE(asked[p] == p);
    records = stay;
    n = records.size();
    REQUIRE(particles.size() == n);
    for (std::size_t p = 0; p < n; ++p) {
      REQUIRE(particles.id()[p] == records[p].id);
      REQUIRE(particles.body()[p] == records[p].body);
      REQUIRE(particles.column(Quantity::position, Dim - 1)[p] == 10.0 * records[p].id + Dim - 1);
    }
  }
}

TEST_CASE("particles are sorted by row, field, tile, group, body and cell, and all tables follow from that") {
  for (int seed = 0; seed < 6; ++seed) check_sorts<2>(seed, seed % 3 == 2);
  for (int seed = 6; seed < 10; ++seed) check_sorts<3>(seed, seed % 3 == 2);
}

TEST_CASE("what was thrown far from the domain is sorted to its rim") {
  Tiling<2> tiling;
  Particles<2> particles;
  tiling.set_domain({9, 13, 0});  // tiles −2 … 4 and −2 … 5
  const std::vector<int> body_field{0};
  particles.allocate(4, {Quantity::position});
  tiling.start_keys(4, body_field);
  const int far[4][2] = {{-900, 1}, {900, 1}, {1, -900}, {1, 900}};
  for (std::uint32_t p = 0; p < 4; ++p) {
    particles.id()[p] = p;
    particles.body()[p] = 0;
    tiling.set_key(p, NodeIndex<2>(far[p][0], far[p][1]), 0, 0, false);
  }
  tiling.build(particles, body_field);
  REQUIRE(tiling.tiles.size() == 4);
  std::set<std::pair<int, int>> windows;
  for (const auto& tile : tiling.tiles) windows.insert({tile.window[0], tile.window[1]});
  CHECK(windows == std::set<std::pair<int, int>>{{-8, 0}, {16, 0}, {0, -8}, {0, 20}});
}

TEST_CASE("a column lies on a line of the cache, holds what was in it, and tells the memory it was given") {
  Draw draw(61);
  for (int round = 0; round < 60; ++round) {
    Column<double> column;
    std::vector<double> wanted;
    std::size_t capacity = 0, used = 0;
    CHECK(column.bytes() == 0);
    for (int k = 0; k < 12; ++k) {
      const auto n = static_cast<std::size_t>(whole(draw, 0, k % 3 == 0 ? 3000 : 300));
      const bool keep = whole(draw, 0, 1) == 1;
      const auto least_capacity = static_cast<std::size_t>(whole(draw, 0, 400));
      if (keep)
        column.grow(n);
      else
        column.resize_discard(n, least_capacity);
      if (n + 64 > capacity) {  // whole lines of eight, a quarter more where it grows
        const std::size_t asked = (keep ? n + n / 4 : std::max(n, least_capacity)) + 64;
        capacity = (asked + 7) / 8 * 8;
        used = 0;
        if (!keep) wanted.assign(n, 0);
      }
      used = std::max(used, n + 64);
      CHECK(column.size() == n);
      CHECK(column.bytes() == std::min(8 * capacity, (8 * used + 4095) / 4096 * 4096));
      CHECK(reinterpret_cast<std::uintptr_t>(column.data()) % 64 == 0);
      for (std::size_t i = 0; i < std::min(n, wanted.size()); ++i) REQUIRE(column[i] == wanted[i]);
      wanted.resize(n);
      for (std::size_t i = 0; i < n; ++i) column[i] = wanted[i] = static_cast<double>(i + 1) / (k + 1);
    }
  }
  Column<std::uint16_t> fresh;
  fresh.resize_discard(100);
  for (std::size_t i = 0; i < 164; ++i) REQUIRE(fresh.data()[i] == 0);
  // Where it has more than four mebibytes the system gives it two at a time.
  Column<double> large;
  large.resize_discard(100, std::size_t{1} << 20);
  CHECK(large.bytes() == std::size_t{1} << 21);
  CHECK(reinterpret_cast<std::uintptr_t>(large.data()) % (std::size_t{1} << 21) == 0);
}

TEST_CASE("what a sort works with counts as the memory that it holds") {
  SortBuffers buffers;
  CHECK(buffers.bytes() == 0);
  buffers.key.reserve(1000);
  buffers.spare.reserve(200);
  buffers.order.reserve(30);
  buffers.order_spare.reserve(7);
  buffers.next.reserve(2);
  buffers.ranges.reserve(5);
  CHECK(buffers.bytes() == 8 * 1200 + 4 * 37 + 2 * 4 * 2048 + 5 * 8);
}

TEST_CASE("the tables of quantities list each at its place, with as many columns as it has components") {
  using Row = std::pair<std::string_view, std::array<int, 2>>;
  const std::vector<Row> particle{{"position", {2, 3}},
                                  {"velocity", {2, 3}},
                                  {"deformation_gradient", {4, 9}},
                                  {"kirchhoff_stress", {4, 6}},
                                  {"mass", {1, 1}},
                                  {"initial_volume", {1, 1}},
                                  {"wave_speed", {1, 1}},
                                  {"domain_edges", {4, 9}},
                                  {"reference_position", {2, 3}},
                                  {"velocity_slopes", {4, 9}},
                                  {"dissipated_energy", {1, 1}},
                                  {"internal_energy", {1, 1}},
                                  {"plastic_strain", {1, 1}},
                                  {"temperature", {1, 1}},
                                  {"elastic_strain", {4, 6}},
                                  {"out_of_plane_stretch", {1, 1}},
                                  {"initial_deformation", {4, 9}},
                                  {"temperature_slope", {2, 3}},
                                  {"thermal_stretch", {1, 1}},
                                  {"volume_ratio", {1, 1}},
                                  {"domain_share", {2, 3}}};
  REQUIRE(particle.size() == kQuantities);
  for (std::size_t k = 0; k < particle.size(); ++k) {
    const auto& info = kQuantityTable[k];
    CAPTURE(info.name);
    CHECK(info.quantity == static_cast<Quantity>(k));
    CHECK(info.name == particle[k].first);
    CHECK(Particles<2>::components(info.quantity) == particle[k].second[0]);
    CHECK(Particles<3>::components(info.quantity) == particle[k].second[1]);
    CHECK(info.extensive == (info.name == "mass" || info.name == "initial_volume"));
  }
  const auto node = [](auto dim, Nodal q) {
    constexpr int Dim = decltype(dim)::value;
    const std::string_view name = kNodalTable[static_cast<std::size_t>(q)].name;
    if (name == "star" || name == "next") return 2 * Dim;
    if (name == "mass_slope") return Dim * Dim;
    const bool vector = name == "momentum" || name == "force" || name == "velocity" || name == "series" ||
                        name == "re_extrapolated" || name == "volume_gradient" || name == "mass_position" ||
                        name == "mass_displacement" || name == "mass_offset" || name == "heat_slope" ||
                        name == "conducting_surface";
    return vector ? Dim : 1;
  };
  std::vector<Nodal> all;
  for (int k = 0; k < kNodalQuantities; ++k) {
    const auto q = static_cast<Nodal>(k);
    all.push_back(q);
    CHECK(kNodalTable[static_cast<std::size_t>(k)].quantity == q);
    CHECK(Nodes<2>::components(q) == node(std::integral_constant<int, 2>(), q));
    CHECK(Nodes<3>::components(q) == node(std::integral_constant<int, 3>(), q));
  }
  for (const bool paired : {true, false}) {
    Nodes<3> nodes;
    nodes.plan(all, paired);
    nodes.resize(40);
    CHECK(nodes.size() == 40);
    std::size_t columns = 0;
    for (const Nodal q : all) {
      const int width = !paired && (q == Nodal::star || q == Nodal::next) ? 3 : Nodes<3>::components(q);
      CHECK(nodes.width(q) == width);
      columns += static_cast<std::size_t>(width);
    }
    CHECK(nodes.bytes() == columns * (40 + 10 + 64 + 6) * 8);  // a quarter more, in lines of eight
    nodes.set(Nodal::force, 7, Vec<3>(1, 2, 3));
    CHECK(nodes.vector(Nodal::force, 7) == Vec<3>(1, 2, 3));
    for (int d = 0; d < 3; ++d) CHECK(nodes.column(Nodal::force, d)[7] == d + 1);
    const auto view = nodes.columns(Nodal::force);
    for (int d = 0; d < 3; ++d) CHECK(view.column[d] == nodes.column(Nodal::force, d));
  }
  Nodes<2> few;
  few.plan({Nodal::mass}, false);
  CHECK(few.has(Nodal::mass));
  CHECK(!few.has(Nodal::force));
  CHECK(few.width(Nodal::force) == 0);
  CHECK(few.columns(Nodal::force).column[1] == nullptr);
}

template <int Dim>
void check_particles() {
  std::vector<Quantity> all;
  std::size_t columns = 0;
  for (const auto& info : kQuantityTable) {
    all.push_back(info.quantity);
    columns += static_cast<std::size_t>(Particles<Dim>::components(info.quantity));
  }
  State<Dim> state;
  auto& particles = state.particles;
  particles.allocate(30, all);
  CHECK(particles.next_id() == 30);
  CHECK(particles.planned_bytes() == 30 * (8 * columns + 6));
  // In lines of 64 bytes: 94 numbers of 8, 4 and 2 bytes.
  CHECK(particles.bytes() == columns * 768 + 384 + 192);
  double next = 1;
  for (const Quantity q : all)
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      for (std::size_t p = 0; p < 30; ++p) particles.column(q, k)[p] = next += 1;
  const auto before = next;
  particles.grow(33);
  CHECK(particles.size() == 33);
  next = 1;
  for (const Quantity q : all)
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      for (std::size_t p = 0; p < 30; ++p) REQUIRE(particles.column(q, k)[p] == (next += 1));
  CHECK(next == before);
  particles.keep_first(40);
  CHECK(particles.size() == 33);
  particles.keep_first(20);
  CHECK(particles.size() == 20);
  CHECK(particles.next_id() == 30);

  state.plane_kind = PlaneKind::axisymmetric;
  const ParticleView<Dim> view = state.view();
  CHECK(view.plane_kind == PlaneKind::axisymmetric);
  std::set<const double*> seen;
  const auto are = [&](const double* const* got, Quantity q) {
    for (int k = 0; k < Particles<Dim>::components(q); ++k) {
      CHECK(got[k] == particles.column(q, k));
      seen.insert(got[k]);
    }
  };
  const auto is = [&](const double* got, Quantity q) { are(&got, q); };
  are(view.position, Quantity::position);
  are(view.velocity, Quantity::velocity);
  are(view.deformation, Quantity::deformation_gradient);
  are(view.stress, Quantity::kirchhoff_stress);
  are(view.edges, Quantity::domain_edges);
  are(view.reference_position, Quantity::reference_position);
  are(view.initial_deformation, Quantity::initial_deformation);
  are(view.domain_share, Quantity::domain_share);
  are(view.slopes, Quantity::velocity_slopes);
  are(view.temperature_slope, Quantity::temperature_slope);
  are(view.state.elastic_strain, Quantity::elastic_strain);
  is(view.mass, Quantity::mass);
  is(view.volume, Quantity::initial_volume);
  is(view.wave_speed, Quantity::wave_speed);
  is(view.stretch, Quantity::out_of_plane_stretch);
  is(view.state.thermal_stretch, Quantity::thermal_stretch);
  is(view.state.dissipated, Quantity::dissipated_energy);
  is(view.state.internal_energy, Quantity::internal_energy);
  is(view.state.plastic_strain, Quantity::plastic_strain);
  is(view.state.temperature, Quantity::temperature);
  is(view.state.volume_ratio, Quantity::volume_ratio);
  CHECK(seen.size() == columns);

  for (std::size_t p = 0; p < 20; ++p) {
    const auto f = particles.deformation_gradient(p);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        REQUIRE(f(i, j) == particles.column(Quantity::deformation_gradient, Dim * i + j)[p]);
    for (int k = 0; k < Dim; ++k) {
      REQUIRE(particles.domain_share(p, k) == particles.column(Quantity::domain_share, k)[p]);
      REQUIRE(particles.vector(Quantity::velocity, p)[k] == particles.column(Quantity::velocity, k)[p]);
    }
    REQUIRE(particles.volume_ratio(p) == particles.column(Quantity::volume_ratio)[p]);
  }
  for (const bool stretch : {false, true}) {
    State<Dim> other;
    std::vector<Quantity> quantities{Quantity::deformation_gradient};
    if (stretch) quantities.push_back(Quantity::out_of_plane_stretch);
    other.particles.allocate(2, quantities);
    for (int k = 0; k < Dim * Dim; ++k)
      other.particles.column(Quantity::deformation_gradient, k)[1] = 0.1 * (k + 1) + (k % (Dim + 1) == 0);
    if (stretch) other.particles.column(Quantity::out_of_plane_stretch)[1] = 1.5;
    // 1 + tr A + (sum of minors of A), A of rank two without a determinant.
    const double det =
        Dim == 2 ? 1.1 * 1.4 - 0.2 * 0.3 : 1 + 1.5 + (0.05 - 0.08) + (0.09 - 0.21) + (0.45 - 0.48);
    CHECK(other.particles.volume_ratio(1) == doctest::Approx(stretch ? 1.5 * det : det));
    CHECK(other.particles.domain_share(1, 0) == 1);
    const auto none = other.view();
    CHECK(none.position[0] == nullptr);
    CHECK(none.state.volume_ratio == nullptr);
    CHECK((none.stretch != nullptr) == stretch);
  }
}

TEST_CASE(
    "particles keep what they have while they grow and go, and a view shows each column as what it is") {
  check_particles<2>();
  check_particles<3>();
}

TEST_CASE("the number of a boundary point is told from its id, and of no other particle") {
  Surfaces<2> surfaces;
  CHECK(surfaces.empty());
  CHECK(surfaces.bytes() == 0);
  surfaces.bodies = {{10, 0, 3}, {0, 0, 0}, {30, 3, 2}};
  surfaces.point_body = {0, 0, 0, 2, 2};
  CHECK(!surfaces.empty());
  CHECK(surfaces.points() == 5);
  CHECK(surfaces.number(0, 9) == -1);
  CHECK(surfaces.number(0, 10) == 0);
  CHECK(surfaces.number(0, 12) == 2);
  CHECK(surfaces.number(1, 12) == -1);
  CHECK(surfaces.number(2, 31) == 4);
  CHECK(surfaces.holds(2, 30));
  CHECK(!surfaces.holds(2, 29));
  surfaces.cone_facets.reserve(100);
  CHECK(surfaces.bytes() >= 400 + 5 * sizeof(int) + 3 * sizeof(Surfaces<2>::Body));
  CHECK(bytes_in(surfaces.point_body, surfaces.cone_facets) == 5 * sizeof(int));
}

}  // namespace
}  // namespace mpmfast
