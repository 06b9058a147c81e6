/// Contacts of a node against plain ones: equations written out one by one, sweeps until nothing changes, and
/// stacks whose impulses are known.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "kernels/contact/delassus_operator.hpp"
#include "kernels/contact/lane_solver.hpp"
#include "kernels/contact/node_solver.hpp"
#include "kernels/contact/resolve_pair.hpp"
#include "kernels/contact/two_pairs.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::test;

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

std::size_t index(int k) { return static_cast<std::size_t>(k); }

// The Delassus operator.

using Numbers = std::vector<double>;

/// Solves the equations of delassus, each from the effect of an impulse on the velocities of all fields, by
/// elimination of the largest entries first.
template <int Dim>
Numbers eliminated(const std::vector<typename DelassusOperator<Dim>::Row>& all, const Numbers& inverse_mass) {
  const std::size_t count = all.size();
  std::vector<Numbers> row(count, Numbers(count + 1));
  for (std::size_t j = 0; j < count; ++j) {
    std::vector<Vec<Dim>> velocity(inverse_mass.size(), Vec<Dim>::Zero());
    velocity[index(all[j].a)] += inverse_mass[index(all[j].a)] * all[j].impulse;
    velocity[index(all[j].b)] -= inverse_mass[index(all[j].b)] * all[j].impulse;
    for (std::size_t i = 0; i < count; ++i) {
      const double reduced_mass = 1 / (inverse_mass[index(all[i].a)] + inverse_mass[index(all[i].b)]);
      row[i][j] = reduced_mass * all[i].motion.dot(velocity[index(all[i].a)] - velocity[index(all[i].b)]);
    }
    row[j][count] = all[j].residual;
  }
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t i = p + 1; i < count; ++i)
      if (std::abs(row[i][p]) > std::abs(row[p][p])) std::swap(row[i], row[p]);
    for (std::size_t i = 0; i < count; ++i) {
      if (i == p) continue;
      const double factor = row[i][p] / row[p][p];
      for (std::size_t j = p; j <= count; ++j) row[i][j] -= factor * row[p][j];
    }
  }
  Numbers solution;
  for (std::size_t p = 0; p < count; ++p) solution.push_back(row[p][count] / row[p][p]);
  return solution;
}

template <int Dim>
Numbers found_by(DelassusOperator<Dim>& delassus,
                 const std::vector<typename DelassusOperator<Dim>::Row>& all) {
  delassus.clear();
  for (const auto& one : all) delassus.push(one);
  CHECK(delassus.count() == static_cast<int>(all.size()));
  CHECK(delassus.solve());
  Numbers found;
  delassus.for_each_change([&](int contact, const Vec<Dim>& change) {
    const auto& one = all[found.size()];
    CHECK(contact == one.contact);
    found.push_back(change.dot(one.impulse) / one.impulse.squaredNorm());
    CHECK((change - found.back() * one.impulse).norm() <= 1e-12 * change.norm());
  });
  CHECK(found.size() == all.size());
  return found;
}

TEST_CASE_TEMPLATE("delassus of any number of sliding contacts are solved as elimination solves them", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(1);
  DelassusOperator<Dim> delassus;  // used again: what stood in it is nothing to the next
  for (int count = 64; count > 0; count -= count > 33 ? 5 : 1) {
    CAPTURE(count);
    const int fields = count + 1;
    Numbers inverse_mass(index(fields));
    for (double& one : inverse_mass) one = std::exp(uniform(draw, -1, 1));
    if (count % 3 == 0) inverse_mass[0] = 0;
    std::vector<typename DelassusOperator<Dim>::Row> all;
    for (int i = 0; i < count; ++i) {
      // A chain, or a star, with either field named first; the impulse leans from the motion as with
      // friction.
      const int near = count % 2 ? i : 0, far = i + 1;
      const int a = uniform(draw, 0, 1) < 0.5 ? near : far, b = near + far - a;
      const double reduced_mass = 1 / (inverse_mass[index(a)] + inverse_mass[index(b)]);
      const Vec<Dim> normal = random_direction<Dim>(draw);
      const Vec<Dim> impulse = normal + 0.3 * random_direction<Dim>(draw);
      all.push_back({7 * i + 3, a, b, reduced_mass * inverse_mass[index(a)],
                     reduced_mass * inverse_mass[index(b)], impulse, normal, uniform(draw, -2, 2)});
    }
    const Numbers expected = eliminated<Dim>(all, inverse_mass), found = found_by(delassus, all);
    double largest = 0, apart = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      largest = std::max(largest, std::abs(expected[k]));
      apart = std::max(apart, std::abs(found[k] - expected[k]));
    }
    CHECK(apart < 1e-8 * largest);
  }
}

