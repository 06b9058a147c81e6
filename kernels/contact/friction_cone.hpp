#pragma once

/// @file Coulomb's cone: normal and tangential parts of an impulse, and the friction limit of the latter. A
/// vector is Vec<Dim>, or LaneVector<Dim> for kLanes impulses at once.

#include "kernels/dimension.hpp"
#include "kernels/simd/lane_vector.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// A vector as x = normal·n + tangential.
template <class Vector>
struct SplitVector {
  NumberOf<Vector> normal;  ///< x·n
  Vector tangential;
};

/// Splits x along the unit normal n.
template <class Vector>
inline SplitVector<Vector> split(const Vector& x, const Vector& n) {
  const NumberOf<Vector> normal = dot(x, n);
  return {normal, x - normal * n};
}

/// A tangential impulse after friction.
template <class Vector>
struct Friction {
  Vector impulse;  ///< N s
  MaskOf<NumberOf<Vector>> sticks;
};

/// Projects the tangential impulse that sticking needs into the cone: its length is at most `limit`.
/// @param needed  its length, N s. Zero always sticks: where unloaded surfaces slip, the caller gives a tiny
/// one.
/// @param limit   what the law carries, N s; infinite: sticks
template <class Vector>
inline Friction<Vector> into_cone(const Vector& tangential, const NumberOf<Vector>& needed,
                                  const NumberOf<Vector>& limit) {
  using Number = NumberOf<Vector>;
  const MaskOf<Number> sticks = needed <= limit;
  if constexpr (std::is_same_v<Number, double>)
    if (sticks) return {tangential, true};  // a branch costs less than the quotient
  return {chosen(sticks, broadcast<Number>(1.0), quotient(limit, needed)) * tangential, sticks};
}

}  // namespace mpmfast

#pragma GCC diagnostic pop
