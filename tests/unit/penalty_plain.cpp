/// Penalty contact against a plain recount that projects every point of every facet on every facet of every
/// other body.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/contact/penalty/penalty.hpp"
#include "kernels/contact/closest_point.hpp"
#include "tests/support.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Parameters of a scene.
struct Parameters {
  double cell, stiffness, tangential;
  std::vector<double> modulus;  ///< K + 4G/3 by body, Pa; 0: rigid
  AnyLaw law;
};

template <int Dim>
class Recount {
 public:
  std::vector<Vec<Dim>> force;
  double friction_work = 0, stored = 0, area = 0;
  Vec<Dim> on_first = Vec<Dim>::Zero();  ///< N, on body 0
  int contacts = 0;

  Recount(const Surfaces<Dim>& surfaces, const Parameters& parameters)
      : surfaces_(surfaces), parameters_(parameters) {}

  void compute_forces(const std::vector<Vec<Dim>>& now, double elapsed) {
    if (before_.empty()) before_ = now;
    now_ = now;
    force.assign(now.size(), Vec<Dim>::Zero());
    friction_work = stored = area = contacts = 0;
    on_first.setZero();
    elapsed_ = elapsed;
    find_normals();
    restored_ = std::exchange(springs_, {});
    for (std::size_t f = 0; f < surfaces_.facets.size(); ++f)
      for (int k = 0; k < (Dim == 2 ? 2 : 1); ++k)
        for (int body = 0; body < static_cast<int>(surfaces_.bodies.size()); ++body)
          if (body != surfaces_.facets[f].body) find_contacts(f, k, body);
    before_ = now_;
  }

 private:
  using Facet = typename Surfaces<Dim>::Facet;
  struct Near {
    std::size_t facet;
    ClosestPoint<Dim> closest;
  };
  struct Spring {
    bool slides = false;
    Vec<Dim> stretch = Vec<Dim>::Zero();
  };
  using Place = std::array<int, 3>;  ///< a facet, its point, a patch

  Vec<Dim> normal_of(std::size_t f) const {
    const Facet& one = surfaces_.facets[f];
    const Vec<Dim> edge = at(one, 1) - at(one, 0);
    if constexpr (Dim == 2)
      return Vec<2>(edge[1], -edge[0]) / edge.norm();
    else
      return edge.cross(at(one, 2) - at(one, 0)).normalized();
  }
  const Vec<Dim>& at(const Facet& facet, std::size_t k) const {
    return now_[static_cast<std::size_t>(facet.point[k])];
  }
  const Vec<Dim>& was_at(const Facet& facet, std::size_t k) const {
    return before_[static_cast<std::size_t>(facet.point[k])];
  }
  void find_normals() {
    normal_.clear();
    for (const auto& cone : surfaces_.normal_cones) {
      Vec<Dim> sum = Vec<Dim>::Zero();
      for (int k = cone.begin; k < cone.end; ++k)
        sum += normal_of(static_cast<std::size_t>(surfaces_.cone_facets[static_cast<std::size_t>(k)]));
      normal_.push_back(sum.normalized());
    }
  }
  /// Weight of a corner in the k-th point of a facet: two Gauss points of a segment, the centroid of a
  /// triangle.
  static double share(int k, int corner) {
    if (Dim == 3) return 1.0 / 3;
    return k == corner ? 0.5 + 0.5 / std::sqrt(3.0) : 0.5 - 0.5 / std::sqrt(3.0);
  }

  std::optional<ClosestPoint<Dim>> project_onto(const Vec<Dim>& x, const Facet& facet) const {
    std::array<Vec<Dim>, Dim> corner, normal;
    std::array<bool, Dim> ends;
    for (std::size_t k = 0; k < Dim; ++k) {
      corner[k] = at(facet, k);
      normal[k] = normal_[static_cast<std::size_t>(facet.normal_cone[k])];
      ends[k] = facet.joint[k] != Joint::smooth;
    }
    auto closest = project_onto_facet(x, corner, normal, ends, parameters_.cell);
    if (closest && closest->at_crease) {
      if constexpr (Dim == 2) {
        closest->convex = facet.joint[closest->weight[0] > 0 ? 0 : 1] == Joint::convex;
      } else {
        std::size_t edge = 0;  // opposite the corner without weight
        while (edge < 2 && closest->weight[edge] != 0) ++edge;
        closest->convex = facet.joint[edge] == Joint::convex;
      }
    }
    return closest;
  }

