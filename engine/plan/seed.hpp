#pragma once

/// @file Particles of a scene at time zero.

#include "engine/plan/plan.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Fills every body with particles (stress-free, F = I) and sets up grid, bodies, fields and materials.
/// Throws SceneError for a body without particles or with particles outside the grid.
template <int Dim>
void seed(const Scene& scene, const Plan& plan, State<Dim>& state);

/// Recomputes every particle's stress and wave speed from its F and its evolving state.
template <int Dim>
void refresh_stress(State<Dim>& state);

/// Σ V0 W over all particles in order of their ids, J: what is recoverable, and under an equation of state
/// the energy of the heat that isentropic compression makes.
template <int Dim>
double stored_energy(State<Dim>& state);

/// The share of particle p in stored_energy and dissipated_energy, J.
template <int Dim>
double inner_energy(State<Dim>& state, std::size_t p);

/// Plastic work and viscous heat of all particles so far, J.
template <int Dim>
double dissipated_energy(State<Dim>& state);

}  // namespace mpmfast
