// The overlap of random domains, against a plain sum over all pairs.

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "engine/output/first_overlaps.hpp"
#include "engine/output/overlap.hpp"
#include "tests/random.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;
using mpmfast::test::Random;

namespace {

std::vector<Vec<2>> corners_of(const ParticleDomain& domain) {
  std::vector<Vec<2>> out;
  for (const auto& [a, b] : std::array<std::array<int, 2>, 4>{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}})
    out.push_back(domain.centre + a * domain.edges.col(0) + b * domain.edges.col(1));
  if (domain.edges.determinant() < 0) std::reverse(out.begin(), out.end());
  return out;
}

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

double area_of(const std::vector<Vec<2>>& polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    twice += cross(polygon[k], polygon[(k + 1) % polygon.size()]);
  return 0.5 * twice;
}

/// What of one polygon lies on the left of all sides of another.
double plain_common_area(const ParticleDomain& p, const ParticleDomain& q) {
  std::vector<Vec<2>> polygon = corners_of(p);
  const std::vector<Vec<2>> sides = corners_of(q);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec<2> from = sides[k], along = sides[(k + 1) % 4] - from;
    std::vector<Vec<2>> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double of_a = cross(along, a - from), of_b = cross(along, b - from);
      if (of_a >= 0) kept.push_back(a);
      if (of_a * of_b < 0) kept.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
    polygon = kept;
  }
  return area_of(polygon);
}

bool plain_holds(const ParticleDomain& q, const Vec<2>& x) {
  const std::vector<Vec<2>> sides = corners_of(q);
  for (std::size_t k = 0; k < 4; ++k)
    if (cross(sides[(k + 1) % 4] - sides[k], x - sides[k]) < 0) return false;
  return true;
}

struct Plain {
  double area = 0, inside = 0;
  std::uint64_t particles = 0;
  std::set<std::pair<int, int>> owners;  ///< of a particle inside, and of the domain around it
};

Plain plain_overlap(const std::vector<ParticleDomain>& domains) {
  Plain sum;
  for (std::size_t p = 0; p < domains.size(); ++p) {
    bool inside = false;
    for (std::size_t q = 0; q < domains.size(); ++q) {
      if (domains[p].owner == domains[q].owner) continue;
      if (q > p) sum.area += plain_common_area(domains[p], domains[q]);
      if (!plain_holds(domains[q], domains[p].centre)) continue;
      inside = true;
      sum.owners.insert({domains[p].owner, domains[q].owner});
    }
    if (!inside) continue;
    ++sum.particles;
    sum.inside += area_of(corners_of(domains[p]));
  }
  return sum;
}

void check_same(const Overlap& overlap, const Plain& plain) {
  CHECK(overlap.area == doctest::Approx(plain.area).epsilon(1e-11));
  CHECK(overlap.inside == doctest::Approx(plain.inside).epsilon(1e-11));
  CHECK(overlap.particles_inside == plain.particles);
  CHECK(
      (plain.particles > 0 ? plain.owners.count(overlap.owners) == 1 : overlap.owners == std::pair(-1, -1)));
}

TEST_CASE("an overlap of random domains is the sum over all pairs, of few owners and of many, near and far") {
  int some = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const int owners = std::array{2, 3, 7, 31, 32, 33, 34, 60}[seed % 8], count = 20 + random.below(120);
    const double wide = random.in(1, 25), high = seed % 3 == 0 ? 0.3 : random.in(1, 25),
                 long_edge = random.in(0.2, 3);
    const double left = random.in(-100, 100), bottom = random.in(-100, 100);
    std::vector<ParticleDomain> domains;
    for (int k = 0; k < count; ++k) {
      const double size = k % 11 == 0 ? long_edge : 0.5;
      Mat<2> edges;
      edges << random.in(-size, size), random.in(-size, size), random.in(-size, size), random.in(-size, size);
      // Of two owners in halves of the plane that meet, so that many domains are near no other owner's.
      const double x = random.in(0, wide);
      const int owner = owners == 2 ? (x > 0.5 * wide ? 1 : 0) : random.below(owners);
      domains.push_back({{left + x, bottom + random.in(0, high)}, edges, owner});
    }
    const Plain plain = plain_overlap(domains);
    some += plain.particles > 0;
    check_same(measure_overlap(domains, 1), plain);
  }
  CHECK(some > 20);
}

