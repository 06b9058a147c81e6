#pragma once

/// @file Bins of facets: a hash table from cells of a coarse lattice to the facets with their centre there.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/penalty/facet_bounds.hpp"

namespace mpmfast::penalty {

/// A facet in its bin.
template <int Dim>
struct BinnedFacet {
  NodeIndex<Dim> bin;
  int facet;
  FacetBounds<Dim> bounds;
};

template <int Dim>
class FacetBins {
 public:
  /// Sorts facets into bins. @param bounds  by facet; @param side  of a bin, m
  void fill(std::span<const int> facets, const std::vector<FacetBounds<Dim>>& bounds, double side);

  NodeIndex<Dim> bin_of(const Vec<Dim>& x) const {
    NodeIndex<Dim> bin;
    for (int d = 0; d < Dim; ++d) bin[d] = node_at(std::floor(x[d] / side_));
    return bin;
  }
  /// Calls visit(BinnedFacet) for the facets in a bin and in all that adjoin it.
  template <class Visit>
  void for_each_around(const NodeIndex<Dim>& bin, const Visit& visit) const {
    for (int k = 0; k < power(3, Dim); ++k) {
      NodeIndex<Dim> there = bin;
      int digits = k;
      for (int d = 0; d < Dim; ++d, digits /= 3) there[d] += digits % 3 - 1;
      const std::size_t bucket = bucket_of(there);
      for (int b = begin_[bucket]; b < begin_[bucket + 1]; ++b)
        if (item(facets_, b).bin == there) visit(item(facets_, b));
    }
  }
  std::size_t bytes() const { return bytes_of(begin_, facets_); }

 private:
  std::size_t bucket_of(const NodeIndex<Dim>& bin) const;

  double side_ = 1;         ///< m
  std::vector<int> begin_;  ///< by bucket, into facets_; a power of two of them, and the end
  std::vector<BinnedFacet<Dim>> facets_;
};

extern template class FacetBins<2>;
extern template class FacetBins<3>;

}  // namespace mpmfast::penalty
