#pragma once

/// @file A cohesive law: the traction of two bonded surfaces over their displacement jump, which grows up to
/// the strength and then softens to zero, and the damage that remains.
///
/// With opening p = ⟨δ_n⟩, slip s = |δ_t|, one initial stiffness K and the strengths σ, τ, the jump in units
/// of the jump at the strength is λ² = (pK/σ)² + (sK/τ)². The tractions are T_n = ωKp and T_t = ωKδ_t. The
/// integrity ω is 1 up to λ = 1. Beyond, ω = S(D)/λ with the damage variable D = (λ − 1)/(λ_f − 1) from 0 to
/// 1 and a softening law S that falls from 1 to 0. Integrity never grows, so unloading goes straight to the
/// origin and no path makes energy. Overlap has a stiffness of its own, without damage.
///
/// Along one direction of the jump, with c² and d² the shares of λ² by opening and by slip, the work per area
/// is G_I = c² g σ²/K and G_II = d² g τ²/K, g = ½ + (λ_f − 1)∫S dD. λ_f follows from
/// (G_I/G_Ic)^α + (G_II/G_IIc)^α = 1.

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/sliding.hpp"

namespace mpmfast {

struct Coulomb;

enum class Softening { triangular, exponential, trapezoidal };
inline constexpr std::array<Keyword<Softening>, 3> kSoftenings{{
    {Softening::triangular, "triangular", "straight from the strength to nothing (default)"},
    {Softening::exponential, "exponential", "fast at first, with a long tail"},
    {Softening::trapezoidal, "trapezoidal", "holds the strength for a while (`plateau`), then straight"},
}};

/// S(D) of a shape.
struct SofteningLaw {
  static constexpr double kDecay = 7;  ///< of the exponential, which is 1/1097 of its start at the end
  Softening shape = Softening::triangular;
  double plateau{};  ///< D up to which the strength holds, below 1

  double hold() const { return shape == Softening::trapezoidal ? plateau : 0; }
  double at(double damage) const {
    if (shape != Softening::exponential) return damage < hold() ? 1 : (1 - damage) / (1 - hold());
    const double end = std::exp(-kDecay);
    return (std::exp(-kDecay * damage) - end) / (1 - end);
  }
  /// ∫ S from 0 to D.
  double integral(double damage) const {
    if (shape != Softening::exponential) {
      if (damage <= hold()) return damage;
      const double left = 1 - damage, most = 1 - hold();
      return hold() + 0.5 * (most - left * (left / most));
    }
    const double end = std::exp(-kDecay);
    return (-std::expm1(-kDecay * damage) / kDecay - damage * end) / (1 - end);
  }
  /// D at which S/λ = ω, in (0, 1), with λ = 1 + length D.
  double damage_at(double integrity, double length) const {
    if (shape != Softening::exponential) {
      const double held = (1 / integrity - 1) / length;
      if (held <= hold()) return held;
      return (1 - integrity * (1 - hold())) / (1 + integrity * length * (1 - hold()));
    }
    // S is convex, so that Newton from the left never passes the root of S − ωλ.
    const double end = std::exp(-kDecay);
    double damage = 0;
    for (int k = 0; k < constants::kDamageIterations; ++k) {
      const double left = std::exp(-kDecay * damage);
      const double excess = (left - end) / (1 - end) - integrity * (1 + length * damage);
      const double step = excess / (kDecay * left / (1 - end) + integrity * length);
      damage += step;
      if (!(step > constants::kDamageStep)) break;
    }
    return std::min(1.0, damage);
  }
};

struct Cohesive {
  static constexpr const char *kKeyword = "cohesive",
                              *kDescription = "bonded by springs that soften and break, then coulomb";
  static constexpr LawScope scope = LawScope::interface;
  static constexpr bool uses_area = true;
  double friction{}, static_friction{};              ///< once it is broken
  double normal_strength = 1, shear_strength = 1;    ///< Pa
  double normal_toughness = 1, shear_toughness = 1;  ///< J/m²
  Softening shape = Softening::triangular;
  double plateau = 0.5, mode_exponent = 1;
  double initial_stiffness{}, compression_stiffness{};  ///< Pa/m
  CompressionModel compression = CompressionModel::spring;

