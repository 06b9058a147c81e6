#pragma once

/// @file The contact laws of a scene, and what they ask for.

#include "engine/scene/scene.hpp"
#include "kernels/contact/laws.hpp"

namespace mpmfast {

/// The law on a grid.
inline AnyLaw law_on(const SurfaceLaw& surface, double cell) {
  AnyLaw law = surface.acts;
  std::visit(
      [&](auto& one) {
        if constexpr (requires { one.set_cell(cell); }) one.set_cell(cell);
      },
      law);
  return law;
}

/// Does any pair of the scene obey a law for which this holds?
template <class F>
bool any_law(const ContactSpec& contact, F holds) {
  const auto of = [&](const SurfaceLaw& law) { return std::visit(holds, law.acts); };
  if (of(contact.law)) return true;
  for (const ContactPair& pair : contact.pairs)
    if (of(pair.law)) return true;
  return false;
}

}  // namespace mpmfast
