// Springs of an interface over many steps of two fields that nothing else moves.

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "kernels/contact/interface.hpp"

namespace mpmfast {
namespace {

/// A jump and its rate, and steps of springs that move them.
struct Oscillator {
  double tension, compression, mass, dt;
  double jump = 0, rate = 1, opening = 0;

  double stiffness() const { return jump > 0 ? tension : compression; }
  double stored() const { return 0.5 * stiffness() * jump * jump; }
  void step() {
    const double end = rate_after_springs(tension, compression, mass, dt, {jump, rate, opening});
    jump += 0.5 * dt * (rate + end);
    rate = end;
  }
};

TEST_CASE("a linear interface swings at its own frequency and keeps its energy at any step") {
  for (double phi : {0.05, 0.3, 1.0, 1.5}) {
    CAPTURE(phi);
    Oscillator o{4.0, 4.0, 0.25, phi / 4};  // √(k/m) = 4
    const double inertia = oscillator_mass(4, 0.25, o.dt) * o.mass, start = 0.5 * inertia;
    const double period = 2 * std::numbers::pi / 4;
    double time = 0, last = 0, before = 0;
    int zeros = 0;
    while (zeros < 100) {
      before = o.jump;
      o.step();
      time += o.dt;
      if (!(before < 0 && o.jump >= 0)) continue;
      // Where the sine through both passes zero.
      last = time - o.dt * std::atan2(o.jump * std::sin(phi), o.jump * std::cos(phi) - before) / phi;
      ++zeros;
    }
    CHECK(last == doctest::Approx(100 * period).epsilon(1e-3));
    CHECK(0.5 * inertia * o.rate * o.rate + o.stored() == doctest::Approx(start).epsilon(1e-10));
  }
}

TEST_CASE("an interface at rest carries what pulls on it, whatever the step") {
  for (double dt : {1e-3, 1.0, 1e3}) {
    Oscillator o{4.0, 9.0, 0.25, dt, 0.5, 0, 2.0};  // k δ = f
    for (int k = 0; k < 10; ++k) o.step();
    CHECK(o.jump == doctest::Approx(0.5).epsilon(1e-12));
    Oscillator pressed{4.0, 8.0, 0.25, dt, -0.25, 0, -2.0};
    for (int k = 0; k < 10; ++k) pressed.step();
    CHECK(pressed.jump == doctest::Approx(-0.25).epsilon(1e-12));
  }
}

TEST_CASE("an interface of two stiffnesses keeps its energy over a hundred bounces") {
  for (double phi : {0.01, 0.1, 0.4})
    for (double ratio : {1e-2, 5.0, 100.0}) {
      CAPTURE(phi);
      CAPTURE(ratio);
      Oscillator o{1.0, ratio, 1.0, phi / std::sqrt(std::max(1.0, ratio))};
      double most = 0;  // speed at which it passes zero, of the last bounce
      int bounces = 0;
      for (double before = 0; bounces < 100;) {
        before = o.jump;
        o.step();
        if (before > 0 && o.jump <= 0) {
          ++bounces;
          most = 0;
        }
        most = std::max(most, std::abs(o.rate));
      }
      while (o.jump < 0) {
        o.step();
        most = std::max(most, std::abs(o.rate));
      }
      CHECK(0.5 * most * most == doctest::Approx(0.5).epsilon(0.005).scale(0));
    }
}

TEST_CASE("jumps, rates and pulls that are so many times smaller end with rates so many times smaller") {
  const volatile double stiff = 4;
  for (double jump : {-0.25, -0.125, 0.0, 0.125})
    for (double rate : {-1.0, 0.5, 1.0}) {
      // Beside others the pull for which the equation of a jump that changes its sign has no linear term.
      const double turning = stiff * jump - 2 * oscillator_mass(stiff, 1, 1) * rate;
      for (double pull : {turning, -1.0, 0.0, 2.0})
        for (const auto& [tension, compression] : {std::pair{4.0, 0.0}, {0.0, 4.0}, {4.0, 1.0}}) {
          CAPTURE(jump);
          CAPTURE(rate);
          CAPTURE(pull);
          const double small = 1.0 / 1024;
          const JumpStart whole{jump, rate, pull}, part{small * jump, small * rate, small * pull};
          CHECK(rate_after_springs(tension, compression, 1, 1, part) ==
                doctest::Approx(small * rate_after_springs(tension, compression, 1, 1, whole))
                    .epsilon(1e-12)
                    .scale(small));
        }
    }
}

// Kinetic and stored energy gain what the pull does, with the inertia of the side it stays on or of the
// stiffer one.
TEST_CASE("a step of two stiffnesses gains the work of its pull, however near to the border it turns") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const double compression = 4, tension = trial % 3 == 0 ? 0 : 4 * std::pow(10, 2 * share(random));
    const JumpStart start{trial % 7 == 0 ? 0.1 : share(random), share(random), 2 * share(random)};
    const double rate = rate_after_springs(tension, compression, 1, 1, start);
    const double end = start.jump + 0.5 * (start.rate + rate);
    const auto stored = [&](double jump) { return 0.5 * (jump > 0 ? tension : compression) * jump * jump; };
    double least = 1e300;
    for (const double stiffness : {tension, compression}) {
      const double inertia = oscillator_mass(stiffness, 1, 1), work = start.opening * (end - start.jump),
                   before = 0.5 * inertia * start.rate * start.rate + stored(start.jump),
                   after = 0.5 * inertia * rate * rate + stored(end);
      least = std::min(least, std::abs(after - before - work) / (after + before + std::abs(work)));
    }
    worst = std::max(worst, least);
  }
  CHECK(worst < 1e-10);  // of rounding
  // Pulls that just do not, and just do, bring it back over the border.
  for (const double pull : {1.5, 1.6, 1.63, 1.634, 1.7, 1.81}) {
    CAPTURE(pull);
    CHECK(std::abs(rate_after_springs(0, 4, 1, 1, {0.1, -1, pull})) < 2);
  }
}

