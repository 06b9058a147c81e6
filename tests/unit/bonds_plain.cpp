/// Springs, curves and bonds between two surfaces: the balance of each step, and integrals by many small
/// parts.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/contact/bond.hpp"
#include "kernels/contact/curved_springs.hpp"
#include "kernels/contact/largest_root.hpp"
#include "kernels/contact/laws.hpp"
#include "tests/unit/contact_cloud.hpp"

namespace {

using namespace mpmfast;
using namespace mpmfast::test;

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

/// ∫ f, by Gauss's rule of two points in each of many parts.
template <class F>
double integral(const F& f, double from, double to, int parts = 1000) {
  const double width = (to - from) / parts, off = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (int k = 0; k < parts; ++k) {
    const double middle = from + (k + 0.5) * width;
    sum += 0.5 * width * (f(middle - off * width) + f(middle + off * width));
  }
  return sum;
}

double spread(Draw& draw, double low, double high) {
  return std::exp(uniform(draw, std::log(low), std::log(high)));
}
double either_sign(Draw& draw, double low, double high) {
  return (uniform(draw, 0, 1) < 0.5 ? -1 : 1) * spread(draw, low, high);
}

/// m_e/m of a stiffness.
double plain_share(double stiffness, double mass, double dt, bool alone) {
  if (!alone || stiffness == 0) return 1;
  const double angle = std::min(0.25 * kFullTurn, dt * std::sqrt(stiffness / mass));
  return std::pow(0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle), 2);
}

TEST_CASE("the inertia beside a spring is that of an oscillator, up to a quarter of its period") {
  Draw draw(1);
  for (int trial = 0; trial < 200; ++trial) {
    const double mass = spread(draw, 1e-3, 10), dt = spread(draw, 1e-4, 1), angle = spread(draw, 2.1e-4, 20);
    const double stiffness = angle * angle * mass / (dt * dt);
    CHECK(oscillator_mass(stiffness, mass, dt) ==
          doctest::Approx(plain_share(stiffness, mass, dt, true)).epsilon(1e-12));
    CHECK(oscillator_mass(1e-8 * stiffness / (angle * angle), mass, dt) == 1);
  }
  CHECK(oscillator_mass(1.9e-4 * 1.9e-4, 1, 1) == 1);
  CHECK(oscillator_mass(2.2e-4 * 2.2e-4, 1, 1) < 1);
}

TEST_CASE("over a step of two stiffnesses the fields lose in speed what the pull and the mean force take") {
  Draw draw(2);
  int crossed = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double stiffness[2] = {trial % 7 == 0 ? 0 : spread(draw, 0.01, 100),
                                 trial % 11 == 0 ? 0 : spread(draw, 0.01, 100)};  // in tension, pressed
    const double mass = spread(draw, 0.1, 10), dt = spread(draw, 0.01, 3);
    const bool alone = trial % 2;
    const JumpStart start{trial % 13 == 0 ? 0 : either_sign(draw, 1e-3, 1), either_sign(draw, 1e-3, 1),
                          either_sign(draw, 1e-3, 1)};
    const double rate = rate_after_springs(stiffness[0], stiffness[1], mass, dt, start, alone);
    const double end = start.jump + 0.5 * dt * (start.rate + rate), way = end - start.jump;
    if (std::abs(way) < 1e-6) continue;
    const auto stored = [&](double jump) { return 0.5 * stiffness[jump < 0] * jump * jump; };
    const double force = (stored(end) - stored(start.jump)) / way;
    const auto misses = [&](double of) {
      const double inertia = plain_share(of, mass, dt, alone) * mass / dt;
      return std::abs(inertia * (rate - start.rate) - start.opening + force) /
             (inertia * (std::abs(rate) + std::abs(start.rate)) + std::abs(start.opening) + std::abs(force));
    };
    const bool crosses = start.jump * end < 0;
    crossed += crosses;
    CAPTURE(start.jump);
    CAPTURE(end);
    const double own = stiffness[start.jump < 0 || (start.jump == 0 && end < 0)],
                 stiffer = std::max(stiffness[0], stiffness[1]);
    if (crosses) {
      CHECK(misses(stiffer) < 1e-9);
    } else if (misses(own) >
               1e-9) {  // by its own inertia it crosses, by that of the stiffer side it does not
      const double alone_rate = rate_after_spring(own, mass, dt, start, alone);
      CHECK((start.jump + 0.5 * dt * (start.rate + alone_rate)) * start.jump <= 0);
      CHECK(misses(stiffer) < 1e-9);
    }
  }
  CHECK(crossed > 300);
}

