#pragma once

/// @file What depends on the number of space dimensions: vectors, index arithmetic, component counts.

#include <Eigen/Core>
#include <cstdint>

namespace mpmfast {

template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;
template <int Dim>
using NodeIndex = Eigen::Matrix<int, Dim, 1>;  ///< integer node coordinates, any sign

/// Components of a symmetric tensor, in the order xx, yy, zz, xy (plane strain carries zz), then yz, xz in
/// 3-D.
template <int Dim>
inline constexpr int kSymmetric = Dim == 2 ? 4 : 6;

/// What the stretch along the normal of a plane does: nothing (plane strain; three dimensions), what leaves
/// no stress there (plane stress), or what a circle about the axis x = 0 does (axisymmetry: x is the radius,
/// y runs along the axis, z round it).
enum class Depth { held, relaxed, hoop };

inline constexpr double kFullTurn = 6.283185307179586477;  ///< 2π

constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// Nodes along the side of a tile, and nodes in a tile.
inline constexpr int kTileSide = 4;
template <int Dim>
inline constexpr int kTileNodes = power(kTileSide, Dim);

/// The window of nodes that the particles of one tile may touch: the tile and its upper neighbours.
inline constexpr int kWindowSide = 2 * kTileSide;
template <int Dim>
inline constexpr int kWindowNodes = power(kWindowSide, Dim);

/// Tiles under a window.
template <int Dim>
inline constexpr int kCorners = power(2, Dim);

constexpr int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace mpmfast
