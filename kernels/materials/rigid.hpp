#pragma once

/// @file What never deforms: no constitutive law, but a model that a scene may name.

#include "kernels/materials/parameters.hpp"

namespace mpmfast {

/// Particles that move as their body says.
struct Rigid {
  static constexpr const char *kModel = "rigid",
                              *kDescription = "moves as its body's velocity says, never deforms";
  double density = 1000;  ///< kg/m³

  template <class Keys>
  void describe(Keys& map) {
    map.key("density", "Only weighs the velocities of several rigid particles at a node.", density,
            Number{Measure::density, kPositive});
  }
  /// Nothing travels through it.
  double modulus() const { return 0; }
};

}  // namespace mpmfast
