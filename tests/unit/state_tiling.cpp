// Memory follows the particles, and every particle is where the tables say.

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/step/tile_loops.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// 20 columns of material side by side over a grid of 200 × 40 cells.
Scene columns(const char* contact) {
  std::string yaml = R"(
space: plane_strain
grid: {size: [200 mm, 40 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
)";
  for (int k = 0; k < 20; ++k)
    yaml += fmt::format("  - {{name: c{}, box: {{from: [{} mm, 1 mm], to: [{} mm, 39 mm]}}, material: m}}\n",
                        k, 10 * k, 10 * k + 10);
  return scene_from(yaml, {{"contact", contact}});
}

TEST_CASE("20 fields over one grid take little more nodal memory than one") {
  const Scene one_scene = columns("none"), many_scene = columns("{law: coulomb, friction: 0.1}");
  Step<2> one(one_scene), many(many_scene);
  advance(one, 1);
  advance(many, 1);
  CHECK(many.plan().fields.size() == 20);
  const auto slots_one = one.state().tiling.slots(), slots_many = many.state().tiling.slots();
  // A column is 10 cells wide: its 11 to 12 nodes lie in 3 to 5 tiles of 4 nodes, against 2.5 without a
  // border.
  CHECK(slots_many < 2 * slots_one);
  CHECK(many.state().nodes.bytes() < 2 * one.state().nodes.bytes());
  // Nodes × fields would be nine times as many.
  CHECK(9 * slots_many < 20 * 201 * 41);
}

template <int Dim>
void check_tables(const Step<Dim>& step) {
  const State<Dim>& state = step.state();
  const auto& tiling = state.tiling;
  std::vector<int> seen(state.particles.size(), 0);
  for (const auto& tile : tiling.tiles)
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = tiling.runs[static_cast<std::size_t>(r)];
      CHECK(run.cell_begin[0] == run.begin);
      CHECK(run.cell_begin[kTileNodes<Dim>] == run.end);
      for (std::uint32_t p = run.begin; p < run.end; ++p) {
        ++seen[p];
        REQUIRE(state.particles.body()[p] == run.body);
        for (int d = 0; d < Dim; ++d) {
          const double cells =
              (state.particles.column(Quantity::position, d)[p] - state.grid.origin[d]) / state.grid.cell;
          REQUIRE(cells >= tile.window[d]);
          REQUIRE(cells <= tile.window[d] + kWindowSide - 1);
        }
      }
    }
  for (int n : seen) REQUIRE(n == 1);
  for (std::size_t t = 1; t < tiling.node_tiles.size(); ++t) {
    const auto &a = tiling.node_tiles[t - 1], &b = tiling.node_tiles[t];
    REQUIRE((a.tile_index < b.tile_index || (a.tile_index == b.tile_index && a.field < b.field)));
  }
  // Every tile is in one strip, and no two strips of a colour share a slot.
  std::vector<int> coloured(tiling.tiles.size(), 0);
  for (const auto& colour : tiling.colours) {
    std::vector<int> owner(tiling.node_tiles.size(), -1);
    int number = 0;
    for (const Strip& strip : colour) {
      for (int t = strip.begin; t < strip.end; ++t) {
        ++coloured[static_cast<std::size_t>(t)];
        for (int slot : tiling.tiles[static_cast<std::size_t>(t)].slot) {
          int& of = owner[static_cast<std::size_t>(slot / kTileNodes<Dim>)];
          REQUIRE((of == -1 || of == number));
          of = number;
        }
      }
      ++number;
    }
  }
  for (int n : coloured) REQUIRE(n == 1);
}

