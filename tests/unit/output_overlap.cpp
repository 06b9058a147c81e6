#include "engine/output/overlap.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/support.hpp"
#include "tests/unit/output_fixture.hpp"

namespace mpmfast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Mat<2> matrix(double xx, double xy, double yx, double yy) {
  Mat<2> m;
  m << xx, xy, yx, yy;
  return m;
}

/// The square |u_k| ≤ half about (x, y).
ParticleDomain square(double x, double y, double half, int owner = 0) {
  return {{x, y}, matrix(half, 0, 0, half), owner};
}

/// An n × n lattice of squares that fills (x, x + side) × (y, y + side).
void add_block(std::vector<ParticleDomain>& domains, double x, double y, double side, int n, int owner) {
  const double half = 0.5 * side / n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      domains.push_back(square(x + (2 * i + 1) * half, y + (2 * j + 1) * half, half, owner));
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  ParticleDomain domain(double spread, int owner = 0) {
    const Mat<2> edges = matrix(in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1));
    return {{in(-spread, spread), in(-spread, spread)}, edges, owner};
  }

 private:
  std::mt19937_64 engine_;
};

bool same_bits(const Overlap& a, const Overlap& b) {
  return a.area == b.area && a.inside == b.inside && a.particles_inside == b.particles_inside;
}

TEST_CASE("two squares share a rectangle") {
  CHECK(common_area(square(0, 0, 1), square(1.5, -1.25, 1)) == doctest::Approx(0.5 * 0.75).epsilon(1e-14));
  CHECK(common_area(square(0, 0, 1), square(0.25, 0.5, 0.125)) == doctest::Approx(0.0625).epsilon(1e-14));
  CHECK(common_area(square(0, 0, 1), square(2.5, 0, 1)) == 0);
  CHECK(common_area(square(0, 0, 1), square(2, 2, 1)) == 0);
}

TEST_CASE("a square and the same square turned by 45 degrees share a regular octagon") {
  const double c = std::sqrt(0.5);
  const ParticleDomain turned{{0, 0}, matrix(c, -c, c, c), 0};
  CHECK(common_area(square(0, 0, 1), turned) == doctest::Approx(8 * (std::sqrt(2.0) - 1)).epsilon(1e-14));
}

TEST_CASE("a square and the same square sheared share what the integral over heights gives") {
  // At height y the widths 2 are shifted by γ y: the integral of max(0, 2 − γ |y|) over |y| ≤ 1.
  for (const double shear : {0.3, 1.0, 2.0, 5.0, -5.0}) {
    const ParticleDomain sheared{{0, 0}, matrix(1, shear, 0, 1), 0};
    const double g = std::abs(shear), expected = g <= 2 ? 4 - g : 4 / g;
    CHECK(common_area(square(0, 0, 1), sheared) == doctest::Approx(expected).epsilon(1e-14));
    CHECK(common_area(sheared, square(0, 0, 1)) == doctest::Approx(expected).epsilon(1e-14));
  }
}

TEST_CASE(
    "common areas are symmetric, additive over parts of a domain, and scale with the map of the plane") {
  Random random(3);
  int overlapping = 0;
  for (int k = 0; k < 500; ++k) {
    const ParticleDomain p = random.domain(0.5), q = random.domain(0.5);
    const double common = common_area(p, q), round_off = 1e-12 * (1 + p.area() + q.area());
    overlapping += common > 0;
    CHECK(std::abs(common_area(q, p) - common) < round_off);
    CHECK(std::abs(common_area(p, p) - p.area()) < round_off);
    double parts = 0;
    for (const double u : {-0.5, 0.5})
      for (const double v : {-0.5, 0.5})
        parts += common_area(p, {q.centre + u * q.edges.col(0) + v * q.edges.col(1), 0.5 * q.edges, 0});
    CHECK(std::abs(parts - common) < round_off);
    const Mat<2> map = matrix(1, 3, -2, 0.5);
    const double mapped = common_area({map * p.centre, map * p.edges, 0}, {map * q.centre, map * q.edges, 0});
    CHECK(std::abs(mapped - map.determinant() * common) < map.determinant() * round_off);
  }
  CHECK(overlapping > 250);
}