TEST_CASE_TEMPLATE("fields that all stick to each other end their motion, though impulses follow from others",
                   D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  DelassusOperator<Dim> delassus;
  for (int fields = 3; fields <= (Dim == 2 ? 8 : 6); ++fields)
    for (int trial = 0; trial < 3; ++trial) {
      CAPTURE(fields);
      Numbers inverse_mass(index(fields));
      std::vector<Vec<Dim>> velocity(index(fields));
      for (double& one : inverse_mass) one = std::exp(uniform(draw, -2, 2));
      for (auto& one : velocity) one = uniform(draw, 0, 3) * random_direction<Dim>(draw);
      std::vector<typename DelassusOperator<Dim>::Row> all;
      for (int a = 0; a < fields; ++a)
        for (int b = a + 1; b < fields; ++b) {
          const double reduced_mass = 1 / (inverse_mass[index(a)] + inverse_mass[index(b)]);
          for (int d = 0; d < Dim; ++d)
            all.push_back({0, a, b, reduced_mass * inverse_mass[index(a)],
                           reduced_mass * inverse_mass[index(b)], Vec<Dim>::Unit(d), Vec<Dim>::Unit(d),
                           reduced_mass * (velocity[index(b)] - velocity[index(a)])[d]});
        }
      const Numbers found = found_by(delassus, all);
      Vec<Dim> mean = Vec<Dim>::Zero();
      double mass = 0;
      for (int k = 0; k < fields; ++k) {
        mean += velocity[index(k)] / inverse_mass[index(k)];
        mass += 1 / inverse_mass[index(k)];
      }
      for (std::size_t i = 0; i < all.size(); ++i) {
        velocity[index(all[i].a)] += inverse_mass[index(all[i].a)] * found[i] * all[i].impulse;
        velocity[index(all[i].b)] -= inverse_mass[index(all[i].b)] * found[i] * all[i].impulse;
      }
      for (const auto& one : velocity) CHECK((one - mean / mass).norm() < 1e-10);
    }
}

TEST_CASE_TEMPLATE(
    "delassus are full where one more contact that sticks has no independent direction, and say what is "
    "none",
    D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  DelassusOperator<Dim> delassus;
  delassus.clear();
  for (int count = 0; count <= 64; ++count) {
    CHECK(delassus.is_full() == (count > 64 - Dim));
    if (count < 64) delassus.push({count, 0, 1, 0.5, 0.5, Vec<Dim>::Unit(0), Vec<Dim>::Unit(0), 1});
  }
  for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()})
    for (const int count : {1, 8, 9, 16, 17, 40})
      for (const int at : {0, count - 1}) {
        delassus.clear();
        for (int k = 0; k < count; ++k)  // each between two fields of its own
          delassus.push(
              {k, 2 * k, 2 * k + 1, 0.5, 0.5, Vec<Dim>::Unit(0), Vec<Dim>::Unit(0), k == at ? none : 1.0});
        CHECK(!delassus.solve());
      }
}

// Nodes of several fields.

/// What a contact is asked, and its own friction.
template <int Dim>
struct PlainContact {
  int a, b;
  Vec<Dim> normal;
  double target_approach = 0;
  bool acts = true, bilateral = false, must_stick = false, friction = true;
  Coulomb law{0, 0};
  Vec<Dim> impulse = Vec<Dim>::Zero();

  /// The impulse that it would have alone where sticking needs this.
  Vec<Dim> demand(const Vec<Dim>& stick, double reduced_mass) const {
    const double normal_part = stick.dot(normal) + reduced_mass * target_approach;
    if (!acts || (normal_part > 0 && !bilateral)) return Vec<Dim>::Zero();
    Vec<Dim> along = stick - stick.dot(normal) * normal;
    if (!must_stick) {
      const double pressure = std::max(0.0, -normal_part), needed = along.norm();
      const bool rests = friction && needed <= std::max(law.friction, law.static_friction) * pressure;
      if (!friction)
        along.setZero();
      else if (!rests && needed > 0)
        along *= law.friction * pressure / needed;
    }
    return normal_part * normal + along;
  }
};

template <int Dim>
struct PlainNode {
  std::vector<Vec<Dim>> velocity;
  std::vector<double> inverse_mass;
  std::vector<PlainContact<Dim>> contacts;

