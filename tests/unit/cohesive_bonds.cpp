// Cohesive bonds over many steps of two fields that nothing else moves: what they store and lose is what is
// taken from the fields, whatever the step.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "kernels/contact/bond.hpp"

namespace mpmfast {
namespace {

/// Strengths 1 and 2, toughnesses 3 and 8 in units of the initial stiffness.
Cohesive law_of(Softening shape, double exponent = 1) {
  Cohesive law;
  law.normal_strength = 1, law.shear_strength = 2;
  law.normal_toughness = 3, law.shear_toughness = 8;
  law.initial_stiffness = 1, law.compression_stiffness = 5;
  law.shape = shape, law.plateau = 0.4, law.mode_exponent = exponent;
  return law;
}

constexpr Softening kShapes[] = {Softening::triangular, Softening::exponential, Softening::trapezoidal};

/// A jump and its rate, and steps of a bond of one square metre that moves them.
struct Pair {
  Cohesive law;
  double mass, dt;
  Vec<2> jump = Vec<2>::Zero(), rate = Vec<2>::Zero(), pull = Vec<2>::Zero();
  double integrity = 1, lost = 0, worked = 0;
  Vec<2> traction = Vec<2>::Zero();  ///< the mean of the last step

  double stored() const {
    if (integrity == 0) return 0;
    const Vec<2> normal(1, 0);
    const double overlap = std::min(0.0, jump[0]);
    return 0.5 * (integrity * law.initial_stiffness * parted<2>(jump, normal).squared() +
                  law.compression_stiffness * overlap * overlap);
  }
  double energy() const { return 0.5 * mass * rate.squaredNorm() + stored() + lost - worked; }
  void step() {
    const Vec<2> normal(1, 0);
    if (integrity > 0) {
      const BondStart<2> start{
          law, integrity, law.initial_stiffness, law.compression_stiffness, {mass, normal, jump, rate, pull}};
      move(rate_after_bond(start, dt));
    } else {
      move(rate + dt / mass * pull);
    }
  }
  /// Without inertia: a machine opens it.
  void open(const Vec<2>& way) {
    const Vec<2> from = jump;
    jump += way;
    const double before = integrity;
    const Integrity now = weaken(from);
    traction = now.mean * law.initial_stiffness * 0.5 * (from + jump);
    if (from[0] < 0 || jump[0] < 0) return;
    worked += traction.dot(way);
    CHECK(before >= now.end);
  }