  template <class Keys>
  void describe(Keys& map) {
    constexpr Number kStrength{Measure::pressure, kPositive}, kToughness{Measure::surface_energy, kPositive},
        kStiffness{Measure::interface_stiffness, kNotNegative};
    constexpr Limit kShare{"in [0, 1)", 0, 1, false, true}, kOne{"1 or more", 1};
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.key("static_friction", kStaticDescription, static_friction, kCoefficient);
    map.need("normal_strength", "Tension at which a bond breaks.", normal_strength, kStrength);
    map.need("shear_strength", "Shear at which a bond breaks.", shear_strength, kStrength);
    map.need("normal_toughness", "Energy that opening takes to break a bond, G_Ic.", normal_toughness,
             kToughness);
    map.need("shear_toughness", "Energy that sliding takes to break a bond, G_IIc.", shear_toughness,
             kToughness);
    map.key("shape", "How the traction falls from the strength.", shape, kSoftenings);
    map.key("plateau", "trapezoidal: share of the way to nothing on which it holds the strength.", plateau,
            Number{Measure::number, kShare});
    map.key("mode_exponent", "Breaks where (G_I/G_Ic)^x + (G_II/G_IIc)^x = 1.", mode_exponent,
            Number{Measure::number, kOne});
    map.key("initial_stiffness", "Traction by jump before the strength; 0: ten times what a cell has.",
            initial_stiffness, kStiffness);
    map.key("compression_stiffness", kCompressionDescription, compression_stiffness, kStiffness);
    map.key("compression", kCompressionModelDescription, compression, kCompressionModels);
  }
  double overlap_stiffness() const {
    if (compression == CompressionModel::contact) return 0;
    return compression_stiffness > 0 ? compression_stiffness : initial_stiffness;
  }
  /// The least initial stiffness for which a bond that has its strength has no more energy than it may take.
  double least_stiffness() const {
    return 0.5 * std::max(normal_strength * (normal_strength / normal_toughness),
                          shear_strength * (shear_strength / shear_toughness));
  }
  double operator()(const Sliding&) const { return 0; }  ///< springs are forces, not contact
  /// The law of its surfaces once it is broken.
  Coulomb contact() const;

  // Of opening p = ⟨δ_n⟩ and slip s, m.

  SofteningLaw softening() const { return {shape, plateau}; }
  /// λ².
  double measure(double opening, double slip_squared) const {
    const double n = opening * initial_stiffness / normal_strength, t = initial_stiffness / shear_strength;
    return n * n + slip_squared * t * t;
  }
  /// λ_f − 1 where this share of λ² is of the opening.
  double length(double opening_share) const {
    const double n = opening_share * normal_strength * (normal_strength / normal_toughness),
                 t = (1 - opening_share) * shear_strength * (shear_strength / shear_toughness);
    const double sum = mode_exponent == 1 ? n + t
                                          : std::pow(std::pow(n, mode_exponent) + std::pow(t, mode_exponent),
                                                     1 / mode_exponent);
    return (initial_stiffness / sum - 0.5) / softening().integral(1);
  }
  /// ω at λ for a bond that was never beyond.
  double integrity(double lambda, double length) const {
    if (lambda <= 1) return 1;
    const double damage = (lambda - 1) / length;
    return damage >= 1 ? 0 : softening().at(damage) / lambda;
  }
  /// ∫ of ω over λ² from 0 to λ.
  double work(double lambda, double length) const {
    if (lambda <= 1) return lambda * lambda;
    return 1 + 2 * length * softening().integral(std::min(1.0, (lambda - 1) / length));
  }
  /// λ at which ω is this, in (0, 1].
  double lambda_of(double integrity, double length) const {
    return integrity < 1 ? 1 + length * softening().damage_at(integrity, length) : 1;
  }
  /// The integrity that remains is stored as the damage that pure opening would have made. It moves with the
  /// bodies without loss. For the triangular law it is the share of the toughness that is spent.
  double damage_at(double integrity) const {
    return integrity >= 1 ? 0 : integrity <= 0 ? 1 : softening().damage_at(integrity, length(1));
  }
  double integrity_of(double damage) const {
    return damage >= 1 ? 0 : integrity(1 + length(1) * damage, length(1));
  }
};

}  // namespace mpmfast
