#pragma once

/// @file The surfaces of a scene's bodies at time zero.

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/surfaces.hpp"

namespace mpmfast {

/// The outline of each body of the scene; empty without penalty contact.
std::vector<Outline> outlines(const Scene& scene, const Plan& plan);

/// Appends the surface of the next body. Normal cones are missing until connect_facets().
/// @param first_id   of its boundary points
/// @param thickness  of a plane body, m
template <int Dim>
void add_surface(const Outline& outline, std::uint32_t first_id, double thickness, Surfaces<Dim>& out);

/// Builds the vertex normal cones of all bodies, once their surfaces are added.
template <int Dim>
void connect_facets(Surfaces<Dim>& surfaces);

/// Undeformed surface area of each boundary point, m²: equal shares of the facets at it.
template <int Dim>
std::vector<double> tributary_areas(const Surfaces<Dim>& surfaces);

}  // namespace mpmfast
