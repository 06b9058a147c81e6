// Points of the surface: where they are taken, and the impulses that they get.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "engine/contact/surface/point_solver.hpp"
#include "engine/contact/surface/surface_sample.hpp"
#include "engine/plan/plan.hpp"
#include "tests/random.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Square particles of half a cell around a node, those of field a below those of field b.
struct TwoLayers {
  std::vector<double> x, y, gxx, gxy, gyy;
  int below = 0;

  /// @param surface  height of a's surface, cells; b's is `gap` above it and ends at x = `end`
  TwoLayers(double surface, double gap, double end) {
    add(surface - 0.25, -1, 2), below = static_cast<int>(x.size());
    add(surface + gap + 0.25, 1, end);
    for (auto* column : {&x, &y, &gxx, &gxy, &gyy}) column->resize(x.size() + 2 * kLanes, 1.0);
    count = static_cast<int>(x.size()) - 2 * kLanes;
  }
  CloudColumns<2> cloud() const {
    CloudColumns<2> c{};
    c.xi[0] = x.data(), c.xi[1] = y.data();
    c.shape[0] = gxx.data(), c.shape[1] = gxy.data(), c.shape[2] = gyy.data();
    c.count = count;
    return c;
  }
  SurfaceSample<2> sample(bool rigid) const {
    const CloudColumns<2> all = cloud();
    return sample_surface<Extent::radial>(
        SampledPair<2>{all, {0, below}, {below, count}, rigid, {0.0, 1.0}, 0.002});
  }
  int count = 0;

 private:
  void add(double height, int towards, double end) {
    for (int row = 0; row < 2; ++row)
      for (double at = end - 0.25; at > -1.3; at -= 0.5) {
        x.push_back(at), y.push_back(height + 0.5 * row * towards);
        gxx.push_back(16), gxy.push_back(0), gyy.push_back(16);  // radius a quarter of a cell
      }
  }
};

TEST_CASE(
    "a node takes three points of a flat surface, midway in the gap, wherever it lies in its half cells") {
  for (const double surface : {-0.49, -0.2, 0.0, 0.31, 0.44}) {
    const SurfaceSample<2> sample = TwoLayers(surface, 0.1, 2).sample(false);
    REQUIRE(sample.count == (surface + 0.05 < 0.5 ? 3 : 0));
    for (int k = 0; k < sample.count; ++k) {
      const SampledPoint<2>& point = sample.points[static_cast<std::size_t>(k)];
      CHECK(point.offset[0] == doctest::Approx((k - 1) / 3.0));
      CHECK(point.offset[1] == doctest::Approx(surface + 0.05));
      CHECK(point.separation == doctest::Approx(0.1 * 0.002));
    }
  }
  CHECK(TwoLayers(0.6, 0.1, 2).sample(false).count == 0);  // the node above has them
  CHECK(TwoLayers(0.0, 0.7, 2).sample(false).count == 0);  // too far apart
}

TEST_CASE("points end where a rigid body ends, and go on beyond the edge of a deformable one") {
  const TwoLayers layers(0.0, 0.0, 0.1);
  const SurfaceSample<2> rigid = layers.sample(true), deformable = layers.sample(false);
  REQUIRE(rigid.count == 2);
  CHECK(rigid.points[1].offset[0] == doctest::Approx(0));
  CHECK(deformable.count == 3);  // a third of a cell is less than kBeyondEdge from 0.1
}

