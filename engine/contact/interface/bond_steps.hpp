#pragma once

/// @file What a step does to the bond of a pair.

#include <algorithm>

#include "engine/contact/interface/interface_spring.hpp"
#include "kernels/contact/bond.hpp"

namespace mpmfast {

/// Breaks a bond whose surfaces are farther apart than the grid can resolve.
template <int Dim>
void break_bond(const Cohesive& law, const InterfaceSpring<Dim>& spring, Bond<Dim>& bond) {
  const Vec<Dim>& jump = spring.jump.value;
  const double along = jump.dot(spring.normal);
  bond.lost = 0.5 * law.integrity_of(bond.damage) * spring.stiffness.tension *
              parted<Dim>(jump, spring.normal).squared();
  if (along < 0) bond.lost += 0.5 * spring.stiffness.compression * along * along;
  bond.damage = 1;
}

/// Records the loss of a bond whose damage grew without a change of its jump. A bond that breaks while its
/// surfaces overlap also loses the stored energy of the overlap.
/// @param before  its integrity before
template <int Dim>
void record_damage(const Cohesive& law, double before, InterfaceSpring<Dim>& spring, Bond<Dim>& bond) {
  const double less = before - law.integrity_of(bond.damage);
  bond.lost +=
      0.5 * less * spring.stiffness.tension * parted<Dim>(spring.jump.value, spring.normal).squared();
  if (!bond.is_broken()) return;
  const double overlap = std::min(0.0, spring.jump.value.dot(spring.normal));
  bond.lost += 0.5 * spring.stiffness.compression * overlap * overlap;
  spring.acts = false;
}

/// The damage and the loss of a bond over the step. @param from  its jump at the start; the spring has that
/// at the end, m
template <int Dim>
void end_bond(const Cohesive& law, const Vec<Dim>& from, InterfaceSpring<Dim>& spring, Bond<Dim>& bond) {
  const Parted start = parted<Dim>(from, spring.normal), end = parted<Dim>(spring.jump.value, spring.normal);
  const double before = law.integrity_of(bond.damage);
  const Integrity integrity = integrity_over(law, before, start, end);
  bond.lost = lost_over(spring.stiffness.tension, before, integrity, start, end);
  if (integrity.end < before) bond.damage = std::max(bond.damage, law.damage_at(integrity.end));
  if (bond.is_broken()) record_damage(law, 0, spring, bond);
}

}  // namespace mpmfast
