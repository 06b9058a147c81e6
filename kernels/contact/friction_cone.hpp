#pragma once

/// @file Coulomb's cone: normal and tangential parts of an impulse, and the friction limit of the latter.

#include "kernels/dimension.hpp"

namespace mpmfast {

/// A vector as x = normal·n + tangential.
template <int Dim>
struct SplitVector {
  double normal;  ///< x·n
  Vec<Dim> tangential;
};

/// Splits x along the unit normal n.
template <int Dim>
inline SplitVector<Dim> split(const Vec<Dim>& x, const Vec<Dim>& n) {
  const double normal = x.dot(n);
  return {normal, x - normal * n};
}

/// A tangential impulse after friction.
template <int Dim>
struct Friction {
  Vec<Dim> impulse;  ///< N s
  bool sticks;
};

/// Projects the tangential impulse that sticking needs into the cone: its length is at most `limit`.
/// @param needed  its length, N s
/// @param limit   what the law carries, N s; infinite: sticks
template <int Dim>
inline Friction<Dim> into_cone(const Vec<Dim>& tangential, double needed, double limit) {
  if (needed <= limit) return {tangential, true};
  return {(limit / needed) * tangential, false};
}

}  // namespace mpmfast
