#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

std::vector<std::string> names_of(const std::vector<MaterialKind>& kinds) {
  std::vector<std::string> names;
  for (const MaterialKind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

void describe_material(Slot& slot, MaterialSpec& material) {
  const std::vector<MaterialKind>& kinds = material_kinds();
  if (slot.reads() && !is_name(material.name)) slot.report("not a name (letters, digits, '_' and '-')");
  slot.map("a map {model, density, …}", [&](Keys& map) {
    map.leave_open();  // until it has a model
    std::size_t index = slot.writes() ? kind_index(material.model) : 0;
    const bool known = map.need_at("model", "The law that the material obeys.",
                                   fmt::format("one of {}", fmt::join(names_of(kinds), ", ")),
                                   [&](Slot& model) { model.choose(index, kinds); });
    for (const MaterialKind& kind : kinds)
      map.under(fmt::format("model={}", kind.name), known && &kind == &kinds[index], [&] {
        if (!map.writes()) material.model = kind.standard;
        kind.describe(map, material.model);
        map.close();
      });
  });
}

}  // namespace

void describe_materials(Keys& top, std::vector<MaterialSpec>& materials) {
  constexpr const char* kExpected = "a map of names, each {model: …}";
  top.need_at("materials", "The materials by name; bodies refer to them.", kExpected, [&](Slot& slot) {
    slot.map(kExpected, [&](Keys& map) {
      map.leave_open();
      const std::size_t count = map.count(materials.size());
      for (std::size_t k = 0; k < count; ++k) {
        MaterialSpec material = map.writes() ? materials[k] : MaterialSpec{"", material_kinds()[0].standard};
        map.entry(k, "NAME", "A material: its model, and what that needs.", material.name,
                  [&](Slot& entry) { describe_material(entry, material); });
        if (map.reads()) materials.push_back(std::move(material));
      }
      if (count == 0) map.report("no materials");
    });
  });
}

}  // namespace mpmfast