  double reduced_mass(const PlainContact<Dim>& c) const {
    return 1 / (inverse_mass[index(c.a)] + inverse_mass[index(c.b)]);
  }
  /// The velocities that the impulses leave.
  std::vector<Vec<Dim>> after() const {
    std::vector<Vec<Dim>> v = velocity;
    for (const auto& c : contacts) {
      v[index(c.a)] += inverse_mass[index(c.a)] * c.impulse;
      v[index(c.b)] -= inverse_mass[index(c.b)] * c.impulse;
    }
    return v;
  }
  double largest() const {
    double most = 0;
    for (const auto& c : contacts) most = std::max(most, c.impulse.norm());
    return most;
  }
  /// By how much the impulses miss what each contact demands with the velocities that all leave.
  double missing() const {
    const auto v = after();
    double most = 0;
    for (const auto& c : contacts) {
      const Vec<Dim> stick = c.impulse + reduced_mass(c) * (v[index(c.b)] - v[index(c.a)]);
      most = std::max(most, (c.demand(stick, reduced_mass(c)) - c.impulse).norm());
    }
    return most;
  }
  /// Gauss–Seidel until nothing changes. @return whether it came to that
  bool sweep_all() {
    auto v = velocity;
    for (auto& c : contacts) c.impulse.setZero();
    for (int sweep = 0; sweep < 5000; ++sweep) {
      double change = 0;
      for (auto& c : contacts) {
        const Vec<Dim> stick = c.impulse + reduced_mass(c) * (v[index(c.b)] - v[index(c.a)]);
        const Vec<Dim> step = c.demand(stick, reduced_mass(c)) - c.impulse;
        c.impulse += step;
        v[index(c.a)] += inverse_mass[index(c.a)] * step;
        v[index(c.b)] -= inverse_mass[index(c.b)] * step;
        change = std::max(change, step.norm());
      }
      if (change < 1e-13) return true;
    }
    return false;
  }
};

template <int Dim>
ActiveSetRule<Dim> rule_of(const PlainContact<Dim>& c) {
  ActiveSetRule<Dim> rule;
  rule.acts = c.acts;
  rule.bilateral = c.bilateral;
  rule.must_stick = c.must_stick;
  rule.friction = c.friction;
  return rule;
}

/// As the solver of one node finds them.
struct Solved {
  bool settled;
  int asked;  ///< how often a law was
};
template <int Dim>
Solved solve_one(PlainNode<Dim>& node, NodeSolver<Dim>& solver) {
  solver.fields.clear();
  solver.contacts.clear();
  for (std::size_t k = 0; k < node.velocity.size(); ++k)
    solver.fields.push_back({node.velocity[k], node.inverse_mass[k]});
  for (const auto& c : node.contacts)
    solver.contacts.push_back({c.a, c.b, c.normal, node.reduced_mass(c), c.target_approach, c.bilateral});
  int asked = 0;
  const bool settled = solver.solve([&](std::size_t k, const Vec<Dim>& stick) {
    ++asked;
    const auto& c = node.contacts[k];
    return rule_of(c).response(c.normal, c.target_approach, stick, node.reduced_mass(c), c.law, 0.0,
                               [](double normal) { return normal; });
  });
  for (std::size_t k = 0; k < node.contacts.size(); ++k)
    node.contacts[k].impulse = solver.contacts[k].impulse;
  const auto after = node.after();
  double fastest = 0;
  for (const auto& v : node.velocity) fastest = std::max(fastest, v.norm());
  for (std::size_t k = 0; k < after.size(); ++k)
    CHECK((solver.fields[k].velocity - after[k]).norm() <=
          1e-12 * (fastest + node.inverse_mass[k] * node.largest()));
  return {settled, asked};
}

/// As the solver of lanes of nodes finds them. @return which settled
template <int Dim, int kFields>
std::vector<bool> solve_lanes(std::vector<PlainNode<Dim>>& nodes, LaneSolver<Dim, kFields>& batch) {
  std::vector<bool> settled(nodes.size());
  for (std::size_t from = 0; from < nodes.size();) {
    std::size_t to = from;
    CHECK(batch.is_empty());
    for (; to < nodes.size() && !batch.is_full(); ++to) {
      CHECK(batch.count() == static_cast<int>(to - from));
      const int lane = batch.begin_node();
      CHECK(lane == static_cast<int>(to - from));
      for (int k = 0; k < kFields; ++k)
        batch.set_field(lane, k, nodes[to].velocity[index(k)], nodes[to].inverse_mass[index(k)]);
      for (const auto& c : nodes[to].contacts) {
        CHECK(!batch.has(lane, c.a, c.b));
        batch.add_contact(lane, c.a, c.b, c.normal, nodes[to].reduced_mass(c), c.target_approach, rule_of(c),
                          c.law);
        CHECK(batch.has(lane, c.b, c.a));
      }
    }
    const unsigned bits = batch.solve(true);
    CHECK((bits >> (to - from)) == 0);
    for (std::size_t k = from; k < to; ++k) {
      const int lane = static_cast<int>(k - from);
      settled[k] = bits >> lane & 1;
      for (auto& c : nodes[k].contacts) {
        c.impulse = batch.impulse(lane, c.a, c.b);
        CHECK(batch.impulse(lane, c.b, c.a) == -c.impulse);
      }
    }
    from = to;
  }
  return settled;
}

