#pragma once

/// @file What contact asks of the basis.

#include "engine/state/state.hpp"

namespace mpmfast {

template <int Dim>
struct NodeBox;  // kernels/contact/collect.hpp
template <int Dim>
struct Candidates;
template <int Dim>
struct CandidatePiece;
template <int Dim>
struct CloudWorkspace;

template <int Dim>
class ContactBasis {
 public:
  virtual ~ContactBasis() = default;

  /// Appends the particles of one tile whose supports may reach a node of the box.
  virtual void add_candidates(const TileContext<Dim, DomainView<Dim>>& tile, const NodeBox<Dim>& box,
                              Candidates<Dim>& out) const = 0;
  /// Appends the candidates of one piece whose basis functions cover the node to the cloud in hand.
  virtual void append_covering(const Candidates<Dim>& from, const CandidatePiece<Dim>& piece,
                               double inverse_cell, const NodeIndex<Dim>& node,
                               CloudWorkspace<Dim>& cloud) const = 0;
  /// Volumes, volume gradients, mean positions and displacements of the slots, as planned.
  /// @param cracks_alone  displacements serve cracks: only nodes near them want any
  virtual void project_geometry(State<Dim>& state, bool cracks_alone, bool cracks_displaced) = 0;
};

}  // namespace mpmfast
