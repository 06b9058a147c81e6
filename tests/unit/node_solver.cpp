#include "kernels/contact/node_solver.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "kernels/contact/resolve_pair.hpp"
#include "tests/compressed_node.hpp"

namespace {

using namespace mpmfast;

template <int Dim>
Vec<Dim> momentum_of(const NodeSolver<Dim>& node) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const auto& field : node.fields)
    if (field.inverse_mass > 0) sum += field.velocity / field.inverse_mass;
  return sum;
}

template <int Dim>
void add_contact(NodeSolver<Dim>& node, int a, int b, const Vec<Dim>& normal) {
  const double inverse = node.fields[static_cast<std::size_t>(a)].inverse_mass +
                         node.fields[static_cast<std::size_t>(b)].inverse_mass;
  node.contacts.push_back({a, b, normal.normalized(), 1 / inverse});
}

/// Solves surfaces that overlap under one law.
template <int Dim, class Law>
bool solve(NodeSolver<Dim>& node, const Law& law) {
  return node.solve([&](std::size_t k, const Vec<Dim>& stick) {
    const auto& c = node.contacts[k];
    return response_of<Dim>(resolve_pair<Dim>(stick, c.normal, -1.0, law, c.reduced_mass), stick);
  });
}

TEST_CASE("a light field pressed between two heavy ones takes their common velocity") {
  NodeSolver<2> node;
  const double heavy = 2.0, light = 1e-7;
  node.fields = {{{1, 0}, 1 / heavy}, {{0.3, 0}, 1 / light}, {{-1, 0}, 1 / heavy}};
  add_contact<2>(node, 0, 1, {1, 0});
  add_contact<2>(node, 1, 2, {1, 0});
  CHECK(solve(node, Frictionless{}));
  for (const auto& field : node.fields) CHECK(std::abs(field.velocity[0] - 0.3 * light / 4) < 1e-8);
  CHECK(node.contacts[0].impulse[0] == doctest::Approx(-heavy).epsilon(1e-6));
}

TEST_CASE("three fields that stick to each other move as one, though their impulses are not unique") {
  NodeSolver<3> node;
  node.fields = {{{1, 0, 0.2}, 1 / 1.0}, {{-1, 0.1, 0}, 1 / 2.0}, {{0, -1, 0}, 1 / 4.0}};
  const Vec<3> common = momentum_of(node) / 7.0;
  add_contact<3>(node, 0, 1, {1, 0, 0});
  add_contact<3>(node, 0, 2, {0, 1, 0});
  add_contact<3>(node, 1, 2, {1, 1, 0});
  CHECK(solve(node, Perfect{}));
  for (const auto& field : node.fields) CHECK((field.velocity - common).norm() < 1e-8);
}

TEST_CASE("a block slides between two plates with the friction of both") {
  NodeSolver<2> node;  // the plates are rigid and close at speed 1; the block moves along them
  const double mass = 0.5, friction = 0.2;
  node.fields = {{{0, 0}, 0}, {{10, -1}, 1 / mass}, {{0, -1}, 1 / 3.0}};
  add_contact<2>(node, 0, 1, {0, 1});
  add_contact<2>(node, 1, 2, {0, 1});
  CHECK(solve(node, Coulomb{friction, 0}));
  // The floor stops both: N = 3.5 below the block, 3 above it, which drags the upper plate along.
  CHECK(node.fields[1].velocity[1] == doctest::Approx(0));
  CHECK(node.fields[2].velocity[1] == doctest::Approx(0));
  CHECK(node.fields[1].velocity[0] == doctest::Approx(10 - friction * (3.5 + 3.0) / mass));
  CHECK(node.fields[2].velocity[0] == doctest::Approx(friction * 3.0 / 3.0));
}

/// Momentum stays; no contact approaches, pulls or drags more than friction allows, and what slides less
/// sticks.
template <int Dim>
void check_random_nodes() {
  std::mt19937_64 draw(11);
  const double friction = 0.3;
  int unsettled = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const CompressedNode<Dim> posed(3 + trial % 3, 6, draw);
    NodeSolver<Dim> node;
    node.fields = posed.fields;
    node.contacts = posed.contacts;
    const Vec<Dim> before = momentum_of(node);
    if (!solve(node, Coulomb{friction, 0})) {
      ++unsettled;
      continue;
    }
    CHECK((momentum_of(node) - before).norm() < 1e-12 * (1 + before.norm()));
    double largest = 0;
    for (const auto& c : node.contacts) largest = std::max(largest, c.impulse.norm());
    for (const auto& c : node.contacts) {
      const Vec<Dim> slip = node.fields[static_cast<std::size_t>(c.b)].velocity -
                            node.fields[static_cast<std::size_t>(c.a)].velocity;
      const double pressure = -c.impulse.dot(c.normal), tolerance = 1e-7 * largest;
      const double shear = (c.impulse + pressure * c.normal).norm();
      const Vec<Dim> sliding = slip - slip.dot(c.normal) * c.normal;
      CHECK(pressure >= -tolerance);
      CHECK(c.reduced_mass * slip.dot(c.normal) >= -tolerance);
      CHECK(std::min(pressure, c.reduced_mass * slip.dot(c.normal)) <= tolerance);
      CHECK(shear <= friction * pressure + tolerance);
      CHECK(std::min(friction * pressure - shear, c.reduced_mass * sliding.norm()) <= tolerance);
    }
  }
  CHECK(unsettled <= 30);  // measured 8 and 27; sweeps without leaps leave 35 and 43
}

