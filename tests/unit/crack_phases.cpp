// Phases of cracks, each alone: segments, crossings, cracked nodes, sides, motion, growth, the line at a tip.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/cracks/growth.hpp"
#include "engine/cracks/line_motion.hpp"
#include "engine/cracks/tip_line.hpp"
#include "engine/cracks/tip_samples.hpp"
#include "engine/cracks/visibility.hpp"
#include "engine/step/passes.hpp"
#include "tests/random.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

using Points = std::vector<Vec<2>>;

CrackLine<2> line_of(int field, const Points& points) {
  CrackLine<2> line;
  line.field = field;
  line.points = points;
  line.sides = {points, points};
  return line;
}

TEST_CASE("the segments found near a box are those of its field whose boxes overlap it") {
  Random random(7);
  const auto point = [&] { return Vec<2>(random.in(0, 10), random.in(0, 10)); };
  std::vector<CrackLine<2>> lines;
  for (const int field : {0, 1, 0}) {
    Points points{point()};
    for (int k = 0; k < 40; ++k) points.push_back(points.back() + 0.1 * (point() - Vec<2>(5, 5)));
    lines.push_back(line_of(field, points));
  }
  CrackSegments<2> segments;
  segments.build(lines);
  std::size_t all = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec<2> low = point(), high = low + 0.2 * point();
    const int field = trial % 2;
    std::vector<Vec<2>> expected;  // where they start
    for (const auto& line : lines)
      for (std::size_t k = 1; k < line.points.size() && line.field == field; ++k) {
        const Vec<2>&a = line.points[k - 1], &b = line.points[k];
        bool overlaps = true;
        for (int d = 0; d < 2; ++d)
          overlaps &= std::min(a[d], b[d]) <= high[d] && std::max(a[d], b[d]) >= low[d];
        if (overlaps) expected.push_back(a);
      }
    std::vector<const CrackSegment<2>*> found;
    segments.find(field, {low, high}, found);
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      CHECK(found[k]->from == expected[k]);
      const Vec<2> along = found[k]->to - found[k]->from;
      CHECK(along[0] * found[k]->normal[1] - along[1] * found[k]->normal[0] ==
            doctest::Approx(along.norm()).epsilon(1e-12));
    }
    all += found.size();
  }
  CHECK(all > 100);
}

/// A block with a grid of 1 mm cells, and what belongs to its particles after one step.
struct Block {
  Scene scene;
  Step<2> step;
  std::unique_ptr<Passes<2>> passes;
  Supports<2> supports;

