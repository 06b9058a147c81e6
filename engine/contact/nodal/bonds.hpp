#pragma once

/// @file What a step leaves of the bond of an entry.

#include "engine/contact/nodal/list.hpp"
#include "kernels/contact/bond.hpp"

namespace mpmfast {

/// Breaks a bond of surfaces that came apart by more than the grid can see.
template <int Dim>
void let_go(const Cohesive& law, const Bridge<Dim>& bridge, Bond<Dim>& bond) {
  const double along = bridge.jump.dot(bridge.normal);
  bond.lost = 0.5 * law.integrity_of(bond.way) * bridge.springs.tension *
              parted<Dim>(bridge.jump, bridge.normal).squared();
  if (along < 0) bond.lost += 0.5 * bridge.springs.compression * along * along;
  bond.way = 1;
}

/// What a bond whose surfaces are where they are has lost as it wears by more than its jump asks for; of one
/// that breaks as surfaces press, the stored overlap too.
template <int Dim>
void wear(const Cohesive& law, double before, Bridge<Dim>& bridge, Bond<Dim>& bond) {
  const double worn = before - law.integrity_of(bond.way);
  bond.lost += 0.5 * worn * bridge.springs.tension * parted<Dim>(bridge.jump, bridge.normal).squared();
  if (!bond.broken()) return;
  const double overlap = std::min(0.0, bridge.jump.dot(bridge.normal));
  bond.lost += 0.5 * bridge.springs.compression * overlap * overlap;
  bridge.acts = false;
}

/// From the jump at the start of the step to that of its end, which the bridge has: what is left, and lost.
template <int Dim>
void end_bond(const Cohesive& law, const Vec<Dim>& from, Bridge<Dim>& bridge, Bond<Dim>& bond) {
  const Parted start = parted<Dim>(from, bridge.normal), end = parted<Dim>(bridge.jump, bridge.normal);
  const double before = law.integrity_of(bond.way);
  const Integrity integrity = integrity_over(law, before, start, end);
  bond.lost = lost_over(bridge.springs.tension, before, integrity, start, end);
  if (integrity.end < before) bond.way = std::max(bond.way, law.way_to(integrity.end));
  if (bond.broken()) wear(law, 0, bridge, bond);
}

}  // namespace mpmfast
