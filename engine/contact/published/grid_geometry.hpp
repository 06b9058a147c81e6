#pragma once

/// @file Normals and separations from the grid, as published methods have them (N20 Eq. 13; NN §3.2 to 3.6).

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Normals from volume gradients, or as the scene specifies them, of all pairs but those of cracks; also
/// where a rigid body gives the normal (ContactSpec::rigid_bias). Nothing where the plan has no column for
/// them.
template <int Dim>
void find_grid_normals(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& list);

/// Separations from mean positions or displacements. Nothing where the plan has no column for them.
template <int Dim>
void find_grid_separations(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& list);

}  // namespace mpmfast
