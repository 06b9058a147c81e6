#include <fmt/format.h>

#include <cmath>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

using Model = decltype(MaterialSpec::model);

constexpr Number kModulus{Measure::pressure, kPositive};
constexpr Number kPoisson{Measure::number,
                          {"in (-1, 0.5), and 0.49 is nearly incompressible", -1, 0.5, true, true}};
constexpr Number kFactor{Measure::number, kNotNegative}, kExponent{Measure::number, kPositive};
constexpr Number kTemperature{Measure::temperature, kPositive};

void describe_density(Keys& map, double& density) {
  map.need("density", "Mass over volume, unstrained.", density, Number{Measure::density, kPositive});
}

void report_moduli(Keys& map, const char* volumetric) {
  std::string got;
  int many = 0;
  for (const char* key : {volumetric, "shear", "young", "poisson"}) {
    if (!map.stated(key)) continue;
    got += (got.empty() ? ", but has only " : " and ") + std::string(key);
    ++many;
  }
  map.report(fmt::format("needs either {} and shear or young and poisson{}", volumetric,
                         many > 2      ? ", not more"
                         : got.empty() ? ", but has none"
                                       : got));
}

/// `volumetric` (bulk or lambda) and shear, or young and poisson in their place.
void describe_moduli(Keys& map, const char* volumetric, double& modulus, double& shear) {
  const bool lame = std::string_view(volumetric) == "lambda";
  const auto choice = map.one_of({{volumetric, "shear"}, {"young", "poisson"}});
  if (choice.none()) return report_moduli(map, volumetric);
  if (choice.takes(0)) {
    map.need(volumetric, lame ? "First Lamé constant." : "Bulk modulus.", modulus,
             Number{Measure::pressure, lame ? kNotNegative : kPositive});
    map.need("shear", "Shear modulus.", shear, kModulus);
  }
  if (!choice.takes(1)) return;
  double young = 0, poisson = 0;
  const bool first =
      map.need("young", "Young's modulus; where both are known here, with `poisson` in place of them.", young,
               kModulus);
  const bool second = map.need("poisson", "Poisson's ratio.", poisson, kPoisson);
  if (!map.reads() || !first || !second) return;
  shear = young / (2 * (1 + poisson));
  modulus = lame ? 2 * shear * poisson / (1 - 2 * poisson) : young / (3 * (1 - 2 * poisson));
  const bool holds = shear > 0 && (lame ? modulus >= 0 : modulus > 0);
  if (!holds || !std::isfinite(shear) || !std::isfinite(modulus))
    map.report(fmt::format("young and poisson give {} = {} Pa and shear = {} Pa: out of range", volumetric,
                           modulus, shear));
}

void describe_neo_hookean(Keys& map, Model& model) {
  auto& spec = std::get<NeoHookeanSpec>(model);
  describe_density(map, spec.density);
  describe_moduli(map, "bulk", spec.bulk, spec.shear);
}

void describe_logarithmic(Keys& map, Model& model) {
  auto& spec = std::get<LogarithmicNeoHookeanSpec>(model);
  describe_density(map, spec.density);
  describe_moduli(map, "lambda", spec.lambda, spec.shear);
}

void describe_linear_elastic(Keys& map, Model& model) {
  auto& spec = std::get<LinearElasticSpec>(model);
  describe_density(map, spec.density);
  map.need("young", "Young's modulus; where both are known here, with `poisson` in place of them.",
           spec.young, kModulus);
  map.need("poisson", "Poisson's ratio.", spec.poisson, kPoisson);
}

void describe_rigid(Keys& map, Model& model) {
  map.key("density", "Only weighs the velocities of several rigid particles at a node.",
          std::get<RigidSpec>(model).density, Number{Measure::density, kPositive});
}

void describe_state(Keys& map, EquationOfStateSpec& state) {
  map.need("gruneisen", "Grüneisen's gamma: pressure that heat adds.", state.gruneisen, kFactor);
  map.need("hugoniot_slope", "Slope of shock speed over particle speed.", state.hugoniot_slope, kFactor);
  map.key("linear_viscosity", "Artificial viscosity against ringing behind a shock, linear in the rate.",
          state.linear_viscosity, kFactor);
  map.key("quadratic_viscosity", "The same, quadratic in the rate: spreads the shock over a few cells.",
          state.quadratic_viscosity, kFactor);
}

void describe_heat(Keys& map, MetalSpec& metal) {
  map.need("heat_capacity", "Heat per mass and temperature, at constant volume.", metal.heat_capacity,
           Number{Measure::heat_capacity, kPositive});
  map.key("temperature", "At the start.", metal.temperature, kTemperature);
}