 private:
  void move(const Vec<2>& end) {
    const Vec<2> from = jump;
    jump += 0.5 * dt * (rate + end);
    traction = pull - mass / dt * (end - rate);
    worked += pull.dot(jump - from);
    rate = end;
    if (integrity > 0) weaken(from);
  }
  Integrity weaken(const Vec<2>& from) {
    const Vec<2> normal(1, 0);
    const Parted start = parted<2>(from, normal), end = parted<2>(jump, normal);
    const Integrity now = integrity_over(law, integrity, start, end);
    const double loss = lost_over(law.initial_stiffness, integrity, now, start, end);
    CHECK(loss >= -1e-13);
    lost += loss;
    integrity = now.end;
    const double overlap = std::min(0.0, jump[0]);  // what presses as the bond breaks
    if (integrity == 0) lost += 0.5 * law.compression_stiffness * overlap * overlap;
    return now;
  }
};

TEST_CASE("each shape falls from one to nothing, its integral is that, and damage is found from integrity") {
  for (const Softening shape : kShapes) {
    const SofteningLaw softening{shape, 0.4};
    CHECK(softening.at(0) == 1);
    CHECK(softening.at(1) == 0);
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) sum += softening.at((k + 0.5) / kSteps) / kSteps;
    CHECK(softening.integral(1) == doctest::Approx(sum).epsilon(1e-7));
    for (double way : {0.01, 0.3, 0.41, 0.9, 0.999})
      for (double length : {0.1, 10.0, 1e4})
        CHECK(softening.damage_at(softening.at(way) / (1 + length * way), length) ==
              doctest::Approx(way).epsilon(1e-9));
  }
}

TEST_CASE(
    "opening and sliding have their strengths, and take their toughness to break, in steps of any length") {
  for (const Softening shape : kShapes)
    for (int mode = 0; mode < 2; ++mode)
      for (int steps : {1, 3, 1000}) {
        CAPTURE(static_cast<int>(shape));
        CAPTURE(mode);
        CAPTURE(steps);
        Pair pair{law_of(shape), 1, 1};
        const double share = mode == 0 ? 1 : 0, strength = mode == 0 ? 1 : 2;
        const double end = (1 + pair.law.length(share)) * strength * 1.01;
        double most = 0;
        for (int k = 0; k < steps; ++k) {
          pair.open(mode == 0 ? Vec<2>(end / steps, 0) : Vec<2>(0, end / steps));
          most = std::max(most, pair.traction.norm());
        }
        if (steps == 1000) CHECK(most == doctest::Approx(strength).epsilon(0.02));
        CHECK(pair.integrity == 0);
        CHECK(pair.lost == doctest::Approx(mode == 0 ? 3 : 8).epsilon(1e-12));
        CHECK(pair.worked == doctest::Approx(pair.lost).epsilon(1e-12));
      }
}

TEST_CASE("along any direction the energies of both modes meet the power law where the bond breaks") {
  for (const Softening shape : kShapes)
    for (double exponent : {1.0, 2.0})
      for (double angle : {0.3, std::numbers::pi / 4, 1.2}) {
        CAPTURE(static_cast<int>(shape));
        Pair pair{law_of(shape, exponent), 1, 1};
        const Vec<2> way = 1e-3 * Vec<2>(std::cos(angle), std::sin(angle));
        double opening = 0, sliding = 0, most = 0;
        while (pair.integrity > 0) {
          pair.open(way);
          most = std::max(most, std::hypot(pair.traction[0] / 1, pair.traction[1] / 2));
          opening += pair.traction[0] * way[0];
          sliding += pair.traction[1] * way[1];
        }
        CHECK(std::pow(opening / 3, exponent) + std::pow(sliding / 8, exponent) ==
              doctest::Approx(1).epsilon(1e-9));
      }
}

TEST_CASE(
    "a bond that softened unloads straight to the origin, loads up the same line, and presses unharmed") {
  for (const Softening shape : kShapes) {
    Pair pair{law_of(shape), 1, 1};
    for (int k = 0; k < 200; ++k) pair.open({0.01, 0});
    const double lost = pair.lost, left = pair.integrity;
    CHECK(left < 0.9);
    CHECK(left == doctest::Approx(pair.law.integrity(2, pair.law.length(1))).epsilon(1e-9));
    pair.open({-1, 0});
    CHECK(pair.traction[0] == doctest::Approx(left * 1.5).epsilon(1e-12));
    pair.open({-2, 0});  // to an overlap
    pair.open({1.5, 0});
    CHECK(pair.integrity == left);
    CHECK(pair.lost == doctest::Approx(lost).epsilon(1e-12));
    // Within one step up the line and beyond: the loss is that of the way.
    pair.open({4, 0});
    Pair straight{law_of(shape), 1, 1};
    straight.open({4.5, 0});
    CHECK(pair.integrity == doctest::Approx(straight.integrity).epsilon(1e-12));
    CHECK(pair.lost == doctest::Approx(straight.lost).epsilon(1e-12));
    // Pressed, the force is that of whole surfaces.
    Pair pressed{law_of(shape), 1, 0.1};
    pressed.integrity = 0.1, pressed.jump = {-0.2, 0}, pressed.pull = {-1, 0};
    for (int k = 0; k < 10; ++k) pressed.step();
    CHECK(pressed.jump[0] == doctest::Approx(-0.2).epsilon(1e-12));
  }
}

TEST_CASE(
    "over a jump that hardly grows the mean integrity is that between its ends, however little it grows") {
  constexpr double kRoundOff = 1e-15;
  for (const Softening shape : kShapes)
    for (double angle : {0.0, 0.7, std::numbers::pi / 2})
      for (double stretch : {1.2, 1.7, 2.9})
        for (double growth : {1e-4, 1e-5, 2e-6, 4e-7, 1e-8, 1e-10, 1e-12, 1e-14}) {
          CAPTURE(static_cast<int>(shape));
          CAPTURE(angle);
          CAPTURE(stretch);
          CAPTURE(growth);
          const Cohesive law = law_of(shape);
          const Vec<2> normal(1, 0), way(std::cos(angle), std::sin(angle));
          const Parted unit = parted<2>(way, normal);
          const double scale = stretch / std::sqrt(law.measure(unit.opening, unit.slip_squared));
          const Parted from = parted<2>(scale * way, normal),
                       to = parted<2>((1 + growth) * scale * way, normal);
          const double q0 = law.measure(from.opening, from.slip_squared),
                       q1 = law.measure(to.opening, to.slip_squared),
                       length = law.length(law.measure(to.opening, 0) / q1);
          const double first = law.integrity(std::sqrt(q0), length),
                       last = law.integrity(std::sqrt(q1), length);
          REQUIRE(last > 0);
          REQUIRE(last < first);
          // As it was left there, and where it comes from a direction in which it is tougher: all that it
          // loses in between is lost before, by the turn.
          for (const double before : {first, 0.5 * (first + 1), 1.0}) {
            const Integrity now = integrity_over(law, before, from, to);
            CHECK(std::abs(now.end - last) <= kRoundOff);
            CHECK(std::abs(now.mean - 0.5 * (first + last)) <= 0.05 * (first - last) + kRoundOff);
          }
          // What has softened more holds what it has.
          const double less = 0.9 * last;
          CHECK(integrity_over(law, less, from, to).mean == less);
          CHECK(integrity_over(law, less, from, to).end == less);
        }
}

TEST_CASE("whatever pulls and however long the step, bonds store and lose what they take from the fields") {
  for (const Softening shape : kShapes)
    for (double dt : {0.03, 0.7, 5.0, 60.0}) {  // √(K/m) = 2; the fall of S is up to 40 times its inertia
      CAPTURE(static_cast<int>(shape));
      CAPTURE(dt);
      Pair pair{law_of(shape), 0.25, dt};
      pair.rate = {2, -3};
      double scale = pair.energy();
      const double start = pair.energy();
      for (int k = 0; k < 400; ++k) {
        pair.pull = Vec<2>(0.5 * std::sin(1.3 * k) - 0.05, 0.9 * std::cos(0.7 * k)) * (1 + 0.002 * k);
        pair.step();
        scale = std::max(scale, std::abs(pair.worked));
        REQUIRE(std::isfinite(pair.jump.norm()));
      }
      CHECK(std::abs(pair.energy() - start) < 1e-11 * scale);
      CHECK(pair.lost > 0);
    }
}

TEST_CASE("a body that a bond stops has lost its energy to it, and one that breaks it keeps the rest") {
  for (const Softening shape : kShapes)
    for (double dt : {0.01, 0.5, 4.0}) {
      Pair slow{law_of(shape), 1, dt};
      slow.rate = {0.9 * std::sqrt(2 * 3.0), 0};
      for (int k = 0; k < 3000; ++k) slow.step();
      CHECK(slow.integrity > 0);
      Pair fast{law_of(shape), 1, dt};
      fast.rate = {2 * std::sqrt(2 * 3.0), 0};
      for (int k = 0; k < 3000; ++k) fast.step();
      CHECK(fast.integrity == 0);
      CHECK(fast.lost == doctest::Approx(3).epsilon(1e-10));
      CHECK(fast.rate[0] == doctest::Approx(std::sqrt(3 * 2 * 3.0)).epsilon(1e-10));
    }
}

TEST_CASE("a pull just below the strength is borne for good, and one just above breaks the bond") {
  for (const Softening shape : kShapes)
    for (double dt : {0.05, 1.0, 30.0}) {
      const auto pulled = [&](double force) {
        Pair pair{law_of(shape), 1, dt};
        for (int k = 0; k < 8000; ++k) {
          const double s = std::min(1.0, k / 6000.0);  // smoothly, so that hardly anything swings
          pair.pull = {force * s * s * (3 - 2 * s), 0};
          pair.step();
        }
        return pair.integrity;
      };
      CHECK(pulled(0.998) == 1);
      CHECK(pulled(1.002) == 0);
    }
}

TEST_CASE("a bond of the least stiffness is whole up to its strength, and then breaks at once") {
  for (const Softening shape : kShapes) {
    CAPTURE(static_cast<int>(shape));
    Cohesive law = law_of(shape);
    law.normal_strength = law.shear_strength = 2;
    law.normal_toughness = law.shear_toughness = 4;
    law.initial_stiffness = law.least_stiffness();
    REQUIRE(law.length(1) == 0);
    CHECK(law.integrity(1, 0) == 1);
    CHECK(law.integrity(1.001, 0) == 0);
    CHECK(law.integrity_of(law.damage_at(1)) == 1);
    CHECK(law.work(1, 0) == 1);
  }
}

}  // namespace
}  // namespace mpmfast
