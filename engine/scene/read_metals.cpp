#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr Limit kShare{"in [0, 1]", 0, 1};

void read_state(MapReader& map, EquationOfStateSpec& state) {
  map.need_quantity("gruneisen", Measure::number, kNotNegative, state.gruneisen);
  map.need_quantity("hugoniot_slope", Measure::number, kNotNegative, state.hugoniot_slope);
  map.quantity("linear_viscosity", Measure::number, kNotNegative, state.linear_viscosity);
  map.quantity("quadratic_viscosity", Measure::number, kNotNegative, state.quadratic_viscosity);
}

/// The keys that every metal with yield has; it heats always, or with an equation of state.
void read_metal(MapReader& map, bool always, MetalSpec& metal) {
  bool heats = always;
  map.need_quantity("density", Measure::density, kPositive, metal.density);
  read_moduli(map, "bulk", metal.bulk, metal.shear);
  if (const auto section = map.find("equation_of_state")) {
    metal.equation_of_state.emplace();
    MapReader state(*section, "a map {gruneisen, hugoniot_slope, linear_viscosity, quadratic_viscosity}");
    if (state.valid()) {
      read_state(state, *metal.equation_of_state);
      state.finish();
    }
    heats = true;
  }
  map.quantity("taylor_quinney", Measure::number, kShare, metal.taylor_quinney);
  if (!heats) return;
  const When stated(map.value(), always ? "" : "equation_of_state");
  map.need_quantity("heat_capacity", Measure::heat_capacity, kPositive, metal.heat_capacity);
  map.quantity("temperature", Measure::temperature, kPositive, metal.temperature);
}

}  // namespace

decltype(MaterialSpec::model) read_mie_gruneisen(MapReader& map) {
  MetalSpec metal;
  map.need_quantity("density", Measure::density, kPositive, metal.density);
  map.need_quantity("bulk", Measure::pressure, kPositive, metal.bulk);
  map.quantity("shear", Measure::pressure, kNotNegative, metal.shear);
  read_state(map, metal.equation_of_state.emplace());
  map.need_quantity("heat_capacity", Measure::heat_capacity, kPositive, metal.heat_capacity);
  map.quantity("temperature", Measure::temperature, kPositive, metal.temperature);
  return metal;
}

decltype(MaterialSpec::model) read_j2_plasticity(MapReader& map) {
  MetalSpec metal;
  read_metal(map, false, metal);
  LinearHardeningSpec strength;
  map.need_quantity("yield", Measure::pressure, kPositive, strength.yield);
  map.quantity("hardening", Measure::pressure, kNotNegative, strength.hardening);
  metal.strength = strength;
  return metal;
}

decltype(MaterialSpec::model) read_johnson_cook(MapReader& map) {
  MetalSpec metal;
  read_metal(map, true, metal);
  JohnsonCookSpec strength;
  strength.reference = metal.temperature;
  map.need_quantity("yield", Measure::pressure, kPositive, strength.yield);
  map.need_quantity("hardening", Measure::pressure, kNotNegative, strength.hardening);
  map.need_quantity("exponent", Measure::number, kPositive, strength.exponent);
  map.quantity("rate_factor", Measure::number, kNotNegative, strength.rate_factor);
  map.quantity("reference_rate", Measure::rate, kPositive, strength.reference_rate);
  map.quantity("softening", Measure::number, kPositive, strength.softening);
  map.quantity("reference", Measure::temperature, kPositive, strength.reference);
  const Limit hotter{"above the reference temperature", strength.reference, kInfinity, true, false, true};
  map.need_quantity("melt", Measure::temperature, hotter, strength.melt);
  metal.strength = strength;
  return metal;
}

}  // namespace mpmfast