  explicit Block(const std::string& crack, const std::string& basis = "linear")
      : scene(scene_from(R"(
space: plane_strain
grid: {size: [24 mm, 24 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {rock: {model: neo_hookean, density: 2.6 g/cm^3, young: 5 GPa, poisson: 0.3}}
bodies: [{name: block, box: {from: [4 mm, 4 mm], to: [20 mm, 20 mm]}, material: rock}]
method: {basis: )" + basis +
                         "}\n" + "cracks: [{body: block, law: frictionless, line: " + crack + "}]\n")),
        step(scene),
        passes(make_passes<2>(step.plan().basis)),
        supports() {
    advance(step, 1);
    supports = passes->supports(step.state());
  }

  std::vector<std::vector<CrackCrossing<2>>> crossings(const std::vector<CrackLine<2>>& lines) {
    CrackSegments<2> segments;
    segments.build(lines);
    CrossingWorkspace<2> workspace;
    std::vector<std::vector<CrackCrossing<2>>> out;
    for (const auto& tile : step.state().tiling.tiles) {
      out.emplace_back();
      find_crossings(step.state(), supports, tile, segments, workspace, out.back());
    }
    return out;
  }
};

/// Crossings to the left less crossings to the right, by the signs of the four triangles.
int signed_crossings(const Points& line, const Vec<2>& from, const Vec<2>& to) {
  const auto area = [](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  int sum = 0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec<2>&a = line[k - 1], &b = line[k];
    if ((area(from, to, a) > 0) == (area(from, to, b) > 0)) continue;
    if ((area(a, b, from) > 0) == (area(a, b, to) > 0)) continue;
    sum += area(a, b, to) > 0 ? 1 : -1;
  }
  return sum;
}

TEST_CASE("crossings are the lines from particles to their nodes that pass a crack in total once") {
  const Points straight{{6.1e-3, 11.137e-3}, {14.3e-3, 12.411e-3}},
      bent{{6.1e-3, 11.137e-3}, {10.02e-3, 11.31e-3}, {11.3e-3, 14.77e-3}},
      folded{{6.1e-3, 11.137e-3}, {14.3e-3, 11.141e-3}, {14.1e-3, 11.647e-3}, {6.2e-3, 11.653e-3}};
  for (const char* basis : {"linear", "bspline3"}) {
    Block block("[[6 mm, 11.1 mm], [14 mm, 12.4 mm]]", basis);
    const State<2>& state = block.step.state();
    for (const Points& points : {straight, bent, folded}) {
      const auto found = block.crossings({line_of(0, points)});
      std::map<std::tuple<std::uint32_t, int, int>, int> by_line;
      for (const auto& of_tile : found)
        for (const auto& one : of_tile) {
          CHECK(one.crack == 0);
          by_line[{one.particle, one.node[0], one.node[1]}] += one.direction;
        }
      std::size_t expected = 0;
      for (std::size_t p = 0; p < state.particles.size(); ++p) {
        const Vec<2> x = state.particles.vector(Quantity::position, p);
        const NodeRange<2> nodes = nodes_ahead(block.supports, p, state.grid.cell);
        for (int k = 0; k < nodes.size(); ++k) {
          const NodeIndex<2> node = nodes.node(k);
          const int sum = signed_crossings(points, x, 1e-3 * node.cast<double>());
          const auto at = by_line.find({static_cast<std::uint32_t>(p), node[0], node[1]});
          REQUIRE((at == by_line.end() ? 0 : at->second) == sum);
          expected += sum != 0;
        }
      }
      CHECK(by_line.size() == expected);
      CHECK(expected > 10);
    }
  }
}

ParticleTile<2> tile_of(int field, int x, int y) {
  ParticleTile<2> tile{};
  tile.field = field;
  tile.window[0] = x;
  tile.window[1] = y;
  return tile;
}

TEST_CASE("a cracked node has its first two cracks by number, the crossings to each side and their normals") {
  const Vec<2> up(0, 1), right(1, 0);
  const NodeIndex<2> node(-3, 5);
  CrackedNodes<2> nodes;
  CHECK(nodes.find(0, node) == nullptr);
  const std::vector<std::vector<CrackCrossing<2>>> crossings{
      {{7, node, 4, 1, up}, {7, node, 2, -1, right}, {8, node, 4, 1, right}, {9, node, 3, 1, up}},
      {{20, NodeIndex<2>(-2, 5), 1, -1, up}}};
  CHECK(nodes.build({tile_of(0, -8, 0), tile_of(1, -8, 0)}, crossings) == 1);
  const CrackedNode<2>* found = nodes.find(0, node);
  REQUIRE(found);
  CHECK(found->crack == std::array{2, 4});
  CHECK(found->crossings == std::array{-1, 2});
  CHECK_FALSE(found->is_left(0));
  CHECK(found->is_left(1));
  CHECK(found->normal[0] == right);
  CHECK(found->normal[1] == up + right);
  CHECK(nodes.find(1, node) == nullptr);
  CHECK(nodes.find(0, NodeIndex<2>(-2, 5)) == nullptr);
  REQUIRE(nodes.find(1, NodeIndex<2>(-2, 5)));
  CHECK(nodes.find(1, NodeIndex<2>(-2, 5))->crack == std::array{1, -1});
  for (const auto& [x, y] : {std::pair{-8, 0}, {-4, 4}, {-4, 0}, {-8, 4}}) {
    CrackedNodes<2>::Window window;
    CHECK(nodes.find_window(tile_of(0, x, y), window));
    for (int w = 0; w < kWindowNodes<2>; ++w) {
      const bool there = x + w % kWindowSide == node[0] && y + w / kWindowSide == node[1];
      CHECK(window[static_cast<std::size_t>(w)] == (there ? found : nullptr));
    }
    CHECK_FALSE(nodes.find_window(tile_of(0, x + 8, y), window));
  }
}

TEST_CASE("one crack lies between two sides that differ in one crack, and none between others") {
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const bool first = (a & 1) != (b & 1), second = (a & 2) != (b & 2);
      CHECK(crack_between(a, b, false) == (first == second ? -1 : first ? 0 : 1));
      CHECK(crack_between(a, b, true) == (first ? 0 : second ? 1 : -1));
    }
}

TEST_CASE(
    "the normal of two sides points from the first to the second, and none is given where a crack folds") {
  CrackedNode<2> node;
  node.crack = {5, 8};
  node.normal = {Vec<2>(0, 2), Vec<2>(-3e-4, 4e-4)};
  for (const int beyond : {0, 2}) {
    const auto left_right = contact_at<2>(&node, 0, beyond, beyond + 1),
               right_left = contact_at<2>(&node, 0, beyond + 1, beyond);
    CHECK(left_right.crack == 5);
    CHECK(left_right.normal == Vec<2>(0, -1));
    CHECK(right_left.normal == Vec<2>(0, 1));
    CHECK(left_right.beyond == (beyond == 2));
    CHECK(right_left.beyond == (beyond == 2));
  }
  CHECK(contact_at<2>(&node, 1, 0, 2).crack == -1);  // the normals cancel
  node.normal[1] = Vec<2>(-3e-3, 4e-3);
  CHECK(contact_at<2>(&node, 1, 0, 2).crack == 8);
  CHECK((contact_at<2>(&node, 1, 0, 2).normal - Vec<2>(0.6, -0.8)).norm() < 1e-12);
  node.crack[1] = -1;
  CHECK(contact_at<2>(&node, 1, 0, 2).crack == -1);
  CHECK(contact_at<2>(nullptr, 0, 0, 1).crack == -1);
}

TEST_CASE("the fields of crack sides follow each other behind those of the bodies") {
  const SideFields fields({-1, 3, 4});
  const std::vector<int> body_field{0, 1, 2, 1, 2, 2, 2};
  CHECK_FALSE(fields.cracked(0));
  CHECK(fields.cracked(1));
  const int sides[] = {0, 0, 0, 1, 1, 2, 3};
  for (int field = 0; field < 7; ++field) CHECK(fields.side(body_field, field) == sides[field]);
  std::vector<int> of_last, of_second;
  fields.for_each(body_field, 2, [&](int field) { of_last.push_back(field); });
  fields.for_each(body_field, 1, [&](int field) { of_second.push_back(field); });
  CHECK(of_last == std::vector{2, 4, 5, 6});
  CHECK(of_second == std::vector{1, 3});
}

TEST_CASE("particles see the side of the crack on which they lie") {
  const Points line{{2e-3, 12.137e-3}, {22e-3, 12.241e-3}};
  Block block("[[2 mm, 12.1 mm], [22 mm, 12.2 mm]]");
  const State<2>& state = block.step.state();
  const auto crossings = block.crossings({line_of(0, line)});
  const auto& tiles = state.tiling.tiles;
  CrackedNodes<2> nodes;
  nodes.build(tiles, crossings);
  const auto is_above = [&](const Vec<2>& x) { return signed_crossings(line, Vec<2>(x[0], 0), x) > 0; };
  std::size_t below = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    std::vector<ParticleSides<2>> seen;
    classify_tile<2>(state, block.supports, nodes, tiles[t], nullptr, crossings[t], seen);
    std::map<std::uint32_t, WindowSides<2>> right;
    for (const auto& one : seen) right[one.particle] = one.right;
    for_each_particle(state.tiling.runs, tiles[t], [&](std::uint32_t p) {
      const bool left = is_above(state.particles.vector(Quantity::position, p));
      const NodeRange<2> reach = nodes_ahead(block.supports, p, state.grid.cell);
      for (int k = 0; k < reach.size(); ++k) {
        const NodeIndex<2> node = reach.node(k);
        if (!nodes.find(0, node)) continue;
        const int w = node[0] - tiles[t].window[0] + kWindowSide * (node[1] - tiles[t].window[1]);
        const auto sides = right.find(p);
        CHECK((sides != right.end() && sides->second[0][static_cast<std::size_t>(w)]) != left);
        below += !left;
      }
    });
  }
  CHECK(below > 100);
}

