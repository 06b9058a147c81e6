#pragma once

/// @file Moments of forces.

#include <Eigen/Geometry>

#include "kernels/dimension.hpp"

namespace mpmfast::penalty {

/// Moment of a force about a point: in 2-D its component out of the plane, N m.
/// @param arm  from the point to the force, m
template <int Dim>
auto moment(const Vec<Dim>& arm, const Vec<Dim>& force) {
  if constexpr (Dim == 2)
    return arm[0] * force[1] - arm[1] * force[0];
  else
    return Vec<3>(arm.cross(force));
}

}  // namespace mpmfast::penalty