TEST_CASE("two blocks of many particles overlap by their common rectangle, each pair counted once") {
  std::vector<ParticleDomain> domains;
  add_block(domains, 0, 0, 1, 20, 0);
  add_block(domains, 0.7, 0.4, 1, 13, 1);
  const Overlap overlap = measure_overlap(domains, 1);
  CHECK(overlap.area == doctest::Approx(0.3 * 0.6).epsilon(1e-12));
  // Centres in the rectangle: 6 × 12 of the first block, at 0.725 … and 0.425 …; 4 × 8 of the second, of
  // which four lie on a side between two domains.
  CHECK(overlap.particles_inside == 6 * 12 + 4 * 8);
  CHECK(overlap.inside == doctest::Approx(72 / 400.0 + 32 / 169.0).epsilon(1e-12));
}

TEST_CASE("a place that three bodies claim counts for each of the three pairs; particles inside count once") {
  std::vector<ParticleDomain> domains;
  for (int owner = 0; owner < 3; ++owner) add_block(domains, 0.01 * owner, 0, 1, 5, owner);
  const Overlap overlap = measure_overlap(domains, 1);
  CHECK(overlap.area == doctest::Approx(0.99 + 0.99 + 0.98).epsilon(1e-12));
  CHECK(overlap.particles_inside == 75);
  CHECK(overlap.inside == doctest::Approx(3).epsilon(1e-12));
}

TEST_CASE("bodies that touch do not overlap, nor do domains of one body") {
  std::vector<ParticleDomain> board;
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i) board.push_back(square(0.1 * i, 0.1 * j, 0.05, (i + j) % 2));
  const Overlap touching = measure_overlap(board, 1);
  CHECK(touching.area < 1e-13 * 0.81);
  CHECK(touching.particles_inside == 0);
  std::vector<ParticleDomain> own;
  add_block(own, 0, 0, 1, 4, 7);
  add_block(own, 0.5, 0.5, 1, 4, 7);
  CHECK(same_bits(measure_overlap(own, 1), {}));
  CHECK(same_bits(measure_overlap({}, 1), {}));
}

TEST_CASE("sparse pairs that overlap count once each, also where they are very many") {
  std::vector<ParticleDomain> domains;
  constexpr int kSide = 185;  // more than 2^16 domains, and about as many bins
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      domains.push_back(square(i, j, 0.125, 0));
      domains.push_back(square(i + 0.125, j, 0.125, 1));  // its centre on the edge of the first
    }
  const Overlap overlap = measure_overlap(domains, 1);
  CHECK(overlap.area == doctest::Approx(kSide * kSide * 0.125 * 0.25).epsilon(1e-12));
  CHECK(overlap.inside == doctest::Approx(2 * kSide * kSide * 0.0625).epsilon(1e-12));
  CHECK(overlap.particles_inside == 2 * kSide * kSide);
}

TEST_CASE("an overlap names the owners of a particle inside another's domain, and nobody where none is") {
  const std::vector<ParticleDomain> inside{square(0, 0, 1, 3), square(1.5, 0, 1, 5), square(0, 0.25, 0.5, 7)};
  const std::pair<int, int> owners = measure_overlap(inside, 1).owners;
  CHECK((owners == std::pair(3, 7) || owners == std::pair(7, 3)));
  const std::vector<ParticleDomain> corners{square(0, 0, 1, 3), square(1.5, 1.5, 1, 5)};
  CHECK(measure_overlap(corners, 1).area > 0);
  CHECK(measure_overlap(corners, 1).owners == std::pair(-1, -1));
}

TEST_CASE("domains that are lines, points, far away or not a number spoil nothing") {
  std::vector<ParticleDomain> domains{square(0, 0, 1, 0), square(1.25, 0, 1, 1)};
  domains.push_back({{0, 0}, matrix(1, 1, 1, 1), 2});
  domains.push_back(square(0.5, 0.5, 0, 3));
  domains.push_back(square(1e6, -1e6, 1, 4));
  domains.push_back(square(kNaN, 0, 1, 5));
  domains.push_back({{0, 0}, matrix(kNaN, 0, 0, 1), 6});
  const Overlap overlap = measure_overlap(domains, 1);
  CHECK(overlap.area == doctest::Approx(1.5).epsilon(1e-14));
  // The line and the point.
  CHECK(overlap.particles_inside == 2);
  CHECK(overlap.inside == 0);
  CHECK(same_bits(measure_overlap({square(3, 4, 0, 0), square(3, 4, 0, 1)}, 1), {}));
}

