#include <doctest/doctest.h>

#include <limits>

#include "tools/study/pareto.hpp"

using namespace mpmfast;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<bool> front(const std::vector<double>& cost, const std::vector<double>& error) {
  return pareto_front(cost, error);
}

}  // namespace

TEST_CASE("the front holds what no other result beats in cost and error") {
  // The third costs more than the second and errs as much; the fifth costs as much as the fourth and errs
  // more.
  CHECK(front({1, 2, 3, 4, 4, 9}, {0.5, 0.2, 0.2, 0.1, 0.15, 0.4}) ==
        std::vector<bool>{true, true, false, true, false, false});
}

TEST_CASE("the front does not depend on the order of the results") {
  CHECK(front({9, 4, 4, 3, 2, 1}, {0.4, 0.15, 0.1, 0.2, 0.2, 0.5}) ==
        std::vector<bool>{false, false, true, false, true, true});
}

TEST_CASE("results that are equal in both stand on the front together") {
  CHECK(front({1, 1}, {0.1, 0.1}) == std::vector<bool>{true, true});
}

TEST_CASE("a result without a cost or an error is not on the front and beats nothing") {
  CHECK(front({1, kNone, 2, 3}, {kNone, 0, 0.2, 0.1}) == std::vector<bool>{false, false, true, true});
  CHECK(front({}, {}).empty());
}

TEST_CASE("an infinite error is beaten by any other at no more cost") {
  CHECK(front({1, 1}, {std::numeric_limits<double>::infinity(), 5}) == std::vector<bool>{false, true});
}
