// Penalty contact: outlines, boundary points and forces between surfaces.

#include <Eigen/Geometry>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/contact/penalty/penalty.hpp"
#include "engine/geometry/clip.hpp"
#include "engine/geometry/outline.hpp"
#include "engine/scene/text/diagnostic.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

double length_of(const Outline& outline) {
  double sum = 0;
  for (const auto& f : outline.facets) {
    const Vec3 &a = outline.points[static_cast<std::size_t>(f.point[0])],
               &b = outline.points[static_cast<std::size_t>(f.point[1])];
    sum += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return sum;
}

/// Positive where the material lies on the left of all segments.
double area_of(const Outline& outline) {
  double twice = 0;
  for (const auto& f : outline.facets) {
    const Vec3 &a = outline.points[static_cast<std::size_t>(f.point[0])],
               &b = outline.points[static_cast<std::size_t>(f.point[1])];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return 0.5 * twice;
}

int joints(const Outline& outline, Joint joint) {
  int count = 0;
  for (const auto& f : outline.facets) count += f.joint[0] == joint;
  return count;
}

TEST_CASE("outlines of plane shapes close, keep their corners and have the material on the left") {
  const double pi = std::numbers::pi;
  const Outline box = outline(BoxShape{{1, 2, 0}, {4, 4, 0}}, 0.25, 2);
  CHECK(box.points.size() == 40);
  CHECK(length_of(box) == doctest::Approx(10));
  CHECK(area_of(box) == doctest::Approx(6));
  CHECK(box.patches == 4);
  CHECK(joints(box, Joint::convex) == 4);
  CHECK(joints(box, Joint::reentrant) == 0);

  const Outline disk = outline(EllipsoidShape{{0, 0, 0}, {2, 2, 0}, 0}, 0.05, 2);
  CHECK(length_of(disk) == doctest::Approx(4 * pi).epsilon(1e-4));
  CHECK(area_of(disk) == doctest::Approx(4 * pi).epsilon(1e-3));
  CHECK(disk.patches == 1);
  CHECK(joints(disk, Joint::smooth) == static_cast<int>(disk.facets.size()));

  const Outline turned = outline(EllipsoidShape{{1, 1, 0}, {3, 1, 0}, 0.7}, 0.05, 2);
  CHECK(area_of(turned) == doctest::Approx(3 * pi).epsilon(1e-3));
  double shortest = 1e9, longest = 0;
  for (const auto& f : turned.facets) {
    const Vec3 &a = turned.points[static_cast<std::size_t>(f.point[0])],
               &b = turned.points[static_cast<std::size_t>(f.point[1])];
    shortest = std::min(shortest, std::hypot(b[0] - a[0], b[1] - a[1]));
    longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
  }
  CHECK(longest < 1.01 * shortest);

  const Outline ring = outline(RingShape{{0, 0, 0}, 1, 2, 0}, 0.05, 2);
  CHECK(ring.patches == 2);
  CHECK(area_of(ring) == doctest::Approx(3 * pi).epsilon(1e-3));
  CHECK(length_of(ring) == doctest::Approx(6 * pi).epsilon(1e-3));

  // Clockwise, with a corner that is sunk in.
  const Outline angle =
      outline(PolygonShape{{{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}}, 0, 0}, 0.25, 2);
  CHECK(area_of(angle) == doctest::Approx(3));
  CHECK(angle.patches == 6);
  CHECK(joints(angle, Joint::convex) == 5);
  CHECK(joints(angle, Joint::reentrant) == 1);

  // A disk of pixels, beside which another level begins: a line without staircase between the two.
  auto image = std::make_shared<GreyImage>();
  image->width = image->height = 60;
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column)
      image->pixel.push_back(std::hypot(column - 29.5, row - 29.5) < 20 ? 7 : 200);
  const Outline pixels = outline(BitmapShape{"", {0, 0, 0}, {6, 6, 0}, 7, image}, 0.05, 2);
  CHECK(pixels.patches == 1);
  CHECK(area_of(pixels) == doctest::Approx(4 * pi).epsilon(0.01));
  CHECK(length_of(pixels) == doctest::Approx(4 * pi).epsilon(0.01));
  const Outline around = outline(BitmapShape{"", {0, 0, 0}, {6, 6, 0}, 200, image}, 0.05, 2);
  CHECK(area_of(around) == doctest::Approx(36 - 4 * pi).epsilon(0.02));
}

std::string two_bodies(const std::string& a, const std::string& b, const std::string& contact) {
  return R"(
space: plane_strain
grid: {size: [40 mm, 40 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, )" +
         a + ", material: m}\n  - {name: b, " + b + ", material: m}\nmethod: {basis: bspline2}\n" +
         "contact: {family: penalty, points_per_cell: 4, " + contact + "}\n";
}

TEST_CASE(
    "a body that stands out of the grid by round-off has its boundary points at the edge, not by more") {
  const auto left_of = [](const std::string& from) {
    const Scene scene =
        scene_from(two_bodies("box: {from: [" + from + ", 5 mm], to: [10 mm, 15 mm]}",
                              "box: {from: [20 mm, 5 mm], to: [30 mm, 15 mm]}", "friction: 0"));
    const Step<2> step(scene);
    const double* x = step.state().particles.column(Quantity::position, 0);
    return *std::min_element(x, x + step.state().particles.size());
  };
  CHECK(left_of("-0.9e-9 m") == 0);  // cells of 1 mm
  CHECK_THROWS_AS(left_of("-2e-9 m"), SceneError);
}

/// Penalty contact of a scene whose bodies are moved by hand.
struct Moved {
  Scene scene;
  Step<2> step;
  std::unique_ptr<Passes<2>> passes;
  Penalty<2> penalty;

  explicit Moved(const std::string& yaml)
      : scene(scene_from(yaml)),
        step(scene),
        passes(make_passes<2>(scene.method.basis)),
        penalty(scene, step.plan(), step.state()) {}

  /// Places a body at its first position moved by `by`, m, turned by `angle` about its first boundary point.
  void move(int body, const Vec<2>& by, double angle = 0) {
    auto& particles = step.state().particles;
    if (first_.empty())
      for (std::size_t p = 0; p < particles.size(); ++p) {
        first_.resize(std::max(first_.size(), std::size_t{particles.id()[p]} + 1), Vec<2>::Zero());
        first_[particles.id()[p]] = particles.vector(Quantity::position, p);
      }
    const Vec<2> pivot = first_[step.state().surfaces.bodies[static_cast<std::size_t>(body)].first_id];
    Mat<2> turn;
    turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.body()[p] != body) continue;
      const Vec<2> x = pivot + turn * (first_[particles.id()[p]] - pivot) + by;
      for (int d = 0; d < 2; ++d) particles.column(Quantity::position, d)[p] = x[d];
    }
  }

  void advance() {
    auto& state = step.state();
    passes->sort(state);
    penalty.invalidate_tiles();
    REQUIRE(!penalty.find_contacts(state));
    penalty.compute_forces(state, std::vector<Vec<2>>(2, Vec<2>::Zero()), 1e-6);
    ++state.step;
    state.time += 1e-6;
  }

  Vec<2> position(int point) const {
    const auto& state = step.state();
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      if (state.surfaces.number(state.particles.body()[p], state.particles.id()[p]) == point)
        return state.particles.vector(Quantity::position, p);
    return Vec<2>::Zero();
  }
  Vec<2> force_on(int body) const {
    const auto& surface = step.state().surfaces.bodies[static_cast<std::size_t>(body)];
    Vec<2> sum = Vec<2>::Zero();
    for (int p = surface.first; p < surface.first + surface.count; ++p)
      sum += penalty.forces()[static_cast<std::size_t>(p)];
    return sum;
  }

 private:
  std::vector<Vec<2>> first_;
};

