#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/scene/keys/moduli.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// Adds a law to the model whose word it has.
template <class Law>
void add(std::vector<MaterialKind>& kinds) {
  const char* with = "";
  if constexpr (requires { Law::kWith; }) with = Law::kWith;
  const auto describe = [](Keys& map, MaterialModel& model) { std::get<Law>(model).describe(map); };
  const auto same = [](const MaterialKind& kind) { return std::string_view(kind.name) == Law::kModel; };
  auto kind = std::find_if(kinds.begin(), kinds.end(), same);
  if (kind == kinds.end()) kind = kinds.insert(kind, {Law::kModel, Law::kDescription, {}});
  kind->laws.push_back({with, Law{}, describe});
}

/// The kind of a material that is written.
std::size_t kind_of(const MaterialModel& model) {
  const auto& kinds = material_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const MaterialKind& kind) {
    return std::any_of(kind.laws.begin(), kind.laws.end(),
                       [&](const LawChoice& law) { return law.standard.index() == model.index(); });
  });
  return static_cast<std::size_t>(found - kinds.begin());
}

/// The law among those of a model that is there.
const LawChoice& law_of(Keys& map, const MaterialKind& kind, const MaterialModel& model) {
  const LawChoice* chosen = &kind.laws[0];
  for (const LawChoice& law : kind.laws) {
    const bool there =
        map.reads() ? *law.with && map.stated(law.with) : law.standard.index() == model.index();
    if (there) chosen = &law;
  }
  return *chosen;
}

/// What heat asks of any material.
void describe_heat_of(Keys& map, MaterialSpec& material) {
  const auto key = [&](const char* name, const char* description, double& member, const Number& form) {
    if (!map.writes() || member != 0) map.derived(name, description, member, form);
  };
  struct Own {
    bool temperature = false, expansion = false;
  };
  const Own own = std::visit(
      []<class Law>(const Law&) -> Own {
        if constexpr (std::is_same_v<Law, Rigid>) return {false, true};
        if constexpr (Evolving<Law>) return {Law::kColumns.temperature, Law::kColumns.internal_energy};
        return {};
      },
      material.model);
  if (!own.temperature)
    key("heat_capacity", "Heat per mass and temperature; scenes with `heat` need it.", material.heat_capacity,
        Number{Measure::heat_capacity, kPositive});
  key("conductivity", "Of heat, in scenes with `heat`; none if not given.", material.conductivity,
      Number{Measure::conductivity, kNotNegative});
  if (!own.expansion)  // an equation of state has its gamma, and nothing stretches what is rigid
    key("thermal_expansion", "Of a length, in scenes with `heat`; none if not given.", material.expansion,
        Number{Measure::expansion, kAny});
}

void describe_model(Keys& map, const MaterialKind& kind, MaterialSpec& material) {
  MaterialModel& model = material.model;
  const LawChoice& chosen = law_of(map, kind, model);
  for (const LawChoice& law : kind.laws) {
    if (!map.describes() && &law != &chosen) continue;
    const auto body = [&] {
      if (!map.writes()) model = law.standard;
      law.describe(map, model);
      describe_heat_of(map, material);
    };
    if (*law.with)
      map.under(law.with, true, body);
    else
      body();
  }
  map.close();
}

void describe_material(Slot& slot, MaterialSpec& material) {
  const std::vector<MaterialKind>& kinds = material_kinds();
  if (slot.reads() && !is_name(material.name)) slot.report("not a name (letters, digits, '_' and '-')");
  slot.map("a map {model, density, …}", [&](Keys& map) {
    map.allow_other_keys();  // until it has a model
    std::size_t index = slot.writes() ? kind_of(material.model) : 0;
    const bool known = map.need_at("model", "The law that the material obeys.",
                                   fmt::format("one of {}", fmt::join(names_of(kinds), ", ")),
                                   [&](Slot& model) { model.choose(index, kinds); });
    for (const MaterialKind& kind : kinds)
      map.under(fmt::format("model={}", kind.name), known && &kind == &kinds[index],
                [&] { describe_model(map, kind, material); });
  });
}

}  // namespace

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kKinds = [] {
    std::vector<MaterialKind> kinds;
#define MPMFAST_ADD(law) add<law>(kinds);
    MPMFAST_LAWS(MPMFAST_ADD)
#undef MPMFAST_ADD
    add<Rigid>(kinds);
    return kinds;
  }();
  return kKinds;
}

void describe_materials(Keys& top, std::vector<MaterialSpec>& materials) {
  constexpr const char* kExpected = "a map of names, each {model: …}";
  top.need_at("materials", "The materials by name; bodies refer to them.", kExpected, [&](Slot& slot) {
    slot.map(kExpected, [&](Keys& map) {
      map.allow_other_keys();
      const std::size_t count = map.count(materials.size());
      for (std::size_t k = 0; k < count; ++k) {
        MaterialSpec material = map.writes() ? materials[k] : MaterialSpec{};
        map.entry(k, "NAME", "A material: its model, and what that needs.", material.name,
                  [&](Slot& entry) { describe_material(entry, material); });
        if (map.reads()) materials.push_back(std::move(material));
      }
      if (count == 0) map.report("no materials");
    });
  });
}

}  // namespace mpmfast
