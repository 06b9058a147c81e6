#pragma once

/// @file How a metal answers to volume: elastically, or by the Mie–Grüneisen equation of state with
/// artificial viscosity.

#include "kernels/constants.hpp"
#include "kernels/materials/evolving.hpp"
#include "kernels/materials/parameters.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// What a volumetric law reports of a step.
template <class V>
struct VolumeResponse {
  V pressure;  ///< J (p + q), Pa: the Kirchhoff pressure
  V modulus;   ///< ρ0 times the squared bulk wave speed, Pa
  V viscous;   ///< speed that the viscosity adds to the stability bound, m/s
};

/// The volumetric part of N20 Eq. 18: W = ½K(½(J² − 1) − ln J).
struct ElasticVolume {
  static constexpr bool kHeats = false;
  double bulk{};  ///< K, Pa

  template <int Dim, class V>
  VolumeResponse<V> respond(const StrainStep<Dim, V>& step, double, double, V, V,
                            MaterialState<Dim, V>&) const {
    const V squared = step.volume_now * step.volume_now;
    return {0.5 * bulk * (1.0 - squared), 0.5 * bulk * (squared + 1.0), broadcast<V>(0.0)};
  }

  /// Stored energy per undeformed volume, J/m³.
  template <int Dim, class V>
  V energy(V j, const MaterialState<Dim, V>&) const {
    return 0.5 * bulk * (0.5 * (j * j - 1.0) - logarithm(j));
  }
};

/// Mie–Grüneisen (N20 Eq. 51, with compression η = 1 − J > 0):
///   p = A(η) + γ0 ρ0 U,  A = K η (1 − ½γ0 η)/(1 − S1 η)² (η > 0),  K η (η ≤ 0),
/// whose Hugoniot is U_s = c0 + S1 u_p with c0² = K/ρ0; and artificial viscosity (Eq. 52)
///   q = ρ Δx |D_kk| (A1 C + A2 Δx |D_kk|) in compression, C the current bulk wave speed.
/// U is the energy of volume change and heat: −(p + q) dJ and plastic work. Elastic shear energy is kept
/// apart (the free energy is a sum), so that the pressure stays the derivative of the energy and the balance
/// closes.
struct GruneisenVolume {
  static constexpr bool kHeats = true;
  double bulk{};                 ///< K, Pa
  double gamma{};                ///< γ0; ρ γ is constant
  double slope{};                ///< S1
  double linear_viscosity{};     ///< A1
  double quadratic_viscosity{};  ///< A2
  double cell{};                 ///< Δx, m; of the grid, not of the material

  template <class Keys>
  void describe(Keys& map) {
    map.need("gruneisen", "Grüneisen's gamma: pressure that heat adds.", gamma, kFactor);
    map.need("hugoniot_slope", "Slope of shock speed over particle speed.", slope, kFactor);
    map.key("linear_viscosity", "Artificial viscosity against ringing behind a shock, linear in the rate.",
            linear_viscosity, kFactor);
    map.key("quadratic_viscosity", "The same, quadratic in the rate: spreads the shock over a few cells.",
            quadratic_viscosity, kFactor);
  }

  /// A and dA/dη. Towards the pole 1/S1, where no shock can reach, A goes on along its tangent.
  template <class V>
  void cold(V eta, V& pressure, V& derivative) const {
    const double limit = slope > 0 ? constants::kHugoniotPole / slope : constants::kUnbounded;
    const V e = smaller(larger(eta, broadcast<V>(0.0)), broadcast<V>(limit));
    const V inverse = 1.0 / (1.0 - slope * e), square = bulk * inverse * inverse;
    derivative = square * ((1.0 - gamma * e) + 2.0 * slope * e * (1.0 - 0.5 * gamma * e) * inverse);
    pressure = square * e * (1.0 - 0.5 * gamma * e) + derivative * (eta - e);
  }

  /// Energy by the trapezoidal rule in p, ρ0 ΔU = −(½(p + p') + q) ΔJ + w with p' = A' + γ0 ρ0 U': linear in
  /// U'. Isentropic heating is dT = −γ0 T dJ, the rest is heat over ρ0 c_v.
  /// Bulk wave speed along the isentrope: ρ0 C² = −J² dp/dJ = J² (dA/dη + γ0 p).
  /// A viscosity ρ Δx Q D bounds an explicit step by Δx/(Q + √(Q² + c²)); Q = A1 C + 2 A2 Δx |D| from the
  /// tangent, the first term also in expansion, which may turn before the next bound is taken.
  /// @param heat_capacity  ρ0 c_v, J/(m³ K)
  /// @param work   plastic work of the step, J/m³
  /// @param heat   share of it that becomes heat at once, J/m³
  template <int Dim, class V>
  VolumeResponse<V> respond(const StrainStep<Dim, V>& step, double density, double heat_capacity, V work,
                            V heat, MaterialState<Dim, V>& state) const {
    const V j = step.volume_now, before = step.volume_before, change = j - before;
    V cold_before, cold_now, slope_before, slope_now;
    cold(1.0 - before, cold_before, slope_before);
    cold(1.0 - j, cold_now, slope_now);
    const V pressure_before = cold_before + gamma * state.internal_energy;
    const V speed_squared =
        larger(before * before * (slope_before + gamma * pressure_before), broadcast<V>(0.0)) *
        (1.0 / density);
    const V linear = linear_viscosity * square_root(speed_squared);
    const V closing = cell * larger(-step.expansion, broadcast<V>(0.0));  // Δx |D_kk|
    const V q = density / j * closing * (linear + quadratic_viscosity * closing);
    const V energy = (state.internal_energy + work - (0.5 * (pressure_before + cold_now) + q) * change) /
                     (1.0 + 0.5 * gamma * change);
    const V friction = -q * change;
    const V pressure = cold_now + gamma * energy;
    state.internal_energy = energy;
    state.dissipated += friction;
    state.temperature =
        state.temperature * exponential(-gamma * change) + (friction + heat) * (1.0 / heat_capacity);
    return {j * (pressure + q), larger(j * j * (slope_now + gamma * pressure), broadcast<V>(0.0)),
            linear + 2.0 * quadratic_viscosity * closing};
  }

  /// ρ0 U less what was dissipated into it.
  template <int Dim, class V>
  V energy(V, const MaterialState<Dim, V>& state) const {
    return state.internal_energy - state.dissipated;
  }
};

}  // namespace mpmfast