TEST_CASE("each side of a crack has the velocity of the material on it") {
  const Points points{{2e-3, 12.1e-3}, {22e-3, 12.2e-3}};
  Block block("[[2 mm, 12.1 mm], [22 mm, 12.2 mm]]");
  State<2>& state = block.step.state();
  const Vec<2> above(1, 3), under(-2, -5);
  auto& particles = state.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<2> x = particles.vector(Quantity::position, p);
    const Vec<2>& velocity = signed_crossings(points, Vec<2>(x[0], 0), x) > 0 ? above : under;
    for (int d = 0; d < 2; ++d) particles.column(Quantity::velocity, d)[p] = velocity[d];
  }
  block.step.advance(1e-9);
  block.supports = block.passes->supports(state);
  std::vector<CrackLine<2>> lines{line_of(0, points)};
  lines[0].node_mass = 2600 * 1e-6;
  CrackedNodes<2> nodes;
  nodes.build(state.tiling.tiles, block.crossings(lines));
  const SideFields fields(block.step.plan().first_side);
  for (double x = 5e-3; x < 19e-3; x += 0.7e-3) {
    const Vec<2> at(x, 12.15e-3);
    const auto left = side_velocity(state, nodes, fields, lines[0], 0, 0, at),
               right = side_velocity(state, nodes, fields, lines[0], 0, 1, at);
    REQUIRE(left);
    REQUIRE(right);
    CHECK((*left - above).norm() < 1e-9);
    CHECK((*right - under).norm() < 1e-9);
  }
  CHECK_FALSE(side_velocity(state, nodes, fields, lines[0], 0, 0, Vec<2>(1.5e-3, 12.15e-3)));
}

