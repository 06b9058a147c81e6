#pragma once

/// @file Soil and sand: the cone of Drucker and Prager with dilation and a tension cut-off.

#include <array>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/materials/evolving.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/materials/radial_return.hpp"
#include "kernels/materials/shape_memory.hpp"

namespace mpmfast {

/// τ = G dev(b̄) − p I over the elastic left Cauchy–Green tensor b = J_e^{2/3} b̄ that the step carries,
/// b' = f b fᵀ with f = I + a, p = ½K(1 − J_e²) as in N20 Eq. 18; of Kirchhoff stresses
///   q = √(3/2)|dev τ| ≤ M p + k,  p ≥ −T.
/// The cone has the strength of Mohr and Coulomb in triaxial compression, in extension or in plane strain,
///   M = 6 sin φ/(3 − sin φ), 6 sin φ/(3 + sin φ) or √3 sin φ,  k = M c cot φ;
/// flow by an equivalent plastic strain x dilates by η x, η as M with ψ, which takes ln J_e.
/// Beyond the cut-off J_e goes on with the volume, while p stays −T and q ≤ k − M T: a gap that opens is
/// closed again before anything presses, and no volume is gained by it. At T = k/M that is the apex.
struct DruckerPrager {
  enum class Cone { compression, extension, plane_strain };
  static constexpr const char *kModel = "drucker_prager",
                              *kDescription =
                                  "soil and sand: cohesion, friction, dilation, no or little tension";
  static constexpr StateColumns kColumns{true, false, true, false, true};
  static constexpr bool kParts = true;          ///< grains leave each other: F says nothing about neighbours
  static constexpr bool kElasticVolume = true;  ///< elastic_strain has the volume in it
  static constexpr double start_temperature = 293;  ///< K, of no account
  static constexpr double heat_share = 1;           ///< of what it dissipates
  double density{};                                 ///< kg/m³, undeformed
  double bulk{}, shear{};                           ///< K, G, Pa
  double friction_angle{}, dilation_angle{};        ///< φ, ψ, rad
  double cohesion{};                                ///< c, Pa
  double tension{};                                 ///< T, Pa
  double heating{};  ///< K m³/J, by dissipated work where a scene has temperatures
  Cone cone = Cone::compression;

  template <class Keys>
  void describe(Keys& map) {
    constexpr Number kAngle{Measure::angle, {"above 0 and below 90 deg", 1e-6, 1.5707963, true, true}};
    describe_density(map, density);
    describe_bulk_and_shear(map, bulk, shear);
    bool known = map.need("friction_angle", "Of Mohr and Coulomb; `cone` says where it is met.",
                          friction_angle, kAngle);
    const auto upto = [&](const char* description, double most) {  // of what was read well
      return Limit{description, 0, map.describes() || !known ? kInfinity : most, false, false, true};
    };
    map.key("dilation_angle", "How much volume shear makes, as an angle.", dilation_angle,
            Number{Measure::angle, upto("from 0 to the angle of friction", friction_angle)});
    map.key("cone", "Where the strength is that of Mohr and Coulomb.", cone, kCones);
    known = map.key("cohesion", "Shear strength where nothing presses.", cohesion, kStrength) && known;
    if (!map.writes()) tension = apex();
    map.derived("tension", "Largest mean tension; that of the cone's apex if not given.", tension,
                Number{Measure::pressure,
                       upto("from 0 to the apex of the cone, cohesion/tan(friction_angle)", apex())});
  }
  /// Of a longitudinal wave at rest, Pa.
  double modulus() const { return bulk + 4 * shear / 3; }
  static constexpr double shape_limit() { return constants::kShapeOfSoils; }

  /// M of an angle of friction, η of one of dilation.
  double slope(double angle) const {
    const double sine = std::sin(angle);
    if (cone == Cone::plane_strain) return 1.7320508075688772 * sine;
    return 6 * sine / (cone == Cone::compression ? 3 - sine : 3 + sine);
  }
  double apex() const { return friction_angle > 0 ? cohesion / std::tan(friction_angle) : 0; }  ///< k/M, Pa