TEST_CASE_TEMPLATE("what is turned with a normal is turned by the least rotation", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec<Dim> from = random_direction<Dim>(draw), to = random_direction<Dim>(draw),
                   x = uniform(draw, 0, 3) * random_direction<Dim>(draw);
    Vec<Dim> expected = x;
    const double cosine = from.dot(to);
    if (cosine > 0) {
      if constexpr (Dim == 2) {
        const double sine = from[0] * to[1] - from[1] * to[0];
        expected = Vec<2>(cosine * x[0] - sine * x[1], sine * x[0] + cosine * x[1]);
      } else {
        const Vec<3> axis = from.cross(to).normalized();
        expected = Eigen::AngleAxisd(std::acos(std::min(1.0, cosine)), axis) * x;
      }
    }
    CHECK((turned<Dim>(from, to, x) - expected).norm() < 1e-9);
  }
}

template <int Dim>
PairStart<Dim> random_pair(Draw& draw) {
  PairStart<Dim> joint;
  joint.mass = spread(draw, 0.1, 10);
  joint.normal = random_direction<Dim>(draw);
  joint.jump = spread(draw, 0.01, 1) * random_direction<Dim>(draw);
  joint.rate = spread(draw, 0.01, 1) * random_direction<Dim>(draw);
  joint.opening = spread(draw, 0.01, 1) * random_direction<Dim>(draw);
  return joint;
}

TEST_CASE_TEMPLATE("springs along and across a normal each act on their part of the jump", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(4);
  for (int trial = 0; trial < 300; ++trial) {
    const PairStart<Dim> joint = random_pair<Dim>(draw);
    const Springs springs{spread(draw, 0.1, 10), spread(draw, 0.1, 10), spread(draw, 0.1, 10)};
    const double dt = spread(draw, 0.01, 2);
    const bool alone = trial % 2;
    const Vec<Dim> rate = rate_after(springs, joint, dt, alone), &n = joint.normal;
    const double along =
        rate_after_springs(springs.tension, springs.compression, joint.mass, dt,
                           {joint.jump.dot(n), joint.rate.dot(n), joint.opening.dot(n)}, alone);
    CHECK(rate.dot(n) == doctest::Approx(along).epsilon(1e-11));
    // Across it: m_e (g₁ − g)/Δt = f − k ½(δ + δ₁).
    const Vec<Dim> end = joint.jump_with(rate, dt);
    CHECK((end - joint.jump - 0.5 * dt * (joint.rate + rate)).norm() < 1e-13);
    const double inertia = plain_share(springs.shear, joint.mass, dt, alone) * joint.mass / dt;
    const Vec<Dim> misses =
        inertia * (rate - joint.rate) - joint.opening + 0.5 * springs.shear * (joint.jump + end);
    CHECK((misses - misses.dot(n) * n).norm() < 1e-11 * (1 + inertia + springs.shear));
  }
}

/// Points from [0, 0] on, or from an overlap on.
TractionCurve random_curve(Draw& draw, int points, bool overlap, bool rises = false) {
  TractionCurve curve;
  double jump = 0, traction = 0;
  for (int k = 0; k < points; ++k) {
    curve.jump.push_back(jump);
    curve.traction.push_back(traction);
    jump += spread(draw, 0.05, 1);
    traction = rises ? traction + uniform(draw, 0, 1) : k == 0 ? uniform(draw, 0.2, 1) : uniform(draw, 0, 1);
  }
  if (overlap) {
    curve.jump.insert(curve.jump.begin(), -spread(draw, 0.05, 1));
    curve.traction.insert(curve.traction.begin(), -uniform(draw, 0, 1));
  }
  return curve;
}

