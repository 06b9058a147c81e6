/// Everything that moves lanes about, against the same on arrays.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "kernels/simd/compress.hpp"
#include "kernels/simd/math.hpp"
#include "kernels/simd/support.hpp"

using namespace mpmfast;

namespace {

using Draw = std::mt19937_64;

Lanes some(Draw& draw) {
  Lanes v;
  for (int i = 0; i < kLanes; ++i) v[i] = std::uniform_int_distribution<int>(-50, 50)(draw);
  return v;
}

}  // namespace

TEST_CASE("lanes are stored in pairs, as whole numbers, rounded, the first of them, or those chosen") {
  Draw draw(91);
  for (int round = 0; round < 50; ++round) {
    const Lanes a = some(draw), b = some(draw);
    double pairs[2 * kLanes];
    float short_pairs[2 * kLanes], rounded[kLanes];
    int whole[kLanes];
    store_pairs(pairs, a, b);
    store_pairs(short_pairs, a, b);
    store_lanes(rounded, a);
    store_indices(whole, a);
    for (int i = 0; i < kLanes; ++i) {
      CHECK(pairs[2 * i] == a[i]);
      CHECK(pairs[2 * i + 1] == b[i]);
      CHECK(short_pairs[2 * i] == static_cast<float>(a[i]));
      CHECK(short_pairs[2 * i + 1] == static_cast<float>(b[i]));
      CHECK(rounded[i] == static_cast<float>(a[i]));
      CHECK(whole[i] == static_cast<int>(a[i]));
    }
    for (int n = 0; n <= kLanes + 2; ++n) {
      double out[kLanes + 1];
      for (double& x : out) x = 77;
      store_first(out, a, n);
      for (int i = 0; i <= kLanes; ++i) CHECK(out[i] == (i < std::min(n, kLanes) ? a[i] : 77));
    }
    unsigned bits = 0;
    std::vector<double> chosen;
    for (int i = 0; i < kLanes; ++i)
      if (a[i] > b[i]) {
        bits |= 1u << i;
        chosen.push_back(a[i]);
      }
    CHECK(bits_of(a > b) == bits);
    CHECK(lane_bits(a > b) == bits);
    CHECK(any_of(a > b) == (bits != 0));
    double out[kLanes];
    store_chosen(out, a, bits);
    for (std::size_t i = 0; i < chosen.size(); ++i) CHECK(out[i] == chosen[i]);
  }
  for (int n = 0; n <= kLanes; ++n) CHECK(first_lanes(n) == (1u << n) - 1u);
  CHECK(!any_of(broadcast<Lanes>(1.0) > broadcast<Lanes>(1.0)));
}

TEST_CASE("lanes change places, are added to their neighbours, and the largest of them is found") {
  Draw draw(92);
  for (int round = 0; round < 200; ++round) {
    const Lanes a = some(draw), b = some(draw);
    const Lanes one = swap_lanes<1>(a), sums = add_neighbours(a, b);
    double most = a[0];
    for (int i = 0; i < kLanes; ++i) {
      CHECK(one[i] == a[i ^ 1]);
      if constexpr (kLanes > 2) CHECK(swap_lanes<2>(a)[i] == a[i ^ 2]);
      if constexpr (kLanes > 4) CHECK(swap_lanes<4>(a)[i] == a[i ^ 4]);
      const Lanes& from = i < kLanes / 2 ? a : b;
      const int k = 2 * i % kLanes;
      CHECK(sums[i] == from[k] + from[k + 1]);
      most = std::max(most, double{a[i]});
    }
    CHECK(largest_of(a) == most);
    CHECK(sum_of(2.5) == 2.5);
    CHECK(broadcast<Lanes>(-0.0)[kLanes - 1] == 0);
    CHECK(larger(2.0, 3.0) == 3);
    CHECK(smaller(2.0, 3.0) == 2);
    CHECK(magnitude(-2.0) == 2);
    CHECK(quotient(3.0, 2.0) == 1.5);
    CHECK(square_root(6.25) == 2.5);
  }
}

TEST_CASE("the foremost of values that come in lanes is the largest of those that count, and where it was") {
  Draw draw(93);
  for (int round = 0; round < 200; ++round) {
    SupportSearch support;
    double most = -std::numeric_limits<double>::infinity();
    int at = -1;
    const int takes = round % 5;
    for (int t = 0; t < takes; ++t) {
      Lanes value, mark;
      for (int i = 0; i < kLanes; ++i) {
        value[i] = std::uniform_real_distribution<double>(-1, 1)(draw);
        mark[i] = std::uniform_int_distribution<int>(0, 3)(draw);
        if (mark[i] > 1 && value[i] > most) {
          most = value[i];
          at = kLanes * t + i;
        }
      }
      support.take(value, mark > broadcast<Lanes>(1.0));
    }
    CHECK(support.found().value == most);
    CHECK(support.found().at == at);
  }
}

TEST_CASE("the inverse of a root is right to two units in the last place, of doubles and lanes") {
  Draw draw(94);
  for (int round = 0; round < 2000; ++round) {
    Lanes x;
    for (int i = 0; i < kLanes; ++i)
      x[i] = std::exp2(std::uniform_real_distribution<double>(-600, 600)(draw));
    const Lanes y = inverse_root(x);
    for (int i = 0; i < kLanes; ++i) {
      CHECK(std::abs(y[i] * std::sqrt(x[i]) - 1) < 6e-16);
      CHECK(std::abs(inverse_root(double{x[i]}) * std::sqrt(x[i]) - 1) < 6e-16);
    }
  }
}