TEST_CASE("every particle is in one run, its support in its window, and tiles of a colour share no slot") {
  const Scene flat = columns("{law: coulomb}");
  Step<2> two(flat);
  advance(two, 1);
  check_tables(two);
  const Scene solid = scene_from(R"(
space: 3d
grid: {origin: [-3 mm, -3 mm, -3 mm], size: [14 mm, 14 mm, 14 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, sphere: {centre: [1 mm, 1 mm, 1 mm], radius: 3 mm}, material: m}
  - {name: b, sphere: {centre: [6 mm, 6 mm, 6 mm], radius: 3 mm}, material: m}
)");
  Step<3> three(solid);
  advance(three, 1);
  check_tables(three);
}

/// Of one particle a cell, with two bodies that hang over the origin.
/// @param several  some strips are of several rows
template <int Dim>
void check_many(const char* space, const char* grid, const char* from, const char* to, const char* next,
                const char* contact, bool several) {
  const Scene scene = scene_from(fmt::format(R"(
space: {}
grid: {{{}, cell: 1 mm}}
time: {{end: 1 s}}
materials: {{m: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
bodies:
  - {{name: a, box: {{from: {}, to: {}}}, material: m, particles_per_cell: 1}}
  - {{name: b, box: {{from: {}, to: {}}}, material: m, particles_per_cell: 1}}
)",
                                             space, grid, from, to, to, next),
                                 {{"contact", contact}});
  Step<Dim> step(scene);
  advance(step, 1);
  check_tables(step);
  // Strips of whole rows.
  const auto& tiling = step.state().tiling;
  int rows = 0;
  for (std::size_t colour = 0; colour < tiling.colours.size(); ++colour)
    for (const Strip& strip : tiling.colours[colour]) {
      CHECK(colour % 2 == 0);
      const auto &first = tiling.tiles[static_cast<std::size_t>(strip.begin)],
                 &last = tiling.tiles[static_cast<std::size_t>(strip.end - 1)];
      rows = std::max(rows, (last.window[1] - first.window[1]) / kTileSide + 1);
    }
  CHECK((rows > 1) == several);
}

/// The longest strip, in tiles, and how many colours there are.
template <int Dim>
std::pair<int, int> strips_of(const Step<Dim>& step) {
  int longest = 0, colours = 0;
  for (const auto& colour : step.state().tiling.colours) {
    colours += !colour.empty();
    for (const Strip& strip : colour) longest = std::max(longest, strip.end - strip.begin);
  }
  return {longest, colours};
}

TEST_CASE("rows are strips where they are many, and cut where they are few") {
  const auto bar = [](const char* size) {
    return scene_from(fmt::format(R"(
space: plane_strain
grid: {{origin: [-5 mm, -5 mm], size: [140 mm, 140 mm], cell: 1 mm}}
time: {{end: 1 s}}
materials: {{m: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}}}
bodies: [{{name: a, box: {{from: [0 mm, 0 mm], to: {}}}, material: m, particles_per_cell: 1}}]
)",
                                  size));
  };
  const Scene low = bar("[128 mm, 20 mm]"), high = bar("[128 mm, 128 mm]");
  Step<2> few(low), many(high);
  for (auto* step : {&few, &many}) {
    advance(*step, 1);
    check_tables(*step);
  }
  CHECK(strips_of(few) == std::pair(4, 4));
  CHECK(strips_of(many) == std::pair(32, 2));
}

TEST_CASE("many tiles lie in strips of whole rows, of which those of a colour share no slot") {
  const char* const apart = "{law: coulomb}";
  const auto flat = [](const char* contact, bool several) {
    check_many<2>("plane_strain", "origin: [-10 mm, -10 mm], size: [200 mm, 360 mm]", "[-5 mm, -5 mm]",
                  "[120 mm, 320 mm]", "[130 mm, 340 mm]", contact, several);
  };
  flat("none", true);
  flat(apart, false);  // between the rows of one field are those of the other
  check_many<3>("3d", "origin: [-10 mm, -10 mm, -10 mm], size: [80 mm, 80 mm, 80 mm]",
                "[-5 mm, -5 mm, -5 mm]", "[43 mm, 47 mm, 45 mm]", "[60 mm, 60 mm, 60 mm]", apart, true);
}

