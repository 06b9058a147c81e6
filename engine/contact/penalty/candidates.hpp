#pragma once

/// @file Phase 1, find candidates: lists of facets of other bodies that may come into contact with a facet.
///
/// Lists hold while no point has moved by more than half of kListSkin since they were built. Their result is
/// that of new lists.

#include <span>
#include <vector>

#include "engine/contact/penalty/body_pairs.hpp"
#include "engine/contact/penalty/facet_bins.hpp"
#include "engine/contact/penalty/facet_bounds.hpp"
#include "engine/contact/penalty/nearby_surfaces.hpp"

namespace mpmfast::penalty {

/// The candidates of one facet.
struct FacetCandidates {
  int facet;
  int begin, end;  ///< into CandidateLists::facets; those of a body follow each other
  /// Distance from the facet's points to the candidates when the lists were built, m. 0 where a point was
  /// inside a body.
  double clearance = 0;
};

template <int Dim>
struct CandidateLists {
  std::vector<FacetCandidates> of_facet;  ///< of facets that have any, by rising number
  std::vector<int> facets;                ///< candidates of all of them
  std::vector<int> normal_cones;          ///< at the corners of all facets in the lists
  std::vector<Vec<Dim>> positions;        ///< when the lists were built, by point, m
  double displacement = 0;                ///< largest of a nearby point since then, m

  std::span<const int> candidates(const FacetCandidates& of) const {
    return {facets.data() + of.begin, facets.data() + of.end};
  }
};

/// Candidates that one thread found.
template <int Dim>
struct CandidateWorkspace {
  std::vector<FacetCandidates> of_facet;
  std::vector<int> facets;
  /// Facets around the bin that was searched last, for one body.
  int body = -1;
  NodeIndex<Dim> bin;
  std::vector<const BinnedFacet<Dim>*> around;
};

/// Finds the candidates of all facets within one grid cell plus the skin.
template <int Dim>
class CandidateSearch {
 public:
  CandidateSearch(const Surfaces<Dim>& surfaces, double cell, std::size_t threads);

  /// Tiles have changed, so that other parts of surfaces may come into contact.
  void invalidate_tiles() { tiles_changed_ = true; }

  /// Computes the bounds of nearby facets, and builds new lists where the old ones do not hold.
  void update(const State<Dim>& state, const SurfaceGeometry<Dim>& geometry, const BodyPairs& pairs);

  /// By facet; not known of facets that are not nearby.
  const std::vector<FacetBounds<Dim>>& bounds() const { return bounds_; }
  CandidateLists<Dim>& lists() { return lists_; }
  const CandidateLists<Dim>& lists() const { return lists_; }
  std::size_t bytes() const;

 private:
  void build(const SurfaceGeometry<Dim>& geometry, const BodyPairs& pairs, int threads);
  void merge(const SurfaceGeometry<Dim>& geometry);

  double cell_;  ///< m, of the grid
  bool tiles_changed_ = true;
  NearbySurfaces nearby_;
  std::vector<FacetBounds<Dim>> bounds_;
  FacetBins<Dim> bins_;
  std::vector<CandidateWorkspace<Dim>> workspaces_;  ///< by thread
  CandidateLists<Dim> lists_;
};

/// Removes those candidates that cannot have the closest point of their patch while the lists hold.
/// @param bounds  of all facets
/// @param skin    kListSkin, m
/// @param from    candidates before it stay
template <int Dim>
void remove_distant(const FacetBounds<Dim>& own, const Surfaces<Dim>& surfaces,
                    const std::vector<FacetBounds<Dim>>& bounds, double skin, std::size_t from,
                    std::vector<int>& candidates);

extern template class CandidateSearch<2>;
extern template class CandidateSearch<3>;

}  // namespace mpmfast::penalty