/// Fields with contacts between most of their pairs; normals lie near those of bodies around a place.
template <int Dim>
PlainNode<Dim> random_node(int fields, double orders, Draw& draw) {
  PlainNode<Dim> node;
  std::vector<Vec<Dim>> place;
  for (int k = 0; k < fields; ++k) {
    place.push_back(uniform(draw, 0.5, 2) * random_direction<Dim>(draw));
    node.velocity.push_back(uniform(draw, 0, 1) * random_direction<Dim>(draw) - place.back());
    node.inverse_mass.push_back(std::pow(10.0, uniform(draw, 0, orders)));
  }
  if (uniform(draw, 0, 1) < 0.25) node.inverse_mass[index(static_cast<int>(uniform(draw, 0, fields)))] = 0;
  for (int a = 0; a < fields; ++a)
    for (int b = a + 1; b < fields; ++b) {
      if (uniform(draw, 0, 1) < 0.1) continue;
      const bool turns = uniform(draw, 0, 1) < 0.5;
      const Vec<Dim> normal = (place[index(b)] - place[index(a)]).normalized();
      PlainContact<Dim> c{turns ? b : a, turns ? a : b, turns ? Vec<Dim>(-normal) : normal};
      node.contacts.push_back(c);
    }
  std::shuffle(node.contacts.begin(), node.contacts.end(), draw);
  return node;
}

/// With all that the step's one set may ask.
template <int Dim>
PlainNode<Dim> asked_node(int fields, double orders, double friction, Draw& draw) {
  PlainNode<Dim> node = random_node<Dim>(fields, orders, draw);
  for (auto& c : node.contacts) {
    const auto odds = [&](double share) { return uniform(draw, 0, 1) < share; };
    c.acts = !odds(0.1);
    c.bilateral = odds(0.2);
    c.must_stick = c.bilateral && odds(0.6);
    c.friction = friction > 0;
    c.target_approach = odds(0.4) ? uniform(draw, 0, 0.4) : 0;
    c.law = {uniform(draw, 0, friction), odds(0.3) ? uniform(draw, friction, 1.5 * friction) : 0};
  }
  return node;
}

/// The velocities without friction are those of sweeps until nothing changes: there is one solution.
template <int Dim, int kFields>
void check_without_friction() {
  CAPTURE(Dim);
  CAPTURE(kFields);
  Draw draw(20 + kFields);
  NodeSolver<Dim> solver;
  LaneSolver<Dim, kFields> batch;
  std::vector<PlainNode<Dim>> nodes;
  for (int k = 0; k < 29; ++k) nodes.push_back(asked_node<Dim>(kFields, 1, 0, draw));
  std::vector<PlainNode<Dim>> lanes = nodes;
  const auto settled = solve_lanes(lanes, batch);
  int settles = 0, compared = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    PlainNode<Dim> plain = nodes[k];
    if (!plain.sweep_all()) continue;  // some gaps cannot close at once
    ++compared;
    CHECK(solve_one(nodes[k], solver).settled);
    settles += settled[k];
    const auto expected = plain.after(), found = nodes[k].after(), together = lanes[k].after();
    for (std::size_t f = 0; f < expected.size(); ++f) {
      CHECK((found[f] - expected[f]).norm() < 1e-7);
      if (settled[k]) CHECK((together[f] - expected[f]).norm() < 1e-7);
    }
  }
  CHECK(compared >= 24);
  CHECK(settles >= compared - 3);
}

TEST_CASE("nodes of two to five fields without friction move as sweeps until nothing changes have them") {
  check_without_friction<2, 2>();
  check_without_friction<2, 3>();
  check_without_friction<2, 4>();
  check_without_friction<2, 5>();
  check_without_friction<3, 2>();
  check_without_friction<3, 3>();
  check_without_friction<3, 4>();
  check_without_friction<3, 5>();
}