TEST_CASE("domains that an outline cuts keep its area and its moments, whatever it looks like") {
  // A wheel with a hole, a needle that crosses cells, a corner in a cell's corner.
  const std::vector<Shape> shapes{RingShape{{2.03, 2.11, 0}, 0.4, 1.3, 0},
                                  EllipsoidShape{{2, 2, 0}, {1.9, 0.13, 0}, 0.4},
                                  PolygonShape{{{1, 1}, {3, 1}, {3, 3}, {2, 1.5}, {1, 3}}, 0, 0}};
  for (const Shape& shape : shapes) {
    const CellLattice grid{{0.5, 0.25, 0}, {4, 4, 0}, 0.25, {2, 3, 1}};
    const Outline around = outline(shape, 0.1, 2);
    Seeds seeds = fill(shape, {}, grid, 2);
    clip(around, grid.origin, seeds);
    double area = 0, x[2] = {0, 0}, least = 1;
    const double domain = 4 * seeds.half_size[0] * seeds.half_size[1];
    for (std::size_t k = 0; k < seeds.position.size(); ++k) {
      area += seeds.share[k] * domain;
      least = std::min(least, seeds.share[k]);
      for (std::size_t d = 0; d < 2; ++d) x[d] += seeds.share[k] * domain * seeds.position[k][d];
    }
    double moment[2] = {0, 0};
    for (const auto& f : around.facets) {
      const Vec3 &a = around.points[static_cast<std::size_t>(f.point[0])],
                 &b = around.points[static_cast<std::size_t>(f.point[1])];
      for (std::size_t d = 0; d < 2; ++d) moment[d] += (a[d] + b[d]) * (a[0] * b[1] - b[0] * a[1]) / 6;
    }
    CHECK(area == doctest::Approx(area_of(around)).epsilon(1e-12));
    CHECK(x[0] == doctest::Approx(moment[0]).epsilon(1e-12));
    CHECK(x[1] == doctest::Approx(moment[1]).epsilon(1e-12));
    if (std::holds_alternative<RingShape>(shape))
      CHECK(least > 0.49);  // wide enough for all to have a neighbour
  }
}

