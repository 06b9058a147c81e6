// Phases of penalty contact, each alone: bins, normals, penetration, classification, friction, reactions,
// ledger.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "engine/contact/penalty/candidates.hpp"
#include "engine/contact/penalty/classify.hpp"
#include "engine/contact/penalty/forces.hpp"
#include "engine/contact/penalty/ledger.hpp"
#include "engine/contact/penalty/moment.hpp"
#include "engine/contact/penalty/penetration.hpp"
#include "engine/contact/penalty/vertex_normals.hpp"
#include "engine/plan/surfaces.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace mpmfast::penalty {
namespace {

using test::Draw;
using test::random_direction;
using test::uniform;

/// Surfaces of some shapes, a body each, with the positions of their boundary points.
template <int Dim>
struct Bodies {
  Surfaces<Dim> surfaces;
  std::vector<Vec<Dim>> positions;

  Bodies(const std::vector<Shape>& shapes, double spacing) {
    for (const Shape& shape : shapes) {
      const Outline one = outline(shape, spacing, Dim);
      add_surface(one, 0, 1, surfaces);
      for (const Vec3& x : one.points) {
        positions.emplace_back();
        for (std::size_t d = 0; d < Dim; ++d) positions.back()[static_cast<int>(d)] = x[d];
      }
    }
    connect_facets(surfaces);
  }
  SurfaceGeometry<Dim> geometry() const { return {surfaces, positions}; }
  std::vector<int> all_facets() const {
    std::vector<int> out(surfaces.facets.size());
    std::iota(out.begin(), out.end(), 0);
    return out;
  }
  std::vector<int> all_cones() const {
    std::vector<int> out(surfaces.normal_cones.size());
    std::iota(out.begin(), out.end(), 0);
    return out;
  }
  std::vector<FacetBounds<Dim>> bounds() const {
    std::vector<FacetBounds<Dim>> out(surfaces.facets.size());
    compute_bounds<Dim>(geometry(), all_facets(), 1, out);
    return out;
  }
};

TEST_CASE("bins around a point give each facet within their side once, and those of a bin in order") {
  constexpr double kSide = 0.3;
  Draw draw(5);
  std::vector<FacetBounds<3>> bounds;
  for (int k = 0; k < 400; ++k)
    bounds.push_back(
        {Vec<3>(uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1)), Vec<3>::UnitX(), 0.1, 0});
  std::vector<int> facets;
  for (int k = 0; k < 400; k += 2) facets.push_back(k);
  FacetBins<3> bins;
  bins.fill(facets, bounds, kSide);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec<3> x(uniform(draw, -1.2, 1.2), uniform(draw, -1.2, 1.2), uniform(draw, -1.2, 1.2));
    std::vector<int> found;
    const BinnedFacet<3>* last = nullptr;
    bins.for_each_around(bins.bin_of(x), [&](const BinnedFacet<3>& one) {
      found.push_back(one.facet);
      if (last && last->bin == one.bin) CHECK(last->facet < one.facet);
      CHECK((one.bin - bins.bin_of(x)).cwiseAbs().maxCoeff() <= 1);
      last = &one;
    });
    CHECK(std::set<int>(found.begin(), found.end()).size() == found.size());
    for (int f : facets)
      if ((bounds[static_cast<std::size_t>(f)].centre - x).norm() <= kSide)
        CHECK(std::find(found.begin(), found.end(), f) != found.end());
  }
}

