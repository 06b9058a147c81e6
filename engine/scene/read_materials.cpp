#include <string>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr Limit kPoisson{"in (-1, 0.5)", -1, 0.5, true, true};

/// Bulk and shear modulus, or Young's modulus and Poisson's ratio in their place.
decltype(MaterialSpec::model) read_neo_hookean(MapReader& map) {
  NeoHookeanSpec spec;
  map.need_quantity("density", Measure::density, kPositive, spec.density);
  const auto bulk = map.find("bulk"), shear = map.find("shear");
  const auto young = map.find("young"), poisson = map.find("poisson");
  const bool by_moduli = bulk && shear && !young && !poisson;
  const bool by_young = young && poisson && !bulk && !shear;
  if (by_moduli) {
    spec.bulk = bulk->quantity(Measure::pressure, kPositive).value_or(0);
    spec.shear = shear->quantity(Measure::pressure, kPositive).value_or(0);
  } else if (by_young) {
    const double modulus = young->quantity(Measure::pressure, kPositive).value_or(0);
    const double ratio = poisson->quantity(Measure::number, kPoisson).value_or(0);
    spec.bulk = modulus / (3 * (1 - 2 * ratio));
    spec.shear = modulus / (2 * (1 + ratio));
  } else {
    map.value().report("needs either bulk and shear or young and poisson");
  }
  return spec;
}

decltype(MaterialSpec::model) read_linear_elastic(MapReader& map) {
  LinearElasticSpec spec;
  map.need_quantity("density", Measure::density, kPositive, spec.density);
  map.need_quantity("young", Measure::pressure, kPositive, spec.young);
  map.need_quantity("poisson", Measure::number, kPoisson, spec.poisson);
  return spec;
}

decltype(MaterialSpec::model) read_rigid(MapReader& map) {
  RigidSpec spec;
  map.quantity("density", Measure::density, kPositive, spec.density);
  return spec;
}

}  // namespace

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kKinds{
      {"neo_hookean", "density, bulk, shear (or young, poisson)", "large elastic strains", read_neo_hookean},
      {"linear_elastic", "density, young, poisson", "infinitesimal strains and turns only",
       read_linear_elastic},
      {"rigid", "density = 1000 kg/m^3", "moves as its body's velocity says, never deforms", read_rigid},
  };
  return kKinds;
}

void read_materials(MapReader& top, std::vector<MaterialSpec>& materials) {
  const auto section = top.need("materials", "a map of names, each {model: …}");
  if (!section) return;
  MapReader all(*section, "a map of names, each {model: …}");
  if (!all.valid()) return;
  std::vector<std::string> models;
  for (const MaterialKind& kind : material_kinds()) models.emplace_back(kind.name);
  for (const Key& key : section->node().keys) {
    const Value value = *all.find(key.text);
    MaterialSpec material{key.text, NeoHookeanSpec{}};
    if (!is_name(key.text)) value.report("not a name (letters, digits, '_' and '-')");
    MapReader map(value, "a map {model, density, …}");
    const auto model = map.need("model", "one of neo_hookean, linear_elastic, rigid");
    const int index = model ? model->word_index(models) : -1;
    if (index >= 0) {
      material.model = material_kinds()[static_cast<std::size_t>(index)].read(map);
      map.finish();
    }
    materials.push_back(std::move(material));
  }
  if (materials.empty()) section->report("no materials");
}

}  // namespace mpmfast