TEST_CASE(
    "a lattice has the mass within its outline, and its boundary points a thousandth of the cells along it") {
  const Scene scene =
      scene_from(two_bodies("disk: {centre: [12 mm, 20 mm], radius: 5 mm}, seeding: lattice",
                            "box: {from: [20 mm, 10 mm], to: [30 mm, 30 mm]}", "law: frictionless"));
  const Step<2> step(scene);
  const auto& state = step.state();
  for (int body : {0, 1}) {
    double mass = 0, on_surface = 0, length = 0;
    for (std::size_t p = 0; p < state.particles.size(); ++p) {
      if (state.particles.body()[p] != body) continue;
      const double m = state.particles.column(Quantity::mass)[p];
      mass += m;
      if (state.surfaces.holds(body, state.particles.id()[p])) on_surface += m;
    }
    for (const auto& facet : state.surfaces.facets)
      if (facet.body == body) length += facet.area;
    const auto b = static_cast<std::size_t>(body);
    const double density = density_of(scene.materials[static_cast<std::size_t>(scene.bodies[b].material)]);
    const double exact =
        area_of(outline(scene.bodies[b].shape, scene.grid.cell / scene.contact.springs.per_cell, 2)) *
        density;
    CHECK(mass == doctest::Approx(exact).epsilon(1e-12));
    CHECK(on_surface == doctest::Approx(1e-3 * length * scene.grid.cell * density).epsilon(1e-12));
  }
}

TEST_CASE("the force between flat surfaces is stiffness times depth") {
  // 6 mm of faces 0.01 mm deep, ω = ρc²/Δh with ρc² = K + 4G/3 = 120 MPa.
  Moved bodies(two_bodies("box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                          "box: {from: [11 mm, 20 mm], to: [17 mm, 26 mm]}", "law: frictionless"));
  bodies.move(1, Vec<2>(0.00013, -1e-5));
  bodies.advance();
  const Vec<2> force = bodies.force_on(1);
  CHECK(force[1] == doctest::Approx(120e6 / 1e-3 * 1e-5 * 6e-3).epsilon(1e-3));
  CHECK(std::abs(force[0]) < 1e-4 * force[1]);
  CHECK((bodies.force_on(0) + force).norm() < 1e-12 * force.norm());
}

/// Checks that Σ f and Σ x × f over all boundary points vanish to round-off.
void check_balanced(const Moved& bodies) {
  const auto& forces = bodies.penalty.forces();
  Vec<2> sum = Vec<2>::Zero();
  double moment = 0, size = 0;
  for (std::size_t p = 0; p < forces.size(); ++p) {
    const Vec<2> x = bodies.position(static_cast<int>(p));
    sum += forces[p];
    moment += x[0] * forces[p][1] - x[1] * forces[p][0];
    size += forces[p].norm();
  }
  REQUIRE(size > 0);
  CHECK(sum.norm() < 1e-13 * size);
  CHECK(std::abs(moment) < 1e-13 * size * 0.04);
}

TEST_CASE("forces and their moments sum to zero, also at corners and with friction") {
  Moved disks(two_bodies("disk: {centre: [14 mm, 20 mm], radius: 5 mm}",
                         "disk: {centre: [24.1 mm, 21 mm], radius: 5 mm}", "friction: 0.4"));
  disks.move(1, Vec<2>(-0.3e-3, 0));
  disks.advance();
  check_balanced(disks);
  disks.move(1, Vec<2>(-0.31e-3, 0.02e-3), 0.003);  // with slip
  disks.advance();
  check_balanced(disks);
  CHECK(disks.penalty.ledger().friction_work > 0);

  Moved corners(two_bodies("box: {from: [10 mm, 10 mm], to: [20 mm, 20 mm]}",
                           "box: {from: [19.6 mm, 19.5 mm], to: [26 mm, 26 mm]}", "law: stick"));
  corners.move(1, Vec<2>(0, 0), 0.1);
  corners.advance();
  corners.move(1, Vec<2>(1e-5, -1e-5), 0.1);
  corners.advance();
  check_balanced(corners);
}

TEST_CASE("a surface that folds onto itself is reported with its body and particle, whichever body it is") {
  for (const int body : {0, 1}) {
    CAPTURE(body);
    Moved disks(two_bodies("disk: {centre: [12 mm, 20 mm], radius: 5 mm}",
                           "disk: {centre: [23 mm, 20 mm], radius: 5 mm}", "law: frictionless"));
    auto& state = disks.step.state();
    auto& particles = state.particles;
    // The point that is nearest to the other body, drawn out to a needle.
    const double sign = body == 0 ? 1 : -1;
    std::size_t tip = particles.size();
    double most = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.body()[p] != body || !state.surfaces.holds(body, particles.id()[p])) continue;
      const double x = sign * particles.column(Quantity::position, 0)[p];
      if (tip < particles.size() && x <= most) continue;
      tip = p;
      most = x;
    }
    REQUIRE(tip < particles.size());
    const std::uint32_t id = particles.id()[tip];
    particles.column(Quantity::position, 0)[tip] += sign * 8e-3;
    disks.passes->sort(state);
    disks.penalty.invalidate_tiles();
    const std::optional<Fold> fold = disks.penalty.find_contacts(state);
    REQUIRE(fold);
    CHECK(fold->body == body);
    CHECK(fold->id == id);
  }
}