/// Two fields whose supports begin at each node from two tiles below the first node of a domain to where they
/// reach two tiles beyond its last.
template <int Dim>
void check_border(const std::array<int, 3>& nodes) {
  constexpr int kLowest = 1 - 2 * kTileSide;
  std::array<std::size_t, 3> count{1, 1, 1};
  for (std::size_t d = 0; d < Dim; ++d)
    count[d] = static_cast<std::size_t>((nodes[d] - 1) / kTileSide * kTileSide + 2 * kTileSide - kLowest + 1);
  const std::size_t n = 2 * count[0] * count[1] * count[2];
  const std::vector<int> field_of_body{0, 1};
  Tiling<Dim> tiling;
  Particles<Dim> particles;
  std::vector<NodeIndex<Dim>> begins(n);
  tiling.set_domain(nodes);
  tiling.start_keys(n, field_of_body);
  particles.allocate(n, {Quantity::position});
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t rest = i / 2;
    for (int d = 0; d < Dim; rest /= count[static_cast<std::size_t>(d++)])
      begins[i][d] = kLowest + static_cast<int>(rest % count[static_cast<std::size_t>(d)]);
    particles.id()[i] = static_cast<std::uint32_t>(i);
    particles.body()[i] = static_cast<std::uint16_t>(i % 2);
    tiling.set_key(i, begins[i], static_cast<int>(i % 2), static_cast<int>(i % 2), false);
  }
  tiling.build(particles, field_of_body);
  std::size_t sorted = 0;
  for (const auto& tile : tiling.tiles) {
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = tiling.runs[static_cast<std::size_t>(r)];
      for (std::uint32_t p = run.begin; p < run.end; ++p, ++sorted) {
        REQUIRE(particles.body()[p] == tile.field);
        for (int d = 0; d < Dim; ++d) {
          const int from = begins[particles.id()[p]][d] - tile.window[d];
          REQUIRE(from >= 1);
          REQUIRE(from <= kTileSide);
        }
      }
    }
    for (int c = 0; c < kCorners<Dim>; ++c) {
      NodeIndex<Dim> node;
      for (int d = 0; d < Dim; ++d) node[d] = tile.window[d] + kTileSide * (c >> d & 1);
      REQUIRE(tiling.slot(node, tile.field) == tile.slot[c]);
    }
  }
  CHECK(sorted == n);
  std::map<std::array<int, 3>, int> at;
  const auto key = [](const NodeIndex<Dim>& node) {
    std::array<int, 3> out{};
    for (int d = 0; d < Dim; ++d) out[static_cast<std::size_t>(d)] = node[d];
    return out;
  };
  for (std::size_t s = 0; s < tiling.node_blocks.size(); ++s) {
    const auto& block = tiling.node_blocks[s];
    REQUIRE(block.end - block.begin == 2);
    at[key(block.first_node)] = static_cast<int>(s);
    for (int t = block.begin; t < block.end; ++t)
      for (int local = 0; local < kTileNodes<Dim>; ++local)
        REQUIRE(
            tiling.slot(tiling.node(block, local), tiling.node_tiles[static_cast<std::size_t>(t)].field) ==
            t * kTileNodes<Dim> + local);
  }
  REQUIRE(at.size() == tiling.node_blocks.size());
  for (const auto& block : tiling.node_blocks)
    for (int k = 0; k < power(3, Dim); ++k) {
      NodeIndex<Dim> beside = block.first_node;
      for (int d = 0, digits = k; d < Dim; ++d, digits /= 3) beside[d] += kTileSide * (digits % 3 - 1);
      const auto found = at.find(key(beside));
      REQUIRE(block.neighbour[k] == (found == at.end() ? -1 : found->second));
    }
  // Beyond are no nodes.
  for (const int outside : {kLowest - 2, 1000})
    CHECK(tiling.slot(NodeIndex<Dim>::Constant(outside), 0) == -1);
}

TEST_CASE("supports up to two tiles beyond a domain have tiles, slots and neighbours of their own") {
  check_border<2>({5, 8, 0});
  check_border<2>({7, 4, 0});
  check_border<2>({9, 6, 0});
  check_border<3>({5, 6, 8});
}

/// Tiles of so many particles, each in a tile of its own or all in one, that lies in the same corner.
template <int Dim>
Tiling<Dim> tiling_of(int particles, bool apart) {
  const std::vector<int> field_of_body{0};
  const auto n = static_cast<std::size_t>(particles);
  Tiling<Dim> tiling;
  Particles<Dim> all;
  tiling.set_domain({8 * kTileSide * particles, 4 * kTileSide, 4 * kTileSide});
  tiling.start_keys(n, field_of_body);
  all.allocate(n, {Quantity::position});
  for (std::size_t i = 0; i < n; ++i) {
    all.id()[i] = static_cast<std::uint32_t>(i);
    all.body()[i] = 0;
    NodeIndex<Dim> begin = NodeIndex<Dim>::Constant(1);
    if (apart || i + 1 == n) begin[0] += 4 * kTileSide * static_cast<int>(i);
    tiling.set_key(i, begin, 0, 0, false);
  }
  tiling.build(all, field_of_body);
  return tiling;
}

