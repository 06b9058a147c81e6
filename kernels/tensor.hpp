#pragma once

/// @file Symmetric tensors as laws see them, and what planes do along their normal.

namespace mpmfast {

/// Components of a symmetric tensor, in the order xx, yy, zz, xy (plane strain carries zz), then yz, xz in
/// 3-D.
template <int Dim>
inline constexpr int kSymmetric = Dim == 2 ? 4 : 6;

/// What the stretch along the normal of a plane does: nothing (plane strain; three dimensions), what leaves
/// no stress there (plane stress), or what a circle about the axis x = 0 does (axisymmetry: x is the radius,
/// y runs along the axis, z round it).
enum class PlaneKind { plane_strain, plane_stress, axisymmetric };

}  // namespace mpmfast
