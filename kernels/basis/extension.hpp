#pragma once

/// @file Extended B-splines (K24 §3.3; Höllig, Reif, Wipper 2002): the value at a node with hardly any
/// material near follows those of a block of nodes that have enough.

#include "kernels/dimension.hpp"

namespace mpmfast {

/// The value at node j of the polynomial that is 1 at node i and 0 at the other nodes 0 … order (K24 Eq. 24).
inline double lagrange_weight(int order, int i, int j) {
  double product = 1;
  for (int k = 0; k <= order; ++k)
    if (k != i) product *= static_cast<double>(j - k) / (i - k);
  return product;
}

/// E_IJ of node J, `at` nodes from the lowest of a block of (order + 1)^Dim nodes, for I, the n-th of these
/// (x fastest). Polynomials of that order along each axis, of the nodes' coordinates, are exact; Σ_I E_IJ
/// = 1.
template <int Dim>
inline double extension_weight(int order, int n, const NodeIndex<Dim>& at) {
  double product = 1;
  for (int d = 0; d < Dim; ++d, n /= order + 1) product *= lagrange_weight(order, n % (order + 1), at[d]);
  return product;
}

}  // namespace mpmfast