TEST_CASE("candidates that are too far for the closest point of their patch are removed, by patch") {
  // A row of facets along x, as one patch up to x = 10 and another from there.
  Surfaces<2> surfaces;
  std::vector<FacetBounds<2>> bounds;
  for (int k = 0; k < 20; ++k) {
    surfaces.facets.push_back({{0, 0}, {0, 0}, {}, 1, k < 10 ? 0 : 1, 1});
    bounds.push_back({Vec<2>(k + 0.5, 0), Vec<2>::UnitY(), 0.5, 1});
  }
  const FacetBounds<2> own{Vec<2>(3.5, 1), Vec<2>::UnitY(), 0.25, 0};
  std::vector<int> candidates{7};  // of another facet, stays
  for (int k = 0; k < 20; ++k) candidates.push_back(k);
  remove_distant(own, surfaces, bounds, 0.5, 1, candidates);
  // Least distances: 1 of patch 0, √50 of patch 1; slack 2 (0.25 + 0.5), radius 0.5: up to 3 and 9.07.
  std::vector<int> expected{7, 1, 2, 3, 4, 5};
  for (int k = 10; k < 20; ++k)
    if (std::hypot(k - 3.0, 1.0) <= std::sqrt(50.0) + 2) expected.push_back(k);
  CHECK(expected.back() == 12);
  CHECK(candidates == expected);
}

TEST_CASE(
    "vertex normals are radial on a circle, those of faces at corners, and missing where a surface folds") {
  Bodies<2> bodies({EllipsoidShape{{1, 2, 0}, {3, 3, 0}, 0}, BoxShape{{10, 0, 0}, {12, 1, 0}}}, 0.2);
  std::vector<Vec<2>> normals(bodies.surfaces.normal_cones.size());
  const auto bounds = bodies.bounds();
  REQUIRE(!compute_vertex_normals<2>(bodies.geometry(), bounds, bodies.all_cones(), 1, normals));
  int corners = 0;
  for (std::size_t c = 0; c < normals.size(); ++c) {
    const auto& cone = bodies.surfaces.normal_cones[c];
    const Vec<2>& x = item(bodies.positions, cone.point);
    if (cone.point < bodies.surfaces.bodies[0].count) {
      CHECK((normals[c] - (x - Vec<2>(1, 2)).normalized()).norm() < 1e-12);
    } else {
      CHECK(normals[c].lpNorm<1>() == doctest::Approx(1).epsilon(1e-14));  // along an axis
      corners += cone.end - cone.begin == 1;
    }
  }
  CHECK(corners == 8);  // two cones at each of four corners
  // A point drawn out to a needle: the two facets there face each other.
  const int point = 17;
  item(bodies.positions, point) += 50 * (item(bodies.positions, point) - Vec<2>(1, 2));
  const std::vector<FacetBounds<2>> unknown(bodies.surfaces.facets.size());
  const auto folded = compute_vertex_normals<2>(bodies.geometry(), unknown, bodies.all_cones(), 1, normals);
  REQUIRE(folded);
  CHECK(*folded == point);
}

/// Projections of a point at (−a, −b) inside a corner of faces x = 0 and y = 0.
std::array<PatchProjection<2>, 2> in_corner(const Vec<2>& x) {
  std::array<PatchProjection<2>, 2> out{};
  for (int k = 0; k < 2; ++k) {
    out[static_cast<std::size_t>(k)] = {
        1, k, k, {-x[k], x[k] < 0, false, false, Vec<2>::Unit(k), {0.5, 0.5}}};
  }
  return out;
}

TEST_CASE("penetration with one patch is the distance to it; its side decides what is outside") {
  auto patches = in_corner(Vec<2>(-0.2, -0.3));
  const std::span<const PatchProjection<2>> one(patches.data(), 1);
  const auto inside = find_penetration(one, 1.0);
  CHECK(inside.status == PointStatus::inside);
  CHECK(inside.depth == 0.2);
  CHECK(inside.share[0] == 1);
  CHECK(inside.exit_direction == Vec<2>::UnitX());
  patches[0].closest.inside = false;
  CHECK(find_penetration(one, 1.0).status == PointStatus::outside);
  patches[0].closest.at_crease = true;  // reentrant: inside
  CHECK(find_penetration(one, 1.0).status == PointStatus::inside);
  patches[0].closest.convex = true;
  CHECK(find_penetration(one, 1.0).status == PointStatus::outside);
  patches[0].closest.distance = 0;
  CHECK(find_penetration(one, 1.0).status == PointStatus::undetermined);
}

