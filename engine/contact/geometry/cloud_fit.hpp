#pragma once

/// @file The normal and the separation of one contact pair, from the cloud of particles around its node.

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "engine/contact/geometry/fit_choice.hpp"
#include "engine/contact/pairs/contact_list.hpp"
#include "kernels/contact/cloud.hpp"
#include "kernels/contact/margin.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// What one thread counts. Sums of whole numbers do not depend on their order.
struct alignas(64) FitTally {
  std::uint64_t regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
  std::uint64_t touching = 0, doubtful = 0;
};

/// Where the particles of each field of a node begin and end in its cloud.
struct FieldRanges {
  const int* first;
  int fields, count;
  std::pair<int, int> operator()(int k) const { return {first[k], k + 1 < fields ? first[k + 1] : count}; }
};

/// The last resort, where one side has no particles or the centroids coincide: the gradient normal with
/// G_pi ∝ −ξ_p, the slope of a paraboloid over the support.
template <int Dim>
Vec<Dim> cloud_gradient(const CloudView<Dim>& cloud) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (int k = 0; k < cloud.count; ++k)
    for (int d = 0; d < Dim; ++d) sum[d] += cloud.side[k] * cloud.xi[d][k];
  const double length = sum.norm();
  return length > 0 ? Vec<Dim>(sum / length) : Vec<Dim>::Zero();
}

/// The normal of the widest margin. @param warm  start from the normal of the last step
/// @return false where no plane separates the two sides
template <int Dim>
bool fit_margin(const CloudView<Dim>& cloud, bool warm, PairGeometry<Dim>& geometry, FitTally& tally) {
  Vec<Dim> guess = Eigen::Map<const Vec<Dim>>(geometry.plane);
  if (!warm || guess.isZero(0)) guess = cloud_gradient(cloud);
  if (guess.isZero(0)) return false;
  const Margin<Dim> margin = widest_margin<Dim>(cloud, guess);
  tally.iterations += static_cast<std::uint64_t>(margin.iterations);
  if (margin.normal.isZero(0)) return false;
  geometry.normal = margin.normal;
  for (int d = 0; d < Dim; ++d) geometry.plane[d] = margin.normal[d];
  return true;
}

/// The normal by the chosen fit, from the plane of the last step where `warm`; regression where a margin is
/// wanted and there is none.
/// @return whether the normal is that of a simpler method
template <int Dim>
bool fit_pair(const FitChoice& choice, bool warm, const CloudView<Dim>& cloud, PairGeometry<Dim>& geometry,
              FitTally& tally) {
  ++tally.regressions;
  if (choice.margin) {
    if (fit_margin(cloud, warm, geometry, tally)) return false;
    warm = false;  // the last step left a normal, not a plane
  }
  const Regression<Dim> result = fit_normal<Dim>(cloud, choice.rule, warm ? geometry.plane : nullptr);
  using Outcome = typename Regression<Dim>::Outcome;
  geometry.normal = result.outcome == Outcome::failed ? cloud_gradient(cloud) : result.normal;
  std::copy(std::begin(result.plane), std::end(result.plane), geometry.plane);
  tally.iterations += static_cast<std::uint64_t>(result.iterations);
  const bool fell_back =
      choice.margin || result.outcome == Outcome::centroid_fallback || result.outcome == Outcome::failed;
  tally.fallbacks += fell_back;
  tally.unconverged += result.outcome == Outcome::unconverged;
  return fell_back;
}

/// Calls f<E>() for an extent that is known at run time.
template <class F>
void with_extent(Extent extent, const F& f) {
  switch (extent) {
    case Extent::radial:
      return f.template operator()<Extent::radial>();
    case Extent::ellipsoid:
      return f.template operator()<Extent::ellipsoid>();
    case Extent::parallelepiped:
      return f.template operator()<Extent::parallelepiped>();
  }
}

/// The separation of a pair (N20 Eq. 24), cells; infinite if a side has no particles.
/// @param support  result, particles: of a along the normal, of the others against it; −1: none
template <int Dim>
double cloud_separation(Extent extent, const CloudColumns<Dim>& cloud, const FieldRanges& fields,
                        const ContactPair& pair, const Vec<Dim>& normal,
                        std::array<std::int32_t, 2>& support) {
  double gap = 0;
  with_extent(extent, [&]<Extent E>() {
    const auto reach = [&](std::pair<int, int> range, const Vec<Dim>& n) {
      const auto part = cloud.part(range.first, range.second - range.first);
      SupportSearch::Found found = reach_along<E>(part, n);
      if (found.at >= 0 && part.number) found.at = static_cast<int>(part.number[found.at]);
      return found;
    };
    const Vec<Dim> back = -normal;
    const auto own = fields(pair.a);
    const auto front = reach(own, normal);
    auto rest = pair.is_lumped() ? reach({0, own.first}, back) : reach(fields(pair.b), back);
    if (pair.is_lumped())
      if (const auto behind = reach({own.second, cloud.count}, back); behind.value > rest.value)
        rest = behind;
    gap = -front.value - rest.value;
    support = {front.at, rest.at};
  });
  return gap;
}

}  // namespace mpmfast
