#include "engine/contact/penalty/detection.hpp"

#include "engine/contact/penalty/vertex_normals.hpp"

namespace mpmfast::penalty {

template <int Dim>
ContactDetection<Dim>::ContactDetection(const Surfaces<Dim>& surfaces, double cell, std::size_t threads)
    : search_(surfaces, cell, threads),
      vertex_normals_(surfaces.normal_cones.size(), Vec<Dim>::Zero()),
      workspaces_(threads) {}

template <int Dim>
std::optional<int> ContactDetection<Dim>::find(const State<Dim>& state, const SurfaceGeometry<Dim>& geometry,
                                               const BodyPairs& pairs,
                                               std::vector<ThreadContacts<Dim>>& out) {
  search_.update(state, geometry, pairs);
  const auto folded = compute_vertex_normals<Dim>(geometry, search_.bounds(), search_.lists().normal_cones,
                                                  state.threads, vertex_normals_);
  if (folded) return folded;
  classify(geometry, search_.bounds(), vertex_normals_, pairs, state.threads, search_.lists(), workspaces_,
           out);
  return std::nullopt;
}

template <int Dim>
std::size_t ContactDetection<Dim>::bytes() const {
  std::size_t sum = search_.bytes() + bytes_of(vertex_normals_);
  for (const auto& workspace : workspaces_) sum += bytes_of(workspace.bodies, workspace.squared);
  return sum;
}

template class ContactDetection<2>;
template class ContactDetection<3>;

}  // namespace mpmfast::penalty