TEST_CASE("forces at a convex corner derive from the potential of the depth, which vanishes on both faces") {
  constexpr double kCell = 0.5;
  const auto depth = [&](const Vec<2>& x) {
    const auto patches = in_corner(x);
    return find_penetration<2>(patches, kCell).depth;
  };
  for (const Vec<2>& x :
       {Vec<2>(-0.1, -0.2), Vec<2>(-0.3, -0.15), Vec<2>(-0.05, -0.45), Vec<2>(-0.1, -0.7)}) {
    CAPTURE(x[0]);
    CAPTURE(x[1]);
    const auto patches = in_corner(x);
    const auto found = find_penetration<2>(patches, kCell);
    REQUIRE(found.status == PointStatus::inside);
    const double near = std::max(x[0], x[1]), far = std::min(x[0], x[1]);
    const double beyond = std::max(0.0, 1 / (far * far) - 1 / (kCell * kCell));
    CHECK(found.depth == doctest::Approx(1 / std::sqrt(1 / (near * near) + beyond)).epsilon(1e-14));
    Vec<2> gradient = Vec<2>::Zero();
    for (std::size_t j = 0; j < 2; ++j) gradient += found.share[j] * patches[j].closest.exit_direction;
    constexpr double kShift = 1e-6;  // central differences are exact to its square
    for (int d = 0; d < 2; ++d) {
      const Vec<2> shift = kShift * Vec<2>::Unit(d);
      CHECK(gradient[d] ==
            doctest::Approx((depth(x - shift) - depth(x + shift)) / (2 * kShift)).epsilon(1e-8));
    }
    CHECK((found.exit_direction - gradient.normalized()).norm() < 1e-14);
  }
  CHECK(depth(Vec<2>(-1e-9, -0.3)) < 1.0001e-9);
  CHECK(depth(Vec<2>(-0.3, -1e-9)) < 1.0001e-9);
}

/// Properties of two deformable bodies with one law.
BodyPairs two_bodies(const AnyLaw& law) {
  BodyPairs out;
  out.field = {0, 1};
  out.rigid = {false, false};
  out.modulus = {3e6, 1e6};
  out.laws = {law};
  out.cell = 0.5;
  return out;
}

TEST_CASE("pairs of bodies have the stiffness of the softer, and two rigid ones or one field never touch") {
  BodyPairs pairs = two_bodies(Frictionless{});
  pairs.springs.stiffness = 2;
  CHECK(pairs.stiffness(0, 1) == 2 * 1e6 / 0.5);
  CHECK(pairs.stiffness(1, 0) == 2 * 1e6 / 0.5);
  CHECK(pairs.may_touch(0, 1));
  pairs.rigid[1] = true;
  pairs.modulus[1] = 0;
  CHECK(pairs.stiffness(0, 1) == 2 * 3e6 / 0.5);
  CHECK(pairs.may_touch(0, 1));
  pairs.rigid[0] = true;
  CHECK_FALSE(pairs.may_touch(0, 1));
  pairs = two_bodies(Frictionless{});
  pairs.field = {0, 0};
  CHECK_FALSE(pairs.may_touch(0, 1));
}

TEST_CASE("laws and named pairs follow the table, and the order within a pair its direction") {
  BodyPairs pairs = two_bodies(Frictionless{});
  CHECK_FALSE(pairs.named(0, 1));
  CHECK(std::holds_alternative<Frictionless>(pairs.law(0, 1)));
  pairs.laws.push_back(Stick{});
  pairs.table.group = {0, 1};
  pairs.table.groups = 2;
  pairs.table.pair = {-1, 0, 0, -1};
  pairs.table.forward = {false, false, true, false};
  CHECK(std::holds_alternative<Stick>(pairs.law(1, 0)));
  CHECK(std::holds_alternative<Frictionless>(pairs.law(0, 0)));
  CHECK_FALSE(pairs.named(0, 0));
  REQUIRE(pairs.named(1, 0));
  CHECK(pairs.named(1, 0)->number == 0);
  CHECK(pairs.named(1, 0)->forward);
  CHECK_FALSE(pairs.named(0, 1)->forward);
  // Both in one group: the lower field is the first.
  pairs.table.group = {0, 0};
  pairs.table.groups = 1;
  pairs.table.pair = {0};
  pairs.table.forward = {true};
  CHECK(pairs.named(0, 1)->forward);
  CHECK_FALSE(pairs.named(1, 0)->forward);
}

