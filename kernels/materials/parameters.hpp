#pragma once

/// @file What laws share when they describe their parameters. A law has a `kModel`, the word of a scene, a
/// line of what it is for (`kDescription`), and `describe(map)`, which names each parameter: its key, a
/// sentence, the member, its measure and limits. `map` reads, writes or describes
/// (engine/scene/keys/keys.hpp). Elastic moduli may be given in two ways: describe_bulk_and_shear and
/// describe_lambda_and_shear (engine/scene/keys/moduli.hpp).

#include "kernels/measure.hpp"

namespace mpmfast {

inline constexpr Number kModulus{Measure::pressure, kPositive};
inline constexpr Number kPoisson{Measure::number,
                                 {"in (-1, 0.5), and 0.49 is nearly incompressible", -1, 0.5, true, true}};
inline constexpr Number kFactor{Measure::number, kNotNegative}, kExponent{Measure::number, kPositive};
inline constexpr Number kStrength{Measure::pressure, kNotNegative};
inline constexpr Number kTemperature{Measure::temperature, kPositive};

inline constexpr const char* kYoungDescription =
    "Young's modulus; where both are known here, with `poisson` in place of them.";
inline constexpr const char *kBulkDescription = "Bulk modulus.", *kShearDescription = "Shear modulus.";
inline constexpr const char* kPoissonDescription = "Poisson's ratio.";

template <class Keys>
void describe_density(Keys& map, double& density) {
  map.need("density", "Mass over volume, unstrained.", density, Number{Measure::density, kPositive});
}

}  // namespace mpmfast
