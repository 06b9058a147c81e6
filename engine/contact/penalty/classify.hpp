#pragma once

/// @file Phase 2, classify: points of integration that are inside another body (K24 Eq. 28), by closest-point
/// projection on the candidates.

#include <vector>

#include "engine/contact/penalty/candidates.hpp"
#include "engine/contact/penalty/point_contact.hpp"

namespace mpmfast::penalty {

/// Of the candidates of a facet, those of one body.
template <int Dim>
struct BodyCandidates {
  int body;
  int begin, end;                  ///< into CandidateLists::facets
  int nearest[kFacetPoints<Dim>];  ///< the candidate with its centre nearest to each point
  double largest_radius;           ///< of their bounds, m
};

/// Memory of one thread.
template <int Dim>
struct alignas(64) ClassifyWorkspace {
  std::vector<BodyCandidates<Dim>> bodies;
  std::vector<double> squared;  ///< from each point to the centre of each candidate, m²
};

/// Finds the contacts of all facets in the lists.
/// @param geometry        surfaces at the positions of this step
/// @param bounds          by facet
/// @param vertex_normals  by normal cone
/// @param lists           candidates; lists that were just built receive their clearance
/// @param workspaces      by thread
/// @param out             by thread; contacts are replaced
template <int Dim>
void classify(const SurfaceGeometry<Dim>& geometry, const std::vector<FacetBounds<Dim>>& bounds,
              const std::vector<Vec<Dim>>& vertex_normals, const BodyPairs& pairs, int threads,
              CandidateLists<Dim>& lists, std::vector<ClassifyWorkspace<Dim>>& workspaces,
              std::vector<ThreadContacts<Dim>>& out);

/// Energy of the normal springs of the contacts, added to `sum`, J.
template <int Dim>
double add_normal_energy(double sum, const std::vector<ThreadContacts<Dim>>& found);

}  // namespace mpmfast::penalty