/// The traction of a curve, looked for segment by segment.
double plain_traction(const TractionCurve& curve, double x) {
  const std::size_t last = curve.jump.size() - 1;
  if (x >= curve.jump[last]) return curve.traction[last];
  const auto on = [&](std::size_t n) {
    return (curve.traction[n + 1] - curve.traction[n]) / (curve.jump[n + 1] - curve.jump[n]);
  };
  if (x < curve.jump[0])
    return curve.traction[0] + (last > 0 ? std::max(0.0, on(0)) : 0) * (x - curve.jump[0]);
  std::size_t n = 0;
  while (!(x < curve.jump[n + 1])) ++n;
  return curve.traction[n] + on(n) * (x - curve.jump[n]);
}

/// ∫ of it from 0, whose parts end at the points.
double plain_energy(const TractionCurve& curve, double x) {
  std::vector<double> ends{0, x};
  for (const double jump : curve.jump)
    if ((jump > 0 && jump < x) || (jump < 0 && jump > x)) ends.push_back(jump);
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (std::size_t k = 1; k < ends.size(); ++k)
    sum += plain_traction(curve, 0.5 * (ends[k - 1] + ends[k])) * (ends[k] - ends[k - 1]);
  return x < 0 ? -sum : sum;
}

TEST_CASE("a curve has its tractions, the area below them, its slopes and secants, also when it is widened") {
  Draw draw(5);
  for (int trial = 0; trial < 300; ++trial) {
    const TractionCurve curve = random_curve(draw, 1 + trial % 5, trial % 2);
    const double most = spread(draw, 0.2, 5);
    const TractionCurve wide = curve.widened(most);
    for (const TractionCurve* one : {&curve, &wide}) {
      CHECK(one->pieces() == static_cast<int>(one->jump.size()) + 1);
      double steepest = 0, secant = 0;
      for (std::size_t n = 1; n < one->jump.size(); ++n) {
        const double slope = (one->traction[n] - one->traction[n - 1]) / (one->jump[n] - one->jump[n - 1]);
        CHECK(one->slope(static_cast<int>(n)) == doctest::Approx(slope).epsilon(1e-12));
        CHECK(one->lower(static_cast<int>(n)) == one->jump[n - 1]);
        CHECK(one->upper(static_cast<int>(n)) == one->jump[n]);
        CHECK(one->piece_of(one->jump[n], true) == static_cast<int>(n) + 1);
        CHECK(one->piece_of(one->jump[n], false) == static_cast<int>(n));
        steepest = std::max(steepest, std::abs(slope));
      }
      for (std::size_t n = 0; n < one->jump.size(); ++n)
        if (one->jump[n] > 0) secant = std::max(secant, one->traction[n] / one->jump[n]);
      CHECK(one->lower(0) == -HUGE_VAL);
      CHECK(one->upper(one->pieces() - 1) == HUGE_VAL);
      CHECK(one->slope(one->pieces() - 1) == 0);
      CHECK(one->steepest() == doctest::Approx(steepest).epsilon(1e-12));
      CHECK(one->largest_secant() == doctest::Approx(secant).epsilon(1e-12));
      for (int k = 0; k < 12; ++k) {
        const double x = k == 0 ? 0 : k == 1 ? one->jump.back() : uniform(draw, -3, 5);
        CHECK(std::abs(one->at(x) - plain_traction(*one, x)) < 1e-12);
        CHECK(std::abs(one->energy(x) - plain_energy(*one, x)) < 1e-11);
      }
    }
    CHECK(wide.traction == curve.traction);
    for (std::size_t n = 0; n < curve.jump.size(); ++n) {
      if (curve.jump[n] == 0) CHECK(wide.jump[n] == 0);
      if (n == 0) continue;
      const double width = std::max(curve.jump[n] - curve.jump[n - 1],
                                    std::abs(curve.traction[n] - curve.traction[n - 1]) / most);
      CHECK(wide.jump[n] - wide.jump[n - 1] == doctest::Approx(width).epsilon(1e-11));
    }
  }
}