TEST_CASE("the ledger gives each of two rigid bodies the forces on its own points") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [40 mm, 40 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, r: {model: rigid}}
bodies:
  - {name: block, box: {from: [5 mm, 5 mm], to: [30 mm, 10.01 mm]}, material: m}
  - {name: left, box: {from: [8 mm, 10 mm], to: [14 mm, 14 mm]}, material: r}
  - {name: right, box: {from: [18 mm, 10 mm], to: [26 mm, 14 mm]}, material: r}
method: {basis: bspline2}
contact: {family: penalty, points_per_cell: 4, law: frictionless}
)");
  Step<2> step(scene);
  auto& state = step.state();
  make_passes<2>(scene.method.basis)->sort(state);
  Penalty<2> penalty(scene, step.plan(), state);
  REQUIRE(!penalty.find_contacts(state));
  const std::vector<Vec<2>> pivots{{0, 0}, {0.011, 0.012}, {0.022, 0.012}};
  const double dt = 1e-6;
  penalty.compute_forces(state, pivots, dt);
  std::vector<Vec<2>> place(state.surfaces.points());
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    if (const int number = state.surfaces.number(state.particles.body()[p], state.particles.id()[p]);
        number >= 0)
      place[static_cast<std::size_t>(number)] = state.particles.vector(Quantity::position, p);
  for (const std::size_t b : {1u, 2u}) {
    CAPTURE(b);
    const auto& own = state.surfaces.bodies[b];
    const auto field = static_cast<std::size_t>(step.plan().body_field[b]);
    Vec<2> force = Vec<2>::Zero();
    double moment = 0;
    for (int p = own.first; p < own.first + own.count; ++p) {
      const auto k = static_cast<std::size_t>(p);
      const Vec<2> arm = place[k] - pivots[field], &push = penalty.forces()[k];
      force += push;
      moment += arm[0] * push[1] - arm[1] * push[0];
    }
    REQUIRE(force[1] > 0);
    REQUIRE(penalty.forces()[static_cast<std::size_t>(own.first)][1] > 0);  // on a corner
    CHECK((penalty.ledger().rigid_impulse[field] - dt * force).norm() < 1e-12 * dt * force.norm());
    CHECK(penalty.ledger().rigid_moment[field][2] ==
          doctest::Approx(dt * moment).epsilon(1e-9).scale(dt * force.norm() * 4e-3));
  }
  CHECK(penalty.ledger().rigid_impulse[0] == Vec<2>::Zero());  // the block is none
}

/// The largest change of the force on b from one position of its path to the next.
template <class Path>
double largest_jump(Moved& bodies, int steps, const Path& path, double& largest) {
  Vec<2> before = Vec<2>::Zero();
  double jump = 0;
  for (int k = 0; k <= steps; ++k) {
    bodies.move(1, path(static_cast<double>(k) / steps));
    bodies.advance();
    const Vec<2> force = bodies.force_on(1);
    largest = std::max(largest, force.norm());
    if (k > 0) jump = std::max(jump, (force - before).norm());
    before = force;
  }
  return jump;
}

TEST_CASE("the force on a body that slides round another never jumps") {
  const std::string small = "disk: {centre: [30 mm, 20 mm], radius: 1.5 mm}";
  std::string gon;
  for (int k = 0; k < 16; ++k) {
    const double angle = 2 * std::numbers::pi * k / 16;
    gon += (k > 0 ? ", [" : "[") + std::to_string(20 + 8 * std::cos(angle)) + " mm, " +
           std::to_string(20 + 8 * std::sin(angle)) + " mm]";
  }
  const auto check = [&](const std::string& shape, const auto& path) {
    Moved bodies(two_bodies(shape, small, "law: frictionless"));
    double largest = 0;
    const double coarse = largest_jump(bodies, 150, path, largest);
    const double fine = largest_jump(bodies, 1200, path, largest);
    CAPTURE(shape);
    REQUIRE(largest > 100);
    CHECK(coarse < 0.5 * largest);
    CHECK(fine < 0.2 * coarse);
  };
  // From a distance, into the flank of a polygon, and round some of its corners.
  check("polygon: [" + gon + "]", [](double s) {
    const double angle = 1.7 * s;
    const Vec<2> centre(0.02 + 0.0091 * std::cos(angle), 0.02 + 0.0091 * std::sin(angle));
    return Vec<2>(centre - Vec<2>(0.03, 0.02));
  });
  // Round the corner of a square: along its side, a quarter of a turn, along the next.
  check("box: {from: [12 mm, 12 mm], to: [28 mm, 28 mm]}", [](double s) {
    const double away = 0.0012, path = 0.008 * (s - 0.5) * 2;
    const double turn = away * std::numbers::pi / 2;
    Vec<2> centre(0.028 + away, 0.028 + path + turn / 2);
    if (path > -turn / 2) {
      const double angle = std::min(1.0, (path + turn / 2) / turn) * std::numbers::pi / 2;
      centre = Vec<2>(0.028 + away * std::cos(angle), 0.028 + away * std::sin(angle));
      if (path > turn / 2) centre[0] -= path - turn / 2;
    }
    return Vec<2>(centre - Vec<2>(0.03, 0.02));
  });
  // Into the corner of an angle, between both flanks.
  check(
      "polygon: [[10 mm, 10 mm], [30 mm, 10 mm], [30 mm, 16 mm], [16 mm, 16 mm], [16 mm, 30 mm], [10 mm, 30 "
      "mm]]",
      [](double s) {
        const Vec<2> centre(0.0173 + 0.006 * std::abs(s - 0.5), 0.0172 + 0.006 * std::max(0.0, 0.5 - s));
        return Vec<2>(centre - Vec<2>(0.03, 0.02));
      });
}

