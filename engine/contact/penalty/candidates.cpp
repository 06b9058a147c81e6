#include "engine/contact/penalty/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

namespace {

/// The farthest that one of the points has moved, m.
template <int Dim>
double largest_displacement(const std::vector<int>& points, const std::vector<Vec<Dim>>& from,
                            const SurfaceGeometry<Dim>& to) {
  double squared = 0;
  for (int p : points) squared = std::max(squared, (to.position(p) - item(from, p)).squaredNorm());
  return std::sqrt(squared);
}

/// Least distance from the centre of a facet to the centres of each patch.
class PatchDistances {
 public:
  /// @return nothing where there are more patches than kMaxListedPatches
  double* find_or_add(int patch) {
    std::size_t k = 0;
    while (k < count_ && patches_[k].number != patch) ++k;
    if (k == patches_.size()) return nullptr;
    if (k == count_) patches_[count_++] = {patch, kInfinity};
    return &patches_[k].least;
  }

 private:
  struct Patch {
    int number;
    double least;  ///< m
  };
  std::array<Patch, kMaxListedPatches> patches_;
  std::size_t count_ = 0;
};

/// Appends the candidates of one facet, by rising number.
template <int Dim>
void find_candidates(int own, const Surfaces<Dim>& surfaces, const FacetBins<Dim>& bins,
                     const std::vector<FacetBounds<Dim>>& bounds, const BodyPairs& pairs,
                     CandidateWorkspace<Dim>& workspace) {
  const FacetBounds<Dim>& own_bounds = item(bounds, own);
  const NodeIndex<Dim> bin = bins.bin_of(own_bounds.centre);
  if (workspace.body != own_bounds.body || workspace.bin != bin) {  // most follow one of the same bin
    workspace.body = own_bounds.body;
    workspace.bin = bin;
    workspace.around.clear();
    bins.for_each_around(bin, [&](const BinnedFacet<Dim>& other) {
      if (pairs.may_touch(own_bounds.body, other.bounds.body)) workspace.around.push_back(&other);
    });
    std::sort(workspace.around.begin(), workspace.around.end(),
              [](const auto* a, const auto* b) { return a->facet < b->facet; });
  }
  const std::size_t begin = workspace.facets.size();
  for (const BinnedFacet<Dim>* other : workspace.around) {
    const double most = (1 + kListSkin) * pairs.cell + own_bounds.radius + other->bounds.radius;
    if ((own_bounds.centre - other->bounds.centre).squaredNorm() <= most * most)
      workspace.facets.push_back(other->facet);
  }
  remove_distant(own_bounds, surfaces, bounds, kListSkin * pairs.cell, begin, workspace.facets);
  const std::size_t end = workspace.facets.size();
  if (end > begin) workspace.of_facet.push_back({own, static_cast<int>(begin), static_cast<int>(end)});
}

}  // namespace

template <int Dim>
void remove_distant(const FacetBounds<Dim>& own, const Surfaces<Dim>& surfaces,
                    const std::vector<FacetBounds<Dim>>& bounds, double skin, std::size_t from,
                    std::vector<int>& candidates) {
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(from);
  const auto distance = [&](int f) { return (own.centre - item(bounds, f).centre).norm(); };
  PatchDistances patches;
  for (auto f = begin; f != candidates.end(); ++f) {
    double* least = patches.find_or_add(surfaces.facet(*f).patch);
    if (!least) return;  // more patches than can be compared: all candidates stay
    *least = std::min(*least, distance(*f));
  }
  const double slack = 2 * (own.radius + skin);
  const auto distant = [&](int f) {
    return distance(f) - item(bounds, f).radius > *patches.find_or_add(surfaces.facet(f).patch) + slack;
  };
  candidates.erase(std::remove_if(begin, candidates.end(), distant), candidates.end());
}

