/// Contact laws on one node with two fields.

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <utility>

#include "kernels/contact/resolve_pair.hpp"
#include "tests/unit/contact_cloud.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// Two fields on a node.
template <int Dim>
struct Pair {
  double mass_a, mass_b;
  Vec<Dim> momentum_a, momentum_b;

  explicit Pair(Draw& draw) : mass_a(uniform(draw, 0.01, 2)), mass_b(uniform(draw, 0.01, 2)) {
    momentum_a = mass_a * uniform(draw, 0, 5) * random_direction<Dim>(draw);
    momentum_b = mass_b * uniform(draw, 0, 5) * random_direction<Dim>(draw);
  }
  /// Δp_a(0): what gives both one velocity.
  Vec<Dim> stick() const { return mass_a / (mass_a + mass_b) * (momentum_a + momentum_b) - momentum_a; }
  double reduced_mass() const { return mass_a * mass_b / (mass_a + mass_b); }
  double kinetic(const Vec<Dim>& change) const {
    return 0.5 * (momentum_a + change).squaredNorm() / mass_a +
           0.5 * (momentum_b - change).squaredNorm() / mass_b;
  }
  Vec<Dim> velocity_jump(const Vec<Dim>& change) const {
    return (momentum_b - change) / mass_b - (momentum_a + change) / mass_a;
  }
};

template <int Dim, class Law>
void check_dissipation_and_detection(const Law& law) {
  Draw draw(1);
  for (int k = 0; k < 500; ++k) {
    const Pair<Dim> pair(draw);
    const Vec<Dim> n = random_direction<Dim>(draw), stick = pair.stick();
    const Vec<Dim> change = resolve_pair<Dim>(stick, n, -0.1, law, pair.reduced_mass(), 0.3);
    CHECK(pair.kinetic(change) <= pair.kinetic(Vec<Dim>::Zero()) * (1 + 1e-13));
    if (Law::scope != LawScope::contact) continue;
    CHECK(resolve_pair<Dim>(stick, n, 0.0, law) == Vec<Dim>::Zero());
    CHECK(resolve_pair<Dim>(stick, n, 0.1, law) == Vec<Dim>::Zero());
    if (stick.dot(n) >= 0) CHECK(change == Vec<Dim>::Zero());
    // In contact the surfaces no longer approach: the normal velocities are equal.
    if (stick.dot(n) < 0)
      CHECK(std::abs(pair.velocity_jump(change).dot(n)) < 1e-10 * (1 + stick.norm() / pair.mass_a));
    // b sees the same pair from its side: opposite stick momentum and opposite normal.
    CHECK((resolve_pair<Dim>(-stick, -n, -0.1, law, pair.reduced_mass(), 0.3) + change).norm() <=
          1e-15 * stick.norm());
  }
}

}  // namespace

TEST_CASE_TEMPLATE("laws never add kinetic energy and act only on touching, approaching surfaces", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  for (const double friction : {0.0, 0.2, 1.0, 50.0}) check_dissipation_and_detection<Dim>(Coulomb{friction});
  check_dissipation_and_detection<Dim>(Frictionless{});
  check_dissipation_and_detection<Dim>(Stick{});
  check_dissipation_and_detection<Dim>(Perfect{});
  check_dissipation_and_detection<Dim>(Ignore{});
  check_dissipation_and_detection<Dim>(Coulomb{0.2, 0.4});
  check_dissipation_and_detection<Dim>(VelocityFriction{0.1, 0.6, 0.5});
  check_dissipation_and_detection<Dim>(Viscous{3, 1});
  check_dissipation_and_detection<Dim>(Adhesion{0.2, 1, 2, 0.01, 1});
}

TEST_CASE_TEMPLATE("Coulomb: on the cone when sliding, along the sliding, whole inside it", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  int slid = 0, stuck = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vec<Dim> n = random_direction<Dim>(draw),
                   stick = uniform(draw, 0.1, 3) * random_direction<Dim>(draw);
    const double along = stick.dot(n), friction = uniform(draw, 0, 1.5);
    if (along >= 0) continue;
    const Vec<Dim> shear = stick - along * n, change = resolve_pair<Dim>(stick, n, -0.1, Coulomb{friction});
    const Vec<Dim> change_shear = change - change.dot(n) * n;
    CHECK(change.dot(n) == doctest::Approx(along).epsilon(1e-12));
    CHECK(change_shear.norm() <= friction * -along * (1 + 1e-12));
    if (shear.norm() > friction * -along) {
      ++slid;
      CHECK(change_shear.norm() == doctest::Approx(friction * -along).epsilon(1e-11));
      CHECK((change_shear.norm() * shear - shear.norm() * change_shear).norm() < 1e-12);
    } else {
      ++stuck;
      CHECK(change == stick);
    }
  }
  CHECK(slid > 50);
  CHECK(stuck > 50);
}

