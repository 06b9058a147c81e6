// Contact nodes, their pairs, and slabs of them, where several bodies meet.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/contact/geometry/fit_slabs.hpp"
#include "engine/contact/geometry/mean_normals.hpp"
#include "engine/contact/pairs/pair_memory.hpp"
#include "engine/run/threads.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A scene of some bodies after a step.
struct Met {
  Scene scene;
  Step<2> step;

  Met(const std::string& bodies, const std::string& contact, const std::string& basis = "bspline2")
      : scene(scene_from(R"(
space: plane_strain
grid: {size: [96 mm, 24 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, tool: {model: rigid}}
bodies:
)" + bodies + "contact: {" +
                         contact + "}\nmethod: {basis: " + basis + "}\n")),
        step(scene) {
    advance(step, 1);
  }

  const ContactList<2>& list() const { return step.contact_list(); }
  /// The number of a field of a node; of a pair's a or b.
  int field(const ContactNode<2>& node, int k) const { return list().fields[node.field_begin + k].field; }
  static int fields(const ContactNode<2>& node) { return node.field_end - node.field_begin; }
  const ContactPair& pair(int e) const { return list().pairs.pair[e]; }
  const PairGeometry<2>& geometry(int e) const { return list().pairs.geometry[e]; }
};

const std::string kFloor =
                      "  - {name: floor, box: {from: [2 mm, 2 mm], to: [14 mm, 6 mm]}, material: tool}\n",
                  kLeft = "  - {name: left, box: {from: [4.3 mm, 6 mm], to: [8 mm, 9 mm]}, material: m}\n",
                  kSliver =
                      "  - {name: sliver, box: {from: [8 mm, 6.1 mm], to: [8.5 mm, 9 mm]}, material: m}\n",
                  kRight = "  - {name: right, box: {from: [8 mm, 6.3 mm], to: [11 mm, 9 mm]}, material: m}\n",
                  kBehind =
                      "  - {name: right, box: {from: [8.5 mm, 6 mm], to: [11 mm, 9 mm]}, material: m}\n";

TEST_CASE("each two of three bodies at a node have the normal and the separation that they have alone") {
  using Place = std::array<int, 2>;
  const std::string method = "fields: simultaneous, normal: linear_regression, separation: ellipsoid";
  for (const std::array<std::string, 3>& order :
       {std::array{kFloor, kLeft, kRight}, {kLeft, kFloor, kRight}, {kLeft, kRight, kFloor}}) {
    CAPTURE(order[0]);
    const Met all(order[0] + order[1] + order[2], method);
    for (int out = 0; out < 3; ++out) {
      CAPTURE(out);
      const int first = out == 0 ? 1 : 0, second = out == 2 ? 1 : 2;
      const Met two(order[static_cast<std::size_t>(first)] + order[static_cast<std::size_t>(second)], method);
      std::map<Place, const PairGeometry<2>*> alone;
      std::map<Place, bool> swapped;
      for (const auto& node : two.list().nodes) {
        const Place at{node.index[0], node.index[1]};
        alone[at] = &two.geometry(node.pair_begin);
        swapped[at] = two.field(node, two.pair(node.pair_begin).a) == 1;
      }
      int seen = 0;
      for (const auto& node : all.list().nodes) {
        const Place at{node.index[0], node.index[1]};
        if (Met::fields(node) < 3 || !alone.contains(at)) continue;
        for (int e = node.pair_begin; e < node.pair_end; ++e) {
          const int a = all.field(node, all.pair(e).a), b = all.field(node, all.pair(e).b);
          if (std::min(a, b) != first || std::max(a, b) != second) continue;
          const double sign = (a == second) == swapped[at] ? 1 : -1;
          CHECK((all.geometry(e).normal - sign * alone[at]->normal).norm() < 1e-9);
          CHECK(std::abs(all.geometry(e).separation - alone[at]->separation) < 1e-9 * 1e-3);
          ++seen;
        }
      }
      CHECK(seen > 3);
    }
  }
}

TEST_CASE("no two pairs of a list have the same name") {
  for (const char* fields : {"lump", "pairs", "simultaneous"})
    for (const std::string& bodies : {kLeft + kSliver + kBehind, kFloor + kLeft + kRight,
                                      kLeft + kFloor + kRight, kLeft + kRight + kFloor}) {
      CAPTURE(std::string(fields));
      CAPTURE(bodies);
      const Met met(bodies, std::string("normal: linear_regression, fields: ") + fields);
      std::set<std::uint64_t> keys;
      std::size_t pairs = 0;
      for (const auto& node : met.list().nodes)
        for (int e = node.pair_begin; e < node.pair_end; ++e, ++pairs)
          keys.insert(pair_key(met.step.state(), met.list(), node, met.pair(e)));
      CHECK(std::any_of(met.list().nodes.begin(), met.list().nodes.end(),
                        [](const auto& node) { return Met::fields(node) == 3; }));
      CHECK(keys.size() == pairs);
    }
}

TEST_CASE("a name tells nodes, fields and partners apart, a rigid first field and a lump too, and cracks") {
  const Met met(kFloor + kLeft + kRight, "normal: linear_regression, fields: simultaneous");
  std::set<std::uint64_t> keys;
  std::size_t names = 0;
  const auto name = [&](const auto& node, const ContactPair& pair) {
    keys.insert(pair_key(met.step.state(), met.list(), node, pair));
    ++names;
  };
  for (const auto& node : met.list().nodes) {
    ContactPair pair{0, 0};
    for (pair.a = 0; pair.a < Met::fields(node); ++pair.a)
      for (pair.b = -1; pair.b < Met::fields(node); ++pair.b)
        if (pair.b != pair.a) name(node, pair);
    for (pair.crack = 0; pair.crack < 3; ++pair.crack)
      for (const bool beyond : {false, true}) {
        pair.beyond = beyond;
        name(node, pair);
      }
  }
  CHECK(names > 50);
  CHECK(keys.size() == names);
}

TEST_CASE("the sides of a crack keep their name, whichever fields they are") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [24 mm, 24 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: block, box: {from: [2 mm, 2 mm], to: [22 mm, 22 mm]}, material: m}]
cracks:
  - {body: block, law: frictionless, line: [[3 mm, 15.1 mm], [21 mm, 15.1 mm]]}
  - {body: block, law: frictionless, line: [[3 mm, 5.1 mm], [21 mm, 5.1 mm]]}
)");
  Step<2> step(scene);
  advance(step, 1);
  const auto& list = step.contact_list();
  ContactList<2> turned = list;
  int seen[2] = {0, 0};
  for (const auto& node : list.nodes) {
    auto &one = turned.fields[node.field_begin], &two = turned.fields[node.field_begin + 1];
    std::swap(one.field, two.field);
    const ContactPair& pair = list.pairs.pair[node.pair_begin];
    REQUIRE(pair.crack >= 0);
    CHECK(pair_key(step.state(), list, node, pair) == pair_key(step.state(), turned, node, pair));
    ++seen[pair.crack];
  }
  CHECK(seen[0] > 10);
  CHECK(seen[1] > 10);
}

