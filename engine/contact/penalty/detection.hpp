#pragma once

/// @file Contact detection: phases 1 and 2 in sequence, with the memory that they keep from step to step.

#include <optional>
#include <vector>

#include "engine/contact/penalty/candidates.hpp"
#include "engine/contact/penalty/classify.hpp"

namespace mpmfast::penalty {

template <int Dim>
class ContactDetection {
 public:
  ContactDetection(const Surfaces<Dim>& surfaces, double cell, std::size_t threads);

  /// Tiles of particles have changed.
  void invalidate_tiles() { search_.invalidate_tiles(); }

  /// Finds the points of integration that are inside another body.
  /// @param geometry  surfaces at the positions of the particles
  /// @param out       by thread; contacts are replaced
  /// @return the point where a surface is folded onto itself, with `out` as it was; nothing if none is
  std::optional<int> find(const State<Dim>& state, const SurfaceGeometry<Dim>& geometry,
                          const BodyPairs& pairs, std::vector<ThreadContacts<Dim>>& out);

  std::size_t bytes() const;

 private:
  CandidateSearch<Dim> search_;
  std::vector<Vec<Dim>> vertex_normals_;            ///< by normal cone
  std::vector<ClassifyWorkspace<Dim>> workspaces_;  ///< by thread
};

extern template class ContactDetection<2>;
extern template class ContactDetection<3>;

}  // namespace mpmfast::penalty