TEST_CASE("a quadratic has its root that is nearest to nothing on the side that is asked") {
  Draw draw(6);
  for (int trial = 0; trial < 400; ++trial) {
    double one = either_sign(draw, 0.1, 10), two = either_sign(draw, 0.1, 10);
    const double scale = either_sign(draw, 0.1, 10);
    const bool above = trial % 2;
    if (trial % 5 == 0) two = HUGE_VAL;  // one root
    const double a = std::isinf(two) ? 0 : scale, b = std::isinf(two) ? scale : -scale * (one + two),
                 c = std::isinf(two) ? -scale * one : scale * one * two;
    if (std::isinf(two)) two = above ? -1 : 1;  // not on that side
    double expected = 0;
    for (const double root : {one, two})
      if ((above ? root > 0 : root < 0) && (expected == 0 || std::abs(root) < std::abs(expected)))
        expected = root;
    CHECK(nearest_root(a, b, c, above) == doctest::Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("a jump on a curve ends where the balance of the step first closes on its way") {
  Draw draw(7);
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const TractionCurve curve = random_curve(draw, 1 + trial % 5, trial % 3 > 0);
    const double area = spread(draw, 0.1, 10), mass = spread(draw, 0.1, 10), dt = spread(draw, 0.05, 2);
    const bool alone = trial % 2;
    const JumpStart start{either_sign(draw, 1e-2, 1), either_sign(draw, 1e-2, 2), either_sign(draw, 1e-2, 2)};
    const double rate = rate_after_curve(curve, area, mass, dt, start, alone);
    const double way = 0.5 * dt * (start.rate + rate);
    double steepest = 0;
    for (std::size_t n = 1; n < curve.jump.size(); ++n)
      steepest = std::max(steepest, std::abs((curve.traction[n] - curve.traction[n - 1]) /
                                             (curve.jump[n] - curve.jump[n - 1])));
    const double inertia = plain_share(steepest * area, mass, dt, alone) * mass;
    const double before = plain_energy(curve, start.jump);
    // What is missing in m_e (g₁ − g)/Δt = f − A (W(δ₁) − W(δ))/(δ₁ − δ), with g₁ = 2 s/Δt − g.
    const auto excess = [&](double s) {
      return 2 * inertia / dt * (s / dt - start.rate) - start.opening +
             area * (plain_energy(curve, start.jump + s) - before) / s;
    };
    if (std::abs(way) < 1e-4) continue;
    ++compared;
    CHECK(std::abs(excess(way)) < 1e-8 * (1 + inertia / dt / dt + area));
    const bool opens =
        2 * inertia / dt * start.rate + start.opening > area * plain_traction(curve, start.jump);
    CHECK(opens == (way > 0));
    for (int k = 1; k < 60; ++k) CHECK((opens ? 1 : -1) * excess(way * k / 60.0) < 1e-9);
  }
  CHECK(compared > 350);
  const JumpStart start{0.3, -0.2, 0.7};
  const TractionCurve curve = random_curve(draw, 3, true);
  CHECK(rate_after_curve(curve, 0, 2, 0.5, start, true) ==
        doctest::Approx(-0.2 + 0.5 / 2 * 0.7).epsilon(1e-13));
}

TEST_CASE_TEMPLATE("slip on a curve closes its balance with the mean force, which has the work of the curve",
                   D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(8);
  for (int trial = 0; trial < 150; ++trial) {
    const TractionCurve curve = random_curve(draw, 1 + trial % 4, false, true);
    const double from = spread(draw, 0.01, 2), to = spread(draw, 0.01, 2);
    const double secant = 2 * (plain_energy(curve, to) - plain_energy(curve, from)) / (to * to - from * from);
    if (std::abs(to - from) > 1e-3)
      CHECK(mean_secant(curve, from, to) == doctest::Approx(secant).epsilon(1e-9));
    const double near = plain_traction(curve, from) / from;
    CHECK(mean_secant(curve, from, from) == doctest::Approx(near).epsilon(1e-12));
    CHECK(mean_secant(curve, from, from * (1 + 1e-7)) == doctest::Approx(near).epsilon(1e-5));
    CHECK(mean_secant(curve, 0, 0) == doctest::Approx(curve.slope(1)).epsilon(1e-12));

    const PairStart<Dim> joint = random_pair<Dim>(draw);
    const double area = spread(draw, 0.1, 10), dt = spread(draw, 0.05, 2);
    const bool alone = trial % 2;
    const CurvedSlip slip{curve, area};
    const double inertia = plain_share(curve.steepest() * area, joint.mass, dt, alone) * joint.mass;
    CHECK(slip.inertia(joint.mass, dt, alone) == doctest::Approx(inertia).epsilon(1e-9));
    const Vec<Dim>& n = joint.normal;
    const auto across = [&](const Vec<Dim>& x) { return Vec<Dim>(x - x.dot(n) * n); };
    const Vec<Dim> rate = slip.rate_after(joint, dt, alone), first = across(joint.jump),
                   last = first + 0.5 * dt * (across(joint.rate) + rate);
    const Vec<Dim> force = slip.mean_force(first, last);
    CHECK(std::abs(rate.dot(n)) < 1e-12);
    CHECK((inertia / dt * (rate - across(joint.rate)) - across(joint.opening) + force).norm() <
          1e-8 * (1 + inertia / dt + area));
    const double work = area * (plain_energy(curve, last.norm()) - plain_energy(curve, first.norm()));
    CHECK(std::abs(force.dot(last - first) - work) < 1e-6 * area);
    const TractionCurve normal = random_curve(draw, 3, true);
    const Vec<Dim> both = rate_after_curves(normal, curve, area, joint, dt, alone);
    CHECK((across(both) - rate).norm() < 1e-12);
    CHECK(
        both.dot(n) ==
        doctest::Approx(rate_after_curve(normal, area, joint.mass, dt,
                                         {joint.jump.dot(n), joint.rate.dot(n), joint.opening.dot(n)}, alone))
            .epsilon(1e-11));
  }
}

/// Surfaces rest, or slide with as much as the law says, and the balance closes with it.
template <int Dim, class Spring>
void check_friction(const Spring& spring, const PairStart<Dim>& joint, double dt, bool alone,
                    const Coulomb& law, double pressed, int& rests) {
  const FrictionResult<Dim> found = apply_friction<Dim>(law, pressed, spring, joint, dt, alone);
  const Vec<Dim>& n = joint.normal;
  const auto across = [&](const Vec<Dim>& x) { return Vec<Dim>(x - x.dot(n) * n); };
  const double inertia = spring.inertia(joint.mass, dt, alone);
  const Vec<Dim> slip = across(joint.jump), last = slip + 0.5 * dt * (across(joint.rate) + found.rate);
  const Vec<Dim> force = spring.mean_force(slip, last);
  const Vec<Dim> misses =
      inertia * (found.rate - across(joint.rate)) - dt * (across(joint.opening) - force) + found.impulse;
  CHECK(misses.norm() < 1e-8 * (1 + inertia));
  const double static_limit = std::max(law.friction, law.static_friction) * pressed;
  if (found.rate.isZero(0)) {
    ++rests;
    CHECK(found.impulse.norm() <= static_limit);
    return;
  }
  CHECK(found.impulse.norm() == doctest::Approx(law.friction * pressed).epsilon(1e-10));
  const Vec<Dim> held = spring.mean_force(slip, Vec<Dim>(slip + 0.5 * dt * across(joint.rate)));
  const Vec<Dim> stick = inertia * across(joint.rate) + dt * (across(joint.opening) - held);
  CHECK(stick.norm() > static_limit);
  CHECK((stick / stick.norm() * found.impulse.norm() - found.impulse).norm() < 1e-10);
}

TEST_CASE_TEMPLATE("friction beside a spring rests, or takes what it may along what rest would take", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(9);
  int rests = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const PairStart<Dim> joint = random_pair<Dim>(draw);
    const double dt = spread(draw, 0.05, 1), friction = uniform(draw, 0.1, 0.8),
                 pressed = spread(draw, 0.01, 3);
    const Coulomb law{friction, trial % 2 ? friction + 0.2 : 0};
    const bool alone = trial % 4 < 2;
    check_friction(SlipSpring{spread(draw, 0.1, 10)}, joint, dt, alone, law, pressed, rests);
    const TractionCurve curve = random_curve(draw, 1 + trial % 4, false, true);
    check_friction(CurvedSlip{curve, spread(draw, 0.1, 10)}, joint, dt, alone, law, pressed, rests);
  }
  CHECK(rests > 60);
  CHECK(rests < 540);
}

// Bonds.

Cohesive random_law(Draw& draw, int kind) {
  Cohesive law;
  law.shape = static_cast<Softening>(kind % 3);
  law.plateau = uniform(draw, 0, 0.9);
  law.mode_exponent = kind / 3 % 2 ? uniform(draw, 1.1, 3) : 1;
  law.normal_strength = spread(draw, 0.5, 2);
  law.shear_strength = spread(draw, 0.5, 2);
  law.normal_toughness = spread(draw, 1, 4);
  law.shear_toughness = spread(draw, 1, 4);
  law.initial_stiffness = law.least_stiffness() * spread(draw, 2, 20);
  law.compression_stiffness = spread(draw, 0.5, 20);
  return law;
}

double plain_softening(const Cohesive& law, double way) {
  if (law.shape == Softening::exponential)
    return (std::exp(-7 * way) - std::exp(-7.0)) / (1 - std::exp(-7.0));
  const double hold = law.shape == Softening::trapezoidal ? law.plateau : 0;
  return way < hold ? 1 : (1 - way) / (1 - hold);
}
double plain_integrity(const Cohesive& law, double lambda, double length) {
  return lambda <= 1 ? 1 : lambda >= 1 + length ? 0 : plain_softening(law, (lambda - 1) / length) / lambda;
}

TEST_CASE("shapes of softening have their formula, and the damage at each of their heights") {
  Draw draw(10);
  for (int trial = 0; trial < 120; ++trial) {
    const Cohesive law = random_law(draw, trial);
    const SofteningLaw softening = law.softening();
    const double length = spread(draw, 0.2, 50);
    for (const double way : {0.0, 1.0, uniform(draw, 0, 1), uniform(draw, 0, 1), 0.99 * softening.hold()}) {
      CHECK(std::abs(softening.at(way) - plain_softening(law, way)) < 1e-14);
      const auto height = [&](double at) { return plain_softening(law, at); };
      const double hold = std::min(way, softening.hold());
      CHECK(std::abs(softening.integral(way) - integral(height, 0, hold, 1) - integral(height, hold, way)) <
            1e-9);
      const double lambda = 1 + length * way, left = plain_integrity(law, lambda, length);
      CHECK(law.integrity(lambda, length) == doctest::Approx(left).epsilon(1e-13));
      if (way > 0 && way < 1) {
        CHECK(softening.damage_at(left, length) == doctest::Approx(way).epsilon(1e-8));
        CHECK(law.lambda_of(left, length) == doctest::Approx(lambda).epsilon(1e-8));
      }
      CHECK(law.integrity(0.7, length) == 1);
      CHECK(law.integrity(1.001 * (1 + length), length) == 0);
      const auto both = [&](double l) { return 2 * l * plain_integrity(law, l, length); };  // ω dλ²
      const double held = 1 + length * hold;
      CHECK(law.work(lambda, length) == doctest::Approx(integral(both, 0, 1, 4) + integral(both, 1, held, 4) +
                                                        integral(both, held, lambda))
                                            .epsilon(1e-8));
      CHECK(law.work(0.6, length) == doctest::Approx(0.36).epsilon(1e-14));
      CHECK(law.work(1 + 2 * length, length) == doctest::Approx(law.work(1 + length, length)).epsilon(1e-14));
    }
    CHECK(law.lambda_of(1, length) == 1);
    CHECK(law.damage_at(1) == 0);
    CHECK(law.damage_at(0) == 1);
    CHECK(law.integrity_of(1) == 0);
    CHECK(law.integrity_of(0) == 1);
    const double left = uniform(draw, 0.01, 0.99);
    CHECK(law.integrity_of(law.damage_at(left)) == doctest::Approx(left).epsilon(1e-8));
  }
}

TEST_CASE("a bond is spent where the energies of its modes meet the power law, along any direction") {
  Draw draw(11);
  for (int trial = 0; trial < 120; ++trial) {
    const Cohesive law = random_law(draw, trial);
    const double share = trial % 10 == 0 ? 0 : trial % 10 == 1 ? 1 : uniform(draw, 0, 1);
    const double opening = spread(draw, 0.1, 2), slip = spread(draw, 0.1, 2);
    const double n = opening * law.initial_stiffness / law.normal_strength,
                 t = slip * law.initial_stiffness / law.shear_strength;
    CHECK(law.measure(opening, slip * slip) == doctest::Approx(n * n + t * t).epsilon(1e-13));
    const double area =
        0.5 + law.length(share) * integral([&](double w) { return plain_softening(law, w); }, 0, 1, 20000);
    const double one = share * area * law.normal_strength * law.normal_strength / law.initial_stiffness,
                 two = (1 - share) * area * law.shear_strength * law.shear_strength / law.initial_stiffness;
    CHECK(std::pow(one / law.normal_toughness, law.mode_exponent) +
              std::pow(two / law.shear_toughness, law.mode_exponent) ==
          doctest::Approx(1).epsilon(1e-4));
    // At the least stiffness one of the modes is spent where the bond has its strength.
    const double spent[2] = {0.5 * law.normal_strength * law.normal_strength / law.normal_toughness,
                             0.5 * law.shear_strength * law.shear_strength / law.shear_toughness};
    CHECK(law.least_stiffness() == doctest::Approx(std::max(spent[0], spent[1])).epsilon(1e-13));
  }
}

TEST_CASE(
    "integrity over a step is its mean over the square of the jump, and the loss what is neither stored") {
  Draw draw(12);
  int softened = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Cohesive law = random_law(draw, trial);
    const double unit[2] = {law.normal_strength / law.initial_stiffness,
                            law.shear_strength / law.initial_stiffness};
    const double longest = 1 + 1.2 * law.length(0.5);
    const auto draw_parted = [&] {
      const double far = uniform(draw, 0, longest), angle = uniform(draw, 0, 0.25 * kFullTurn);
      return Parted{trial % 5 == 0 ? 0 : unit[0] * far * std::cos(angle),
                    std::pow(unit[1] * far * std::sin(angle), 2)};
    };
    const Parted from = draw_parted(), to = draw_parted();
    const double q0 = law.measure(from.opening, from.slip_squared),
                 q1 = law.measure(to.opening, to.slip_squared);
    const double length = law.length(std::pow(to.opening / unit[0], 2) / q1);
    const double before = std::min(uniform(draw, 0.05, 1.3), 1.0);
    const Integrity found = integrity_over(law, before, from, to);
    const auto at = [&](double lambda) { return std::min(before, plain_integrity(law, lambda, length)); };
    CHECK(found.end == doctest::Approx(at(std::sqrt(q1))).epsilon(1e-10));
    if (q1 > q0 && q1 - q0 > 1e-5 * q1) {
      softened += found.end < before;
      const double mean =
          integral([&](double l) { return 2 * l * at(l); }, std::sqrt(q0), std::sqrt(q1), 4000) / (q1 - q0);
      CHECK(found.mean == doctest::Approx(std::max(mean, found.end)).epsilon(2e-4));
    } else {
      CHECK(found.mean == (found.end < before ? found.end : before));
    }
    CHECK(from.squared() == from.opening * from.opening + from.slip_squared);
    const double stored = 0.5 * law.initial_stiffness * from.squared(),
                 after = 0.5 * law.initial_stiffness * to.squared();
    CHECK(
        lost_over(law.initial_stiffness, before, found, from, to) ==
        doctest::Approx(found.mean * (after - stored) - (found.end * after - before * stored)).epsilon(1e-9));
    const Parted hardly{to.opening * (1 + 1e-8), to.slip_squared * (1 + 2e-8)};
    const Integrity little = integrity_over(law, before, to, hardly);
    CHECK(little.mean == doctest::Approx(at(std::sqrt(q1))).epsilon(1e-5));
  }
  CHECK(softened > 100);
}

