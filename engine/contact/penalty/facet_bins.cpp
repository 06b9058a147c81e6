#include "engine/contact/penalty/facet_bins.hpp"

#include "engine/constants.hpp"

namespace mpmfast::penalty {

namespace {

/// Large primes that spread neighbouring bins over the buckets, by axis. They affect time only.
constexpr std::uint32_t kHashPrimes[3] = {73856093u, 19349663u, 83492791u};

/// Shift that mixes high bits of the hash into the low ones, bits. It affects time only.
constexpr int kHashShift = 15;

}  // namespace

template <int Dim>
std::size_t FacetBins<Dim>::bucket_of(const NodeIndex<Dim>& bin) const {
  std::uint32_t hash{};
  for (int d = 0; d < Dim; ++d) hash ^= static_cast<std::uint32_t>(bin[d]) * kHashPrimes[d];
  hash ^= hash >> kHashShift;
  const auto buckets = static_cast<std::uint32_t>(begin_.size() - 1);
  return hash & (buckets - 1);
}

template <int Dim>
void FacetBins<Dim>::fill(std::span<const int> facets, const std::vector<FacetBounds<Dim>>& bounds,
                          double side) {
  side_ = side;
  const std::size_t n = facets.size();
  std::size_t buckets = kLeastBuckets;
  while (buckets < kBucketsPerFacet * n) buckets *= 2;
  begin_.assign(buckets + 1, 0);
  facets_.resize(n);
  const auto bin_of_facet = [&](std::size_t k) { return bin_of(item(bounds, facets[k]).centre); };
  for (std::size_t k = 0; k < n; ++k) ++begin_[bucket_of(bin_of_facet(k))];
  for (std::size_t b = 0; b < buckets; ++b) begin_[b + 1] += begin_[b];
  // From behind, so that each bucket has its facets in rising order.
  for (std::size_t k = n; k-- > 0;) {
    const NodeIndex<Dim> bin = bin_of_facet(k);
    item(facets_, --begin_[bucket_of(bin)]) = {bin, facets[k], item(bounds, facets[k])};
  }
}

template class FacetBins<2>;
template class FacetBins<3>;

}  // namespace mpmfast::penalty