/// A row of points between two fields of random masses and velocities.
SurfaceList<2> random_points(int count, Random& random) {
  SurfaceList<2> points;
  points.resize(static_cast<std::size_t>(count));
  for (int column = 0; column < count + 1; ++column)
    for (int row = 0; row < 4; ++row) {  // two rows of field a, two of field b
      SurfaceNode<2>& node = points.nodes.emplace_back();
      node.slot = 4 * column + row;
      node.mass = std::exp(3 * random.in(-1, 1));
      node.impulse.setZero(), node.as_force.setZero();
      NodeResponse<2>& response = points.responses.emplace_back();
      response.inverse_mass.setConstant(1 / node.mass);
      response.velocity = {random.in(-1, 1), random.in(-1, 1)};
    }
  for (int p = 0; p < count; ++p) {
    points.geometry[p] = {Vec<2>::Zero(), {0, 1}, 0, 0, 1, PairLaws::kDefault, false, true};
    double inverse = 0;
    for (int side = 0; side < 2; ++side) {
      const double x = random.in(0, 1), y = random.in(0, 1);
      points.stencil[p].weight[side] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
      for (std::size_t c = 0; c < 4; ++c) {
        const int node = 4 * (p + static_cast<int>(c & 1)) + 2 * side + static_cast<int>(c >> 1);
        points.stencil[p].node[side][c] = node;
        inverse += std::pow(points.stencil[p].weight[side][c], 2) / points.nodes[node].mass;
      }
    }
    PointSolve<2>& solve = points.solve[p];
    solve.reduced_mass = 1 / inverse;
    solve.trial.setZero();
    solve.normal = points.geometry[p].normal;
    solve.law = points.geometry[p].law;
    points.before[p] = {}, points.status[p] = {}, points.impulse[p] = {};
    points.status[p].target_approach = random.in(0, 0.3);
  }
  points.blocks[0] = {{0, count}};
  return points;
}

const Scene& two_disks(const char* law) {
  static std::map<std::string, Scene> scenes;
  return scenes
      .try_emplace(law, scene_from(std::string(R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [3 mm, 5 mm], radius: 2 mm}, material: m}
  - {name: b, disk: {centre: [7 mm, 5 mm], radius: 2 mm}, material: m}
contact: {family: surface, law: )") +
                                   law + "}\n"))
      .first->second;
}

/// Solves random points by the second correction. @return the points
SurfaceList<2> solved(const char* law, int count, Random& random) {
  const Scene& scene = two_disks(law);
  const Plan plan = make_plan(scene);
  const PairLaws laws(scene, plan);
  const CorrectionMethod method(scene, plan);
  SurfaceList<2> points = random_points(count, random);
  solve_points<2>({laws, second_rule(method), 1}, points, [](int) {});
  return points;
}

TEST_CASE("impulses at smooth points press only, end the approach, and leave the momentum as it was") {
  Random random(7);
  for (const int count : {1, 2, 3}) {
    const SurfaceList<2> points = solved("frictionless", count, random);
    Vec<2> sum = Vec<2>::Zero();
    for (const SurfaceNode<2>& node : points.nodes) sum += node.impulse;
    CHECK(sum.norm() < 1e-13);
    for (int p = 0; p < count; ++p) {
      const double pressed = -points.impulse[p].now.dot(points.geometry[p].normal);
      const double left = points.relative_velocity(p)[1] + points.status[p].target_approach;
      CHECK(pressed >= 0);
      CHECK(points.impulse[p].now[0] == 0);
      CHECK(left > -1e-3);
      if (pressed > 0) CHECK(std::abs(left) < 1e-3);
    }
  }
}

TEST_CASE("points that stick have no relative velocity but that which closes the gap") {
  Random random(11);
  const SurfaceList<2> points = solved("stick", 4, random);
  int stuck = 0;
  for (int p = 0; p < 4; ++p) {
    if (points.status[p].now != ContactStatus::stick) continue;
    ++stuck;
    CHECK(std::abs(points.relative_velocity(p)[0]) < 1e-2);
  }
  CHECK(stuck > 0);
}

TEST_CASE("friction at points stays in its cone and acts against the slip that is left") {
  Random random(5);
  const SurfaceList<2> points = solved("coulomb, friction: 0.3", 6, random);
  int sliding = 0;
  for (int p = 0; p < 6; ++p) {
    const Vec<2>& impulse = points.impulse[p].now;
    CHECK(std::abs(impulse[0]) <= -0.3 * impulse[1] * (1 + 1e-12));
    if (points.status[p].now != ContactStatus::slip || impulse[1] == 0) continue;
    ++sliding;
    CHECK(std::abs(impulse[0]) == doctest::Approx(-0.3 * impulse[1]));
    CHECK(impulse[0] * points.relative_velocity(p)[0] >= 0);  // Δp_a along v_b − v_a
  }
  CHECK(sliding > 0);
}

}  // namespace
}  // namespace mpmfast