/// Two squares, the right one `depth` inside the left one, with every facet a candidate of the other's.
struct Overlap {
  Bodies<2> bodies;
  BodyPairs pairs;
  std::vector<FacetBounds<2>> bounds;
  std::vector<ThreadContacts<2>> contacts{1};
  CandidateLists<2> lists;

  Overlap(double depth, const AnyLaw& law)
      : bodies({BoxShape{{0, 0, 0}, {2, 2, 0}}, BoxShape{{2 - depth, 0.5, 0}, {3, 1.5, 0}}}, 0.25),
        pairs(two_bodies(law)),
        bounds(bodies.bounds()) {
    const auto& facets = bodies.surfaces.facets;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const int begin = static_cast<int>(lists.facets.size());
      for (std::size_t g = 0; g < facets.size(); ++g)
        if (facets[g].body != facets[f].body) lists.facets.push_back(static_cast<int>(g));
      lists.of_facet.push_back({static_cast<int>(f), begin, static_cast<int>(lists.facets.size())});
    }
  }
  void classify_all() {
    std::vector<Vec<2>> normals(bodies.surfaces.normal_cones.size());
    REQUIRE(!compute_vertex_normals<2>(bodies.geometry(), bounds, bodies.all_cones(), 1, normals));
    std::vector<ClassifyWorkspace<2>> workspaces(1);
    classify(bodies.geometry(), bounds, normals, pairs, 1, lists, workspaces, contacts);
  }
};

TEST_CASE("points inside a body are found with their depth, the exit and half the stiffness of their area") {
  constexpr double kDepth = 0.01;
  Overlap overlap(kDepth, Frictionless{});
  overlap.classify_all();
  double stiffness[2] = {0, 0}, energy = 0;
  Vec<2> force[2] = {Vec<2>::Zero(), Vec<2>::Zero()};
  for (const auto& contact : overlap.contacts[0].contacts) {
    const int body = overlap.bodies.surfaces.facet(contact.own_facet).body;
    CHECK((contact.to_surface - contact.to_surface.norm() * contact.exit_direction).norm() < 1e-15);
    CHECK(contact.weight[0] + contact.weight[1] == doctest::Approx(1).epsilon(1e-14));
    CHECK(contact.compression <= kDepth * (1 + 1e-12));
    force[body] += contact.stiffness * contact.compression * contact.exit_direction;
    if (contact.energy > 0) stiffness[body] += contact.stiffness;  // once a point
    energy += contact.energy;
  }
  // ½ ω A on each side: ω = 1e6/0.5 Pa/m, A = 1 m². The face of the small square is far from other faces of
  // the large one. Points of the large square are also near the sides of the small one, at a distance d_2 of
  // theirs.
  CHECK(stiffness[1] == doctest::Approx(1e6).epsilon(1e-12));
  CHECK(force[1][0] == doctest::Approx(1e6 * kDepth).epsilon(1e-12));
  double expected_force = 0, expected_energy = 0.5 * 1e6 * kDepth * kDepth;
  for (int facet = 0; facet < 4; ++facet)
    for (const double at : {1 - kGaussWeight, kGaussWeight}) {
      const double y = 0.25 * (facet + at), side = std::min(y, 1 - y), cell = 0.5;
      const double depth = 1 / std::sqrt(1 / (kDepth * kDepth) + 1 / (side * side) - 1 / (cell * cell));
      const double share = std::pow(depth / kDepth, 3), share_of_side = std::pow(depth / side, 3);
      const double k = 1e6 / 8 * share / std::hypot(share, share_of_side);
      expected_force += k * depth * share;
      expected_energy += 0.5 * k * depth * depth;
    }
  CHECK(force[0][0] == doctest::Approx(-expected_force).epsilon(1e-10));
  for (const Vec<2>& one : force) CHECK(std::abs(one[1]) < 1e-10 * std::abs(one[0]));
  CHECK(energy == doctest::Approx(expected_energy).epsilon(1e-10));
  CHECK(add_normal_energy(3.0, overlap.contacts) == doctest::Approx(3 + energy).epsilon(1e-14));
}

