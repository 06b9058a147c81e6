#pragma once

/// @file Which results no other one beats.

#include <cmath>
#include <span>
#include <vector>

namespace mpmfast {

/// True where no other point costs no more, errs no more, and is better in one of the two. A point with a
/// cost or an error that is not a number is never on the front and beats nothing.
inline std::vector<bool> pareto_front(std::span<const double> cost, std::span<const double> error) {
  std::vector<bool> front(cost.size());
  const auto known = [&](std::size_t k) { return !std::isnan(cost[k]) && !std::isnan(error[k]); };
  for (std::size_t a = 0; a < cost.size(); ++a) {
    bool beaten = !known(a);
    for (std::size_t b = 0; b < cost.size() && !beaten; ++b)
      beaten = known(b) && cost[b] <= cost[a] && error[b] <= error[a] &&
               (cost[b] < cost[a] || error[b] < error[a]);
    front[a] = !beaten;
  }
  return front;
}

}  // namespace mpmfast
