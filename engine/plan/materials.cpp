#include "engine/plan/materials.hpp"

#include <type_traits>

namespace mpmfast {

Material make_material(const MaterialSpec& spec, double cell, bool heat) {
  return std::visit(
      [&]<class Model>(Model law) -> Material {
        if constexpr (requires { law.set_cell(cell); }) law.set_cell(cell);
        if constexpr (requires { law.heating; })
          if (heat && spec.heat_capacity > 0)
            law.heating = law.heat_share / (law.density * spec.heat_capacity);
        if constexpr (std::is_same_v<Model, Rigid>)
          return NeoHookean{};  // its particles are never asked
        else
          return law;
      },
      spec.model);
}

double heat_capacity_of(const MaterialSpec& spec) {
  return std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (Evolving<Law>) {
          if constexpr (Law::kColumns.temperature) return law.heat_capacity;
        }
        return spec.heat_capacity;
      },
      spec.model);
}

BodyHeat body_heat(const Scene& scene, const BodySpec& body) {
  const MaterialSpec& spec = scene.materials[static_cast<std::size_t>(body.material)];
  BodyHeat heat;
  heat.capacity = heat_capacity_of(spec);
  if (is_rigid(scene, body) && heat.capacity == 0) heat.capacity = 1;  // it only weighs
  heat.conductivity = spec.conductivity;
  heat.expansion = spec.expansion;
  heat.start = body.temperature.value_or(scene.heat.temperature);
  std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (Evolving<Law>) {
          if constexpr (Law::kColumns.internal_energy) heat.stored = law.density * law.heat_capacity;
          if constexpr (requires { Law::kElasticVolume; }) heat.elastic_volume = true;
          if constexpr (Law::kColumns.temperature)
            if (!body.temperature) heat.start = law.start_temperature;
        }
      },
      spec.model);
  return heat;
}

std::vector<Quantity> state_columns(const std::vector<MaterialSpec>& materials) {
  StateColumns any;
  bool evolves = false;
  for (const MaterialSpec& spec : materials)
    std::visit(
        [&]<class Law>(const Law&) {
          if constexpr (Evolving<Law>) {
            evolves = true;
            any.dissipated |= Law::kColumns.dissipated;
            any.internal_energy |= Law::kColumns.internal_energy;
            any.plastic_strain |= Law::kColumns.plastic_strain;
            any.temperature |= Law::kColumns.temperature;
            any.elastic_strain |= Law::kColumns.elastic_strain;
          }
        },
        make_material(spec, 1, false));
  std::vector<Quantity> columns;
  if (evolves) columns.push_back(Quantity::volume_ratio);
  if (any.dissipated) columns.push_back(Quantity::dissipated_energy);
  if (any.internal_energy) columns.push_back(Quantity::internal_energy);
  if (any.plastic_strain) columns.push_back(Quantity::plastic_strain);
  if (any.temperature) columns.push_back(Quantity::temperature);
  if (any.elastic_strain) columns.push_back(Quantity::elastic_strain);
  return columns;
}

}  // namespace mpmfast
