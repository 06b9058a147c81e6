#pragma once

/// @file The largest root of a function of which one side is known.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"

namespace mpmfast {

/// Where `excess` becomes 0, coming down from `high`, where it is not positive: secants from above, and
/// between both sides once one is below. It is positive, or 0, at 0, and falls by no more than its argument
/// grows: excess(x) = M(x) − x, M not negative. Exact to kRootTolerance of the root.
template <class Excess>
double largest_root(double high, const Excess& excess) {
  double high_excess = excess(high), low = -1, low_excess = 0;
  if (!(high_excess < 0)) return high;
  double x = std::max(0.0, high + high_excess);
  int side = 0;  // that was moved last
  for (int k = 0; k < constants::kRootIterations; ++k) {
    const double here = excess(x);
    if (std::abs(here) <= constants::kRootTolerance * x) break;
    if (here < 0 && low < 0) {  // still above all roots
      const double slope = (high_excess - here) / (high - x);
      high = x, high_excess = here;
      x = std::max(0.0, std::min(x + here, slope < 0 ? x - here / slope : x));
      continue;
    }
    if (here > 0) {
      if (side > 0) high_excess *= 0.5;  // Illinois: no side stays for good
      low = x, low_excess = here, side = 1;
    } else {
      if (side < 0) low_excess *= 0.5;
      high = x, high_excess = here, side = -1;
    }
    if (!(high - low > constants::kRootTolerance * high)) break;
    x = (low * high_excess - high * low_excess) / (high_excess - low_excess);
  }
  return x;
}

}  // namespace mpmfast
