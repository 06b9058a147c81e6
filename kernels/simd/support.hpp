#pragma once

/// @file The largest of values that come a vector at a time, and which it was.

#include <limits>

#include "kernels/simd/lanes.hpp"

namespace mpmfast {

class SupportSearch {
 public:
  /// The next kLanes values; those count where `counts` holds.
  void take(Lanes value, IntLanes counts) {
    const auto further = counts & (value > value_);
    value_ = further ? value : value_;
    at_ = further ? index_ : at_;
    index_ += static_cast<double>(kLanes);
  }

  struct Found {
    double value;  ///< −∞: none counted
    int at;        ///< −1: likewise
  };
  Found found() const {
    Lanes value = value_, at = at_;
    if constexpr (kLanes > 4) choose<4>(value, at);
    if constexpr (kLanes > 2) choose<2>(value, at);
    choose<1>(value, at);
    return {value[0], static_cast<int>(at[0])};
  }

 private:
  template <int Distance>
  static void choose(Lanes& value, Lanes& at) {
    const Lanes other = swap_lanes<Distance>(value), other_at = swap_lanes<Distance>(at);
    at = other > value ? other_at : at;
    value = larger(value, other);
  }
  static Lanes counted() {
    Lanes index;
    for (int i = 0; i < kLanes; ++i) index[i] = i;
    return index;
  }

  Lanes value_ = broadcast<Lanes>(-std::numeric_limits<double>::infinity()), at_ = broadcast<Lanes>(-1.0),
        index_ = counted();
};

}  // namespace mpmfast