  void find_contacts(std::size_t own, int k, int body) {
    const Facet& facet = surfaces_.facets[own];
    Vec<Dim> x = Vec<Dim>::Zero();
    for (int c = 0; c < Dim; ++c) x += share(k, c) * at(facet, static_cast<std::size_t>(c));
    std::map<int, Near> nearest;  // by patch
    for (std::size_t f = 0; f < surfaces_.facets.size(); ++f) {
      const Facet& other = surfaces_.facets[f];
      if (other.body != body || (at(other, 0) - x).norm() > 4 * parameters_.cell) continue;
      const auto closest = project_onto(x, other);
      if (!closest) continue;
      const auto found = nearest.find(other.patch);
      if (found == nearest.end())
        nearest.emplace(other.patch, Near{f, *closest});
      else if (closest->distance < found->second.closest.distance)
        found->second = {f, *closest};
    }
    if (nearest.empty()) return;
    const Near* first = nullptr;
    for (const auto& [patch, near] : nearest)
      if (!first || near.closest.distance < first->closest.distance) first = &near;
    if (!(first->closest.distance > 0) ||
        (first->closest.at_crease ? first->closest.convex : !first->closest.inside))
      return;
    // 1/d² = Σ 1/d_j², less 1/Δh² for each patch but the nearest; −∂d/∂x = Σ (d/d_j)³ e_j.
    double sum = 0;
    std::vector<std::pair<const Near*, double>> patches;
    for (const auto& [patch, near] : nearest) {
      const double d = near.closest.distance;
      double weight = 1 / (d * d);
      if (&near != first) {
        const bool counts = near.closest.at_crease ? near.closest.convex : near.closest.inside;
        weight = counts && d > 0 && !first->closest.at_crease
                     ? std::max(0.0, weight - 1 / (parameters_.cell * parameters_.cell))
                     : 0;
      }
      sum += weight;
      if (weight > 0) patches.push_back({&near, 0});
    }
    const double depth = 1 / std::sqrt(sum);
    Vec<Dim> way = Vec<Dim>::Zero();
    for (auto& [near, part] : patches) {
      part = patches.size() == 1 ? 1 : std::pow(depth / near->closest.distance, 3);
      way += part * near->closest.exit_direction;
    }
    const double facing = std::max(0.0, -normal_of(own).dot(way.normalized()));
    const double a = parameters_.modulus[static_cast<std::size_t>(facet.body)],
                 b = parameters_.modulus[static_cast<std::size_t>(body)];
    const double softer = a == 0 ? b : b == 0 ? a : std::min(a, b);
    const double by_area = 0.5 * parameters_.stiffness * softer / parameters_.cell;
    const double stiffness = by_area * facing * facet.area / (Dim == 2 ? 2 : 1);
    if (!(stiffness > 0)) return;
    stored += 0.5 * stiffness * depth * depth;
    area += 0.5 * facet.area / (Dim == 2 ? 2 : 1);
    for (const auto& [near, part] : patches)
      add_contact(own, k, x, *near, stiffness, part * depth, stiffness / by_area);
  }