TEST_CASE("the tangential spring stretches with the slip up to the friction cone, and returns elastically") {
  // Moved with 120e9 Pa/m × 1e-5 m × 6 mm = 7.2 N × 1e3 (of a metre's depth); μ = 0.3.
  Moved bodies(two_bodies("box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                          "box: {from: [11 mm, 20 mm], to: [17 mm, 26 mm]}", "friction: 0.3"));
  const auto at = [&](double slip) {
    bodies.move(1, Vec<2>(slip, -1e-5));
    bodies.advance();
    return bodies.force_on(1);
  };
  const double normal = at(0)[1];
  CHECK(at(0)[0] == doctest::Approx(0));
  const double elastic = at(1e-6)[0];
  CHECK(elastic == doctest::Approx(-0.1 * normal).epsilon(2e-3));  // the spring is as stiff as the normal one
  CHECK(at(2e-6)[0] == doctest::Approx(2 * elastic).epsilon(1e-6));
  CHECK(bodies.penalty.ledger().friction_work == 0);
  CHECK(at(8e-6)[0] == doctest::Approx(-0.3 * normal).epsilon(2e-3));
  CHECK(bodies.penalty.ledger().friction_work == doctest::Approx(0.3 * normal * 5e-6).epsilon(3e-3).scale(0));
  CHECK(at(6e-6)[0] == doctest::Approx(-0.1 * normal).epsilon(5e-3));  // back by 2e-6 of the 3e-6 it holds
  CHECK(at(0)[0] == doctest::Approx(0.3 * normal).epsilon(2e-3));
}

TEST_CASE("two disks that collide obliquely keep momentum, angular momentum and energy") {
  std::string yaml = two_bodies("disk: {centre: [14 mm, 19 mm], radius: 4 mm}, velocity: [6 m/s, 0 m/s]",
                                "disk: {centre: [23 mm, 21 mm], radius: 4 mm}, velocity: [-6 m/s, 0 m/s]",
                                "law: frictionless");
  const Scene scene = scene_from(yaml, {{"method.extension", "{occupation: 0.8}"}});
  Step<2> step(scene);
  const auto totals = [&] {
    std::array<double, 4> sum{};
    auto& particles = step.state().particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double m = particles.column(Quantity::mass)[p];
      const Vec<2> x = particles.vector(Quantity::position, p), v = particles.vector(Quantity::velocity, p);
      sum[0] += m * v[0];
      sum[1] += m * v[1];
      sum[2] += m * (x[0] * v[1] - x[1] * v[0]);
      sum[3] += 0.5 * m * v.squaredNorm();
    }
    return sum;
  };
  const auto first = totals();
  while (step.state().time < 6e-4) step.advance(step.stable_dt());
  const auto last = totals();
  const double momentum = 6 * 1000 * std::numbers::pi * 16e-6;
  CHECK(step.penalty().contact_points_peak() > 0);
  CHECK(std::abs(last[0] - first[0]) < 1e-12 * momentum);
  CHECK(std::abs(last[1] - first[1]) < 1e-12 * momentum);
  CHECK(std::abs(last[2] / first[2] - 1) < 0.04);  // measured 0.028; 0.20 with contact on nodes
  CHECK(last[3] + step.stored_energy() == doctest::Approx(first[3]).epsilon(3e-3));
  CHECK(last[3] < 0.97 * first[3]);
  // FLIP leaves the motion of the outline alone that the grid does not see.
  const auto& state = step.state();
  double mass = 0, squares = 0;
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    if (!state.surfaces.holds(state.particles.body()[p], state.particles.id()[p])) continue;
    mass += state.particles.column(Quantity::mass)[p];
    squares += state.particles.column(Quantity::mass)[p] *
               state.particles.vector(Quantity::velocity, p).squaredNorm();
  }
  const double of_all = 2 * last[3] / (2 * 1000 * std::numbers::pi * 16e-6);
  CHECK(squares / mass < 1.2 * of_all);  // measured 0.93; 1.53 where they keep their own velocity
}