/// The keys that every metal with yield has; it heats always, or with an equation of state.
void describe_yielding(Keys& map, bool always, MetalSpec& metal) {
  constexpr Limit kShare{"in [0, 1]", 0, 1};
  describe_density(map, metal.density);
  describe_moduli(map, "bulk", metal.bulk, metal.shear);
  map.at("equation_of_state", "Pressure by Mie and Grüneisen in place of the bulk modulus alone.",
         [&](Slot& slot) {
           if (slot.writes() && !metal.equation_of_state) return;
           EquationOfStateSpec state = metal.equation_of_state.value_or(EquationOfStateSpec{});
           slot.map("a map {gruneisen, hugoniot_slope, linear_viscosity, quadratic_viscosity}",
                    [&](Keys& keys) { describe_state(keys, state); });
           if (slot.reads()) metal.equation_of_state = state;
         });
  map.key("taylor_quinney", "Share of the plastic work that heats.", metal.taylor_quinney,
          Number{Measure::number, kShare});
  if (always)
    describe_heat(map, metal);
  else
    map.under("equation_of_state", metal.equation_of_state.has_value(), [&] { describe_heat(map, metal); });
}

constexpr const char* kYield = "Stress at which it first yields (A of Johnson and Cook).";
constexpr const char* kHardening = "How the yield stress grows with plastic strain (B of Johnson and Cook).";

void describe_mie_gruneisen(Keys& map, Model& model) {
  auto& metal = std::get<MetalSpec>(model);
  describe_density(map, metal.density);
  map.need("bulk", "Bulk modulus.", metal.bulk, kModulus);
  map.key("shear", "Shear modulus.", metal.shear, Number{Measure::pressure, kNotNegative});
  describe_state(map, *metal.equation_of_state);
  describe_heat(map, metal);
}

void describe_j2_plasticity(Keys& map, Model& model) {
  auto& metal = std::get<MetalSpec>(model);
  auto& strength = std::get<LinearHardeningSpec>(metal.strength);
  describe_yielding(map, false, metal);
  map.need("yield", kYield, strength.yield, kModulus);
  map.key("hardening", kHardening, strength.hardening, Number{Measure::pressure, kNotNegative});
}

void describe_johnson_cook(Keys& map, Model& model) {
  auto& metal = std::get<MetalSpec>(model);
  auto& strength = std::get<JohnsonCookSpec>(metal.strength);
  describe_yielding(map, true, metal);
  if (!map.writes()) strength.reference = metal.temperature;
  map.need("yield", kYield, strength.yield, kModulus);
  map.need("hardening", kHardening, strength.hardening, Number{Measure::pressure, kNotNegative});
  map.need("exponent", "Exponent of the plastic strain, n.", strength.exponent, kExponent);
  map.key("rate_factor", "Factor of the logarithm of the strain rate, C.", strength.rate_factor, kFactor);
  map.key("reference_rate", "Strain rate at which that logarithm is zero.", strength.reference_rate,
          Number{Measure::rate, kPositive});
  map.key("softening", "Exponent of the homologous temperature, m.", strength.softening, kExponent);
  map.key("reference", "Temperature at which softening begins; that at the start if not given.",
          strength.reference, kTemperature);
  const Limit hotter{"above the reference temperature", strength.reference, kInfinity, true, false, true};
  map.need("melt", "Temperature at which no strength is left.", strength.melt,
           Number{Measure::temperature, hotter});
}

MetalSpec metal_of(std::optional<EquationOfStateSpec> state, decltype(MetalSpec::strength) strength) {
  MetalSpec metal;
  metal.equation_of_state = state;
  metal.strength = strength;
  return metal;
}

}  // namespace

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kKinds{
      {"neo_hookean", "large elastic strains", NeoHookeanSpec{}, describe_neo_hookean},
      {"linear_elastic", "infinitesimal strains and turns only", LinearElasticSpec{},
       describe_linear_elastic},
      {"logarithmic_neo_hookean", "large elastic strains, pressure by ln J", LogarithmicNeoHookeanSpec{},
       describe_logarithmic},
      {"mie_gruneisen", "shocks: equation of state, elastic shear, artificial viscosity",
       metal_of(EquationOfStateSpec{}, std::monostate{}), describe_mie_gruneisen},
      {"j2_plasticity",
       "metal with linear hardening at large strains; with heat_capacity under an equation of state",
       metal_of({}, LinearHardeningSpec{}), describe_j2_plasticity},
      {"johnson_cook", "metal whose strength depends on strain, rate and heat",
       metal_of({}, JohnsonCookSpec{}), describe_johnson_cook},
      {"rigid", "moves as its body's velocity says, never deforms", RigidSpec{}, describe_rigid},
  };
  return kKinds;
}

std::size_t kind_index(const Model& model) {
  const auto* metal = std::get_if<MetalSpec>(&model);
  const std::vector<MaterialKind>& kinds = material_kinds();
  std::size_t k = 0;
  for (; k + 1 < kinds.size(); ++k) {
    const auto* other = std::get_if<MetalSpec>(&kinds[k].standard);
    if (kinds[k].standard.index() == model.index() &&
        (!metal || metal->strength.index() == other->strength.index()))
      break;
  }
  return k;
}

}  // namespace mpmfast