  void add_contact(std::size_t own, int k, const Vec<Dim>& x, const Near& near, double stiffness,
                   double depth, double surface) {
    ++contacts;
    const Facet &facet = surfaces_.facets[own], &other = surfaces_.facets[near.facet];
    const Vec<Dim>& exit = near.closest.exit_direction;
    const Place place{static_cast<int>(own), k, other.patch};
    Vec<Dim> surface_point = Vec<Dim>::Zero(), slip = Vec<Dim>::Zero();
    for (std::size_t c = 0; c < Dim; ++c) {
      surface_point += near.closest.weight[c] * at(other, c);
      slip += share(k, static_cast<int>(c)) * (at(facet, c) - was_at(facet, c)) -
              near.closest.weight[c] * (at(other, c) - was_at(other, c));
    }
    slip -= slip.dot(exit) * exit;
    Vec<Dim> total = stiffness * depth * exit;
    if (const auto* film = std::get_if<Viscous>(&parameters_.law)) {
      if (elapsed_ > 0) {
        const Vec<Dim> drag = 0.5 * film->viscosity / film->film * surface / elapsed_ * slip;
        total -= drag;
        friction_work += drag.dot(slip);
      }
    } else {
      Spring spring;
      const double tangential = parameters_.tangential * stiffness;
      if (const auto found = restored_.find(place); found != restored_.end()) {
        spring = found->second;
        const Vec<Dim> along = spring.stretch - spring.stretch.dot(exit) * exit;
        if (along.norm() > 0) spring.stretch = spring.stretch.norm() / along.norm() * along;
        spring.stretch += slip;
      }
      double limit = 0, speed = elapsed_ > 0 ? slip.norm() / elapsed_ : 0;
      if (const auto* one = std::get_if<Coulomb>(&parameters_.law))
        limit = (spring.slides ? one->friction : std::max(one->friction, one->static_friction)) * stiffness *
                depth;
      if (std::holds_alternative<Stick>(parameters_.law)) limit = HUGE_VAL;
      if (const auto* one = std::get_if<VelocityFriction>(&parameters_.law))
        limit =
            stiffness * depth *
            (one->friction + (one->static_friction - one->friction) * std::exp(-speed / one->decay_speed));
      const double length = spring.stretch.norm(), most = limit / tangential;
      spring.slides = length > most;
      if (spring.slides) {
        friction_work += (length - most) * limit;
        spring.stretch *= most / length;
      }
      stored += 0.5 * tangential * spring.stretch.squaredNorm();
      total -= tangential * spring.stretch;
      springs_[place] = spring;
    }
    for (std::size_t c = 0; c < Dim; ++c) {
      force[static_cast<std::size_t>(facet.point[c])] += share(k, static_cast<int>(c)) * total;
      force[static_cast<std::size_t>(other.point[c])] -= near.closest.weight[c] * total;
    }
    if (facet.body == 0) on_first += total;
    if (other.body == 0) on_first -= total;
    add_couple(other, exit, surface_point - x, total);
  }

  /// Corner forces along the exit direction that sum to zero and have the moment arm × total, in the sense of
  /// least squares.
  void add_couple(const Facet& other, const Vec<Dim>& exit, const Vec<Dim>& arm, const Vec<Dim>& total) {
    const auto add = [&](std::size_t c, double size) {
      force[static_cast<std::size_t>(other.point[c])] += size * exit;
      force[static_cast<std::size_t>(other.point[0])] -= size * exit;
    };
    if constexpr (Dim == 2) {
      const auto cross = [](const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; };
      add(1, cross(arm, total) / cross(at(other, 1) - at(other, 0), exit));
    } else {
      Eigen::Matrix<double, 3, 2> arms;
      arms.col(0) = Vec<3>(at(other, 1) - at(other, 0)).cross(exit);
      arms.col(1) = Vec<3>(at(other, 2) - at(other, 0)).cross(exit);
      const Vec<2> size = (arms.transpose() * arms).inverse() * (arms.transpose() * arm.cross(total));
      add(1, size[0]);
      add(2, size[1]);
    }
  }

  const Surfaces<Dim>& surfaces_;
  Parameters parameters_;
  double elapsed_ = 0;
  std::vector<Vec<Dim>> now_, before_, normal_;
  std::map<Place, Spring> restored_, springs_;
};

bool as_much(double a, double b) { return std::abs(a - b) <= 1e-8 * std::max(std::abs(a), std::abs(b)); }

