#pragma once

/// @file What depends on the number of space dimensions: vectors, index arithmetic, component counts.

#include <Eigen/Core>
#include <cstdint>

#include "kernels/tensor.hpp"

namespace mpmfast {

template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;
template <int Dim>
using NodeIndex = Eigen::Matrix<int, Dim, 1>;  ///< integer node coordinates, any sign

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

/// Nodes farther from the origin than this are nowhere: indices near them are sums that do not overflow.
inline constexpr double kFarthestNode = 1 << 30;

/// The whole number x as a node of an axis. What is too large, or no number, is a node that is nowhere.
constexpr int node_at(double x) {
  return static_cast<int>(x > -kFarthestNode ? (x < kFarthestNode ? x : kFarthestNode) : -kFarthestNode);
}

constexpr int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace mpmfast