TEST_CASE("separated bodies have no contact but a clearance, and are skipped until it may be used up") {
  Overlap overlap(-0.05, Frictionless{});
  overlap.classify_all();
  CHECK(overlap.contacts[0].contacts.empty());
  double least = 1e9;
  for (const auto& list : overlap.lists.of_facet) least = std::min(least, list.clearance);
  CHECK(least == doctest::Approx(0.05).epsilon(1e-12));
  // At positions inside of each other: a displacement within the clearance skips them, a larger one does not.
  for (std::size_t p = 0; p < overlap.bodies.positions.size(); ++p)
    if (overlap.bodies.surfaces.point_body[p] == 1) overlap.bodies.positions[p][0] -= 0.06;
  overlap.bounds = overlap.bodies.bounds();
  overlap.lists.displacement = 0.02;
  overlap.classify_all();
  CHECK(overlap.contacts[0].contacts.empty());
  overlap.lists.displacement = 0.06;
  overlap.classify_all();
  CHECK(!overlap.contacts[0].contacts.empty());
}

TEST_CASE("bodies that ignore each other have no contacts") {
  Overlap overlap(0.01, Ignore{});
  overlap.classify_all();
  CHECK(overlap.contacts[0].contacts.empty());
}

TEST_CASE("the limit of friction is that of each law") {
  CHECK(friction_limit(Coulomb{0.3, 0.5}, 10, 0, false) == 5);
  CHECK(friction_limit(Coulomb{0.3, 0.5}, 10, 0, true) == 3);
  CHECK(friction_limit(Coulomb{0.3, 0}, 10, 0, false) == 3);
  CHECK(friction_limit(Frictionless{}, 10, 1, false) == 0);
  CHECK(friction_limit(Stick{}, 1, 0, false) > 1e300);
  const VelocityFriction law{0.1, 0.6, 2};
  CHECK(friction_limit(law, 10, 0, false) == doctest::Approx(6).epsilon(1e-15));
  CHECK(friction_limit(law, 10, 2, true) == doctest::Approx(1 + 5 * std::exp(-1)).epsilon(1e-15));
}

TEST_CASE("a tangential spring keeps its length when the surface turns, and adds the slip") {
  TangentialSpring<3> spring{2, false, Vec<3>(0.3, 0, 0.4)};
  stretch_spring<3>(spring, Vec<3>(0, 0.1, 0), Vec<3>::UnitZ());
  CHECK((spring.stretch - Vec<3>(0.5, 0.1, 0)).norm() < 1e-15);
  spring.stretch = Vec<3>(0, 0, 1);  // along the exit direction: no direction is left
  stretch_spring<3>(spring, Vec<3>(0.1, 0, 0), Vec<3>::UnitZ());
  CHECK((spring.stretch - Vec<3>(0.1, 0, 0)).norm() < 1e-15);
}