/// A unit vector for each two fields, from the lower to the higher.
Vec<2> made_up_normal(int a, int b) {
  const double angle = 1 + std::min(a, b) + 0.3 * std::max(a, b);
  return (a < b ? 1.0 : -1.0) * Vec<2>(std::cos(angle), std::sin(angle));
}

/// The means over the nodes around of normals that are the same wherever two fields meet.
void check_means(const Met& met, bool pairs, int most) {
  const auto& list = met.list();
  std::vector<RawNormal<2>> raw(list.pairs.size());
  const MeanNormals<2> mean(met.step.state(), list, raw, pairs);
  const auto other = [&](const auto& node, const ContactPair& pair) {
    return met.field(node, pair.is_lumped() ? 1 - pair.a : pair.b);
  };
  int fields = 0;
  for (const auto& node : list.nodes) {
    fields = std::max(fields, Met::fields(node));
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = met.pair(e);
      raw[static_cast<std::size_t>(e)] =
          mean.raw(node, pair, made_up_normal(met.field(node, pair.a), other(node, pair)), true, false);
    }
  }
  REQUIRE(fields == most);
  std::vector<Vec<2>> sums;
  for (const auto& node : list.nodes) {
    mean(mean.around(node), node, sums);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = met.pair(e);
      const Vec<2>& sum = sums[static_cast<std::size_t>(e - node.pair_begin)];
      REQUIRE(sum.norm() > 0);
      CHECK((sum.normalized() - made_up_normal(met.field(node, pair.a), other(node, pair))).norm() < 1e-12);
    }
  }
}

