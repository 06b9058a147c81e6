#pragma once

/// @file The contact laws of a scene, and what they ask for.

#include <algorithm>
#include <variant>

#include "engine/constants.hpp"
#include "engine/scene/scene.hpp"
#include "kernels/contact/laws.hpp"

namespace mpmfast {

/// The largest modulus of longitudinal waves in the bodies of a scene, at rest, Pa.
inline double stiffest_modulus(const Scene& scene) {
  double modulus{};
  for (const BodySpec& body : scene.bodies)
    if (!is_rigid(scene, body))
      modulus = std::max(modulus, std::visit([](const auto& law) { return law.modulus(); },
                                             scene.materials[static_cast<std::size_t>(body.material)].model));
  return modulus;
}

/// The law on a grid.
inline AnyLaw law_on(const SurfaceLaw& surface, const Scene& scene) {
  using namespace constants::plan;
  const double cell = scene.grid.cell;
  AnyLaw law = surface.acts;
  if (auto* springs = std::get_if<Interface>(&law)) {
    const double unit = stiffest_modulus(scene) / cell;
    springs->compression_stiffness = springs->overlap_stiffness();
    const auto all = {&springs->normal_stiffness, &springs->shear_stiffness, &springs->compression_stiffness};
    if (std::all_of(all.begin(), all.end(), [&](const double* one) { return *one >= kTiedStiffness * unit; }))
      return Perfect{};
    for (double* one : all) *one = std::min(*one, kMostStiffness * unit);
  }
  if (auto* curves = std::get_if<NonlinearInterface>(&law)) {
    const double most = kMostStiffness * stiffest_modulus(scene) / cell;
    curves->normal_curve = curves->curve_with_overlap(cell).widened(most);
    curves->shear_curve = curves->shear_curve.widened(most);
  }
  if (auto* bond = std::get_if<Cohesive>(&law)) {
    const double unit = stiffest_modulus(scene) / cell;
    double& stiffness = bond->initial_stiffness;
    stiffness = stiffness > 0 ? std::min(stiffness, kMostStiffness * unit) : kBondStiffness * unit;
    stiffness = std::max(stiffness, kBrittleStiffness * bond->least_stiffness());
    bond->compression_stiffness = std::min(bond->overlap_stiffness(), kMostStiffness * unit);
  }
  std::visit(
      [&](auto& one) {
        if constexpr (requires { one.set_cell(cell); }) one.set_cell(cell);
      },
      law);
  return law;
}

/// Does any pair of the scene, or a crack, obey a law for which this holds?
template <class F>
bool any_law(const Scene& scene, F holds) {
  const auto on_grid = [&](const SurfaceLaw& law) { return std::visit(holds, law_on(law, scene)); };
  return scene.contact.any(on_grid) ||
         std::any_of(scene.cracks.begin(), scene.cracks.end(),
                     [&](const CrackSpec& crack) { return on_grid(crack.law); });
}

}  // namespace mpmfast
