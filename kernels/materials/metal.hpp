#pragma once

/// @file Finite-strain metals: a volumetric law and a yield strength over the neo-Hookean shear of N20
/// Eq. 18.

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/materials/radial_return.hpp"
#include "kernels/materials/shape_memory.hpp"
#include "kernels/materials/volume.hpp"
#include "kernels/materials/yield.hpp"

namespace mpmfast {

/// τ = G dev(b̄) − J(p + q) I. Without yield b̄ = J^{−2/3} F Fᵀ; with it b̄ is the isochoric elastic left
/// Cauchy–Green tensor of Simo (1988): carried by the step, b̄' = |f|^{−2/3} f b̄ fᵀ with f = I + a, then
/// returned radially to the von Mises surface √(3/2)|dev τ| = σ_y.
template <class Volume, class Yield>
struct Metal {
  static constexpr const char *kModel = Yield::kModel, *kDescription = Yield::kDescription;
  /// The key that asks for this law, where others have the same word.
  static constexpr const char* kWith = Volume::kHeats && Yield::kPlastic ? "equation_of_state" : "";
  static constexpr StateColumns kColumns{Volume::kHeats || Yield::kPlastic, Volume::kHeats, Yield::kPlastic,
                                         Volume::kHeats || Yield::kThermal, Yield::kPlastic};
  double density{};  ///< kg/m³, undeformed
  double shear{};    ///< G, Pa
  Volume volume{};
  Yield yield{};
  double heat_capacity = 1;        ///< c_v, J/(kg K)
  double heat_share = 0.9;         ///< of plastic work that becomes heat (Taylor and Quinney)
  double start_temperature = 293;  ///< K
  double heating{};  ///< K m³/J, by plastic work where the law has no temperature and the scene has

  template <class Keys>
  void describe(Keys& map) {
    constexpr Number kShare{Measure::number, {"in [0, 1]", 0, 1}};
    describe_density(map, density);
    if constexpr (Yield::kPlastic) {
      describe_bulk_and_shear(map, volume.bulk, shear);
      if constexpr (Volume::kHeats)
        map.need_section("equation_of_state",
                         "Pressure by Mie and Grüneisen in place of the bulk modulus alone.",
                         "a map {gruneisen, hugoniot_slope, linear_viscosity, quadratic_viscosity}",
                         [&](Keys& keys) { volume.describe(keys); });
      map.key("taylor_quinney", "Share of the plastic work that heats.", heat_share, kShare);
    } else {
      map.need("bulk", kBulkDescription, volume.bulk, kModulus);
      map.key("shear", kShearDescription, shear, kStrength);
      volume.describe(map);
    }
    if constexpr (kColumns.temperature) {
      map.need("heat_capacity", "Heat per mass and temperature, at constant volume.", heat_capacity,
               Number{Measure::heat_capacity, kPositive});
      map.key("temperature", "At the start.", start_temperature, kTemperature);
    }
    if constexpr (Yield::kPlastic) yield.describe(map, start_temperature);
  }
  /// Of a longitudinal wave at rest, Pa.
  double modulus() const { return volume.bulk + 4 * shear / 3; }
  /// Without yield the shear stress is that of F; without shear there is none.
  double shape_limit() const {
    return Yield::kPlastic ? constants::kShapeOfMetals
           : shear > 0     ? constants::kWholeShape
                           : constants::kShapeOfFluids;
  }
  /// What the law takes from the grid.
  void set_cell(double cell) requires Volume::kHeats { volume.cell = cell; }

  template <int Dim, class V>
  void advance(const StrainStep<Dim, V>& step, MaterialState<Dim, V>& state, V (&tau)[kSymmetric<Dim>],
               V& wave_speed_squared) const {
    V b[kSymmetric<Dim>];
    V work = broadcast<V>(0.0);
    const double capacity = density * heat_capacity;  // ρ0 c_v, J/(m³ K)
    isochoric_strain(step, state, b);
    if constexpr (Yield::kPlastic) {
      work = flow<Dim>(step.dt, state, b);
      for (int c = 0; c < kSymmetric<Dim>; ++c) state.elastic_strain[c] = b[c];
      state.dissipated += work;
      if constexpr (Yield::kThermal && !Volume::kHeats) state.temperature += heat_share / capacity * work;
    }
    const auto response = volume.respond(step, density, capacity, work, V(heat_share * work), state);
    const V trace = b[0] + b[1] + b[2];
    V dev[kSymmetric<Dim>];
    deviator<Dim>(b, dev);
    for (int c = 0; c < kSymmetric<Dim>; ++c)
      tau[c] = c < 3 ? shear * dev[c] - response.pressure : shear * dev[c];
    // As in neo_hookean.hpp; det b̄ = 1. Plastic flow only slows waves down.
    const V smallest = smallest_stretch_squared<Dim>(b, broadcast<V>(1.0));
    const V modulus = response.modulus + shear * (trace * (5.0 / 9.0) - smallest * (1.0 / 3.0));
    const V elastic = modulus * (1.0 / density), viscous = response.viscous;
    const V bound = viscous + square_root(viscous * viscous + elastic);
    wave_speed_squared = bound * bound;
  }

  /// Recoverable energy per undeformed volume, J/m³.
  template <int Dim, class V>
  V energy(const V (&f)[Dim * Dim], const MaterialState<Dim, V>& state) const {
    const V j = state.volume_ratio;
    V trace;
    if constexpr (Yield::kPlastic) {
      trace = state.elastic_strain[0] + state.elastic_strain[1] + state.elastic_strain[2];
    } else {
      V b[kSymmetric<Dim>];
      left_cauchy_green<Dim>(f, b);
      trace = (b[0] + b[1] + b[2]) * isochoric_factor(j);
    }
    return 0.5 * shear * (trace - 3.0) + volume.template energy<Dim>(j, state);
  }

 private:
  template <int Dim, class V>
  static void isochoric_strain(const StrainStep<Dim, V>& step, const MaterialState<Dim, V>& state,
                               V (&b)[kSymmetric<Dim>]) {
    V scale;
    if constexpr (Yield::kPlastic) {
      push_forward<Dim>(step.increment, state.elastic_strain, b);
      scale = isochoric_factor(step.volume_now / step.volume_before);
    } else {
      left_cauchy_green<Dim>(step.deformation, b);
      scale = isochoric_factor(step.volume_now);
    }
    for (int c = 0; c < kSymmetric<Dim>; ++c) b[c] *= scale;
  }

  /// Radial return to the strength.
  /// @return plastic work, J/m³
  template <int Dim, class V>
  V flow(double dt, MaterialState<Dim, V>& state, V (&b)[kSymmetric<Dim>]) const {
    const Shear<Dim, V> trial(b, shear);
    const V x = yield.increment(trial.measure, trial.slope, state.plastic_strain, state.temperature, dt);
    state.plastic_strain += x;
    return trial.flow(x, b);
  }
};

using MieGruneisen = Metal<GruneisenVolume, NoYield>;
using MieGruneisenPlastic = Metal<GruneisenVolume, LinearHardening>;
using MieGruneisenJohnsonCook = Metal<GruneisenVolume, JohnsonCook>;
using ElasticPlastic = Metal<ElasticVolume, LinearHardening>;
using ElasticJohnsonCook = Metal<ElasticVolume, JohnsonCook>;

}  // namespace mpmfast