TEST_CASE("contacts of random nodes obey Coulomb's law together (2-D)") { check_random_nodes<2>(); }
TEST_CASE("contacts of random nodes obey Coulomb's law together (3-D)") { check_random_nodes<3>(); }

/// Many fields, all pairs in contact, with normals that no bodies could have: they jam in rings.
/// @param orders of magnitude that the masses span
template <int Dim>
NodeSolver<Dim> jam(std::mt19937_64& draw, int fields, double orders) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> exponent(-orders, 0);
  const auto vector = [&] {
    Vec<Dim> out;
    for (int d = 0; d < Dim; ++d) out[d] = gauss(draw);
    return out;
  };
  NodeSolver<Dim> node;
  for (int k = 0; k < fields; ++k) node.fields.push_back({vector(), std::pow(10.0, -exponent(draw))});
  for (int a = 0; a < fields; ++a)
    for (int b = a + 1; b < fields; ++b) add_contact<Dim>(node, a, b, vector());
  return node;
}

/// Every second pair of a jam is held (`persistent`) and may pull.
template <int Dim>
void check_energy() {
  std::mt19937_64 draw(3);
  int unsettled = 0;
  double worst = 0;
  for (int trial = 0; trial < 400; ++trial) {
    NodeSolver<Dim> node = jam<Dim>(draw, 3 + trial % 12, 9);
    const auto energy = [&] {
      double sum = 0;
      for (const auto& field : node.fields) sum += 0.5 * field.velocity.squaredNorm() / field.inverse_mass;
      return sum;
    };
    const double before = energy();
    const Vec<Dim> momentum = momentum_of(node);
    const Coulomb law{0.2, 0};
    unsettled += !node.solve([&](std::size_t k, const Vec<Dim>& stick) {
      const auto& c = node.contacts[k];
      const double along = stick.dot(c.normal);
      if (k % 2 == 0 && along > 0) return Response<Dim>{along * c.normal, ContactStatus::slip};
      return response_of<Dim>(resolve_pair<Dim>(stick, c.normal, -1.0, law, c.reduced_mass), stick);
    });
    CHECK(energy() <= before * (1 + 1e-9));
    CHECK((momentum_of(node) - momentum).norm() < 1e-9 * std::sqrt(before));
    double taken = 0;
    for (const auto& c : node.contacts)
      taken += c.impulse.dot(node.fields[c.b].velocity - node.fields[c.a].velocity);
    worst = std::min(worst, taken / before);
    CHECK(taken <= before * (1 + 1e-8));
  }
  CHECK(unsettled > 20);
  CHECK(worst >= -2e-8);  // round-off of masses over nine orders: measured 5e-9, on any processor
  MESSAGE("did not settle: ", unsettled, " of 400; given at worst ", -worst, " of what was there");
}

TEST_CASE("contacts that jam and do not settle still take energy, never give it (2-D)") { check_energy<2>(); }
TEST_CASE("contacts that jam and do not settle still take energy, never give it (3-D)") { check_energy<3>(); }