/// With friction each contact has what its law demands of the velocities that all contacts leave.
template <int Dim, int kFields>
void check_with_friction() {
  CAPTURE(Dim);
  CAPTURE(kFields);
  Draw draw(40 + kFields);
  NodeSolver<Dim> solver;
  LaneSolver<Dim, kFields> batch;
  std::vector<PlainNode<Dim>> nodes;
  constexpr int kNodes = 61;
  for (int k = 0; k < kNodes; ++k) nodes.push_back(asked_node<Dim>(kFields, 1, 0.15, draw));
  std::vector<PlainNode<Dim>> lanes = nodes;
  const auto settled = solve_lanes(lanes, batch);
  int together = 0, one = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (solve_one(nodes[k], solver).settled) {
      ++one;
      CHECK(nodes[k].missing() <= 1e-7 * nodes[k].largest());
    }
    if (settled[k]) {
      ++together;
      CHECK(lanes[k].missing() <= 1e-7 * lanes[k].largest());
    }
  }
  CHECK(one >= kNodes / 2);                                         // the other friction jams
  if (Dim == 2 || kFields <= 3) CHECK(together >= kNodes * 2 / 5);  // slips that turn take lanes more sweeps
}

TEST_CASE("nodes of two to five fields with friction obey all their laws at once") {
  check_with_friction<2, 2>();
  check_with_friction<2, 3>();
  check_with_friction<2, 4>();
  check_with_friction<2, 5>();
  check_with_friction<3, 2>();
  check_with_friction<3, 3>();
  check_with_friction<3, 4>();
  check_with_friction<3, 5>();
}

/// Blocks one on the other on a rigid floor that they fall on, as fast as each other; with `slope` each moves
/// along the floor faster than that below it.
template <int Dim>
PlainNode<Dim> stack(int fields, double speed, double faster, double friction, Draw& draw) {
  const Vec<Dim> up = random_direction<Dim>(draw);
  const Vec<Dim> across = rotation_to<Dim>(up, draw).col(1);
  std::vector<int> number(index(fields));
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), draw);
  PlainNode<Dim> node;
  node.velocity.resize(index(fields));
  node.inverse_mass.resize(index(fields));
  for (int k = 0; k < fields; ++k) {
    node.inverse_mass[index(number[index(k)])] = k == 0 ? 0 : std::pow(10.0, uniform(draw, -1, 2));
    node.velocity[index(number[index(k)])] =
        k == 0 ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(-speed * up + k * faster * across);
  }
  for (int k = 0; k + 1 < fields; ++k) {
    const int below = number[index(k)], above = number[index(k + 1)];
    const bool turns = uniform(draw, 0, 1) < 0.5;
    PlainContact<Dim> c{turns ? above : below, turns ? below : above, turns ? Vec<Dim>(-up) : up};
    c.law = {friction, 0};
    double weight = 0;  // all that lies above
    for (int l = k + 1; l < fields; ++l) weight += 1 / node.inverse_mass[index(number[index(l)])];
    const Vec<Dim> on_below = weight * (-speed * up + std::min(friction * speed, 1e3) * across);
    c.impulse = turns ? Vec<Dim>(-on_below) : on_below;
    node.contacts.push_back(c);
  }
  std::shuffle(node.contacts.begin(), node.contacts.end(), draw);
  return node;
}

template <int Dim, int kFields>
void check_stacks() {
  CAPTURE(Dim);
  CAPTURE(kFields);
  Draw draw(60 + kFields);
  NodeSolver<Dim> solver;
  LaneSolver<Dim, kFields> batch;
  std::vector<PlainNode<Dim>> nodes;
  for (int k = 0; k < 21; ++k)
    nodes.push_back(stack<Dim>(kFields, uniform(draw, 0.5, 2), 5, k % 3 ? uniform(draw, 0, 0.8) : 0, draw));
  std::vector<PlainNode<Dim>> lanes = nodes;
  const auto settled = solve_lanes(lanes, batch);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const PlainNode<Dim> expected = nodes[k];
    CHECK(expected.missing() < 1e-9 * expected.largest());
    const Solved found = solve_one(nodes[k], solver);
    CHECK(found.settled);
    CHECK(settled[k]);
    CHECK(found.asked <= 10 * (kFields - 1));  // the leap goes there: masses span three orders
    for (std::size_t c = 0; c < expected.contacts.size(); ++c) {
      const Vec<Dim>& impulse = expected.contacts[c].impulse;
      CHECK((nodes[k].contacts[c].impulse - impulse).norm() < 1e-8 * expected.largest());
      CHECK((lanes[k].contacts[c].impulse - impulse).norm() < 1e-8 * expected.largest());
    }
  }
}

