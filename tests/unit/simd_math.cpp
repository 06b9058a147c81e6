/// Vectors of doubles and the functions on them, against the standard library.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/simd/math.hpp"

using namespace mpmfast;

namespace {

using Draw = std::mt19937_64;

double between(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

/// Largest relative difference of f from g over random arguments, and of Lanes from doubles.
template <class F, class G, class Argument>
double worst_error(F f, G g, Argument argument) {
  Draw draw(1);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    Lanes x;
    for (int i = 0; i < kLanes; ++i) x[i] = argument(draw);
    const Lanes y = f(x);
    for (int i = 0; i < kLanes; ++i) {
      const double expected = g(x[i]), alone = f(double{x[i]});
      worst = std::max({worst, std::abs(y[i] / expected - 1), std::abs(alone / expected - 1)});
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("exponential agrees with the standard library to 2e-15") {
  const auto f = [](auto x) { return exponential(x); };
  const auto g = [](double x) { return std::exp(x); };
  CHECK(worst_error(f, g, [](Draw& d) { return between(d, -2, 2); }) < 2e-15);
  CHECK(worst_error(f, g, [](Draw& d) { return between(d, -700, 700); }) < 2e-15);
  CHECK(worst_error(f, g, [](Draw& d) { return std::pow(10.0, between(d, -18, 0)); }) < 2e-15);
  CHECK(exponential(0.0) == 1.0);
  CHECK(exponential(1e300) == exponential(700.0));
  CHECK(exponential(-1e300) == exponential(-700.0));
  CHECK(std::isfinite(exponential(1e300)));
  CHECK(exponential(-1e300) > 0);
}

TEST_CASE("logarithm agrees with the standard library to 2e-15") {
  const auto f = [](auto x) { return logarithm(x); };
  const auto g = [](double x) { return std::log(x); };
  CHECK(worst_error(f, g, [](Draw& d) { return between(d, 0.3, 2); }) < 2e-15);
  CHECK(worst_error(f, g, [](Draw& d) { return std::pow(10.0, between(d, -300, 300)); }) < 2e-15);
  CHECK(worst_error(f, g, [](Draw& d) { return 1.0 + std::pow(10.0, between(d, -15, -1)); }) < 2e-15);
  CHECK(worst_error(f, g, [](Draw& d) { return 1.0 - std::pow(10.0, between(d, -15, -1)); }) < 2e-15);
  CHECK(logarithm(1.0) == 0.0);
}

TEST_CASE("the isochoric factor is J^(-2/3) to 2e-15") {
  const auto f = [](auto x) { return isochoric_factor(x); };
  const auto g = [](double x) { return std::pow(x, -2.0 / 3.0); };
  CHECK(worst_error(f, g, [](Draw& d) { return between(d, 0.1, 3); }) < 2e-15);
  CHECK(isochoric_factor(1.0) == 1.0);
}

TEST_CASE(
    "root and quotient of Lanes are right to a unit in the last place, and those of no number are none") {
  constexpr double kUnit = 2.220446049250313e-16;
  Draw draw(3);
  for (int k = 0; k < 5000; ++k) {
    Lanes x, y;
    for (int i = 0; i < kLanes; ++i) {
      x[i] = std::exp2(between(draw, -600, 600));
      y[i] = std::copysign(std::exp2(between(draw, -300, 300)), between(draw, -1, 1));
    }
    const Lanes root = square_root(x), ratio = quotient(x, y);
    for (int i = 0; i < kLanes; ++i) {
      CHECK(std::abs(root[i] - std::sqrt(x[i])) <= kUnit * std::sqrt(x[i]));
      CHECK(std::abs(ratio[i] - x[i] / y[i]) <= 2 * kUnit * std::abs(x[i] / y[i]));
    }
  }
  CHECK(square_root(broadcast<Lanes>(0.0))[0] == 0.0);
  CHECK(std::isnan(square_root(broadcast<Lanes>(-1.0))[0]));
  CHECK(!std::isfinite(quotient(broadcast<Lanes>(1.0), broadcast<Lanes>(0.0))[0]));
}

TEST_CASE("floor, magnitude, larger, smaller and sum of Lanes are those of their doubles") {
  Draw draw(2);
  for (int k = 0; k < 2000; ++k) {
    Lanes x, y;
    double sum = 0;
    for (int i = 0; i < kLanes; ++i) {
      x[i] = k < 10 ? std::round(between(draw, -5, 5)) : between(draw, -1e3, 1e3);
      y[i] = between(draw, -1e3, 1e3);
      sum += x[i];
    }
    const Lanes size = magnitude(x), floor = floor_of(x), more = larger(x, y), less = smaller(x, y);
    for (int i = 0; i < kLanes; ++i) {
      CHECK(size[i] == std::abs(x[i]));
      CHECK(floor[i] == std::floor(x[i]));
      CHECK(more[i] == std::max(x[i], y[i]));
      CHECK(less[i] == std::min(x[i], y[i]));
    }
    CHECK(sum_of(x) == doctest::Approx(sum).epsilon(1e-12));
  }
  CHECK(floor_of(-0.5) == -1.0);
  CHECK(floor_of(-1e-300) == -1.0);
}

template <int N, class R>
void check_transpose() {
  R r[N];
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) r[i][j] = 10 * i + j;
  transpose(r);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) CHECK(double{r[i][j]} == 10 * j + i);
}

TEST_CASE("transpose exchanges rows and columns of four records and of eight wide ones") {
  check_transpose<4, Record>();
  check_transpose<8, WideRecord>();
}

TEST_CASE("the leading lanes are the first n of them, or all") {
  Lanes number;
  for (int i = 0; i < kLanes; ++i) number[i] = i;
  for (int n = 0; n <= 3 * kLanes; ++n) {
    CAPTURE(n);
    const auto before = [&](int last) {
      return where_less(leading_lanes(kLanes), number, broadcast<Lanes>(static_cast<double>(last)));
    };
    CHECK(same_lanes(leading_lanes(n), before(n)));
    if (n < kLanes) CHECK_FALSE(same_lanes(leading_lanes(n), before(n + 1)));
    for (int i = 0; i < kLanes; ++i) CHECK((lanes_before(n)[i] != 0) == (i < n));
  }
}

TEST_CASE("lanes are loaded and stored at any address") {
  double in[2 * kLanes], out[2 * kLanes];
  for (int i = 0; i < 2 * kLanes; ++i) in[i] = i;
  store_lanes(out + 1, load_lanes(in + 1));
  for (int i = 1; i <= kLanes; ++i) CHECK(out[i] == in[i]);
}