TEST_CASE("the largest root is found, with few questions, however the function turns below it") {
  Draw draw(13);
  for (int trial = 0; trial < 400; ++trial) {
    // M grows in soft steps; what lies above all steps and M is no root.
    const int steps = trial % 4;
    double place[3], height[3], width[3], floor = uniform(draw, 0, 0.5), slope = uniform(draw, 0, 0.9);
    if (trial % 3 == 0) slope = 0;
    double top = floor;
    for (int k = 0; k < steps; ++k) {
      place[k] = uniform(draw, 0, 1.5);
      height[k] = uniform(draw, 0, 0.8);
      width[k] = spread(draw, 0.003, 0.3);
      top += 2 * height[k];
    }
    const double high = top / (1 - slope) + uniform(draw, 0, 1);
    int asked = 0;
    const auto excess = [&](double x) {
      ++asked;
      double sum = floor + slope * x;
      for (int k = 0; k < steps; ++k) sum += height[k] * (1 + std::tanh((x - place[k]) / width[k]));
      return sum - x;
    };
    const double found = largest_root(high, excess);
    CHECK(asked <= 80);
    if (steps == 0) CHECK(asked <= 4);
    CHECK(std::abs(excess(found)) <= 1e-11 * (1 + found));
    double closest = HUGE_VAL;
    for (int k = 1; k <= 2000; ++k) {
      const double x = found + (high - found) * k / 2000.0;
      if (x > found + 0.02) closest = std::min(closest, -excess(x));
    }
    CHECK(closest > -1e-12);
  }
  CHECK(largest_root(2.0, [](double x) { return 3 - x; }) == 2);  // positive there: itself
  CHECK(largest_root(2.0, [](double x) { return 2 - x; }) == 2);
  CHECK(largest_root(2.0, [](double x) { return -x; }) == 0);
}