/// Moves and bends the bodies of a scene at random from step to step, and compares both counts of the forces.
template <int Dim>
void check_recount(const std::string& text, const Parameters& parameters, double bend, int steps,
                   std::uint64_t seed, const Vec<Dim>& approach = Vec<Dim>::Zero()) {
  const Scene scene = scene_from(text);
  Step<Dim> step(scene);
  auto& state = step.state();
  const auto passes = make_passes<Dim>(scene.method.basis);
  Penalty<Dim> penalty(scene, step.plan(), state);
  Recount<Dim> recount(state.surfaces, parameters);
  Draw draw(seed);
  double dt = 0;
  int contacts = 0;
  passes->sort(state);
  for (int k = 0; k < steps; ++k) {
    auto& particles = state.particles;
    const Vec<Dim> shift = parameters.cell * (approach + bend * random_direction<Dim>(draw)),
                   axis = random_direction<Dim>(draw);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec<Dim> x = particles.vector(Quantity::position, p);
      const double phase = x.dot(axis) / (6 * parameters.cell);
      for (int d = 0; d < Dim; ++d)
        particles.column(Quantity::position, d)[p] +=
            (particles.body()[p] == 1 ? shift[d] : 0) +
            0.5 * bend * parameters.cell * std::sin(phase + d) * (k > 0);
    }
    if (k % 3 == 0) {
      passes->sort(state);
      penalty.invalidate_tiles();
    }
    std::vector<Vec<Dim>> now(state.surfaces.points());
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const int number = state.surfaces.number(particles.body()[p], particles.id()[p]);
      if (number >= 0) now[static_cast<std::size_t>(number)] = particles.vector(Quantity::position, p);
    }
    REQUIRE(!penalty.find_contacts(state));
    penalty.compute_forces(state, std::vector<Vec<Dim>>(scene.bodies.size(), Vec<Dim>::Zero()), 1e-6);
    recount.compute_forces(now, k > 0 ? dt : 0);
    contacts += recount.contacts;
    double size = 1e-300, apart = 0;
    for (std::size_t p = 0; p < now.size(); ++p) {
      size = std::max(size, recount.force[p].norm());
      apart = std::max(apart, (penalty.forces()[p] - recount.force[p]).norm());
    }
    CAPTURE(k);
    CHECK(apart <= 1e-8 * size);
    const auto& ledger = penalty.ledger();
    CHECK(as_much(ledger.friction_work, recount.friction_work));
    if (!ledger.pair_impulse.empty()) {
      CHECK((ledger.pair_impulse[0] - 1e-6 * recount.on_first).norm() <= 1e-8 * 1e-6 * size * 100);
      CHECK(as_much(ledger.pair_area[0], recount.area));
      CHECK(as_much(ledger.pair_friction_work[0], recount.friction_work));
    }
    CHECK(as_much(penalty.stored_energy(state), recount.stored));
    ++state.step;
    dt = uniform(draw, 1e-6, 3e-6);
    state.time += dt;
  }
  CHECK(contacts > 10);
}

