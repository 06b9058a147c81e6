/// Two contacts on one node at once: both laws hold together, and momentum is conserved.

#include <doctest/doctest.h>

#include "kernels/contact/two_pairs.hpp"
#include "tests/unit/contact_cloud.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// Fields 0 and 1 on either side of field 2, as pairs (0, 2) and (1, 2).
template <int Dim>
struct Chain {
  double mass[3];
  Vec<Dim> velocity[3];
  PairContact<Dim> pair[2];

  Chain(Draw& draw, double middle) : mass{uniform(draw, 0.2, 2), uniform(draw, 0.2, 2), middle} {
    for (auto& v : velocity) v = uniform(draw, 0, 3) * random_direction<Dim>(draw);
    const Vec<Dim> n = random_direction<Dim>(draw);
    pair[0].normal = n;
    pair[1].normal = (-n + 0.4 * random_direction<Dim>(draw)).normalized();
    for (int k = 0; k < 2; ++k) {
      pair[k].jump = velocity[2] - velocity[k];
      pair[k].inverse_mass = 1 / mass[k] + 1 / middle;
    }
  }
  double coupling() const { return 1 / mass[2]; }  // the shared field is b in both
  Vec<Dim> after(int k) const {
    return k == 2 ? Vec<Dim>(velocity[2] - (pair[0].impulse + pair[1].impulse) / mass[2])
                  : Vec<Dim>(velocity[k] + pair[k].impulse / mass[k]);
  }
};

/// No approach, no attraction, one or the other zero; the shear inside the cone, or on it along the slip.
template <int Dim>
void check_coulomb(const Chain<Dim>& chain, int k, double friction) {
  const auto& p = chain.pair[k];
  const Vec<Dim> slip = chain.after(2) - chain.after(k);
  CHECK((slip - p.slip).norm() < 1e-10 * (1 + slip.norm()));
  const double scale = std::max(3 / p.inverse_mass, p.impulse.norm()), normal = -p.impulse.dot(p.normal),
               opening = slip.dot(p.normal);
  CHECK(normal > -1e-12 * scale);
  CHECK(opening > -1e-9);
  CHECK(std::abs(normal * opening) < 1e-9 * scale);
  const Vec<Dim> shear = p.impulse + normal * p.normal, sliding = slip - opening * p.normal;
  CHECK(shear.norm() <= friction * normal + 1e-10 * scale);
  if (normal > 1e-6 * scale && sliding.norm() > 1e-6) {
    CHECK(shear.norm() == doctest::Approx(friction * normal).epsilon(1e-6));
    CHECK((shear.norm() * sliding - sliding.norm() * shear).norm() < 1e-6 * scale);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("both friction laws of a chain of three fields hold at once, however light the middle", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(11);
  int unsettled = 0, pressed = 0;
  for (int k = 0; k < 600; ++k) {
    const double friction[2] = {uniform(draw, 0, 0.4), uniform(draw, 0, 0.4)};
    Chain<Dim> chain(draw, k % 3 == 0 ? 1.0 : k % 3 == 1 ? 1e-2 : 1e-5);
    if (!solve_two_pairs(chain.pair, chain.coupling(), AnyLaw(Coulomb{friction[0]}),
                         AnyLaw(Coulomb{friction[1]}))) {
      ++unsettled;
      continue;
    }
    for (int i = 0; i < 2; ++i) check_coulomb(chain, i, friction[i]);
    pressed += !chain.pair[0].impulse.isZero(0) && !chain.pair[1].impulse.isZero(0);
  }
  MESSAGE("unsettled " << unsettled << " of 600, both pressed " << pressed);
  CHECK(pressed > 100);
  // Measured 5 (2-D) and 51 (3-D, where a slip direction must be found too), all of them wedges of 1e-2 and
  // 1e-5 of their neighbours' mass squeezed out at an angle.
  CHECK(unsettled < (Dim == 2 ? 12 : 70));
}

TEST_CASE("two pairs that are stuck move with the mean velocity of all three") {
  Draw draw(12);
  Chain<2> chain(draw, 0.3);
  REQUIRE(solve_two_pairs(chain.pair, chain.coupling(), AnyLaw(Perfect{}), AnyLaw(Perfect{})));
  Vec<2> mean = Vec<2>::Zero();
  double mass = 0;
  for (int k = 0; k < 3; ++k) mean += chain.mass[k] * chain.velocity[k], mass += chain.mass[k];
  for (int k = 0; k < 3; ++k) CHECK((chain.after(k) - mean / mass).norm() < 1e-12);
}

TEST_CASE("pairs without a common field are solved as each by itself") {
  Draw draw(13);
  for (int k = 0; k < 50; ++k) {
    Chain<3> chain(draw, 0.7);
    if (!solve_two_pairs(chain.pair, 0.0, AnyLaw(Coulomb{0.3}), AnyLaw(Coulomb{0.3}))) continue;
    for (const auto& p : chain.pair) {
      const Vec<3> alone =
          resolve_pair<3>(p.jump / p.inverse_mass, p.normal, -1, Coulomb{0.3}, 1 / p.inverse_mass);
      CHECK((p.impulse - alone).norm() < 1e-11);
    }
  }
}

/// What both contacts ask for at first, changed at once or always of the same one first, chases itself.
TEST_CASE("a light wedge between two blocks settles to the same impulses whichever contact is named first") {
  struct Wedge {
    double mass, angle, friction[2];
    Vec<2> velocity[3];
  };
  for (const Wedge& wedge : {Wedge{1e-4, 0.4, {0.7, 0.2}, {{2, -0.5}, {1.5, 2}, {-1.5, -1.5}}},
                             Wedge{1e-4, 0.3, {0.1, 0.5}, {{-1, 1.5}, {-2, -0.5}, {1.5, -2}}},
                             Wedge{1e-4, 0.2, {0.7, 0.2}, {{1.5, 0}, {1, 1}, {-1.5, -2}}},
                             Wedge{1e-3, 0.1, {0.4, 0.8}, {{0, -1}, {-0.5, -1.5}, {1.5, -1.5}}}}) {
    Vec<2> impulse[2];
    for (int first = 0; first < 2; ++first) {
      CAPTURE(wedge.angle);
      CAPTURE(first);
      Draw draw(1);
      Chain<2> chain(draw, wedge.mass);
      chain.velocity[2] = wedge.velocity[2];
      for (int k = 0; k < 2; ++k) {
        const int side = k == 0 ? first : 1 - first;
        chain.mass[k] = 1;
        chain.velocity[k] = wedge.velocity[side];
        auto& pair = chain.pair[k];
        pair.normal = side == 0 ? Vec<2>(1, 0) : Vec<2>(-std::cos(wedge.angle), std::sin(wedge.angle));
        pair.jump = chain.velocity[2] - chain.velocity[k];
        pair.inverse_mass = 1 + 1 / wedge.mass;
      }
      const double one = wedge.friction[first], two = wedge.friction[1 - first];
      REQUIRE(solve_two_pairs(chain.pair, chain.coupling(), AnyLaw(Coulomb{one}), AnyLaw(Coulomb{two})));
      check_coulomb(chain, 0, one);
      check_coulomb(chain, 1, two);
      for (int k = 0; k < 2; ++k) {
        Vec<2>& same = impulse[k == 0 ? first : 1 - first];
        if (first == 1) CHECK((chain.pair[k].impulse - same).norm() < 1e-9);
        same = chain.pair[k].impulse;
      }
    }
  }
}
