#pragma once

/// @file The displacement jump of two fields at a node, from the displacements of their particles.

#include <Eigen/LU>

#include "engine/contact/pairs/node_fields.hpp"

namespace mpmfast {

/// u_b − u_a of two fields at a node, from their displacements led to the node along their slopes, and turned
/// with the material: δ = F (X_a − X_b), X the initial positions of what is here now, 1 − F⁻¹ the mean slope
/// of both. (Without F, an interface that turns with its bodies would be sheared as it opens.)
template <int Dim>
Vec<Dim> extrapolated_jump(const State<Dim>& state, const NodeFields<Dim>& fields,
                           const ContactNode<Dim>& node, int a, int b) {
  const Vec<Dim> here = node.index.template cast<double>() * state.grid.cell;
  const auto slopes = [&](int k) {
    Mat<Dim> sum;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        sum(i, j) = state.nodes.column(Nodal::mass_slope, i * Dim + j)[fields.slot(k)];
    return sum;
  };
  const double mass_a = fields.mass(a), mass_b = fields.mass(b);
  const Mat<Dim> slope_a = slopes(a), slope_b = slopes(b);
  const Vec<Dim> u_a = (fields.vector(Nodal::mass_offset, a) + slope_a * here) / mass_a,
                 u_b = (fields.vector(Nodal::mass_offset, b) + slope_b * here) / mass_b;
  const Mat<Dim> inverse = Mat<Dim>::Identity() - (slope_a + slope_b) / (mass_a + mass_b);
  return inverse.inverse() * (u_b - u_a);
}

}  // namespace mpmfast