TEST_CASE(
    "the overlap of particles is that of their domains, boundary points left out, and a search ends early") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Random random(100 + seed);
    const std::size_t n = 60;
    Particles<2> particles;
    std::vector<Quantity> quantities{Quantity::position};
    if (seed % 4 != 3) quantities.push_back(Quantity::deformation_gradient);
    if (seed % 2 == 0) quantities.push_back(Quantity::domain_share);
    particles.allocate(n, quantities);
    const std::vector<std::uint32_t> order = shuffled(n);
    const std::vector<BodyView<2>> bodies{
        {{0.3, 0.5}, 0, false, {}}, {{0.4, 0.2}, 0, false, {}}, {{0.6, 0.3}, 0, false, {}}};
    const std::vector<int> owner = seed % 3 == 0 ? std::vector{4, 9, 9} : std::vector{0, 1, 2};
    Surfaces<2> surfaces;
    if (seed % 5 == 0) {  // the last of the second body
      surfaces.bodies = {{0, 0, 0}, {50, 0, 4}, {0, 0, 0}};
      surfaces.point_body = {1, 1, 1, 1};
    }
    std::vector<ParticleDomain> domains(n);
    std::vector<bool> is_left_out(n);
    for (std::size_t p = 0; p < n; ++p) {
      const std::size_t id = order[p];
      particles.id()[p] = order[p];
      particles.body()[p] = static_cast<std::uint16_t>(id % 3);
      Mat<2> f = Mat<2>::Identity();
      for (int d = 0; d < 2; ++d) particles.column(Quantity::position, d)[p] = random.in(0, d == 0 ? 9 : 4);
      if (particles.has(Quantity::deformation_gradient))
        for (int k = 0; k < 4; ++k)
          particles.column(Quantity::deformation_gradient, k)[p] = f(k / 2, k % 2) += random.in(-0.7, 0.7);
      const BodyView<2>& body = bodies[id % 3];
      for (int d = 0; d < 2; ++d) {
        double share = 1;
        if (particles.has(Quantity::domain_share))
          particles.column(Quantity::domain_share, d)[p] = share = random.in(0.25, 1);
        f.col(d) *= share * body.half_size[d];
      }
      domains[id] = {particles.vector(Quantity::position, p), f, owner[id % 3]};
      is_left_out[id] = seed % 5 == 0 && id % 3 == 1 && id >= 50;
    }
    for (std::size_t id = n; id-- > 0;)
      if (is_left_out[id]) domains.erase(domains.begin() + static_cast<std::ptrdiff_t>(id));
    const Plain plain = plain_overlap(domains);
    check_same(measure_overlap(particles, bodies, owner, surfaces, 1), plain);
    const std::vector<ParticleDomain> listed = particle_domains(particles, bodies, owner, surfaces);
    REQUIRE(listed.size() == domains.size());
    double area = 0;
    for (std::size_t k = 0; k < listed.size(); ++k) {
      CHECK(listed[k].owner == domains[k].owner);
      CHECK(listed[k].centre == domains[k].centre);
      CHECK(listed[k].edges.isApprox(domains[k].edges, 1e-13));
      area += std::abs(area_of(corners_of(domains[k])));
    }
    CHECK(area_of_domains(particles, bodies, surfaces) == doctest::Approx(area).epsilon(1e-12));
    std::set<std::pair<int, int>> pairs;
    for (const auto& [a, b] : plain.owners) pairs.insert(std::minmax(a, b));
    for (const std::size_t most : {0, 1, 2, 3}) {
      const FirstOverlaps first = first_overlaps(particles, bodies, owner, surfaces, most, 1);
      // One particle stands for one pair of owners, so that some may not be met.
      if (pairs.size() <= most) CHECK(first.all);
      if (most == 0) CHECK(first.all == pairs.empty());
      if (first.all) check_same(first.overlap, plain);
      if (!first.all) CHECK(first.overlap.particles_inside > 0);
    }
  }
}

}  // namespace
