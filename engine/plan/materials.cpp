#include "engine/plan/materials.hpp"

#include <type_traits>

namespace mpmfast {

namespace {

ElasticVolume volume_of(const MetalSpec& m) { return {m.bulk}; }
GruneisenVolume volume_of(const MetalSpec& m, double cell) {
  const EquationOfStateSpec& s = *m.equation_of_state;
  return {m.bulk, s.gruneisen, s.hugoniot_slope, s.linear_viscosity, s.quadratic_viscosity, cell};
}
NoYield yield_of(std::monostate) { return {}; }
LinearHardening yield_of(const LinearHardeningSpec& s) { return {s.yield, s.hardening}; }
JohnsonCook yield_of(const JohnsonCookSpec& s) {
  return {s.yield,          s.hardening, s.exponent,  s.rate_factor,
          s.reference_rate, s.softening, s.reference, s.melt};
}

template <class Volume, class Yield>
Material metal(const MetalSpec& m, const Volume& volume, const Yield& yield) {
  Metal<Volume, Yield> law{m.density, m.shear, volume, yield};
  if (m.heat_capacity > 0) law.heat_capacity = m.density * m.heat_capacity;
  law.heat_share = m.taylor_quinney;
  law.start_temperature = m.temperature;
  return law;
}

Material make_metal(const MetalSpec& m, double cell) {
  return std::visit(
      [&](const auto& strength) -> Material {
        const auto yield = yield_of(strength);
        if (m.equation_of_state) return metal(m, volume_of(m, cell), yield);
        if constexpr (std::is_same_v<decltype(yield), const NoYield>)
          return NeoHookean{m.density, m.bulk, m.shear};
        else
          return metal(m, volume_of(m), yield);
      },
      m.strength);
}

}  // namespace

Material make_material(const MaterialSpec& spec, double cell) {
  if (const auto* m = std::get_if<NeoHookeanSpec>(&spec.model))
    return NeoHookean{m->density, m->bulk, m->shear};
  if (const auto* m = std::get_if<LinearElasticSpec>(&spec.model)) {
    const double shear = m->young / (2 * (1 + m->poisson));
    return LinearElastic{m->density, m->young * m->poisson / ((1 + m->poisson) * (1 - 2 * m->poisson)),
                         shear};
  }
  if (const auto* m = std::get_if<LogarithmicNeoHookeanSpec>(&spec.model))
    return LogarithmicNeoHookean{m->density, m->lambda, m->shear};
  if (const auto* m = std::get_if<MetalSpec>(&spec.model)) return make_metal(*m, cell);
  return NeoHookean{};
}

double density_of(const MaterialSpec& spec) {
  return std::visit([](const auto& m) { return m.density; }, spec.model);
}

std::vector<Quantity> state_columns(const std::vector<MaterialSpec>& materials) {
  StateColumns any;
  for (const MaterialSpec& spec : materials)
    std::visit(
        [&]<class Law>(const Law&) {
          if constexpr (Evolving<Law>) {
            any.dissipated |= Law::kColumns.dissipated;
            any.internal_energy |= Law::kColumns.internal_energy;
            any.plastic_strain |= Law::kColumns.plastic_strain;
            any.temperature |= Law::kColumns.temperature;
            any.elastic_strain |= Law::kColumns.elastic_strain;
          }
        },
        make_material(spec, 1));
  std::vector<Quantity> columns;
  if (any.dissipated) columns.push_back(Quantity::dissipated_energy);
  if (any.internal_energy) columns.push_back(Quantity::internal_energy);
  if (any.plastic_strain) columns.push_back(Quantity::plastic_strain);
  if (any.temperature) columns.push_back(Quantity::temperature);
  if (any.elastic_strain) columns.push_back(Quantity::elastic_strain);
  return columns;
}

}  // namespace mpmfast