TEST_CASE("momentum of boundary points beyond the velocity of the grid goes to the body, once") {
  for (const char* extension : {"none", "{occupation: 0.8}"}) {
    CAPTURE(std::string(extension));
    const Scene scene =
        scene_from(two_bodies("disk: {centre: [12.3 mm, 19 mm], radius: 4 mm}, velocity: [6 m/s, 0 m/s]",
                              "disk: {centre: [28 mm, 21 mm], radius: 4 mm}", "law: frictionless"),
                   {{"method.extension", extension}, {"method.strain", "average"}});
    Step<2> step(scene);
    auto& state = step.state();
    Vec<2> on_surface = Vec<2>::Zero();  // momentum, kg m/s
    const auto sum = [&](Quantity q) {
      Vec<2> out = Vec<2>::Zero();
      for (std::size_t p = 0; p < state.particles.size(); ++p)
        out += state.particles.column(Quantity::mass)[p] * state.particles.vector(q, p);
      return out;
    };
    for (std::size_t p = 0; p < state.particles.size(); ++p) {
      if (state.particles.body()[p] != 0 || !state.surfaces.holds(0, state.particles.id()[p])) continue;
      for (int d = 0; d < 2; ++d) state.particles.column(Quantity::velocity, d)[p] += d == 0 ? 30 : -20;
      on_surface += state.particles.column(Quantity::mass)[p] * Vec<2>(30, -20);
    }
    const Vec<2> momentum = sum(Quantity::velocity), place = sum(Quantity::position);
    const double dt = step.stable_dt(), size = momentum.norm();
    step.advance(dt);
    CHECK((sum(Quantity::velocity) - momentum).norm() < 1e-12 * size);
    // The grid moves all of it by its velocity at the end.
    CHECK((sum(Quantity::position) - place - dt * momentum).norm() < 1e-6 * dt * on_surface.norm());
  }
}

struct Measures {
  double area = 0, volume = 0;  ///< volume: positive where triangles turn counter-clockwise from outside
};

Measures measures_of(const Outline& outline) {
  Measures out;
  for (const auto& f : outline.facets) {
    Vec<3> x[3];
    for (std::size_t k = 0; k < 3; ++k)
      for (int d = 0; d < 3; ++d)
        x[k][d] = outline.points[static_cast<std::size_t>(f.point[k])][static_cast<std::size_t>(d)];
    out.area += 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    out.volume += x[0].dot(x[1].cross(x[2])) / 6;
  }
  return out;
}

/// Each edge belongs to two triangles, which pass it in opposite ways.
bool closes(const Outline& outline) {
  std::map<std::pair<int, int>, int> passed;
  for (const auto& f : outline.facets)
    for (std::size_t k = 0; k < 3; ++k) ++passed[{f.point[k], f.point[(k + 1) % 3]}];
  for (const auto& [edge, times] : passed)
    if (times != 1 || !passed.contains({edge.second, edge.first})) return false;
  return true;
}

TEST_CASE("outlines of solid shapes close, face outwards and keep their creases") {
  const double pi = std::numbers::pi;
  const Outline box = outline(BoxShape{{1, 2, 3}, {3, 3, 4}}, 0.3, 3);
  CHECK(closes(box));
  CHECK(box.patches == 6);
  CHECK(measures_of(box).area == doctest::Approx(10));
  CHECK(measures_of(box).volume == doctest::Approx(2));

  const Outline ball = outline(EllipsoidShape{{1, 0, 0}, {2, 2, 2}, 0}, 0.2, 3);
  CHECK(closes(ball));
  CHECK(ball.patches == 1);
  CHECK(measures_of(ball).area == doctest::Approx(16 * pi).epsilon(5e-3));
  CHECK(measures_of(ball).volume == doctest::Approx(32 * pi / 3).epsilon(5e-3));
  const Outline egg = outline(EllipsoidShape{{0, 0, 0}, {3, 2, 1}, 0.4}, 0.2, 3);
  CHECK(measures_of(egg).volume == doctest::Approx(8 * pi).epsilon(5e-3));

  const Outline tube = outline(RingShape{{0, 0, 1}, 1, 2, 0.5}, 0.1, 3);
  CHECK(closes(tube));
  CHECK(tube.patches == 4);
  CHECK(measures_of(tube).volume == doctest::Approx(3 * pi).epsilon(2e-3));
  const Outline rod = outline(RingShape{{0, 0, 0}, 0, 1, 2}, 0.1, 3);
  CHECK(closes(rod));
  CHECK(rod.patches == 3);
  CHECK(measures_of(rod).volume == doctest::Approx(4 * pi).epsilon(2e-3));

  const Outline angle = outline(PolygonShape{{{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}}, 0, 1}, 0.3, 3);
  CHECK(closes(angle));
  CHECK(angle.patches == 8);
  CHECK(measures_of(angle).volume == doctest::Approx(3));
  int sunk = 0;
  for (const auto& f : angle.facets)
    for (const Joint joint : f.joint) sunk += joint == Joint::reentrant;
  CHECK(sunk > 0);
}