TEST_CASE("return mapping keeps what the limit carries, and dissipates its work on the rest") {
  TangentialSpring<2> spring{0, false, Vec<2>(0.03, 0.04)};
  const auto elastic = return_to_limit<2>(spring, 100, 5);
  CHECK_FALSE(spring.slides);
  CHECK((elastic.force - Vec<2>(-3, -4)).norm() < 1e-14);
  CHECK(elastic.dissipated == 0);
  CHECK(elastic.stored == doctest::Approx(0.125).epsilon(1e-14));
  const auto limited = return_to_limit<2>(spring, 100, 2);
  CHECK(spring.slides);
  CHECK((limited.force - Vec<2>(-1.2, -1.6)).norm() < 1e-14);
  CHECK(spring.stretch.norm() == doctest::Approx(0.02).epsilon(1e-14));
  CHECK(limited.dissipated == doctest::Approx(2 * 0.03).epsilon(1e-14));
  CHECK(limited.stored == doctest::Approx(0.5 * 100 * 0.02 * 0.02).epsilon(1e-14));
}

TEST_CASE("springs are restored in the step after they were stored, for their patch") {
  PointSprings<2> springs{7, {}};
  springs.springs[1] = {3, true, Vec<2>(1, 2)};
  CHECK(springs.restore(3, 8).stretch == Vec<2>(1, 2));
  CHECK(springs.restore(3, 8).slides);
  CHECK(springs.restore(4, 8).patch == -1);
  CHECK(springs.restore(3, 9).patch == -1);
}