  template <int Dim, class V>
  void advance(const StrainStep<Dim, V>& step, MaterialState<Dim, V>& state, V (&tau)[kSymmetric<Dim>],
               V& wave_speed_squared) const {
    V b[kSymmetric<Dim>];
    push_forward<Dim>(step.increment, state.elastic_strain, b);
    V volume = square_root(symmetric_determinant<Dim>(b));  // J_e
    const V isochoric = isochoric_factor(volume);
    for (int c = 0; c < kSymmetric<Dim>; ++c) b[c] *= isochoric;

    const Shear<Dim, V> trial(b, shear);
    const V x = increment(trial.measure, trial.slope, volume);
    const V deviatoric = trial.flow(x, b);
    const double eta = slope(dilation_angle);
    if (eta > 0) volume *= exponential(-eta * x);
    const V p = pressure(volume);
    state.plastic_strain += x;
    state.dissipated += deviatoric - eta * p * x;

    V dev[kSymmetric<Dim>];
    deviator<Dim>(b, dev);
    for (int c = 0; c < kSymmetric<Dim>; ++c) tau[c] = c < 3 ? shear * dev[c] - p : shear * dev[c];
    // As in metal.hpp. Where the volume is open, the bound is that of the cut-off.
    const V trace = b[0] + b[1] + b[2], closed = smaller(volume, broadcast<V>(opening()));
    const V smallest = smallest_stretch_squared<Dim>(b, broadcast<V>(1.0));
    const V stiffness =
        0.5 * bulk * (closed * closed + 1.0) + shear * (trace * (5.0 / 9.0) - smallest * (1.0 / 3.0));
    wave_speed_squared = stiffness * (1.0 / density);

    const V grown = 1.0 / isochoric_factor(volume);
    for (int c = 0; c < kSymmetric<Dim>; ++c) state.elastic_strain[c] = b[c] * grown;
  }

  /// Recoverable energy per undeformed volume, J/m³: of an open volume ∫ T d ln J_e beyond the cut-off.
  template <int Dim, class V>
  V energy(const V (&)[Dim * Dim], const MaterialState<Dim, V>& state) const {
    const V volume = square_root(symmetric_determinant<Dim>(state.elastic_strain));
    const V trace = state.elastic_strain[0] + state.elastic_strain[1] + state.elastic_strain[2];
    const V j = smaller(volume, broadcast<V>(opening()));
    return 0.5 * shear * (trace * isochoric_factor(volume) - 3.0) +
           0.5 * bulk * (0.5 * (j * j - 1.0) - logarithm(j)) + tension * logarithm(volume / j);
  }

 private:
  static constexpr std::array<Keyword<Cone>, 3> kCones{{
      {Cone::compression, "compression", "in triaxial compression (default)"},
      {Cone::extension, "extension", "in triaxial extension"},
      {Cone::plane_strain, "plane_strain", "in plane strain without dilation: slopes, flows"},
  }};

  /// J_e at which p = −T.
  double opening() const { return std::sqrt(1 + 2 * tension / bulk); }

  template <class V>
  V pressure(V volume) const {
    return larger(0.5 * bulk * (1.0 - volume * volume), broadcast<V>(-tension));
  }

  /// The plastic strain x ≥ 0 with q − 3Ḡ x = M p + k: g(x) = q − 3Ḡ x − (M p(J_e e^{−ηx}) + k) falls all the
  /// way, from g(0) > 0 to g(q/3Ḡ) ≤ 0. Newton's method kept in that bracket; without dilation its first step
  /// is exact. A lane stops when its own g has vanished, so that its neighbours do not matter.
  template <class V>
  V increment(V measure, V stiffness, V volume) const {
    const double m = slope(friction_angle), eta = slope(dilation_angle), k = m * apex();
    const V zero = broadcast<V>(0.0);
    const auto strength = [&](V p) { return larger(m * p + k, zero); };
    const V rest = measure - strength(pressure(volume));
    const auto yields = rest > constants::kSoilTolerance * measure;
    V low = zero, high = measure / stiffness, x = yields ? rest / stiffness : zero;
    if (eta == 0) return x;
    const double round_off = constants::kPressureRoundOff * m * bulk;
    for (int round = 0; round < constants::kPlasticIterations; ++round) {
      const V j = volume * exponential(-eta * x), p = pressure(j);
      const V g = measure - stiffness * x - strength(p);
      const auto open = yields & (magnitude(g) > constants::kSoilTolerance * measure + round_off);
      if (!any_open(open)) break;
      low = g > 0.0 ? x : low;
      high = g > 0.0 ? high : x;
      const V rising = p > -tension ? m * eta * bulk * j * j : zero;
      const V newton = x + g / (stiffness + rising);
      const V next = ((newton > low) & (newton <= high)) ? newton : 0.5 * (low + high);
      x = open ? next : x;
    }
    return x;
  }
  static bool any_open(bool open) { return open; }
  static bool any_open(IntLanes open) { return any_of(open); }
};

}  // namespace mpmfast
