// Springs whose tractions are curves, over many steps of two fields that nothing else moves.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernels/contact/curved_springs.hpp"
#include "kernels/contact/laws.hpp"

namespace mpmfast {
namespace {

/// Two surfaces of 2 m² that open along x and slip along y.
struct Pair {
  TractionCurve normal, shear;
  double mass, dt;
  bool alone = true;
  Vec<2> jump = Vec<2>::Zero(), rate = Vec<2>::Zero(), pull = Vec<2>::Zero();

  static constexpr double kArea = 2;
  double stored() const { return kArea * (normal.energy(jump[0]) + shear.energy(std::abs(jump[1]))); }
  double energy() const { return 0.5 * mass * rate.squaredNorm() + stored() - pull.dot(jump); }
  void step() {
    const PairStart<2> start{mass, Vec<2>::UnitX(), jump, rate, pull};
    const Vec<2> end = rate_after_curves(normal, shear, kArea, start, dt, alone);
    jump += 0.5 * dt * (rate + end);
    rate = end;
  }
};

/// It hardens where surfaces close, holds 3 Pa as they open, then falls to nothing.
const TractionCurve kJoint{{-2, -1, 0, 1, 3, 4}, {-20, -4, 0, 3, 3, 0}};
const TractionCurve kSlip{{0, 1, 2, 5}, {0, 2, 2.5, 1}};
const TractionCurve kNone{{0}, {0}};

TEST_CASE("a curve of tractions is linear between its points, and the energy is the area below it") {
  CHECK(kJoint.at(-3) == doctest::Approx(-36));  // goes on as between its first points
  CHECK(kJoint.at(-1.5) == doctest::Approx(-12));
  CHECK(kJoint.at(0) == 0);
  CHECK(kJoint.at(3.5) == doctest::Approx(1.5));
  CHECK(kJoint.at(9) == 0);
  CHECK(kNone.at(1) == 0);
  CHECK(kJoint.energy(1) == doctest::Approx(1.5));
  CHECK(kJoint.energy(10) == doctest::Approx(1.5 + 6 + 1.5));
  CHECK(kJoint.energy(-2) == doctest::Approx(2 + 12));
  CHECK(kJoint.energy(-3) == doctest::Approx(2 + 12 + 28));
  for (double x : {-2.5, -0.3, 0.7, 2.0, 3.2, 6.0}) {
    const double step = 1e-5;
    CHECK((kJoint.energy(x + step) - kJoint.energy(x - step)) / (2 * step) ==
          doctest::Approx(kJoint.at(x)).epsilon(1e-8));
  }
  CHECK(kJoint.steepest() == 16);
  CHECK(kSlip.largest_secant() == 2);
  const TractionCurve lifts{{0, 1, 2}, {0, 1, 5}};
  CHECK(lifts.largest_secant() == 2.5);
}

TEST_CASE("a straight curve does what springs do, bit by bit but for round-off, in steps of any length") {
  const TractionCurve straight{{-1, 0, 1000}, {-5, 0, 5000}};
  const TractionCurve sliding{{0, 1000}, {0, 3000}};
  for (bool alone : {true, false})
    for (double dt : {0.01, 0.3, 2.0, 50.0}) {
      CAPTURE(dt);
      Pair pair{straight, sliding, 0.7, dt, alone, {0.2, -0.1}, {1.5, 0.8}, {0.3, 0.2}};
      for (int k = 0; k < 20; ++k) {
        const PairStart<2> start{pair.mass, Vec<2>::UnitX(), pair.jump, pair.rate, pair.pull};
        const Vec<2> springs = rate_after({10, 10, 6}, start, dt, alone);
        pair.step();
        CHECK((pair.rate - springs).norm() < 1e-9 * (1 + springs.norm()));
      }
    }
}

TEST_CASE(
    "curved springs keep the energy to round-off, whatever the curve, the step and the number of pieces") {
  for (double dt : {0.003, 0.1, 1.0, 30.0})
    for (double speed : {0.4, 1.5, 6.0}) {
      CAPTURE(dt);
      CAPTURE(speed);
      Pair pair{kJoint, kSlip, 0.9, dt, false, {-0.3, 0.2}, {speed, 0.6 * speed}, {-0.5, -0.2}};
      const double start = pair.energy();
      double scale = std::abs(start), most = 0;
      for (int k = 0; k < 300; ++k) {
        pair.step();
        scale = std::max(scale, 0.5 * pair.mass * pair.rate.squaredNorm());
        most = std::max(most, std::abs(pair.energy() - start));
      }
      CHECK(most < 2e-10 * scale);
    }
}

/// Alone, a pair has the inertia with which straight springs have their own frequency; a constant one, so
/// that nothing is lost on the way through the curve either.
TEST_CASE("a pair of curved springs that is alone neither gains nor loses over a hundred swings") {
  Pair pair{kJoint, kNone, 1.0, 0.2, true, {0, 0}, {1.0, 0}};
  double least = 10, most = 0;
  int swings = 0;
  for (double before = 0; swings < 100; before = pair.jump[0]) {
    pair.step();
    if (!(before < 0 && pair.jump[0] >= 0)) continue;
    ++swings;
    // The speed at 0 by the energy of this moment.
    const double share = oscillator_mass(kJoint.steepest() * Pair::kArea, 1, pair.dt);
    const double at_zero = std::sqrt(pair.rate[0] * pair.rate[0] + 2 * pair.stored() / share);
    least = std::min(least, at_zero);
    most = std::max(most, at_zero);
  }
  CHECK(most - least < 1e-9);
  CHECK(most == doctest::Approx(1).epsilon(1e-9));
}

/// T = k δ² in pieces: the quarter period of m δ″ = −A k δ² from δ_0 at rest is √(3 m/(2 A k δ_0)) ∫ dx/√(1 −
/// x³), the integral 1.402182 (¼ B(1/3, 1/2) · 4/3).
TEST_CASE("springs that harden swing with the period of their curve") {
  TractionCurve square;
  for (int n = 0; n <= 100; ++n) {
    square.jump.push_back(0.01 * n);
    square.traction.push_back(3 * square.jump.back() * square.jump.back());
  }
  const double quarter = std::sqrt(3 * 0.8 / (2 * Pair::kArea * 3 * 0.9)) * 1.4021821053;
  double last = 1;
  for (double dt : {0.02, 0.01, 0.005}) {
    Pair pair{square, kNone, 0.8, dt, false, {0.9, 0}, {0, 0}};
    double time = 0, before = 0.9;
    for (; pair.jump[0] > 0; time += dt) {
      before = pair.jump[0];
      pair.step();
    }
    time -= dt * pair.jump[0] / (pair.jump[0] - before);
    const double off = std::abs(time / quarter - 1);
    CHECK(off < 0.1 * dt);
    CHECK(off < last);
    last = off;
  }
}

TEST_CASE("a curve at rest carries what pulls on it, whatever the step; beyond its top it lets go") {
  for (double dt : {1e-3, 1.0, 1e3}) {
    Pair still{kJoint, kSlip, 0.5, dt, true, {0.5, 0.75}, {0, 0}, {3.0, 3.0}};  // A T = pull
    for (int k = 0; k < 10; ++k) still.step();
    CHECK(still.jump[0] == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(still.jump[1] == doctest::Approx(0.75).epsilon(1e-9));
  }
  Pair pulled{kJoint, kNone, 0.5, 0.05, true, {0, 0}, {0, 0}, {6.3, 0}};  // 5 % beyond what it holds
  for (int k = 0; k < 400; ++k) pulled.step();
  CHECK(pulled.jump[0] > 10);
}

TEST_CASE("slip in three dimensions is held along itself") {
  const TractionCurve shear = kSlip;
  for (double dt : {0.01, 5.0}) {
    const PairStart<3> start{1.3, Vec<3>::UnitZ(), {0.3, 0.4, 0.1}, {0.6, 0.8, 0}, {0.03, 0.04, 0}};
    const Vec<3> end = CurvedSlip{shear, 2}.rate_after(start, dt, false);
    CHECK(std::abs(end[0] * 0.8 - end[1] * 0.6) < 1e-12);
    CHECK(end[2] == 0);
    const PairStart<2> plane{1.3, Vec<2>::UnitX(), {0.1, 0.5}, {0, 1}, {0, 0.05}};
    CHECK(end.dot(Vec<3>(0.6, 0.8, 0)) ==
          doctest::Approx(CurvedSlip{shear, 2}.rate_after(plane, dt, false)[1]).epsilon(1e-12));
  }
}

TEST_CASE("a curve that is widened reaches every traction, with no piece too steep, and knows its energy") {
  const TractionCurve wide = kJoint.widened(2);
  CHECK(wide.jump == std::vector<double>{-10, -2, 0, 1.5, 3.5, 5});
  CHECK(wide.traction == kJoint.traction);
  CHECK(wide.steepest() == 2);
  TractionCurve plain{wide.jump, wide.traction};
  for (double x : {-11.0, -3.0, -1.0, 0.0, 0.4, 1.5, 3.0, 4.0, 9.0})
    CHECK(wide.energy(x) == doctest::Approx(plain.energy(x)));
  CHECK(kSlip.widened(1e9).jump == kSlip.jump);
  CHECK(kSlip.widened(1e9).largest_secant() == 2);
  CHECK(kNone.widened(1).energy(3) == 0);
}

/// With a = 1, on the second piece, u behind its start, a s² − drive s + W is −0.9 + 2.1 u − u²: 0 at 0.6 and
/// again at 1.5, and below at its end.
TEST_CASE("a jump ends where it is first held, also within a piece that falls") {
  const TractionCurve falls{{0, 1, 3}, {0, 4, -4}};
  const double rate = rate_after_curve(falls, 1, 0.5, 1, {0, 3.9, 0}, false);
  CHECK(0.5 * (3.9 + rate) == doctest::Approx(1.6).epsilon(1e-12));
}

/// A coefficient next to nothing does next to nothing, however stiff the springs.
TEST_CASE("friction that vanishes leaves the springs as they are") {
  for (double dt : {0.1, 1.0, 30.0}) {
    const PairStart<2> start{0.7, Vec<2>::UnitX(), {-0.2, 0.3}, {-1, 0.6}, {0.1, 0.2}};
    const SlipSpring spring{9};
    const CurvedSlip curve{kSlip, 2};
    CHECK((apply_friction(Coulomb{1e-12, 0}, 1, spring, start, dt, true).rate -
           spring.rate_after(start, dt, true))
              .norm() < 1e-10);
    CHECK((apply_friction(Coulomb{1e-12, 0}, 1, curve, start, dt, true).rate -
           curve.rate_after(start, dt, true))
              .norm() < 1e-10);
  }
}

/// What friction takes on the mean slip is what motion and springs lose, to round-off: beside straight
/// springs and curves, sticking and sliding, and in steps of any length.
TEST_CASE("friction beside springs: rests or takes its share of the pressure, and the balance closes") {
  const double mass = 1.3, area = 2;
  for (double dt : {0.01, 0.4, 5.0})
    for (double pressed : {0.0, 0.02, 0.3, 50.0}) {
      CAPTURE(dt);
      CAPTURE(pressed);
      const PairStart<3> start{mass, Vec<3>::UnitZ(), {0.3, -0.4, 0.1}, {0.8, 0.5, -3}, {0.1, 0.4, 2}};
      const auto check = [&](const auto& spring, const auto& stored) {
        const FrictionResult<3> after = apply_friction(Coulomb{0.5, 0.6}, pressed, spring, start, dt, false);
        const Vec<3> from = start.across(start.jump), rate = start.across(start.rate),
                     drawn = start.across(start.opening), mean = 0.5 * (rate + after.rate),
                     to = from + dt * mean;
        CHECK(after.rate[2] == 0);
        CHECK(after.impulse.norm() <= 0.6 * pressed + 1e-12);
        if (!after.rate.isZero(0)) {  // slides: against the slip that it leaves, or stops
          CHECK(after.impulse.norm() == doctest::Approx(0.5 * pressed));
        }
        const Vec<3> change =
            mass * (after.rate - rate) + after.impulse - dt * drawn + dt * spring.mean_force(from, to);
        CHECK(change.norm() < 1e-9);  // Newton's law with all forces
        const double moved = 0.5 * mass * (after.rate.squaredNorm() - rate.squaredNorm());
        CHECK(moved + stored(to) - stored(from) + after.impulse.dot(mean) - dt * drawn.dot(mean) ==
              doctest::Approx(0).scale(1 + std::abs(moved)).epsilon(1e-9));
      };
      check(SlipSpring{6}, [](const Vec<3>& slip) { return 3 * slip.squaredNorm(); });
      check(CurvedSlip{kSlip, area}, [&](const Vec<3>& slip) { return area * kSlip.energy(slip.norm()); });
      check(CurvedSlip{kNone, area}, [](const Vec<3>&) { return 0.0; });
    }
}

}  // namespace
}  // namespace mpmfast