TEST_CASE("blocks that slide on each other in a stack press and drag by what lies above, within few sweeps") {
  check_stacks<2, 2>();
  check_stacks<2, 3>();
  check_stacks<2, 4>();
  check_stacks<2, 5>();
  check_stacks<3, 2>();
  check_stacks<3, 3>();
  check_stacks<3, 4>();
  check_stacks<3, 5>();
}

TEST_CASE_TEMPLATE("pairs that are all held whichever way they go need one leap, whatever their masses", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(80);
  NodeSolver<Dim> solver;
  for (int trial = 0; trial < 60; ++trial) {
    const int fields = 3 + trial % 10;
    PlainNode<Dim> node = random_node<Dim>(fields, 2, draw);
    const bool sticks = trial % 2;
    std::erase_if(node.contacts, [&](const auto& c) { return std::abs(c.a - c.b) > 1; });  // a chain
    if (node.contacts.size() < 2) continue;
    for (auto& c : node.contacts) {
      c.bilateral = true;
      c.must_stick = sticks;
      c.target_approach = uniform(draw, -0.5, 0.5);
      c.friction = false;
    }
    const Solved found = solve_one(node, solver);
    const int contacts = static_cast<int>(node.contacts.size());
    CHECK(found.settled);
    CHECK(found.asked <= (sticks ? 3 : 2) * contacts);  // and once whether all stick
    const auto after = node.after();
    for (const auto& c : node.contacts) {
      const Vec<Dim> slip = after[index(c.b)] - after[index(c.a)];
      CHECK(std::abs(slip.dot(c.normal) + c.target_approach) < 1e-7);
      if (sticks) CHECK((slip + c.target_approach * c.normal).norm() < 1e-7);
    }
  }
}

/// All pairs in contact, with normals that no bodies could have: they jam in rings, and hardly any settles.
template <int Dim>
PlainNode<Dim> jam(int fields, double friction, Draw& draw) {
  PlainNode<Dim> node = asked_node<Dim>(fields, 3, friction, draw);
  for (auto& c : node.contacts) c.normal = random_direction<Dim>(draw);
  return node;
}

TEST_CASE_TEMPLATE(
    "in other units, or with fields of contacts named the other way, impulses are the same bits", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(82);
  NodeSolver<Dim> solver;
  int unsettled = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const bool jams = trial % 2;
    PlainNode<Dim> node =
        jams ? jam<Dim>(3 + trial % 4, 0.5, draw) : asked_node<Dim>(3 + trial % 3, 3, 0.3, draw);
    const PlainNode<Dim> posed = node;
    const bool settled = solve_one(node, solver).settled;
    unsettled += !settled;
    for (const double mass : {0x1p-30, 0x1p30})
      for (const double speed : {0x1p-20, 0x1p20}) {
        PlainNode<Dim> other = posed;
        for (double& inverse : other.inverse_mass) inverse /= mass;
        for (auto& v : other.velocity) v *= speed;
        for (auto& c : other.contacts) {
          c.target_approach *= speed;
          if (speed < 1) std::swap(c.a, c.b), c.normal = -c.normal;
        }
        CHECK(solve_one(other, solver).settled == settled);
        for (std::size_t k = 0; k < node.contacts.size(); ++k)
          CHECK(other.contacts[k].impulse == (speed < 1 ? -1 : 1) * mass * speed * node.contacts[k].impulse);
      }
  }
  CHECK(unsettled > 5);
}

TEST_CASE("lanes of nodes in other units get the same bits") {
  Draw draw(83);
  LaneSolver<3, 4> batch;
  std::vector<PlainNode<3>> nodes, others;
  for (int k = 0; k < 40; ++k) {
    nodes.push_back(asked_node<3>(4, 3, 0.3, draw));
    others.push_back(nodes.back());
    for (double& inverse : others.back().inverse_mass) inverse *= 0x1p30;
    for (auto& v : others.back().velocity) v *= 0x1p12;
    for (auto& c : others.back().contacts) c.target_approach *= 0x1p12;
  }
  CHECK(solve_lanes(nodes, batch) == solve_lanes(others, batch));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (std::size_t c = 0; c < nodes[k].contacts.size(); ++c)
      CHECK(others[k].contacts[c].impulse == 0x1p-18 * nodes[k].contacts[c].impulse);
}