TEST_CASE("spheres that collide obliquely with friction: forces and moments sum to zero") {
  const Scene scene = scene_from(R"(
space: 3d
grid: {size: [16 mm, 16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, sphere: {centre: [5 mm, 6 mm, 7 mm], radius: 3 mm}, material: m, velocity: [20 m/s, 0 m/s, 0 m/s]}
  - {name: b, box: {from: [8.2 mm, 5 mm, 5 mm], to: [12 mm, 12 mm, 11 mm]}, material: m, velocity: [-20 m/s, 8 m/s, 3 m/s]}
contact: {family: penalty, friction: 0.3}
method: {basis: bspline2, extension: {occupation: 0.75}}
)");
  Step<3> step(scene);
  const auto momentum = [&] {
    Vec<3> sum = Vec<3>::Zero();
    const auto& particles = step.state().particles;
    for (std::size_t p = 0; p < particles.size(); ++p)
      sum += particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p);
    return sum;
  };
  const Vec<3> first = momentum();
  int tried = 0;
  for (int k = 0; k < 25; ++k) {
    const auto& state = step.state();
    std::vector<Vec<3>> place(state.surfaces.points());
    for (std::size_t p = 0; p < state.particles.size(); ++p)
      if (const int number = state.surfaces.number(state.particles.body()[p], state.particles.id()[p]);
          number >= 0)
        place[static_cast<std::size_t>(number)] = state.particles.vector(Quantity::position, p);
    step.advance(step.stable_dt());
    Vec<3> sum = Vec<3>::Zero(), moment = Vec<3>::Zero();
    double size = 0;
    const auto& forces = step.penalty().forces();
    for (std::size_t p = 0; p < forces.size(); ++p) {
      sum += forces[p];
      moment += place[p].cross(forces[p]);
      size += forces[p].norm();
    }
    if (size == 0) continue;
    ++tried;
    CHECK(sum.norm() < 1e-12 * size);
    CHECK(moment.norm() < 1e-12 * size * 0.016);
  }
  CHECK(tried > 5);
  CHECK(step.sums().friction_work > 0);
  CHECK((momentum() - first).norm() < 1e-12 * first.norm());
}

TEST_CASE("a moving plate gives a body the momentum and energy in the ledger") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [20 mm, 24 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}, r: {model: rigid}}
bodies:
  - {name: plate, box: {from: [2 mm, 2 mm], to: [18 mm, 5 mm]}, material: r, velocity: [0 m/s, 8 m/s]}
  - {name: disk, disk: {centre: [10 mm, 9.2 mm], radius: 4 mm}, material: m}
method: {basis: bspline2, extension: {occupation: 0.75}}
contact: {family: penalty, law: frictionless, pairs: [{between: [disk, plate], law: frictionless}]}
)");
  Step<2> step(scene);
  while (step.state().time < 3e-4) step.advance(step.stable_dt());
  Vec<2> momentum = Vec<2>::Zero();
  double energy = step.stored_energy();
  const auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body()[p] == 0) continue;
    const Vec<2> v = particles.vector(Quantity::velocity, p);
    momentum += particles.column(Quantity::mass)[p] * v;
    energy += 0.5 * particles.column(Quantity::mass)[p] * v.squaredNorm();
  }
  const auto& sums = step.sums();
  REQUIRE(momentum[1] > 0.1);
  CHECK((sums.pair_impulse[0] - momentum).norm() < 1e-11 * momentum.norm());
  CHECK((sums.rigid_impulse[0] + momentum).norm() < 1e-11 * momentum.norm());
  CHECK(sums.boundary_work == doctest::Approx(8 * momentum[1]).epsilon(5e-3));
  CHECK(energy == doctest::Approx(sums.boundary_work).epsilon(0.01));
  // Between planes of symmetry the plate feels no moment about its middle.
  CHECK(std::abs(sums.rigid_moment[0][2]) < 1e-6 * momentum[1] * 0.01);
}

