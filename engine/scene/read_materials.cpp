#include <fmt/format.h>

#include <cmath>
#include <string>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr Limit kPoisson{"in (-1, 0.5), and 0.49 is nearly incompressible", -1, 0.5, true, true};

decltype(MaterialSpec::model) read_neo_hookean(MapReader& map) {
  NeoHookeanSpec spec;
  map.need_quantity("density", Measure::density, kPositive, spec.density);
  read_moduli(map, "bulk", spec.bulk, spec.shear);
  return spec;
}

decltype(MaterialSpec::model) read_logarithmic(MapReader& map) {
  LogarithmicNeoHookeanSpec spec;
  map.need_quantity("density", Measure::density, kPositive, spec.density);
  read_moduli(map, "lambda", spec.lambda, spec.shear);
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

void read_moduli(MapReader& map, const char* volumetric, double& modulus, double& shear) {
  const auto first = map.find(volumetric), second = map.find("shear");
  const auto young = map.find("young"), poisson = map.find("poisson");
  const bool lame = std::string(volumetric) == "lambda";
  const int given = map.one_of({{volumetric, "shear"}, {"young", "poisson"}});
  if (given == 0) {
    modulus = first->quantity(Measure::pressure, lame ? kNotNegative : kPositive).value_or(0);
    shear = second->quantity(Measure::pressure, kPositive).value_or(0);
  } else if (given == 1) {
    const double e = young->quantity(Measure::pressure, kPositive).value_or(0);
    const double ratio = poisson->quantity(Measure::number, kPoisson).value_or(0);
    shear = e / (2 * (1 + ratio));
    modulus = lame ? 2 * shear * ratio / (1 - 2 * ratio) : e / (3 * (1 - 2 * ratio));
    const bool holds = shear > 0 && (lame ? modulus >= 0 : modulus > 0);
    if (e > 0 && (!holds || !std::isfinite(shear) || !std::isfinite(modulus)))
      map.value().report(fmt::format("young and poisson give {} = {} Pa and shear = {} Pa: out of range",
                                     volumetric, modulus, shear));
  } else {
    std::string got;
    for (const auto& [key, value] :
         {std::pair{volumetric, &first}, {"shear", &second}, {"young", &young}, {"poisson", &poisson}})
      if (*value) got += (got.empty() ? ", but has only " : " and ") + std::string(key);
    const bool many =
        int{first.has_value()} + int{second.has_value()} + int{young.has_value()} + int{poisson.has_value()} >
        2;
    map.value().report(fmt::format("needs either {} and shear or young and poisson{}", volumetric,
                                   many          ? ", not more"
                                   : got.empty() ? ", but has none"
                                                 : got));
  }
}

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kKinds{
      {"neo_hookean", "large elastic strains", read_neo_hookean},
      {"linear_elastic", "infinitesimal strains and turns only", read_linear_elastic},
      {"logarithmic_neo_hookean", "large elastic strains, pressure by ln J", read_logarithmic},
      {"mie_gruneisen", "shocks: equation of state, elastic shear, artificial viscosity", read_mie_gruneisen},
      {"j2_plasticity",
       "metal with linear hardening at large strains; with heat_capacity under an equation of state",
       read_j2_plasticity},
      {"johnson_cook", "metal whose strength depends on strain, rate and heat", read_johnson_cook},
      {"rigid", "moves as its body's velocity says, never deforms", read_rigid},
  };
  return kKinds;
}

void read_materials(MapReader& top, std::vector<MaterialSpec>& materials) {
  const auto section = top.need("materials", "a map of names, each {model: …}");
  if (!section) return;
  if (!MapReader(*section, "a map of names, each {model: …}").valid()) return;
  std::vector<std::string> models;
  for (const MaterialKind& kind : material_kinds()) models.emplace_back(kind.name);
  for (std::size_t k = 0; k < section->size(); ++k) {
    const Key& key = section->node().keys[k];
    const Value value = section->entry(k, "NAME");
    MaterialSpec material{key.text, NeoHookeanSpec{}};
    if (!is_name(key.text)) value.report("not a name (letters, digits, '_' and '-')");
    MapReader map(value, "a map {model, density, …}");
    const auto model = map.need("model", fmt::format("one of {}", fmt::join(models, ", ")));
    const int index = model ? model->choice(material_kinds()) : -1;
    if (index >= 0) {
      const When chosen(value, "model=" + models[static_cast<std::size_t>(index)]);
      material.model = material_kinds()[static_cast<std::size_t>(index)].read(map);
      map.finish();
    }
    materials.push_back(std::move(material));
  }
  if (materials.empty()) section->report("no materials");
}

}  // namespace mpmfast