/// Two bodies of a soft and a hard material, or a rigid one.
std::string pair_of(bool solid, const std::string& a, const std::string& b, const std::string& second,
                    const std::string& law, double stiffness, double tangential) {
  return fmt::format(R"(
space: {}
grid: {{size: {}, cell: 1 mm}}
time: {{end: 1 s}}
materials:
  soft: {{model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
  hard: {{model: neo_hookean, density: 2000 kg/m^3, bulk: 800 MPa, shear: 300 MPa}}
  stiff: {{model: rigid}}
bodies:
  - {{name: a, {}, material: soft}}
  - {{name: b, {}, material: {}}}
method: {{basis: bspline2}}
contact:
  family: penalty
  points_per_cell: {}
  stiffness: {}
  tangential_stiffness: {}
  pairs: [{{between: [a, b], {}}}]
)",
                     solid ? "3d" : "plane_strain", solid ? "[14 mm, 14 mm, 14 mm]" : "[30 mm, 30 mm]", a, b,
                     second, solid ? 2 : 4, stiffness, tangential, law);
}

constexpr double kSoft = 120e6, kHard = 1200e6;

TEST_CASE("forces of plane surfaces are those of every point against every facet, with each law") {
  const char* disk = "disk: {centre: [11 mm, 12 mm], radius: 4 mm}";
  const struct {
    const char *other, *law;
    AnyLaw acts;
  } cases[] = {
      {"disk: {centre: [18.9 mm, 12.6 mm], radius: 4 mm}",
       "law: coulomb, friction: 0.3, static_friction: 0.5", Coulomb{0.3, 0.5}},
      {"box: {from: [9 mm, 15.8 mm], to: [17 mm, 20 mm]}", "law: stick", Stick{}},
      {"polygon: [[14 mm, 8 mm], [20 mm, 7 mm], [21 mm, 15 mm], [14.6 mm, 15 mm], [14.8 mm, 12 mm]]",
       "law: viscous, viscosity: 20 Pa*s, film: 0.1 mm", Viscous{20, 1e-4}},
      {"polygon: [[13 mm, 13 mm], [20 mm, 13.5 mm], [19 mm, 20 mm], [12 mm, 19 mm]]",
       "law: velocity_friction, friction: 0.1, static_friction: 0.6, decay_speed: 5 m/s",
       VelocityFriction{0.1, 0.6, 5}},
      {"disk: {centre: [18.9 mm, 11.2 mm], radius: 4 mm}", "law: frictionless", Frictionless{}},
  };
  std::uint64_t seed = 1;
  for (const auto& one : cases) {
    CAPTURE(seed);
    const double stiffness = 0.5 + 0.3 * static_cast<double>(seed),
                 tangential = 0.4 + 0.2 * static_cast<double>(seed);
    const bool rigid = seed == 5;
    check_recount<2>(
        pair_of(false, disk, one.other, rigid ? "stiff" : "hard", one.law, stiffness, tangential),
        {1e-3, stiffness, tangential, {kSoft, rigid ? 0 : kHard}, one.acts}, 0.02, 8, seed);
    ++seed;
  }
}

TEST_CASE("forces at the corners of boxes are those of every point against every facet") {
  check_recount<2>(pair_of(false, "box: {from: [5 mm, 5 mm], to: [12 mm, 12 mm]}",
                           "box: {from: [11.7 mm, 11.6 mm], to: [18 mm, 18 mm]}", "hard",
                           "law: coulomb, friction: 0.4", 1, 1),
                   {1e-3, 1, 1, {kSoft, kHard}, Coulomb{0.4, 0}}, 0.03, 8, 11);
}

TEST_CASE("forces of bodies that approach from beyond a cell are those of every point against every facet") {
  check_recount<2>(pair_of(false, "disk: {centre: [9 mm, 12 mm], radius: 3 mm}",
                           "polygon: [[13.5 mm, 11 mm], [18 mm, 9 mm], [18 mm, 15 mm], [15 mm, 16 mm]]",
                           "hard", "law: coulomb, friction: 0.2", 1, 1),
                   {1e-3, 1, 1, {kSoft, kHard}, Coulomb{0.2, 0}}, 0.01, 16, 31, Vec<2>(-0.14, 0.01));
}

TEST_CASE("forces of solid surfaces are those of every point against every facet") {
  check_recount<3>(pair_of(true, "box: {from: [4 mm, 4 mm, 4 mm], to: [7 mm, 7 mm, 6 mm]}",
                           "box: {from: [5.6 mm, 5.7 mm, 5.9 mm], to: [8 mm, 8 mm, 8 mm]}", "hard",
                           "law: coulomb, friction: 0.4", 2, 0.7),
                   {1e-3, 2, 0.7, {kSoft, kHard}, Coulomb{0.4, 0}}, 0.02, 4, 21);
  check_recount<3>(
      pair_of(true, "sphere: {centre: [6 mm, 6 mm, 6 mm], radius: 2 mm}",
              "box: {from: [5 mm, 5 mm, 7.8 mm], to: [8 mm, 8 mm, 9 mm]}", "stiff", "law: stick", 1, 1),
      {1e-3, 1, 1, {kSoft, 0}, Stick{}}, 0.02, 4, 22);
}

}  // namespace
}  // namespace mpmfast
