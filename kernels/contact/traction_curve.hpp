#pragma once

/// @file A traction over the jump of two surfaces, as points of a curve, and the energy below it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace mpmfast {

/// Traction T(δ): linear between the points. After the last it stays; before the first it goes on with the
/// slope of the first segment where that rises, so that what is pressed cannot pass. One point: constant.
/// Piece k of it lies between the points k − 1 and k.
struct TractionCurve {
  std::vector<double> jump;      ///< m, strictly increasing, at least one entry
  std::vector<double> traction;  ///< Pa, as many entries as `jump`

  int pieces() const { return static_cast<int>(jump.size()) + 1; }
  double lower(int k) const { return k > 0 ? jump[static_cast<std::size_t>(k) - 1] : -kFar; }
  double upper(int k) const { return k + 1 < pieces() ? jump[static_cast<std::size_t>(k)] : kFar; }
  /// Pa/m
  double slope(int k) const {
    if (jump.size() < 2 || k + 1 == pieces()) return 0;
    const auto n = static_cast<std::size_t>(std::max(k, 1));
    const double slope = (traction[n] - traction[n - 1]) / (jump[n] - jump[n - 1]);
    return k == 0 ? std::max(0.0, slope) : slope;
  }
  /// The piece of a jump; of a point the one that follows, or comes before it.
  int piece_of(double x, bool follows) const {
    const auto found = follows ? std::upper_bound(jump.begin(), jump.end(), x)
                               : std::lower_bound(jump.begin(), jump.end(), x);
    return static_cast<int>(found - jump.begin());
  }
  double at(double x) const {
    const int k = piece_of(x, true);
    const auto n = static_cast<std::size_t>(std::max(k, 1)) - 1;
    return traction[n] + slope(k) * (x - jump[n]);
  }
  /// ∫ T from 0 to a jump, J/m².
  double energy(double x) const { return energy_from_first(x) - energy_from_first(0); }
  /// The largest |slope|, Pa/m.
  double steepest() const {
    if (known.ready) return known.steepest;
    double most = 0;
    for (int k = 1; k + 1 < pieces(); ++k) most = std::max(most, std::abs(slope(k)));
    return most;
  }
  /// The largest T(δ)/δ of jumps above 0, Pa/m: it is at a point. For T(0) = 0.
  double largest_secant() const {
    if (known.ready) return known.secant;
    double most = 0;
    for (std::size_t n = 0; n < jump.size(); ++n)
      if (jump[n] > 0) most = std::max(most, traction[n] / jump[n]);
    return most;
  }
  /// The curve with no piece steeper than this (Pa/m): those that are reach as far as it takes, seen from 0,
  /// so that every traction is still reached. It remembers what it is asked often.
  TractionCurve widened(double most) const {
    TractionCurve out = *this;
    const auto zero =
        static_cast<std::size_t>(std::lower_bound(jump.begin(), jump.end(), 0.0) - jump.begin());
    const auto width = [&](std::size_t n) {  // between the points n − 1 and n
      return std::max(jump[n] - jump[n - 1], std::abs(traction[n] - traction[n - 1]) / most);
    };
    for (std::size_t n = zero + 1; n < jump.size(); ++n) out.jump[n] = out.jump[n - 1] + width(n);
    for (std::size_t n = std::min(zero, jump.size() - 1); n-- > 0;)
      out.jump[n] = out.jump[n + 1] - width(n + 1);
    out.known.below.clear();
    for (std::size_t n = 0; n < jump.size(); ++n)
      out.known.below.push_back(n == 0 ? 0
                                       : out.known.below.back() + 0.5 * (traction[n] + traction[n - 1]) *
                                                                      (out.jump[n] - out.jump[n - 1]));
    out.known = {false, out.steepest(), out.largest_secant(), std::move(out.known.below)};
    out.known.ready = true;
    return out;
  }

  /// What is asked often; only of curves that are made by `widened`.
  struct Known {
    bool ready = false;
    double steepest = 0, secant = 0;
    std::vector<double> below = {};  ///< ∫ T from the first point to each, J/m²
  };
  Known known = {};

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  double energy_from_first(double x) const {
    double sum = 0, from = jump.front();
    int k = 1;
    if (x < from) return 0.5 * (traction.front() + at(x)) * (x - from);
    if (known.ready) {
      k = piece_of(x, true);
      sum = known.below[static_cast<std::size_t>(k) - 1], from = lower(k);
    }
    for (; from < x; ++k) {
      const double to = std::min(x, upper(k));
      sum += 0.5 * (at(from) + at(to)) * (to - from);
      from = to;
    }
    return sum;
  }
};

}  // namespace mpmfast