template <int Dim>
CandidateSearch<Dim>::CandidateSearch(const Surfaces<Dim>& surfaces, double cell, std::size_t threads)
    : cell_(cell), bounds_(surfaces.facets.size()), workspaces_(threads) {}

template <int Dim>
void CandidateSearch<Dim>::update(const State<Dim>& state, const SurfaceGeometry<Dim>& geometry,
                                  const BodyPairs& pairs) {
  const bool grown = tiles_changed_ && update_nearby(state, nearby_);
  tiles_changed_ = false;
  if (grown)
    for (FacetBounds<Dim>& bounds : bounds_) bounds.body = -1;
  compute_bounds<Dim>(geometry, nearby_.facets, state.threads, bounds_);
  lists_.displacement = grown ? kInfinity : largest_displacement(nearby_.points, lists_.positions, geometry);
  if (!(lists_.displacement <= 0.5 * kListSkin * cell_)) build(geometry, pairs, state.threads);
}

/// The side of the bins is such that all candidates of a facet lie in the bins around its own.
template <int Dim>
void CandidateSearch<Dim>::build(const SurfaceGeometry<Dim>& geometry, const BodyPairs& pairs, int threads) {
  double widest = 0;
  for (int f : nearby_.facets) widest = std::max(widest, item(bounds_, f).radius);
  bins_.fill(nearby_.facets, bounds_, (1 + kListSkin) * cell_ + 2 * widest);
  for (auto& workspace : workspaces_) {
    workspace.of_facet.clear();
    workspace.facets.clear();
    workspace.body = -1;
  }
  // Threads take stretches of facets in order of their numbers, so that merged lists are in order.
  for_each_of(static_cast<std::int64_t>(nearby_.facets.size()), threads, kSerialFacets, [&](std::int64_t k) {
    find_candidates(item(nearby_.facets, k), geometry.surfaces(), bins_, bounds_, pairs,
                    item(workspaces_, thread_index()));
  });
  merge(geometry);
}

template <int Dim>
void CandidateSearch<Dim>::merge(const SurfaceGeometry<Dim>& geometry) {
  lists_.of_facet.clear();
  lists_.facets.clear();
  for (const auto& workspace : workspaces_) {
    const int before = static_cast<int>(lists_.facets.size());
    for (const FacetCandidates& one : workspace.of_facet)
      lists_.of_facet.push_back({one.facet, before + one.begin, before + one.end});
    lists_.facets.insert(lists_.facets.end(), workspace.facets.begin(), workspace.facets.end());
  }
  // A candidate has candidates itself, so that these facets are all in the lists.
  auto& cones = lists_.normal_cones;
  cones.clear();
  for (const FacetCandidates& one : lists_.of_facet)
    for (int cone : geometry.facet(one.facet).normal_cone) cones.push_back(cone);
  std::sort(cones.begin(), cones.end());
  cones.erase(std::unique(cones.begin(), cones.end()), cones.end());
  lists_.positions = geometry.positions();
  lists_.displacement = 0;
}

template <int Dim>
std::size_t CandidateSearch<Dim>::bytes() const {
  std::size_t sum = bytes_of(nearby_.points, nearby_.facets, nearby_.in_reach, nearby_.marked, nearby_.shared,
                             bounds_, lists_.of_facet, lists_.facets, lists_.normal_cones, lists_.positions) +
                    bins_.bytes();
  for (const auto& workspace : workspaces_)
    sum += bytes_of(workspace.of_facet, workspace.facets, workspace.around);
  return sum;
}

template class CandidateSearch<2>;
template class CandidateSearch<3>;

template void remove_distant<2>(const FacetBounds<2>&, const Surfaces<2>&, const std::vector<FacetBounds<2>>&,
                                double, std::size_t, std::vector<int>&);
template void remove_distant<3>(const FacetBounds<3>&, const Surfaces<3>&, const std::vector<FacetBounds<3>>&,
                                double, std::size_t, std::vector<int>&);

}  // namespace mpmfast::penalty
