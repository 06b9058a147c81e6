#pragma once

/// @file What one thread works in while it fits the normals of contact nodes.

#include <vector>

#include "engine/contact/geometry/cloud_fit.hpp"
#include "kernels/contact/collect.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

template <int Dim>
struct alignas(64) FitWorkspace {
  int block;                                ///< whose candidates are listed; −1: none
  Candidates<Dim> candidates;               ///< particles near it
  std::vector<CloudWorkspace<Dim>> clouds;  ///< of the slabs whose clouds are kept
  CloudWorkspace<Dim> of_pair;              ///< the particles of two fields of a node
  std::vector<double> side;                 ///< −1, 1 or 0 for each particle of a pair (fill_sides)
  std::vector<Vec<Dim>> sums;               ///< of normals, by pair of a node
  FitTally tally;

  /// The particles of a pair, with their sides in `side`: those of its two fields, or all of them for a
  /// lumped pair.
  CloudColumns<Dim> particles_of(const CloudColumns<Dim>& cloud, const FieldRanges& ranges,
                                 const ContactPair& pair) {
    const auto [a_begin, a_end] = ranges(pair.a);
    if (pair.is_lumped() || ranges.fields == 2) {
      fill_sides(cloud.count, a_begin, a_end);
      return cloud;
    }
    const auto [b_begin, b_end] = ranges(pair.b);
    const int count = a_end - a_begin + b_end - b_begin, low = std::min(a_begin, b_begin);
    if (std::max(a_end, b_end) - low == count) {  // they follow each other in the cloud
      fill_sides(count, a_begin - low, a_end - low);
      return cloud.part(low, count);
    }
    of_pair.count = 0;
    of_pair.append_positions(cloud, a_begin, a_end);
    of_pair.append_positions(cloud, b_begin, b_end);
    fill_sides(count, 0, a_end - a_begin);
    return of_pair.columns(0, count);
  }

  CloudView<Dim> view(const CloudColumns<Dim>& cloud) const {
    CloudView<Dim> v;
    for (int d = 0; d < Dim; ++d) v.xi[d] = cloud.xi[d];
    v.side = side.data();
    v.count = cloud.count;
    return v;
  }

 private:
  /// −1 for [begin, end), 1 for the other particles, 0 beyond the last.
  void fill_sides(int count, int begin, int end) {
    const auto needed = static_cast<std::size_t>(padded_count(count));
    if (side.size() < needed) side.resize(2 * needed);
    const Lanes zero{}, one = broadcast<Lanes>(1.0);
    Lanes index;
    for (int i = 0; i < kLanes; ++i) index[i] = i;
    for (int k = 0; k < count; k += kLanes) {
      const IntLanes own = (index >= static_cast<double>(begin)) & (index < static_cast<double>(end));
      const Lanes counted = index < static_cast<double>(count) ? one : zero;
      store_lanes(&side[static_cast<std::size_t>(k)], own ? -one : counted);
      index += static_cast<double>(kLanes);
    }
  }
};

}  // namespace mpmfast
