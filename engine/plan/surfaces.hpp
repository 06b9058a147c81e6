#pragma once

/// @file The surfaces of a scene's bodies at time zero.

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/surfaces.hpp"

namespace mpmfast {

/// The outline of each body; empty where the plan follows none.
std::vector<Outline> outlines(const Scene& scene, const Plan& plan);

/// Enters the outline of the next body. @param first_id  of its boundary points
template <int Dim>
void add_surface(const Outline& outline, std::uint32_t first_id, double thickness, Surfaces<Dim>& out);

/// Numbers what adjoins what: after the last body.
template <int Dim>
void join(Surfaces<Dim>& surfaces);

/// Undeformed area of the surface that belongs to each point, m².
template <int Dim>
std::vector<double> tributary_areas(const Surfaces<Dim>& surfaces);

}  // namespace mpmfast
