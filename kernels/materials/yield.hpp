#pragma once

/// @file Yield strength of metals. `increment` solves the consistency condition of radial return,
///   g(x) = q − 3Ḡ x − σ_y(α + x, x/Δt, T) = 0  for the equivalent plastic strain x ≥ 0 of the step,
/// with q the von Mises measure of the trial Kirchhoff stress.

#include "kernels/constants.hpp"
#include "kernels/materials/evolving.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

inline constexpr const char* kYieldDescription = "Stress at which it first yields (A of Johnson and Cook).";
inline constexpr const char* kHardeningDescription =
    "How the yield stress grows with plastic strain (B of Johnson and Cook).";

/// No yield: the shear response is elastic.
struct NoYield {
  static constexpr const char *kModel = "mie_gruneisen",
                              *kDescription =
                                  "shocks: equation of state, elastic shear, artificial viscosity";
  static constexpr bool kPlastic = false, kThermal = false;
};

/// σ_y = Y + H α.
struct LinearHardening {
  static constexpr const char *kModel = "j2_plasticity",
                              *kDescription =
                                  "metal with linear hardening at large strains; with heat_capacity under an "
                                  "equation of state";
  static constexpr bool kPlastic = true, kThermal = false;
  double yield{};      ///< Y, Pa
  double hardening{};  ///< H, Pa

  template <class Keys>
  void describe(Keys& map, double) {
    map.need("yield", kYieldDescription, yield, kModulus);
    map.key("hardening", kHardeningDescription, hardening, kStrength);
  }

  template <class V>
  V strength(V plastic_strain, V, V) const {
    return yield + hardening * plastic_strain;
  }
  template <class V>
  V increment(V trial, V slope, V plastic_strain, V, double) const {
    return larger(trial - (yield + hardening * plastic_strain), broadcast<V>(0.0)) / (slope + hardening);
  }
};

/// Johnson and Cook (1983): σ_y = (A + B αⁿ)(1 + C ln max(α̇/ε̇0, 1))(1 − T*ᵐ), T* = (T − T0)/(T_m − T0) in
/// [0, 1].
struct JohnsonCook {
  static constexpr const char *kModel = "johnson_cook",
                              *kDescription = "metal whose strength depends on strain, rate and heat";
  static constexpr bool kPlastic = true, kThermal = true;
  double yield{}, hardening{}, exponent = 1;           ///< A, B (Pa), n
  double rate_factor{}, reference_rate = 1;            ///< C, ε̇0 (1/s)
  double softening = 1, reference = 293, melt = 1000;  ///< m, T0, T_m (K)

  /// @param temperature  at the start, K
  template <class Keys>
  void describe(Keys& map, double temperature) {
    if (!map.writes()) reference = temperature;
    map.need("yield", kYieldDescription, yield, kModulus);
    map.need("hardening", kHardeningDescription, hardening, kStrength);
    map.need("exponent", "Exponent of the plastic strain, n.", exponent, kExponent);
    map.key("rate_factor", "Factor of the logarithm of the strain rate, C.", rate_factor, kFactor);
    map.key("reference_rate", "Strain rate at which that logarithm is zero.", reference_rate,
            Number{Measure::rate, kPositive});
    map.key("softening", "Exponent of the homologous temperature, m.", softening, kExponent);
    map.key("reference", "Temperature at which softening begins; that at the start if not given.", reference,
            kTemperature);
    const Limit hotter{"above the reference temperature", reference, kInfinity, true, false, true};
    map.need("melt", "Temperature at which no strength is left.", melt, Number{Measure::temperature, hotter});
  }

  template <class V>
  V thermal_share(V temperature) const {
    const V zero = broadcast<V>(0.0), one = broadcast<V>(1.0);
    const V t = smaller(larger((temperature - reference) * (1.0 / (melt - reference)), zero), one);
    return t > 0.0 ? 1.0 - exponential(softening *
                                       logarithm(larger(t, broadcast<V>(constants::kLeastHomologous))))
                   : one;
  }

  template <class V>
  V strength(V plastic_strain, V rate, V temperature) const {
    V derivative;
    return static_strength(plastic_strain, derivative) * rate_share(rate) * thermal_share(temperature);
  }

  /// Newton's method kept in a bracket: g falls from g(0) > 0 to g(q/3Ḡ) < 0. A lane stops when its own g has
  /// vanished, so that its neighbours do not matter.
  template <class V>
  V increment(V trial, V slope, V plastic_strain, V temperature, double dt) const {
    const V zero = broadcast<V>(0.0), thermal = thermal_share(temperature);
    V derivative;
    const V rest = static_strength(plastic_strain, derivative) * thermal;
    V low = zero, high = larger(trial, zero) / slope;
    V x = (trial - rest) / (slope + derivative * thermal);
    const auto yields = trial > rest;
    x = ((x > low) & (x <= high)) ? x : 0.5 * high;
    for (int k = 0; k < constants::kPlasticIterations; ++k) {
      const V rate = x * (1.0 / dt);
      const V base = static_strength(plastic_strain + x, derivative), share = rate_share(rate);
      const V rate_slope = rate > reference_rate ? rate_factor / x : zero;
      const V g = trial - slope * x - base * share * thermal;
      const auto open = yields & (magnitude(g) > constants::kMetalTolerance * trial);
      if (!any_open(open)) break;
      low = g > 0.0 ? x : low;
      high = g > 0.0 ? high : x;
      const V newton = x + g / (slope + thermal * (derivative * share + base * rate_slope));
      const V next = ((newton > low) & (newton <= high)) ? newton : 0.5 * (low + high);
      x = open ? next : x;
    }
    return yields ? x : zero;
  }

 private:
  static bool any_open(bool open) { return open; }
  static bool any_open(IntLanes open) { return any_of(open); }

  /// A + B αⁿ and its derivative.
  template <class V>
  V static_strength(V plastic_strain, V& derivative) const {
    const V a = larger(plastic_strain, broadcast<V>(constants::kLeastPlasticStrain));
    const V grown = hardening * exponential(exponent * logarithm(a));
    derivative = exponent * grown / a;
    return yield + grown;
  }
  template <class V>
  V rate_share(V rate) const {
    return 1.0 + rate_factor * logarithm(larger(rate * (1.0 / reference_rate), broadcast<V>(1.0)));
  }
};

}  // namespace mpmfast
