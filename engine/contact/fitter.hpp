#pragma once

/// @file What contact asks of the basis.

#include "engine/contact/nodal/list.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

template <int Dim>
class ContactFitter {
 public:
  virtual ~ContactFitter() = default;

  /// Normals by regression and separations by the particles' domains, of the listed contact entries.
  virtual void fit_contact(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& contact) = 0;
  /// What the fits hold between two steps: clouds, and normals before they are smoothed.
  virtual std::size_t fit_bytes() const = 0;
  /// Volumes, volume gradients, mean positions and displacements of the slots, as planned.
  /// @param cracks_alone  displacements serve cracks: only nodes near them want any
  virtual void project_geometry(State<Dim>& state, bool cracks_alone, bool cracks_displaced) = 0;
};

}  // namespace mpmfast