TEST_CASE_TEMPLATE("a bond has the mean integrity that its own jump asks for, and no larger one fits", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(14);
  int softened = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Cohesive law = random_law(draw, trial);
    const double area = spread(draw, 0.5, 2), before = std::min(1.0, uniform(draw, 0.2, 1.5)),
                 dt = spread(draw, 0.02, 0.5);
    PairStart<Dim> joint = random_pair<Dim>(draw);
    joint.rate *= 5;
    const Parted seen = parted<Dim>(joint.jump, joint.normal);
    const double along = joint.jump.dot(joint.normal);
    CHECK(seen.opening == std::max(0.0, along));
    CHECK(seen.slip_squared == doctest::Approx(joint.jump.squaredNorm() - along * along).epsilon(1e-9));
    const BondStart<Dim> bond{law, before, law.initial_stiffness * area, law.compression_stiffness * area,
                              joint};
    const auto asked = [&](double mean) {
      const double spring = mean * bond.stiffness;
      const Vec<Dim> rate = rate_after({spring, bond.compression, spring}, joint, dt, false);
      const Vec<Dim> end = joint.jump + 0.5 * dt * (joint.rate + rate);
      return integrity_over(law, before, seen, parted<Dim>(end, joint.normal)).mean;
    };
    const double mean = mean_integrity(bond, dt);
    CHECK(std::abs(asked(mean) - mean) < 1e-6);
    CHECK(mean <= before);
    softened += mean < before;
    for (int k = 1; k <= 40; ++k) {
      const double larger = mean + (before - mean) * k / 40.0;
      CHECK(asked(larger) <= larger + 1e-9);
    }
    const double spring = mean * bond.stiffness;
    CHECK((rate_after_bond(bond, dt) - rate_after({spring, bond.compression, spring}, joint, dt, false))
              .norm() < 1e-10 * (1 + joint.rate.norm()));
  }
  CHECK(softened > 25);
}