TEST_CASE("points outside of the body have the velocity of the nearest point inside") {
  SideVelocities<2> side;
  for (int k = 0; k < 8; ++k) side.velocity.push_back(k < 3 || k > 5 ? Vec<2>(0, 0) : Vec<2>(k, -k));
  side.known = {0, 0, 0, 1, 1, 1, 0, 0};
  extend_velocities(side);
  const double expected[] = {3, 3, 3, 3, 4, 5, 5, 5};
  for (std::size_t k = 0; k < 8; ++k) {
    CHECK(side.velocity[k] == Vec<2>(expected[k], -expected[k]));
    CHECK(side.known[k]);
  }
}

constexpr double kCell = 1e-3, kStrength = 1e6;

TEST_CASE("a crack begins to grow at its toughness, by J or by its hoop stress") {
  GrowthSpec spec;
  spec.toughness = 10;
  TipLoad load;
  load.modulus = 50e6;
  for (const double share : {0.99, 1.01}) {
    spec.rule = GrowthRule::energy;
    load.energy_release_rate = share * spec.toughness;
    load.mode_i = 0;
    CHECK(decide_growth(spec, {}, load, kStrength, kCell).grows == (share > 1));
    spec.rule = GrowthRule::hoop_stress;
    load.energy_release_rate = 0;
    load.mode_i = std::sqrt(share * spec.toughness * load.modulus);
    CHECK(decide_growth(spec, {}, load, kStrength, kCell).grows == (share > 1));
    load.mode_i = -load.mode_i;  // closed
    CHECK_FALSE(decide_growth(spec, {}, load, kStrength, kCell).grows);
    // In mode II alone the largest hoop intensity is 2/√3 K_II, at 70.5 degrees.
    load.mode_i = 0;
    load.mode_ii = std::sqrt(3 * share * spec.toughness * load.modulus) / 2;
    const GrowthStep step = decide_growth(spec, {}, load, kStrength, kCell);
    CHECK(step.grows == (share > 1));
    CHECK(step.angle == doctest::Approx(-std::acos(1 / 3.0)).epsilon(1e-9));
    load.mode_ii = 0;
  }
}

TEST_CASE(
    "a crack that grew goes on when its bonded length is four cells, and turns after three straight ones") {
  GrowthSpec spec;
  spec.toughness = 10;
  TipLoad load;
  load.modulus = 50e6;
  load.traction = {kStrength, kStrength};
  CrackEnd end;
  end.grown = 0.5 * kCell;
  for (const double cells : {3.9, 4.1}) {
    load.bonded_length = cells * kCell;
    CHECK(decide_growth(spec, end, load, kStrength, kCell).grows == (cells < 4));
  }
  for (const double cells : {2.5, 3.0}) {
    end.straight = cells * kCell;
    const double angle = decide_growth(spec, end, load, kStrength, kCell).angle;
    CHECK(angle == doctest::Approx(cells < 3 ? 0 : -2 * std::atan(0.5)).epsilon(1e-12));
  }
}

TEST_CASE("an end joins the nearest line of its body, and of its own line only what lies well behind") {
  const std::vector<CrackLine<2>> lines{
      line_of(0, {{0, 0}, {10, 0}, {10, 5}, {0, 5}, {0, 3}, {0, 1.5}, {0, 0.4}}),
      line_of(0, {{-0.2, -3}, {-0.2, 3}}), line_of(1, {{0, -3}, {0, 3}})};
  const auto joined = nearest_on_lines<2>(lines, 0, true, {0, 0.4}, 1);
  REQUIRE(joined);
  CHECK((*joined - Vec<2>(-0.2, 0.4)).norm() < 1e-12);
  const auto own = nearest_on_lines<2>({lines[0], lines[2]}, 0, true, {0, 0.4}, 1);
  REQUIRE(own);
  CHECK(own->norm() < 1e-12);
  CHECK_FALSE(nearest_on_lines<2>(lines, 0, true, {5, 2}, 1));
  CHECK_FALSE(nearest_on_lines<2>({lines[0]}, 0, true, {5, 5.5}, 4));  // 16 behind the end are left out
}

