#pragma once

/// @file Elastic moduli that a constitutive law has where nothing is deformed.

#include <cmath>

namespace mpmfast {

/// G, Pa; 0 where the law has none (fluids, rigid bodies).
template <class Law>
double shear_at_rest(const Law& law) {
  if constexpr (requires { law.shear(); })
    return law.shear();
  else if constexpr (requires { law.shear + 1.0; })
    return law.shear;
  else
    return 0;
}

/// E′ of a plane, Pa: E of plane stress, E/(1 − ν²) of plane strain; 0 likewise.
template <class Law>
double plane_modulus(const Law& law, bool plane_stress) {
  const double shear = shear_at_rest(law);
  if (shear == 0) return 0;
  const double lambda = law.modulus() - 2 * shear;
  return plane_stress ? shear * (3 * lambda + 2 * shear) / (lambda + shear)
                      : 4 * shear * (lambda + shear) / (lambda + 2 * shear);
}

/// How fast waves run along its surface, m/s: by Viktorov's fit c_s (0.87 + 1.12 ν)/(1 + ν), ν of the plane;
/// 0 likewise.
template <class Law>
double rayleigh_speed(const Law& law, bool plane_stress) {
  const double shear = shear_at_rest(law);
  if (shear == 0) return 0;
  const double lambda = law.modulus() - 2 * shear, of_space = 0.5 * lambda / (lambda + shear),
               poisson = plane_stress ? of_space / (1 + of_space) : of_space;
  return std::sqrt(shear / law.density) * (0.87 + 1.12 * poisson) / (1 + poisson);
}

}  // namespace mpmfast