TEST_CASE("what presses has the stiffness that is said, or else that of opening, or contact has it") {
  for (const double said : {0.0, 7.0}) {
    Interface interface { 3, 4, said };
    CHECK(interface.overlap_stiffness() == (said > 0 ? 7 : 3));
    Cohesive bond;
    bond.initial_stiffness = 5, bond.compression_stiffness = said;
    CHECK(bond.overlap_stiffness() == (said > 0 ? 7 : 5));
    NonlinearInterface curves{{{0, 2}, {0, 3}}, {{0}, {0}}, said};
    CHECK(!curves.has_overlap());
    const TractionCurve pressed = curves.curve_with_overlap(0.25);
    CHECK(pressed.jump == std::vector<double>{-0.25, 0, 2});
    CHECK(pressed.traction == std::vector<double>{said > 0 ? -7 * 0.25 : -1.5 * 0.25, 0, 3});
    interface.compression = bond.compression = curves.compression = CompressionModel::contact;
    CHECK(interface.overlap_stiffness() == 0);
    CHECK(bond.overlap_stiffness() == 0);
    CHECK(curves.curve_with_overlap(0.25).traction[0] == 0);
    NonlinearInterface whole{{{-1, 0, 2}, {-4, 0, 3}}, {{0}, {0}}, said};
    CHECK(whole.has_overlap());
    CHECK(whole.curve_with_overlap(0.25).jump == whole.normal_curve.jump);
    CHECK(whole.curve_with_overlap(0.25).traction == whole.normal_curve.traction);
  }
}

}  // namespace
