#pragma once

/// @file The particles around a contact node, as the contact kernels see them.

#include "kernels/simd/lanes.hpp"

namespace mpmfast {

/// Point cloud of one contact node: every particle with S_pi ≠ 0 there. Coordinates relative to the node in
/// cells; class −1 for field a, +1 for the rest. The arrays are readable up to the next multiple of kLanes,
/// and the caller fills the rest with coordinates and side 0: side 0 marks an entry that does not count.
template <int Dim>
struct CloudView {
  const double* xi[Dim];
  const double* side;
  int count;
};

/// Entries that the arrays of a cloud of this many particles must have.
constexpr int padded_count(int count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// Particles of a cloud with their domains, valid until their workspace grows. What follows them is
/// readable for a vector more.
template <int Dim>
struct CloudColumns {
  const double* xi[Dim];           ///< relative to the node, cells
  const double* shape[Dim * Dim];  ///< of the domains, as their extent asks (domain_shape), cells; else null
  const double* number;            ///< of the particles, if asked for; else null
  int count;

  CloudColumns part(int first, int particles) const {
    CloudColumns c = *this;
    for (auto& column : c.xi) column += first;
    for (auto& column : c.shape)
      if (column) column += first;
    if (number) c.number += first;
    c.count = particles;
    return c;
  }
};

}  // namespace mpmfast
