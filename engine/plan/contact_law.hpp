#pragma once

/// @file From the law that a scene names to the function object that acts.

#include <algorithm>

#include "engine/scene/scene.hpp"
#include "kernels/contact/laws.hpp"

namespace mpmfast {

inline AnyLaw make_law(const LawSpec& spec, double cell) {
  switch (spec.law) {
    case LawKind::coulomb:
      return Coulomb{spec.friction, spec.static_friction};
    case LawKind::frictionless:
      return Frictionless{};
    case LawKind::stick:
      return Stick{};
    case LawKind::perfect:
      return Perfect{};
    case LawKind::ignore:
      return Ignore{};
    case LawKind::adhesion:
      return Adhesion{spec.friction, spec.normal_strength, spec.shear_strength, spec.reach * cell};
    case LawKind::velocity_friction:
      return VelocityFriction{spec.friction, std::max(spec.friction, spec.static_friction), spec.decay_speed};
    case LawKind::viscous:
      return Viscous{spec.viscosity / spec.film};
  }
  return Ignore{};
}

/// Does any pair of the scene obey a law for which this holds?
template <class F>
bool any_law(const ContactSpec& contact, F holds) {
  if (holds(static_cast<const LawSpec&>(contact))) return true;
  for (const ContactPair& pair : contact.pairs)
    if (holds(pair.law)) return true;
  return false;
}

inline bool uses_area(const LawSpec& spec) {
  return std::visit([](const auto& law) { return law.uses_area; }, make_law(spec, 1));
}
/// Does it ask for normals and separations?
inline bool uses_geometry(const LawSpec& spec) {
  return spec.law != LawKind::perfect && spec.law != LawKind::ignore;
}

}  // namespace mpmfast
