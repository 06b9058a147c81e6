#pragma once

/// @file Makes the list of points of a step from the samples of the contact nodes.

#include <vector>

#include "engine/contact/geometry/free_directions.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/contact/surface/point_memory.hpp"
#include "engine/contact/surface/surface_list.hpp"
#include "engine/contact/surface/surface_sample.hpp"

namespace mpmfast {

template <int Dim>
class PointFinder {
 public:
  /// Lists the points in the order of their nodes, with what the last step left of them.
  /// @param samples  by pair of the contact list
  void find(const State<Dim>& state, const PairLaws& laws, const FreeDirections<Dim>& free,
            const ContactList<Dim>& contacts, const std::vector<SurfaceSample<Dim>>& samples,
            const PointMemory<Dim>& memory, SurfaceList<Dim>& points);

  std::size_t bytes() const { return bytes_in(node_at_); }

 private:
  /// The points of one thread's share of the contact nodes.
  struct alignas(64) Listing {
    std::vector<PointGeometry<Dim>> geometry;
    std::vector<PointStencil<Dim>> stencil;  ///< with slots in place of nodes
    std::vector<int> contact_node;
    std::size_t begin;  ///< of its first point in the whole list
  };

  void list_point(const State<Dim>& state, const PairLaws& laws, const ContactList<Dim>& contacts, int node,
                  int e, const SampledPoint<Dim>& sampled, Listing& out) const;
  void place_listings(const State<Dim>& state, const ContactList<Dim>& contacts, SurfaceList<Dim>& points);
  void number_nodes(const State<Dim>& state, const FreeDirections<Dim>& free, SurfaceList<Dim>& points);

  std::vector<Listing> listings_;  ///< by thread
  Indexed<int> node_at_;           ///< by slot, into SurfaceList::nodes; −1: none
};

extern template class PointFinder<2>;
extern template class PointFinder<3>;

}  // namespace mpmfast