TEST_CASE_TEMPLATE("limits: no friction, endless friction, tied and ignored surfaces", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  for (int k = 0; k < 200; ++k) {
    const Vec<Dim> n = random_direction<Dim>(draw), stick = random_direction<Dim>(draw);
    for (const double separation : {-0.1, 0.1}) {
      CHECK((resolve_pair<Dim>(stick, n, separation, Coulomb{0}) -
             resolve_pair<Dim>(stick, n, separation, Frictionless{}))
                .norm() < 1e-15);
      if (std::abs(stick.dot(n)) > 1e-6)
        CHECK(resolve_pair<Dim>(stick, n, separation, Coulomb{1e12}) ==
              resolve_pair<Dim>(stick, n, separation, Stick{}));
      CHECK(resolve_pair<Dim>(stick, n, separation, Perfect{}) == stick);
      CHECK(resolve_pair<Dim>(stick, n, separation, Ignore{}) == Vec<Dim>::Zero());
    }
  }
  // Head on: nothing to slide, no division by the vanishing shear.
  const Vec<Dim> n = Vec<Dim>::Unit(0);
  CHECK(resolve_pair<Dim>(-2.0 * n, n, -0.1, Coulomb{0}) == -2.0 * n);
  CHECK(resolve_pair<Dim>(-2.0 * n, n, -0.1, Frictionless{}) == -2.0 * n);
}

TEST_CASE("Coulomb: static friction holds up to its own cone, then the sliding coefficient counts") {
  const Coulomb law{0.2, 0.5};
  CHECK(law({10, 4.9}) == kSticks);
  CHECK(law({10, 5.1}) == doctest::Approx(2).epsilon(1e-15));
}

TEST_CASE("velocity-dependent friction satisfies its law at the speed that remains") {
  const VelocityFriction law{0.1, 0.6, 0.5};
  Draw draw(4);
  for (int k = 0; k < 300; ++k) {
    const double normal = uniform(draw, 0.1, 3), reduced_mass = uniform(draw, 0.01, 2);
    const double stick = normal * uniform(draw, 0.6001, 4);
    const double shear = law({normal, stick, reduced_mass});
    const double speed = (stick - shear) / reduced_mass;  // N20 Eq. 8: Δp = Δp(0) − m_red k t
    CHECK(speed > 0);
    CHECK(shear == doctest::Approx((0.1 + 0.5 * std::exp(-speed / 0.5)) * normal).epsilon(1e-10));
  }
  CHECK(law({1, 0.6, 1}) == kSticks);
}

TEST_CASE("a viscous film carries its viscosity times the speed that remains, and never reverses it") {
  const double resistance = 7, reduced_mass = 0.4, area_time = 0.02, stick = 3;
  const double shear = Viscous{resistance, 1}({1, stick, reduced_mass, area_time});
  CHECK(shear == doctest::Approx(resistance * area_time * (stick - shear) / reduced_mass).epsilon(1e-14));
  CHECK(Viscous{1e30, 1}({1, stick, reduced_mass, area_time}) == doctest::Approx(stick));
  CHECK(Viscous{resistance, 1}({1, stick, reduced_mass, 0}) == 0);
}

TEST_CASE("a bond holds up to its ellipse of tension and shear, within reach, and friction follows") {
  const Adhesion law{0.3, 2, 5, 0.01};
  const double area_time = 0.1;  // tension up to 0.2, shear up to 0.5
  const Vec<2> n = Vec<2>::Unit(0), t = Vec<2>::Unit(1);
  const auto change = [&](const Vec<2>& stick, double separation) {
    return resolve_pair<2>(stick, n, separation, law, 1, area_time);
  };
  CHECK(change(0.199 * n, 0.005) == 0.199 * n);
  CHECK(change(0.201 * n, 0.005) == Vec<2>::Zero());
  CHECK(change(0.199 * n, 0.011) == Vec<2>::Zero());  // out of reach
  CHECK(change(0.499 * t, 0.005) == 0.499 * t);
  CHECK(change(0.501 * t, 0.005) == Vec<2>::Zero());
  const double r = std::sqrt(0.5);
  CHECK(change(r * 0.199 * n + r * 0.499 * t, 0) == r * 0.199 * n + r * 0.499 * t);
  CHECK(change(r * 0.201 * n + r * 0.501 * t, 0) == Vec<2>::Zero());
  // In compression the shear strength and the friction add up; broken, only the friction is left.
  CHECK(change(-n + 0.79 * t, -0.1) == -n + 0.79 * t);
  CHECK((change(-n + 0.81 * t, -0.1) - (-n + 0.3 * t)).norm() < 1e-15);
}

