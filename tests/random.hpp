#pragma once

/// @file Random numbers that are the same with every library: the distributions of <random> are not.

#include <concepts>
#include <cstdint>
#include <random>

namespace mpmfast::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// 0 … n − 1; n > 0.
  template <std::integral I>
  I below(I n) {
    return static_cast<I>(engine_() % static_cast<std::uint64_t>(n));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace mpmfast::test
