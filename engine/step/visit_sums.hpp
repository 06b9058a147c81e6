#pragma once

/// @file The sums of a run, for an archive.

#include <string>

#include "engine/state/archive.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// Both sides have as many boundaries, fields and pairs: those of the scene.
template <int N>
void visit_vectors(Archive& archive, const std::string& name, std::vector<Vec<N>>& vectors) {
  static_assert(sizeof(Vec<N>) == N * sizeof(double));
  archive.column(name, vectors.empty() ? nullptr : vectors.front().data(), N * vectors.size());
}

template <int Dim>
void visit_sums(Archive& archive, const std::string& group, Sums<Dim>& sums) {
  archive.number(group + "/friction_work", sums.friction_work);
  archive.number(group + "/boundary_work", sums.boundary_work);
  archive.number(group + "/body_force_work", sums.body_force_work);
  visit_vectors<Dim>(archive, group + "/boundary_impulse", sums.boundary_impulse);
  visit_vectors<Dim>(archive, group + "/rigid_impulse", sums.rigid_impulse);
  visit_vectors<3>(archive, group + "/rigid_moment", sums.rigid_moment);
  visit_vectors<Dim>(archive, group + "/pair_impulse", sums.pair_impulse);
  archive.column(group + "/pair_friction_work", sums.pair_friction_work.data(),
                 sums.pair_friction_work.size());
  archive.number(group + "/outflow_particles", sums.outflow.particles);
  archive.number(group + "/outflow_mass", sums.outflow.mass);
  archive.number(group + "/outflow_energy", sums.outflow.energy);
  archive.column(group + "/outflow_momentum", sums.outflow.momentum.data(), sums.outflow.momentum.size());
  archive.number(group + "/interface_loss", sums.interface_loss);
}

}  // namespace mpmfast