TEST_CASE("bodies that ignore each other have no surfaces") {
  const Scene scene =
      scene_from(two_bodies("box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                            "box: {from: [11 mm, 20 mm], to: [17 mm, 26 mm]}", "law: ignore"));
  const Step<2> step(scene);
  CHECK(step.state().surfaces.empty());
}

TEST_CASE("penalty contact refuses laws, keys and boundaries that it does not support") {
  const std::string box = "box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                    other = "box: {from: [11 mm, 20 mm], to: [17 mm, 26 mm]}";
  const auto complaint = [](const std::string& yaml, const std::map<std::string, std::string>& sets = {}) {
    std::vector<std::pair<std::string, std::string>> list(sets.begin(), sets.end());
    try {
      scene_from(yaml, {list.begin(), list.end()});
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(complaint(two_bodies(box, other, "law: frictionless")).empty());
  CHECK(complaint(two_bodies(box, other, "law: perfect")).find("only pushes") != std::string::npos);
  CHECK(complaint(two_bodies(box, other, "normal: max_margin")).find("unknown key") != std::string::npos);
  CHECK(complaint(two_bodies(box, other, "law: stick"), {{"grid.leaving", "outflow"}}).find("flow out") !=
        std::string::npos);
}

template <int Dim>
void move_body(State<Dim>& state, int body, const Vec<Dim>& by) {
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    for (int d = 0; d < Dim && state.particles.body()[p] == body; ++d)
      state.particles.column(Quantity::position, d)[p] += by[d];
}

template <int Dim>
const std::vector<Vec<Dim>>& forces_of(Penalty<Dim>& penalty, const State<Dim>& state) {
  REQUIRE(!penalty.find_contacts(state));
  penalty.compute_forces(state, std::vector<Vec<Dim>>(2, Vec<Dim>::Zero()), 1e-6);
  return penalty.forces();
}

TEST_CASE("the force between flat faces in 3-D is stiffness times depth") {
  // 4 x 4 mm of faces 0.01 mm deep, as in two dimensions.
  const Scene scene = scene_from(R"(
space: 3d
grid: {size: [16 mm, 16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [4 mm, 4 mm, 4 mm], to: [12 mm, 12 mm, 7 mm]}, material: m}
  - {name: b, box: {from: [6 mm, 6 mm, 7 mm], to: [10 mm, 10 mm, 10 mm]}, material: m}
contact: {family: penalty, law: frictionless}
method: {basis: bspline2}
)");
  Step<3> step(scene);
  auto& state = step.state();
  move_body<3>(state, 1, Vec<3>(0, 0, -1e-5));
  make_passes<3>(scene.method.basis)->sort(state);
  Penalty<3> penalty(scene, step.plan(), state);
  const auto& forces = forces_of(penalty, state);
  const auto& surface = state.surfaces.bodies[1];
  Vec<3> sum = Vec<3>::Zero();
  for (int p = surface.first; p < surface.first + surface.count; ++p)
    sum += forces[static_cast<std::size_t>(p)];
  CHECK(sum[2] == doctest::Approx(120e6 / 1e-3 * 1e-5 * 16e-6).scale(0).epsilon(0.005));
  CHECK(std::hypot(sum[0], sum[1]) < 1e-3 * sum[2]);
}

/// Moves bodies a and b against each other, and compares forces of old lists and new ones.
template <int Dim>
void check_lists(const std::string& yaml) {
  const Scene scene = scene_from(yaml);
  std::size_t most = 0;
  for (const double way : {-1.0, 1.0})
    for (int along = 0; along < Dim; ++along) {
      CAPTURE(way);
      CAPTURE(along);
      Step<Dim> step(scene);
      auto& state = step.state();
      make_passes<Dim>(scene.method.basis)->sort(state);
      Penalty<Dim> before(scene, step.plan(), state);
      forces_of(before, state);
      // Just within half of the skin, then beyond it.
      for (const double cells : {0.199, 0.8}) {
        const Vec<Dim> by = way * cells * scene.grid.cell * Vec<Dim>::Unit(along);
        move_body<Dim>(state, 0, -by);
        move_body<Dim>(state, 1, by);
        Penalty<Dim> anew(scene, step.plan(), state);
        const auto &old = forces_of(before, state), &now = forces_of(anew, state);
        if (cells < 0.2) most = std::max(most, anew.contact_points());
        CHECK(before.contact_points() == anew.contact_points());
        CHECK(old == now);
      }
    }
  CHECK(most > 4);
}

TEST_CASE("candidate lists hold as long as they are used: forces are those of new lists") {
  check_lists<2>(two_bodies("disk: {centre: [15 mm, 20 mm], radius: 5 mm}",
                            "disk: {centre: [24.7 mm, 19 mm], radius: 5 mm}", "law: frictionless"));
  check_lists<2>(two_bodies("box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                            "box: {from: [11 mm, 19.7 mm], to: [17 mm, 26 mm]}", "law: frictionless"));
  // Apart, so that their clearance lets facets be skipped until they have come near.
  check_lists<2>(two_bodies("disk: {centre: [15 mm, 20 mm], radius: 5 mm}",
                            "disk: {centre: [25.3 mm, 20 mm], radius: 5 mm}", "law: frictionless"));
  check_lists<2>(two_bodies("box: {from: [5 mm, 10 mm], to: [25 mm, 20 mm]}",
                            "box: {from: [11 mm, 20.3 mm], to: [17 mm, 26 mm]}", "law: frictionless"));
  check_lists<3>(R"(
space: 3d
grid: {size: [16 mm, 16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, sphere: {centre: [5 mm, 6 mm, 7 mm], radius: 3 mm}, material: m}
  - {name: b, sphere: {centre: [10.6 mm, 6.5 mm, 6.6 mm], radius: 3 mm}, material: m}
contact: {family: penalty, law: frictionless}
method: {basis: bspline2}
)");
}

}  // namespace
}  // namespace mpmfast