/// Pairs of a step's one set: every third is held both ways, and every third closes a gap by the end of the
/// step. Whether friction settles or not, the normal impulses hold.
template <int Dim>
void check_set(double friction, int most_unsettled, double tolerance) {
  std::mt19937_64 draw(5);
  std::uniform_real_distribution<double> uniform;
  int unsettled = 0;
  double worst = 0;
  for (int trial = 0; trial < 300; ++trial) {
    NodeSolver<Dim> node = jam<Dim>(draw, 3 + trial % 4, 5);
    int kind = 0;
    for (auto& c : node.contacts) {
      kind = (kind + 1) % 3;
      c.bilateral = kind == 0;
      c.target_approach = kind == 2 ? uniform(draw) : 0;
    }
    const auto law = [&](std::size_t k, const Vec<Dim>& stick) -> Response<Dim> {
      const auto& c = node.contacts[k];
      const double along = stick.dot(c.normal), normal = along + c.reduced_mass * c.target_approach;
      if (normal > 0 && !c.bilateral) return {Vec<Dim>::Zero(), ContactStatus::open};
      const Vec<Dim> tangential = stick - along * c.normal;
      const double limit = friction * std::max(0.0, -normal), needed = tangential.norm();
      if (needed <= limit) return {normal * c.normal + tangential, ContactStatus::stick};
      return {normal * c.normal + limit / needed * tangential, ContactStatus::slip};
    };
    const Vec<Dim> before = momentum_of(node);
    unsettled += !node.solve(law);
    double scale = 1e-7;  // of fields that part: 1e-14 is round-off of their momenta
    for (const auto& c : node.contacts) scale = std::max(scale, c.impulse.norm());
    for (std::size_t k = 0; k < node.contacts.size(); ++k) {
      const auto& c = node.contacts[k];
      const Vec<Dim> slip = node.fields[static_cast<std::size_t>(c.b)].velocity -
                            node.fields[static_cast<std::size_t>(c.a)].velocity;
      const Vec<Dim> missing = law(k, c.impulse + c.reduced_mass * slip).impulse - c.impulse;
      worst = std::max(worst, std::abs(missing.dot(c.normal)) / scale);
    }
    CHECK((momentum_of(node) - before).norm() < 1e-9 * (1 + before.norm()));
  }
  CAPTURE(worst);
  CHECK(worst < tolerance);
  CHECK(unsettled <= most_unsettled);
  MESSAGE("friction ", friction, ": ", unsettled, " of 300 did not settle, normal impulses err by ", worst);
}

// In the plane, 15 pairs of 6 fields ask for more than these can do: a few settle slowly (measured 3e-4).
TEST_CASE("normal impulses of pairs that last and close gaps settle in any jam (2-D)") {
  check_set<2>(0, 10, 1e-3);
  check_set<2>(0.3, 100, 1e-3);
}
TEST_CASE("normal impulses of pairs that last and close gaps settle in any jam (3-D)") {
  check_set<3>(0, 0, 1e-6);
  check_set<3>(0.3, 100, 1e-6);
}

/// Momenta far ahead of a wave are so small that their squares vanish: J·n may be zero where J is not.
TEST_CASE("momenta whose squares underflow give finite impulses") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int infinite = 0;  // 6 where J·n divides whatever it is
  for (int trial = 0; trial < 20000; ++trial) {
    NodeSolver<2> node;
    const double tiny = std::pow(10.0, -157.5 + 7.5 * uniform(random));
    const auto velocity = [&] { return Vec<2>(tiny * uniform(random), tiny * uniform(random)); };
    node.fields = {{velocity(), 1 / 4.8e-6}, {velocity(), 1 / 4.3e-7}, {velocity(), 1 / 4.3e-7}};
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
      add_contact<2>(node, a, b, trial % 3 ? Vec<2>(uniform(random), uniform(random)) : Vec<2>(1e-17, -1));
    // A contact that lasts pulls too, and a slip whose square vanishes seems to be none.
    node.solve([&](std::size_t k, const Vec<2>& stick) {
      const Vec<2>& n = node.contacts[k].normal;
      const double along = stick.dot(n), normal = trial % 2 ? along : std::min(along, 0.0);
      const Vec<2> tangential = stick - along * n;
      const bool slides = tangential.norm() > 0;
      return response_of<2>(slides ? Vec<2>(normal * n) : Vec<2>(normal * n + tangential), stick);
    });
    for (const auto& c : node.contacts) infinite += !c.impulse.allFinite();
  }
  CHECK(infinite == 0);
}

/// A film drags surfaces that slide on it and presses nothing: J·n is zero where J is not.
TEST_CASE("a contact that drags and does not press takes its share of the slip") {
  for (const Vec<2>& slip : {Vec<2>(0, 1), Vec<2>(0, -3)}) {
    NodeSolver<2> node;
    node.fields = {{Vec<2>::Zero(), 1 / 2.0}, {slip, 1 / 3.0}, {Vec<2>(5, 0), 1 / 4.0}};
    add_contact<2>(node, 0, 1, {1, 0});
    add_contact<2>(node, 1, 2, {1, 0});  // parts
    const double share = 0.25, reduced_mass = node.contacts[0].reduced_mass;
    CHECK(node.solve([&](std::size_t k, const Vec<2>& stick) -> Response<2> {
      if (k == 1) return {Vec<2>::Zero(), ContactStatus::open};
      return {Vec<2>(0, share * stick[1]), ContactStatus::slip};
    }));
    CHECK((node.contacts[0].impulse - share * reduced_mass * slip).norm() < 1e-12);
    CHECK((node.fields[0].velocity - share * reduced_mass / 2 * slip).norm() < 1e-12);
    CHECK(node.contacts[1].impulse.norm() == 0);
  }
}

}  // namespace