TEST_CASE("a domain that is nowhere changes not a bit of the overlap of others") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (unsigned seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    std::vector<ParticleDomain> domains;
    for (int k = 0; k < 200; ++k) domains.push_back(random.domain(4, k % 2));
    add_block(domains, 50 + random.in(0, 50), 0, 50, 10, 0);  // meets nobody
    const Overlap before = measure_overlap(domains, 1);
    CHECK(before.particles_inside > 0);
    for (const double far : {kNaN, kInfinity, -kInfinity}) {
      CAPTURE(far);
      auto more = domains;
      for (const int owner : {0, 1, 2}) {
        more.push_back(square(far, 0, 1, owner));
        more.push_back(square(0, far, 1, owner));
        more.push_back({{0, 0}, matrix(far, 0, 0, 1), owner});
        more.push_back({{0, 0}, matrix(1, 0, far, 1), owner});
      }
      CHECK(same_bits(measure_overlap(more, 1), before));
    }
  }
}

TEST_CASE("the overlap has the same bits on any number of threads and for any order of the particles") {
  Random random(11);
  std::vector<ParticleDomain> domains;
  for (int k = 0; k < 3000; ++k) domains.push_back(random.domain(30, k % 5));
  const Overlap one = measure_overlap(domains, 1);
  CHECK(one.particles_inside > 100);
  for (const int threads : {2, 3, 7}) CHECK(same_bits(measure_overlap(domains, threads), one));

  const auto of = [](const std::vector<std::uint32_t>& order) {
    const std::vector<BodyView<2>> bodies(3, BodyView<2>{{0.03, 0.05}, 0, false, {}});
    const auto particles = output_test::particles_in_order<2>(order);
    const Overlap listed = measure_overlap(particle_domains(particles, bodies, {0, 1, 2}), 1);
    CHECK(same_bits(measure_overlap(particles, bodies, {0, 1, 2}, {}, 2), listed));
    return listed;
  };
  const Overlap sorted = of(output_test::ascending(2000));
  CHECK(sorted.area > 0);
  CHECK(same_bits(of(output_test::shuffled(2000)), sorted));
}

TEST_CASE("a particle's domain is its undeformed rectangle under F") {
  const auto particles = output_test::particles_in_order<2>({2, 0, 1});
  const std::vector<BodyView<2>> bodies{
      {{1, 2}, 0, false, {}}, {{3, 4}, 0, false, {}}, {{5, 6}, 0, false, {}}};  // body b holds id b
  const auto domains = particle_domains(particles, bodies, {10, 20, 20});
  REQUIRE(domains.size() == 3);
  CHECK(domains[0].owner == 10);
  CHECK(domains[2].owner == 20);
  CHECK(domains[1].centre == particles.vector(Quantity::position, 2));
  CHECK(domains[1].edges == particles.deformation_gradient(2) * Vec<2>(3, 4).asDiagonal());
}

const char* const kTwoBlocks = R"(
space: plane_strain
thickness: 7 m
grid: {size: [10 m, 10 m], cell: 0.5 m}
time: {end: 1 ms}
materials: {m: {model: linear_elastic, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}}
bodies:
  - {name: a, box: {from: [1 m, 1 m], to: [5 m, 5 m]}, material: m}
  - {name: b, box: {from: [4 m, 3 m], to: [8 m, 9 m]}, material: m}
output: {frames: 0, history: 3, overlap: true}
)";

TEST_CASE("the history and the summary of a run state the overlap where the scene asks for it") {
  const test::Outcome outcome = test::run(test::scene_from(kTwoBlocks));
  REQUIRE(outcome.failure == "");
  CHECK(outcome.history.at("overlap_m2").front() == doctest::Approx(2).epsilon(1e-8));  // whatever the depth
  CHECK(outcome.history.at("inside_m2").front() == doctest::Approx(4).epsilon(1e-8));
  REQUIRE(outcome.summary.overlap);
  CHECK(outcome.summary.overlap->area == doctest::Approx(outcome.history.at("overlap_m2").back()));
  CHECK(outcome.summary.overlap->particles_inside > 0);
  const test::Outcome without = test::run(test::scene_from(kTwoBlocks, {{"output.overlap", "false"}}));
  CHECK(without.history.count("overlap_m2") == 0);
  CHECK_FALSE(without.summary.overlap);
  CHECK(without.summary.checksum == outcome.summary.checksum);
}

TEST_CASE("check reports bodies that overlap at the start, and says nothing of bodies that touch") {
  const auto says = [](const std::string& lower) {
    const std::string text = describe_plan(test::scene_from(kTwoBlocks, {{"bodies.1.box.from", lower}}));
    return text.find("  overlap ") == std::string::npos ? "" : text.substr(text.find("  overlap "), 100);
  };
  CHECK(says("[4 m, 3 m]").find("2 m^2, 5 % of all bodies (64 particles lie inside another body, '") !=
        std::string::npos);
  CHECK(says("[5 m, 3 m]") == "");
}

}  // namespace
}  // namespace mpmfast