TEST_CASE("what is not said of a node is nothing: no mass, and no area for a film or a bond") {
  const Sliding bare{1, 2};
  CHECK(bare.reduced_mass == 0);
  CHECK(bare.area_time == 0);
  const Vec<2> n = Vec<2>::Unit(0), t = Vec<2>::Unit(1), stick = -n + 3 * t;
  CHECK(resolve_pair<2>(stick, n, -0.1, Viscous{7, 1}, 0.4) == -n);
  const Adhesion bond{0.25, 2, 4, 0.01};
  CHECK(resolve_pair<2>(stick, n, -0.1, bond, 0.4) == resolve_pair<2>(stick, n, -0.1, Coulomb{0.25}, 0.4));
  CHECK(resolve_pair<2>(n, n, -0.1, bond, 0.4) == Vec<2>::Zero());
  // A film stops at once what has no mass.
  Sliding massless{1, 3};
  massless.area_time = 0.02;
  CHECK(Viscous{7, 1}(massless) == doctest::Approx(3).epsilon(1e-15));
}

// Powers of two: both sides of each bound are the same number.
TEST_CASE("at their bounds themselves surfaces rest and bonds hold, but nothing has reach or touches") {
  CHECK(Coulomb{0.25, 0.5}({4, 2}) == kSticks);
  CHECK(VelocityFriction{0.25, 0.5, 1}({4, 2, 1}) == kSticks);
  const Adhesion bond{0.25, 2, 4, 0.5, 0.25};  // reach 1/8 m
  const Vec<2> n = Vec<2>::Unit(0), t = Vec<2>::Unit(1);
  const auto change = [&](const Vec<2>& stick, double separation) {  // tension up to 1, shear up to 2
    return resolve_pair<2>(stick, n, separation, bond, 1, 0.5);
  };
  for (const double side : {-1.0, 1.0}) {
    CHECK(change(2 * side * t, 0) == 2 * side * t);
    CHECK(change(-n + 2.25 * side * t, -0.125) == -n + 2.25 * side * t);
    CHECK(resolve_pair<2>(side * t, n, -0.125, Stick{}) == Vec<2>::Zero());
    CHECK(resolve_pair<2>(side * n, side * -n, 0, Stick{}) == Vec<2>::Zero());
  }
  CHECK(change(n, 0) == n);
  CHECK(change(n, 0.12) == n);
  CHECK(change(n, 0.125) == Vec<2>::Zero());
}

TEST_CASE_TEMPLATE("a pair in a mirror does what the pair does, mirrored, by each law", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  const auto check = []<class Law>(const Law& law) {
    Draw draw(6);
    for (int k = 0; k < 200; ++k) {
      const Vec<Dim> n = random_direction<Dim>(draw),
                     stick = uniform(draw, 0.1, 3) * random_direction<Dim>(draw);
      for (const double separation : {-0.1, 0.005})
        for (int d = 0; d < Dim; ++d) {
          const auto mirrored = [d](Vec<Dim> x) {
            x[d] = -x[d];
            return x;
          };
          const Vec<Dim> change = resolve_pair<Dim>(stick, n, separation, law, 0.7, 0.3),
                         other = resolve_pair<Dim>(mirrored(stick), mirrored(n), separation, law, 0.7, 0.3);
          CHECK((other - mirrored(change)).norm() < 1e-14 * stick.norm());
        }
    }
  };
  check(Coulomb{0.3, 0.5});
  check(Frictionless{});
  check(Stick{});
  check(Perfect{});
  check(VelocityFriction{0.1, 0.6, 0.5});
  check(Viscous{3, 1});
  check(Adhesion{0.2, 1, 2, 0.01, 1});
}

TEST_CASE("every law has a word of its own and says what it is") {
  std::set<std::string> words;
  const auto check = [&]<class Law>(const Law&) {
    CHECK(words.insert(Law::kKeyword).second);
    CHECK(!std::string(Law::kDescription).empty());
  };
  [&]<std::size_t... K>(std::index_sequence<K...>) { (check(std::variant_alternative_t<K, AnyLaw>{}), ...); }
  (std::make_index_sequence<std::variant_size_v<AnyLaw>>());
  CHECK(words.size() == 11);
}
