#include <doctest/doctest.h>

#include <cmath>

#include "tools/study/error_measure.hpp"

using namespace mpmfast;

namespace {

/// Reference y = 10 x on 0 … 4; the curve lies 1, 2, 6 and 1 off it at x = 1 … 4.
const Curve kReference{{0, 4}, {0, 40}};
const Curve kCurve{{1, 2, 3, 4}, {11, 18, 36, 41}};

ErrorRule rule(Compare compare, Relative relative) {
  ErrorRule out;
  out.compare = compare;
  out.relative = relative;
  return out;
}

double error(const ErrorRule& of, const Curve& curve = kCurve, const Curve& reference = kReference) {
  return measure_error(of, curve, reference).error;
}

}  // namespace

TEST_CASE("the largest difference, absolute and relative to the reference there or to its largest value") {
  CHECK(error(rule(Compare::maximum, Relative::absolute)) == doctest::Approx(6));
  CHECK(error(rule(Compare::maximum, Relative::pointwise)) == doctest::Approx(0.2));
  CHECK(error(rule(Compare::maximum, Relative::maximum)) == doctest::Approx(6.0 / 40));
}

TEST_CASE("the mean difference is the root of the mean of squares") {
  CHECK(error(rule(Compare::root_mean_square, Relative::absolute)) == doctest::Approx(std::sqrt(42.0 / 4)));
  CHECK(error(rule(Compare::root_mean_square, Relative::pointwise)) ==
        doctest::Approx(std::sqrt((0.01 + 0.01 + 0.04 + 1.0 / 1600) / 4)));
}

TEST_CASE("only the window counts, its ends included") {
  ErrorRule window = rule(Compare::maximum, Relative::absolute);
  window.from = 1;
  window.to = 2;
  CHECK(error(window) == doctest::Approx(2));
  window.from = window.to = 4;
  CHECK(error(window) == doctest::Approx(1));
  window.from = 5;
  window.to = 6;
  CHECK(std::isnan(error(window)));
}

TEST_CASE("points that the reference does not reach are left out") {
  const Curve reference{{1.5, 3.5}, {15, 35}};
  CHECK(error(rule(Compare::root_mean_square, Relative::absolute), kCurve, reference) ==
        doctest::Approx(std::sqrt(40.0 / 2)));
  CHECK(std::isnan(error(rule(Compare::maximum, Relative::absolute), kCurve, {})));
}

TEST_CASE("a curve that is not a number somewhere has no error") {
  const Curve torn{{1, 2, 3}, {10, std::nan(""), 30}};
  CHECK(std::isnan(error(rule(Compare::maximum, Relative::absolute), torn)));
  CHECK(std::isnan(error(rule(Compare::root_mean_square, Relative::absolute), torn)));
}

TEST_CASE("agreement where the reference is zero is no error, a difference there is without bound") {
  const Curve zero{{0, 1}, {0, 0}};
  CHECK(error(rule(Compare::maximum, Relative::pointwise), zero, zero) == 0);
  CHECK(std::isinf(error(rule(Compare::maximum, Relative::pointwise), {{0, 1}, {0, 1}}, zero)));
}

TEST_CASE("the last value is compared with what is expected, or with the reference at its place") {
  ErrorRule last = rule(Compare::final_value, Relative::pointwise);
  CHECK(error(last) == doctest::Approx(1.0 / 40));
  last.expected = -82;
  const Measured measured = measure_error(last, kCurve, {});
  CHECK(measured.value == 41);
  CHECK(measured.error == doctest::Approx(1.5));
  last.relative = Relative::absolute;
  CHECK(error(last) == doctest::Approx(123));
  CHECK(std::isnan(error(last, {})));
}

TEST_CASE("a crossing is found linearly between its two points") {
  ErrorRule first = rule(Compare::crossing, Relative::absolute);
  first.threshold = 27;  // half-way from (2, 18) to (3, 36)
  first.expected = 2;
  const Measured measured = measure_error(first, kCurve, {});
  CHECK(measured.value == doctest::Approx(2.5));
  CHECK(measured.error == doctest::Approx(0.5));
  first.relative = Relative::pointwise;
  CHECK(error(first) == doctest::Approx(0.25));
}

TEST_CASE("a crossing downwards, and one against the reference's own") {
  ErrorRule down = rule(Compare::crossing, Relative::absolute);
  down.below = true;
  down.threshold = -1;
  const Curve early{{0, 1, 2}, {0, -4, 0}}, late{{0, 2, 4}, {0, -2, 5}};
  CHECK(measure_error(down, early, late).value == doctest::Approx(0.25));
  CHECK(error(down, early, late) == doctest::Approx(0.75));
}

TEST_CASE("a threshold is passed, not touched; what never passes it has no crossing") {
  ErrorRule first = rule(Compare::crossing, Relative::absolute);
  first.expected = 0;
  first.threshold = 41;
  CHECK(std::isnan(error(first)));
  first.threshold = 5;  // beyond it from the first point on
  CHECK(measure_error(first, kCurve, {}).value == 1);
  first.threshold = 20;
  first.to = 2.5;  // passed at 2.11, but the point beyond lies outside the window
  CHECK(std::isnan(error(first)));
}

TEST_CASE("a curve is linear between its points and unknown outside") {
  CHECK(value_at(kReference, 0) == 0);
  CHECK(value_at(kReference, 4) == 40);
  CHECK(value_at(kReference, 1.3) == doctest::Approx(13));
  CHECK(std::isnan(value_at(kReference, -1e-9)));
  CHECK(std::isnan(value_at(kReference, 4.1)));
}