TEST_CASE_TEMPLATE("jams conserve momentum, and give no more energy than there was", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(84);
  NodeSolver<Dim> solver;
  for (int trial = 0; trial < 60; ++trial) {
    PlainNode<Dim> node = jam<Dim>(3 + trial % 6, 0.5, draw);
    for (auto& c : node.contacts) c.target_approach = 0, c.must_stick = false;
    solve_one(node, solver);
    const auto after = node.after();
    double energy = 0, before = 0, taken = 0;
    for (std::size_t k = 0; k < after.size(); ++k)
      if (node.inverse_mass[k] > 0) {
        const Vec<Dim> ground = [&] {  // the rigid field's, of which energies are seen
          for (std::size_t l = 0; l < after.size(); ++l)
            if (node.inverse_mass[l] == 0) return node.velocity[l];
          return Vec<Dim>(Vec<Dim>::Zero());
        }();
        energy += 0.5 * (after[k] - ground).squaredNorm() / node.inverse_mass[k];
        before += 0.5 * (node.velocity[k] - ground).squaredNorm() / node.inverse_mass[k];
      }
    for (const auto& c : node.contacts) taken += c.impulse.dot(after[index(c.b)] - after[index(c.a)]);
    CHECK(energy <= before * (1 + 1e-9));
    CHECK(taken >= -1e-9 * before);
  }
}

TEST_CASE("a node of one contact asks its law once, also where it closes a gap between fields at rest") {
  Draw draw(85);
  NodeSolver<3> solver;
  for (int trial = 0; trial < 20; ++trial) {
    PlainNode<3> node;
    node.velocity.assign(2, trial % 2 ? Vec<3>(1, 2, 3) : Vec<3>(Vec<3>::Zero()));
    node.inverse_mass = {uniform(draw, 0.1, 2), uniform(draw, 0.1, 2)};
    PlainContact<3> c{0, 1, random_direction<3>(draw)};
    c.target_approach = uniform(draw, 1, 100);
    c.bilateral = true;
    node.contacts.push_back(c);
    const Solved found = solve_one(node, solver);
    CHECK(found.settled);
    CHECK(found.asked == 1);
    CHECK(node.missing() <= 1e-12 * node.largest());
    CHECK(node.contacts[0].impulse.dot(c.normal) ==
          doctest::Approx(node.reduced_mass(c) * c.target_approach));
  }
}

// Two pairs.

/// The tangential impulse that a law carries, from its formula.
double plain_limit(const AnyLaw& law, double normal, double stick, double reduced_mass, double area_time) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  if (const auto* one = std::get_if<Coulomb>(&law))
    return stick <= one->static_friction * normal ? kAll : one->friction * normal;
  if (const auto* one = std::get_if<Adhesion>(&law)) return one->friction * normal;
  if (const auto* one = std::get_if<Viscous>(&law)) {
    // reduced v = stick − S, S = (η/h) v A Δt
    const double drag = one->viscosity * area_time / one->film;
    return drag * (stick / (reduced_mass + drag));
  }
  if (const auto* one = std::get_if<VelocityFriction>(&law)) {
    const double rest = std::max(one->friction, one->static_friction);
    if (stick <= rest * normal) return kAll;
    double low = 0, high = stick / reduced_mass;  // halved until nothing is left between
    for (int k = 0; k < 100; ++k) {
      const double speed = 0.5 * (low + high);
      const double carried =
          (one->friction + (rest - one->friction) * std::exp(-speed / one->decay_speed)) * normal;
      (reduced_mass * speed + carried < stick ? low : high) = speed;
    }
    return stick - reduced_mass * low;
  }
  return std::holds_alternative<Frictionless>(law) ? 0 : kAll;
}

/// What a law makes of one pair.
template <int Dim>
Vec<Dim> plain_pair(const AnyLaw& law, const Vec<Dim>& stick, const Vec<Dim>& normal, double separation,
                    double reduced_mass, double area_time) {
  if (std::holds_alternative<Perfect>(law)) return stick;
  if (std::holds_alternative<Ignore>(law) || has_springs(law)) return Vec<Dim>::Zero();
  const double along = stick.dot(normal), needed = (stick - along * normal).norm();
  if (const auto* bond = std::get_if<Adhesion>(&law); bond && separation < bond->reach * bond->cell) {
    const double holds_tension = bond->normal_strength * area_time,
                 holds_shear = bond->shear_strength * area_time;
    const bool holds = along > 0 ? std::pow(along / holds_tension, 2) + std::pow(needed / holds_shear, 2) <= 1
                                 : needed <= holds_shear - bond->friction * along;
    if (holds) return stick;
  }
  if (separation >= 0 || along >= 0) return Vec<Dim>::Zero();
  const double limit = plain_limit(law, -along, needed, reduced_mass, area_time);
  const Vec<Dim> tangential = stick - along * normal;
  return along * normal + (needed <= limit ? 1 : limit / needed) * tangential;
}