TEST_CASE("a jump that starts at zero has the spring of the side that it goes to, and nothing of the other") {
  for (const bool alone : {true, false})
    for (const auto& [tension, compression] :
         {std::pair{100.0, 1.0}, {1.0, 100.0}, {4.0, 0.0}, {0.0, 4.0}, {4.0, 4.0}})
      for (const double way : {-1.0, 1.0})
        for (const auto& [rate, pull] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.3, 2.0}, {1e-6, 1e-9}}) {
          CAPTURE(tension);
          CAPTURE(way);
          const JumpStart start{0, way * rate, way * pull};
          const double own = rate_after_spring(way > 0 ? tension : compression, 1, 0.1, start, alone);
          CHECK(rate_after_springs(tension, compression, 1, 0.1, start, alone) ==
                doctest::Approx(own).epsilon(1e-13).scale(0));
        }
}

TEST_CASE("springs do to what closes what the same springs, swapped, do to what opens") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    const double compression = trial % 3 == 0 ? 0 : 4, tension = 4 * std::pow(10, 2 * share(random)),
                 rate = share(random), pull = 2 * share(random), jump = share(random);
    // Of a jump that starts at zero, and whose rate and pull are of two signs, nobody knows the side.
    const JumpStart one = trial % 5 == 0 ? JumpStart{0, rate, std::copysign(pull, rate)}
                                         : JumpStart{trial % 7 == 0 ? 0.01 * jump : jump, rate, pull};
    const JumpStart other{-one.jump, -one.rate, -one.opening};
    for (const bool alone : {true, false})
      worst = std::max(worst, std::abs(rate_after_springs(tension, compression, 1, 1, one, alone) +
                                       rate_after_springs(compression, tension, 1, 1, other, alone)));
  }
  CHECK(worst < 1e-10);
}

TEST_CASE("two fields move along each axis by its own spring, whichever is called the first") {
  const Springs springs{3, 7, 2};
  for (const bool alone : {true, false})
    for (const double open : {-0.4, -0.01, 0.01, 0.4}) {
      CAPTURE(open);
      const Vec<3> jump(open, 0.2, -0.3), rate(0.5, -0.7, 0.1), pull(-1, 0.4, 0.6);
      const PairStart<3> pair{0.8, Vec<3>::UnitX(), jump, rate, pull};
      const Vec<3> end = rate_after(springs, pair, 0.3, alone);
      for (int d = 0; d < 3; ++d) {
        const JumpStart start{jump[d], rate[d], pull[d]};
        const double by_axis = d == 0 ? rate_after_springs(3, 7, 0.8, 0.3, start, alone)
                                      : rate_after_spring(2, 0.8, 0.3, start, alone);
        CHECK(end[d] == doctest::Approx(by_axis).epsilon(1e-13).scale(1));
      }
      const PairStart<3> swapped{0.8, -pair.normal, -jump, -rate, -pull};
      CHECK((rate_after(springs, swapped, 0.3, alone) + end).norm() < 1e-13);
      const Vec<3> reached = pair.jump_with(end, 0.3);
      CHECK((reached - jump - 0.15 * (rate + end)).norm() < 1e-15);
    }
}

TEST_CASE("surfaces that springs leave free in tension part with the speed they came with") {
  Oscillator o{0.0, 50.0, 1.0, 0.1, 0.3, -1.0};
  while (!(o.jump > 0 && o.rate > 0)) o.step();
  CHECK(o.rate == doctest::Approx(1).epsilon(0.005));
}

TEST_CASE("what is turned with a normal keeps its parts along it and across, and its length") {
  const Vec<3> from = Vec<3>(1, 2, -2) / 3, x(0.3, -0.7, 0.2);
  for (const Vec<3>& towards : {Vec<3>(2, 2, -2), Vec<3>(1, 2, -1.9), Vec<3>(1, 2, -2)}) {
    const Vec<3> to = towards.normalized(), y = turned<3>(from, to, x), axis = from.cross(to);
    CHECK(y.dot(to) == doctest::Approx(x.dot(from)).epsilon(1e-14));
    CHECK(y.norm() == doctest::Approx(x.norm()).epsilon(1e-14));
    CHECK(y.dot(axis) == doctest::Approx(x.dot(axis)).epsilon(1e-14));  // nothing turns about the normal
    CHECK((turned<3>(from, to, from) - to).norm() < 1e-15);
  }
  CHECK(turned<3>(from, Vec<3>(-from), x) == x);  // another surface
}

}  // namespace
}  // namespace mpmfast