template <int Dim>
void check_bytes() {
  constexpr int kParticles = 60;
  const Tiling<Dim> one = tiling_of<Dim>(kParticles, false), many = tiling_of<Dim>(kParticles, true);
  REQUIRE(one.tiles.size() == 2);
  REQUIRE(many.tiles.size() == kParticles);
  // A node tile is listed for each corner of a window; here each is one of its own. The workspace of the sort
  // is that of the particles.
  REQUIRE(many.node_tiles.size() == kCorners<Dim> * many.tiles.size());
  const std::size_t of_tile = sizeof(ParticleTile<Dim>) + sizeof(ParticleRun<Dim>) +
                              kCorners<Dim> * (sizeof(NodeTile<Dim>) + sizeof(NodeBlock<Dim>));
  CHECK(many.bytes() - one.bytes() == (kParticles - 2) * of_tile);
}

TEST_CASE("a tile takes the memory of its own, its run and the nodes at its corners") {
  check_bytes<2>();
  check_bytes<3>();
}

/// Whom each tile is told to be followed by, and whether the sums go on to it, by one thread.
template <int Dim>
int check_followed(const Scene& scene) {
  Step<Dim> step(scene);
  advance(step, 1);
  State<Dim>& state = step.state();
  state.threads = 1;
  TileLoops<Dim> loops(1);
  std::vector<int> seen(state.tiling.tiles.size(), 0);
  const ParticleTile<Dim>* expected = nullptr;
  bool goes_on_to = false;
  int going_on = 0;
  const auto see = [&](const TileContext<Dim>& c) {
    if (expected) REQUIRE(c.tile == expected);
    expected = c.next;
    ++seen[static_cast<std::size_t>(c.tile - state.tiling.tiles.data())];
  };
  loops.for_each_by_colour(state, [&](const TileContext<Dim>& c, int thread, bool rigid) {
    REQUIRE(thread == 0);
    REQUIRE(!rigid);
    see(c);
    REQUIRE(c.goes_on_from == goes_on_to);
    goes_on_to = c.goes_on_to;
    REQUIRE(goes_on_to == (c.next && goes_on<Dim>(*c.tile, *c.next)));
    going_on += goes_on_to;
  });
  CHECK(!expected);
  for (const int times : seen) REQUIRE(times == 1);
  loops.for_each_deformable(state, [&](const TileContext<Dim>& c, int) { see(c); });
  CHECK(!expected);
  for (const int times : seen) REQUIRE(times == 2);
  return going_on;
}

TEST_CASE("a tile is followed by the one that it is told, and sums go on to it where it shares nodes") {
  const Scene bar = scene_from(R"(
space: plane_strain
grid: {origin: [-5 mm, -5 mm], size: [140 mm, 40 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [0 mm, 0 mm], to: [128 mm, 20 mm]}, material: m, particles_per_cell: 1}]
)");
  CHECK(check_followed<2>(bar) > 100);
  check_followed<2>(columns("{law: coulomb}"));
  const Scene solid = scene_from(R"(
space: 3d
grid: {origin: [-5 mm, -5 mm, -5 mm], size: [40 mm, 20 mm, 20 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [0 mm, 0 mm, 0 mm], to: [30 mm, 10 mm, 10 mm]}, material: m, particles_per_cell: 1}]
)");
  CHECK(check_followed<3>(solid) == 0);  // in space each tile has sums of its own
}

TEST_CASE("bodies of different fields that lie in one row of tiles are neighbours among the particles") {
  const Scene scene = columns("{law: coulomb}");
  Step<2> step(scene);
  advance(step, 1);
  const auto& tiles = step.state().tiling.tiles;
  for (std::size_t t = 1; t < tiles.size(); ++t) {
    const auto &a = tiles[t - 1], &b = tiles[t];
    REQUIRE(std::tuple(a.window[1], a.field, a.window[0]) < std::tuple(b.window[1], b.field, b.window[0]));
  }
}

}  // namespace
}  // namespace mpmfast