/// A contact above a random facet, with a random force: reactions balance the force and its moment.
template <int Dim>
void check_reactions(std::uint64_t seed) {
  Draw draw(seed);
  for (int trial = 0; trial < 100; ++trial) {
    std::array<Vec<Dim>, Dim> corner;
    for (auto& x : corner) x = uniform(draw, 0.5, 1.5) * random_direction<Dim>(draw);
    Vec<Dim> normal;
    if constexpr (Dim == 2)
      normal = Vec<2>(corner[1][1] - corner[0][1], corner[0][0] - corner[1][0]).normalized();
    else
      normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    if constexpr (Dim == 3) {
      const double area = (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
      if (area < 0.1) continue;
    }
    if ((corner[1] - corner[0]).norm() < 0.1) continue;
    PointContact<Dim> contact{};
    contact.exit_direction = normal;
    double rest = 1;
    Vec<Dim> closest = Vec<Dim>::Zero();
    for (int k = 0; k < Dim; ++k) {
      contact.weight[k] = k + 1 < Dim ? rest * uniform(draw, 0, 1) : rest;
      rest -= contact.weight[k];
      closest += contact.weight[k] * item(corner, k);
    }
    contact.to_surface = uniform(draw, 0.01, 0.1) * normal;
    const Vec<Dim> point = closest - contact.to_surface,
                   force = uniform(draw, 1, 2) * random_direction<Dim>(draw);
    Vec<Dim> reaction[Dim];
    distribute_reaction<Dim>(contact, corner, force, reaction);
    Vec<Dim> sum = force;
    auto torque = moment<Dim>(point, force);
    for (int k = 0; k < Dim; ++k) {
      sum += reaction[k];
      torque += moment<Dim>(item(corner, k), reaction[k]);
    }
    CHECK(sum.norm() < 1e-12);
    if constexpr (Dim == 2)
      CHECK(std::abs(torque) < 1e-12);
    else
      CHECK(torque.norm() < 1e-12);
  }
}

TEST_CASE("reactions on a facet balance the force on the point and its moment") {
  check_reactions<2>(1);
  check_reactions<3>(2);
}

TEST_CASE("a slip of one body has its friction work, impulse and area in the ledger of the pair") {
  constexpr double kDepth = 0.01, kSlip = 0.02, kStep = 1e-3;
  Overlap overlap(kDepth, Coulomb{0.3, 0});
  overlap.pairs.laws.push_back(Coulomb{0.3, 0});
  overlap.pairs.table.group = {0, 1};
  overlap.pairs.table.groups = 2;
  overlap.pairs.table.pair = {-1, 0, 0, -1};
  overlap.pairs.table.forward = {false, true, false, false};
  FrictionHistory<2> history(kFacetPoints<2> * overlap.bodies.surfaces.facets.size());
  std::vector<Vec<2>> forces(overlap.bodies.positions.size()), before = overlap.bodies.positions;
  const auto step = [&](std::uint64_t number) {
    overlap.bounds = overlap.bodies.bounds();
    overlap.lists.displacement = 1;
    overlap.classify_all();
    const SurfaceMotion<2> motion{
        overlap.bodies.geometry(), {overlap.bodies.surfaces, before}, kStep, number};
    compute_contact_forces(motion, overlap.pairs, 1, overlap.contacts, history);
    assemble_point_forces(overlap.bodies.surfaces, overlap.contacts, forces);
    ContactLedger<2> ledger;
    ledger.reset(2, 1);
    record_contacts(overlap.bodies.surfaces, overlap.pairs, overlap.contacts, kStep, ledger);
    before = overlap.bodies.positions;
    return ledger;
  };
  const auto on_body = [&](int body) {
    Vec<2> sum = Vec<2>::Zero();
    for (std::size_t p = 0; p < forces.size(); ++p)
      if (overlap.bodies.surfaces.point_body[p] == body) sum += forces[p];
    return sum;
  };
  const auto first = step(1);
  CHECK(first.friction_work == 0);
  CHECK(tangential_energy(overlap.contacts) == 0);
  CHECK(first.pair_area[0] == doctest::Approx(1).epsilon(0.05));  // the face of the smaller square
  for (std::size_t p = 0; p < before.size(); ++p)
    if (overlap.bodies.surfaces.point_body[p] == 1) overlap.bodies.positions[p][1] += kSlip;
  const auto second = step(2);
  const Vec<2> force = on_body(0);
  CHECK((force + on_body(1)).norm() < 1e-12 * force.norm());
  CHECK(force[1] == doctest::Approx(-0.3 * force[0]).epsilon(1e-2));  // dragged along with the slip
  CHECK((second.pair_impulse[0] - kStep * force).norm() < 1e-12 * kStep * force.norm());
  CHECK(second.pair_friction_work[0] == second.friction_work);
  // A spring as stiff as the normal one holds 0.3 of the depth; the rest of the slip dissipates.
  CHECK(second.friction_work == doctest::Approx(std::abs(force[1]) * (kSlip - 0.3 * kDepth)).epsilon(2e-2));
  CHECK(tangential_energy(overlap.contacts) ==
        doctest::Approx(0.5 * std::abs(force[1]) * 0.3 * kDepth).epsilon(2e-2));
}

TEST_CASE("forces on a rigid body have impulse, moment about its pivot and work in the ledger") {
  Overlap overlap(0.01, Frictionless{});
  overlap.pairs.rigid[1] = true;
  std::vector<Vec<2>> forces(overlap.bodies.positions.size(), Vec<2>::Zero());
  const int last = static_cast<int>(forces.size()) - 1;  // a point of body 1
  forces[0] = Vec<2>(100, 100);                          // of body 0, which is not rigid
  item(forces, last) = Vec<2>(3, -4);
  std::vector<Vec<2>> before = overlap.bodies.positions;
  item(before, last) -= Vec<2>(0.1, 0.2);
  const Vec<2> pivot(2.5, 1), arm = item(overlap.bodies.positions, last) - pivot;
  ContactLedger<2> ledger;
  ledger.reset(2, 0);
  record_rigid_bodies(overlap.bodies.geometry(), {overlap.bodies.surfaces, before}, overlap.pairs, forces,
                      {Vec<2>::Zero(), pivot}, 0.5, ledger);
  CHECK(ledger.rigid_impulse[0] == Vec<2>::Zero());
  CHECK((ledger.rigid_impulse[1] - Vec<2>(1.5, -2)).norm() < 1e-15);
  CHECK(ledger.rigid_moment[1][2] == doctest::Approx(0.5 * (arm[0] * -4 - arm[1] * 3)).epsilon(1e-14));
  CHECK(ledger.rigid_work == doctest::Approx(-(3 * 0.1 - 4 * 0.2)).epsilon(1e-12));
}

}  // namespace
}  // namespace mpmfast::penalty
