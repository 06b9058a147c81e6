#pragma once

/// @file Contacts of points of integration with facets of other bodies: what the phases hand on.

#include <cstddef>
#include <vector>

#include "kernels/dimension.hpp"

namespace mpmfast::penalty {

/// A point of integration that is inside another body, and a facet of one of this body's patches that pushes
/// it out. Contacts of a point follow each other.
template <int Dim>
struct PointContact {
  int own_facet, own_point;  ///< the facet of the point, and which of its points
  int facet;                 ///< of the other body, with the closest point
  double stiffness;          ///< of the normal spring, N/m
  double compression;        ///< of the normal spring, m: its force over its stiffness
  double energy;  ///< of the point's normal springs, J; 0 but in the point's first contact of a body
  Vec<Dim> exit_direction;  ///< unit
  double weight[Dim];       ///< of the facet's corners in the closest point
  Vec<Dim> to_surface;      ///< from the point to the closest point, m
};

/// Forces of a contact.
template <int Dim>
struct ContactForce {
  Vec<Dim> force;          ///< on the point of integration, N
  Vec<Dim> reaction[Dim];  ///< on the corners of the other body's facet, N
  double dissipated;       ///< by slip in this step, J
  double stored;           ///< in the tangential spring, J
};

/// Contacts that one thread found, by rising number of the facet, and their forces. Those of all threads in
/// sequence are in the same order for any number of threads.
template <int Dim>
struct alignas(64) ThreadContacts {  // a cache line of its own
  std::vector<PointContact<Dim>> contacts;
  std::vector<ContactForce<Dim>> forces;  ///< by contact
  std::size_t points = 0;                 ///< points of integration in contact
};

}  // namespace mpmfast::penalty
