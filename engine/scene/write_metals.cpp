#include <fmt/format.h>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

std::string pressure(double value) { return quantity_text(value, Measure::pressure); }
std::string temperature(double value) { return quantity_text(value, Measure::temperature); }

std::string state_text(const EquationOfStateSpec& state) {
  return fmt::format("gruneisen: {}, hugoniot_slope: {}, linear_viscosity: {}, quadratic_viscosity: {}",
                     state.gruneisen, state.hugoniot_slope, state.linear_viscosity,
                     state.quadratic_viscosity);
}

struct StrengthText {
  std::string operator()(const std::monostate&) const { return ""; }
  std::string operator()(const LinearHardeningSpec& s) const {
    return fmt::format(", yield: {}, hardening: {}", pressure(s.yield), pressure(s.hardening));
  }
  std::string operator()(const JohnsonCookSpec& s) const {
    return fmt::format(
        ", yield: {}, hardening: {}, exponent: {}, rate_factor: {}, reference_rate: {}, softening: {}, "
        "reference: {}, melt: {}",
        pressure(s.yield), pressure(s.hardening), s.exponent, s.rate_factor,
        quantity_text(s.reference_rate, Measure::rate), s.softening, temperature(s.reference),
        temperature(s.melt));
  }
};

}  // namespace

std::string metal_text(const MetalSpec& metal) {
  constexpr const char* kModels[] = {"mie_gruneisen", "j2_plasticity", "johnson_cook"};
  std::string text = fmt::format(
      "model: {}, density: {}, bulk: {}, shear: {}", kModels[metal.strength.index()],
      quantity_text(metal.density, Measure::density), pressure(metal.bulk), pressure(metal.shear));
  const bool yields = metal.strength.index() > 0;
  if (metal.equation_of_state) {
    const std::string state = state_text(*metal.equation_of_state);
    text += yields ? fmt::format(", equation_of_state: {{{}}}", state) : ", " + state;
  }
  if (yields) text += fmt::format(", taylor_quinney: {}", metal.taylor_quinney);
  if (metal.heat_capacity > 0)
    text += fmt::format(", heat_capacity: {}, temperature: {}",
                        quantity_text(metal.heat_capacity, Measure::heat_capacity),
                        temperature(metal.temperature));
  return text + std::visit(StrengthText{}, metal.strength);
}

}  // namespace mpmfast