TEST_CASE("the direction of an end spans two cells, or the straight part of the line") {
  const TipLine line{{0, 0}, {-1, 0}, {-2, 0}, {-2, -1}, {-2, -2}};
  CHECK((end_direction(line, 1, HUGE_VAL) - Vec<2>(1, 0)).norm() < 1e-12);
  CHECK((end_direction(line, 1.1, HUGE_VAL) - Vec<2>(2, 1).normalized()).norm() < 1e-12);
  CHECK((end_direction(line, 1.1, 2) - Vec<2>(1, 0)).norm() < 1e-12);
}

TEST_CASE("a line is shortened along its pieces, and the last one is cut within") {
  for (const auto& [length, x, y] :
       {std::tuple{0.0, 0.0, 0.0}, {0.3, -0.3, 0.0}, {1.0, -1.0, 0.0}, {2.6, -2.0, -0.6}}) {
    TipLine line{{0, 0}, {-1, 0}, {-2, 0}, {-2, -1}, {-2, -2}};
    shorten(line, length);
    CHECK((line.front() - Vec<2>(x, y)).norm() < 1e-12);
    CHECK(line.back() == Vec<2>(-2, -2));
  }
}

TipSample sample_of(const Vec<2>& position, double area, const Mat<2>& stress) {
  return {position, area, Vec<2>::Zero(), Mat<2>::Zero(), stress, 0};
}

/// Small squares that fill a rectangle, without stress.
TipSamples fill(double from, double to, double half_width) {
  constexpr double kSide = 0.02;
  TipSamples samples;
  for (double x = from + 0.5 * kSide; x < to; x += kSide)
    for (double y = -half_width + 0.5 * kSide; y < half_width; y += kSide)
      samples.push_back(sample_of({x, y}, kSide * kSide, Mat<2>::Zero()));
  return samples;
}

/// Area of the wedge ahead of a tip up to a distance; its half width is a cell up to two cells, then half the
/// distance.
double wedge(double x) { return x < 2 ? 2 * x : 4 + 0.5 * (x * x - 4); }

TEST_CASE("a body is followed ahead of a tip as far as it fills four fifths of a wedge") {
  for (const double end : {1.0, 2.3, 3.8, 6.0}) {
    CAPTURE(end);
    double expected = 2;
    for (double x = 2.5; x <= 8; x += 0.5)
      if (wedge(end) >= 0.8 * wedge(x)) expected = x;
    CHECK(filled_length(fill(-2, end, 5), 8, 1) == doctest::Approx(expected));
  }
  CHECK(filled_length(fill(-2, 0.7, 5), 8, 1) == 0);  // 0.35 of two cells
  CHECK(filled_length(fill(-2, 9, 5), 8, 1) == 8);
  CHECK(filled_length(fill(-2, 9, 0.3), 8, 1) == 0);
}

TEST_CASE("the traction behind an end is that of the stress in a band of two cells behind and one beside") {
  const Vec<2> direction = Vec<2>(3, 4) / 5, left(-0.8, 0.6), end(7, -2);
  Mat<2> stress;
  stress << 2, 5, 5, -3;
  TipSamples samples;
  for (const auto& [behind, beside] :
       {std::pair{0.1, 0.9}, {1.9, -0.9}, {1.0, 0.0}, {-0.1, 0.0}, {2.1, 0.0}, {1.0, 1.1}, {1.0, -1.1}}) {
    const bool inside = behind > 0 && behind < 2 && std::abs(beside) < 1;
    samples.push_back(sample_of(end - behind * direction + beside * left, 1,
                                inside ? stress : Mat<2>(Mat<2>::Constant(1e3))));
  }
  const Vec<2> found = traction_behind(samples, end, direction, HUGE_VAL, 1);
  CHECK(found[0] == doctest::Approx(direction.dot(stress * left)).epsilon(1e-12));
  CHECK(found[1] == doctest::Approx(left.dot(stress * left)).epsilon(1e-12));
  CHECK(traction_behind(samples, end, direction, 0.05, 1) == Vec<2>(0, 0));
}

}  // namespace
}  // namespace mpmfast
