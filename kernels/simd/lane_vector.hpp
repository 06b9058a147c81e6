#pragma once

/// @file Vectors of lanes, and operations under one name for numbers and for lanes, so that one algorithm
/// runs over both.

#include <type_traits>
#include <utility>

#include "kernels/dimension.hpp"
#include "kernels/simd/lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // g++ 12, of arrays of vectors that loops fill

namespace mpmfast {

/// kLanes vectors, component by component.
template <int Dim>
struct LaneVector {
  Lanes component[Dim];

  /// The vector of f(0), f(1), …. (Without a loop: a compiler keeps the components in registers.)
  template <class F>
  static LaneVector of(const F& f) {
    return [&]<int... D>(std::integer_sequence<int, D...>) { return LaneVector{{f(D)...}}; }
    (std::make_integer_sequence<int, Dim>());
  }

  Lanes& operator[](int d) { return component[d]; }
  const Lanes& operator[](int d) const { return component[d]; }

  LaneVector& operator+=(const LaneVector& other) { return *this = *this + other; }
  LaneVector& operator-=(const LaneVector& other) { return *this = *this - other; }
  friend LaneVector operator+(const LaneVector& a, const LaneVector& b) {
    return of([&](int d) { return a[d] + b[d]; });
  }
  friend LaneVector operator-(const LaneVector& a, const LaneVector& b) {
    return of([&](int d) { return a[d] - b[d]; });
  }
  friend LaneVector operator*(const Lanes& factor, const LaneVector& x) {
    return of([&](int d) { return factor * x[d]; });
  }
};

/// A vector of numbers, or of lanes.
template <int Dim, class Number>
using VectorOf = std::conditional_t<std::is_same_v<Number, double>, Vec<Dim>, LaneVector<Dim>>;
/// A condition for each number.
template <class Number>
using MaskOf = std::conditional_t<std::is_same_v<Number, double>, bool, IntLanes>;
/// What the components of a vector are.
template <class Vector>
using NumberOf = std::remove_cvref_t<decltype(std::declval<const Vector&>()[0])>;

template <int Dim>
inline double dot(const Vec<Dim>& x, const Vec<Dim>& y) {
  return x.dot(y);
}
template <int Dim>
inline Lanes dot(const LaneVector<Dim>& x, const LaneVector<Dim>& y) {
  Lanes sum = x[0] * y[0];
  for (int d = 1; d < Dim; ++d) sum += x[d] * y[d];
  return sum;
}

/// a where the condition holds, else b.
template <class T>
inline T chosen(bool which, const T& a, const T& b) {
  return which ? a : b;
}
inline Lanes chosen(IntLanes which, Lanes a, Lanes b) { return which ? a : b; }
inline IntLanes chosen(IntLanes which, IntLanes a, IntLanes b) { return which ? a : b; }
template <int Dim>
inline LaneVector<Dim> chosen(IntLanes which, const LaneVector<Dim>& a, const LaneVector<Dim>& b) {
  return LaneVector<Dim>::of([&](int d) { return which ? a[d] : b[d]; });
}

inline bool any_of(bool condition) { return condition; }
inline bool opposite(bool condition) { return !condition; }
inline IntLanes opposite(IntLanes condition) { return ~condition; }

}  // namespace mpmfast

#pragma GCC diagnostic pop