TEST_CASE("the mean of the normals around a node is of the same two bodies, and of no others") {
  // A layer so thin that nodes of its one face lie beside those of the other, and none has all three.
  const std::string layers = R"(
  - {name: high, box: {from: [2 mm, 9.5 mm], to: [20 mm, 13 mm]}, material: m}
  - {name: layer, box: {from: [2 mm, 7.5 mm], to: [20 mm, 9.5 mm]}, material: m}
  - {name: low, box: {from: [2 mm, 4 mm], to: [20 mm, 7.5 mm]}, material: m}
)";
  const Met two(layers, "normal: smoothed_max_margin", "linear");
  check_means(two, false, 2);
  for (const std::string& bodies : {kFloor + kLeft + kSliver + kBehind, kLeft + kFloor + kSliver + kBehind,
                                    kLeft + kSliver + kBehind + kFloor}) {
    CAPTURE(bodies);
    check_means(Met(bodies, "fields: simultaneous, normal: smoothed_max_margin"), true, 4);
  }
}

TEST_CASE("slabs hold each node once, and all around a slab's nodes lies in slabs up to its last") {
  const ThreadCount one(1);
  Met met(R"(
  - {name: low, box: {from: [2 mm, 5 mm], to: [94 mm, 7 mm]}, material: m}
  - {name: high, box: {from: [2 mm, 7 mm], to: [94 mm, 9 mm]}, material: m}
)",
          "normal: average_gradient");
  const auto& list = met.list();
  State<2>& state = met.step.state();
  state.threads = 1;
  FitSlabs<2> slabs;
  const auto check = [&](const std::vector<std::uint8_t>& due, bool many) {
    slabs.cut(state, list, due, many);
    REQUIRE((slabs.size() > 1) == many);
    std::vector<std::size_t> slab_of(list.nodes.size(), slabs.size());
    for (std::size_t s = 0; s < slabs.size(); ++s)
      slabs.for_each_node(s, state, list, [&](std::size_t k, const auto&) {
        CHECK(slab_of[k] == slabs.size());
        slab_of[k] = s;
      });
    std::size_t waited = 0;
    for (std::size_t k = 0; k < list.nodes.size(); ++k) {
      const std::size_t s = slab_of[k];
      if (s == slabs.size()) {
        CHECK(!due[k]);
        continue;
      }
      CHECK(slabs.surrounded_by(s) - s < slabs.at_once());
      for (int m = 0; m < 9; ++m) {
        const int beside = contact_neighbour(state.tiling, list, list.nodes[k], m);
        if (beside < 0) continue;
        const std::size_t there = slab_of[static_cast<std::size_t>(beside)];
        if (there == slabs.size()) continue;
        CHECK(there <= slabs.surrounded_by(s));
        CHECK(s <= slabs.surrounded_by(there));
        waited += there > s;
      }
    }
    CHECK((waited > 0) == many);
    return std::count(slab_of.begin(), slab_of.end(), slabs.size());
  };
  std::vector<std::uint8_t> due(list.nodes.size(), 1);
  CHECK(check(due, true) == 0);
  CHECK(check(due, false) == 0);
  // Of every 24th block nothing is to be fitted, of the others one node.
  std::fill(due.begin(), due.end(), 0);
  std::ptrdiff_t left_out = 0;
  for (std::size_t k = 0; k < due.size(); ++k) {
    const int block = list.nodes[k].block;
    left_out += block % 24 == 0;
    due[k] = block % 24 != 0 && (k + 1 == due.size() || list.nodes[k + 1].block != block);
  }
  CHECK(left_out > 0);
  CHECK(check(due, true) == left_out);
}

}  // namespace
}  // namespace mpmfast