/// Each law with parameters drawn.
AnyLaw drawn_law(int kind, Draw& draw) {
  const double friction = uniform(draw, 0, 0.6), rest = uniform(draw, 0, 1);
  switch (kind) {
    case 0:
      return Coulomb{friction, 0};
    case 1:
      return Coulomb{friction, friction + 0.5 * rest};
    case 2:
      return Frictionless{};
    case 3:
      return Stick{};
    case 4:
      return Perfect{};
    case 5:
      return VelocityFriction{friction, rest, uniform(draw, 0.1, 3)};
    case 6:
      return Viscous{uniform(draw, 0, 3), uniform(draw, 0.2, 2)};
    case 7:
      return Adhesion{friction, uniform(draw, 0.5, 4), uniform(draw, 0.5, 4), uniform(draw, 0.01, 0.2),
                      uniform(draw, 0.5, 2)};
    case 8:
      return Ignore{};
    case 9:
      return Interface{};
    case 10:
      return NonlinearInterface{};
    default:
      return Cohesive{};
  }
}

TEST_CASE_TEMPLATE("each law makes of a pair what its formula says, in contact, apart and in tension", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(90);
  for (int trial = 0; trial < 2400; ++trial) {
    const AnyLaw law = drawn_law(trial % 12, draw);
    const Vec<Dim> stick = uniform(draw, 0, 3) * random_direction<Dim>(draw),
                   normal = random_direction<Dim>(draw);
    const double separation = uniform(draw, -0.2, 0.2), reduced_mass = uniform(draw, 0.2, 2),
                 area_time = uniform(draw, 0.1, 1);
    const Vec<Dim> found = std::visit(
        [&](const auto& one) {
          return resolve_pair<Dim>(stick, normal, separation, one, reduced_mass, area_time);
        },
        law);
    const Vec<Dim> expected = plain_pair<Dim>(law, stick, normal, separation, reduced_mass, area_time);
    CAPTURE(law.index());
    CHECK((found - expected).norm() < 1e-12 * (1 + stick.norm()));
  }
}

TEST_CASE_TEMPLATE("two pairs that share a field on any side, or none, obey any two laws at once", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(91);
  int settled = 0, trials = 0;
  for (int trial = 0; trial < 490; ++trial, ++trials) {
    const bool shared = trial % 5 != 0;
    const double mass[4] = {uniform(draw, 0.2, 2), uniform(draw, 0.2, 2), uniform(draw, 0.1, 2),
                            uniform(draw, 0.2, 2)};
    Vec<Dim> velocity[4];
    for (auto& v : velocity) v = uniform(draw, 0, 3) * random_direction<Dim>(draw);
    const AnyLaw law[2] = {drawn_law(trial % 7, draw), drawn_law(trial / 7 % 7, draw)};
    int a[2], b[2];
    PairContact<Dim> pair[2];
    for (int k = 0; k < 2; ++k) {
      const int other = shared ? 2 : 2 + k;
      const bool turns = uniform(draw, 0, 1) < 0.5;
      a[k] = turns ? other : k;
      b[k] = turns ? k : other;
      pair[k].normal = random_direction<Dim>(draw);
      pair[k].jump = velocity[b[k]] - velocity[a[k]];
      pair[k].inverse_mass = 1 / mass[a[k]] + 1 / mass[b[k]];
      pair[k].area_time = uniform(draw, 0.1, 1);
    }
    const double coupling = !shared ? 0 : (a[0] == 2) == (a[1] == 2) ? 1 / mass[2] : -1 / mass[2];
    if (!solve_two_pairs(pair, coupling, law[0], law[1])) continue;
    ++settled;
    for (int k = 0; k < 2; ++k) {
      velocity[a[k]] += pair[k].impulse / mass[a[k]];
      velocity[b[k]] -= pair[k].impulse / mass[b[k]];
    }
    for (int k = 0; k < 2; ++k) {
      CAPTURE(law[k].index());
      const Vec<Dim> slip = velocity[b[k]] - velocity[a[k]];
      CHECK((slip - pair[k].slip).norm() < 1e-10);
      const double reduced_mass = 1 / pair[k].inverse_mass;
      const Vec<Dim> demand = pair[k].impulse + reduced_mass * slip;
      const Vec<Dim> expected =
          plain_pair<Dim>(law[k], demand, pair[k].normal, -1, reduced_mass, pair[k].area_time);
      CHECK((pair[k].impulse - expected).norm() < 1e-8 * (1 + pair[k].impulse.norm()));
    }
  }
  CHECK(settled >= trials * 9 / 10);
}

}  // namespace
