#pragma once

/// @file Phase 3, compute contact forces (K24 Eq. 31, 33 to 35): normal springs, friction with its history,
/// and the reactions on the other body.

#include <vector>

#include "engine/contact/penalty/body_pairs.hpp"
#include "engine/contact/penalty/friction.hpp"
#include "engine/contact/penalty/point_contact.hpp"
#include "engine/contact/penalty/surface_geometry.hpp"

namespace mpmfast::penalty {

/// Positions at the start of this step and of the last.
template <int Dim>
struct SurfaceMotion {
  SurfaceGeometry<Dim> current, previous;
  double elapsed;      ///< between them, s; 0 in the first step
  std::uint64_t step;  ///< number of this step
};

/// Distributes the reaction to a force on the corners of a facet, with the moment of the force.
/// Friction acts at the closest point, not at the point of integration. The moment about the closest point is
/// taken by corner forces along the exit direction that sum to zero.
/// @param corner  positions of the facet's corners, m
/// @param force   on the point of integration, N
/// @param out     on the corners, N
template <int Dim>
void distribute_reaction(const PointContact<Dim>& contact, const std::array<Vec<Dim>, Dim>& corner,
                         const Vec<Dim>& force, Vec<Dim> (&out)[Dim]);

/// Computes the forces of all contacts.
/// @param contacts  by thread; forces and numbers of points are replaced
/// @param history   springs of the points in contact are restored and stored
template <int Dim>
void compute_contact_forces(const SurfaceMotion<Dim>& motion, const BodyPairs& pairs, int threads,
                            std::vector<ThreadContacts<Dim>>& contacts, FrictionHistory<Dim>& history);

/// Sums the forces on boundary points. @param out  by point, N; replaced
template <int Dim>
void assemble_point_forces(const Surfaces<Dim>& surfaces, const std::vector<ThreadContacts<Dim>>& contacts,
                           std::vector<Vec<Dim>>& out);

/// Energy of the tangential springs, J.
template <int Dim>
double tangential_energy(const std::vector<ThreadContacts<Dim>>& contacts);

}  // namespace mpmfast::penalty
