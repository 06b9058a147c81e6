#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/sections/describe.hpp"
#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

using Kind = HeatConditionSpec::Kind;

/// A temperature in time, above zero.
void need_temperature(Keys& map, const char* name, const char* description, TimeTable& table) {
  map.need_at(name, description, expected_of(Table{Measure::temperature}), [&](Slot& slot) {
    if (!slot.take(table, Table{Measure::temperature}) || !slot.reads()) return;
    if (std::any_of(table.value.begin(), table.value.end(), [](double value) { return !(value > 0); }))
      slot.complain("not positive");
  });
}

/// {temperature}, {flux} or {ambient, coefficient}; of nodes in a box a temperature alone.
void describe_value(Keys& map, HeatConditionSpec& condition) {
  if (!condition.face) {
    need_temperature(map, "temperature", "Of these nodes.", condition.value);
    return;
  }
  const auto choice =
      map.one_of({{"temperature"}, {"flux"}, {"ambient", "coefficient"}}, static_cast<int>(condition.kind));
  if (choice.none()) map.report("needs either temperature, flux, or ambient and coefficient");
  if (choice.takes(0)) {
    condition.kind = Kind::temperature;
    need_temperature(map, "temperature", "Of what lies at the face.", condition.value);
  }
  if (choice.takes(1)) {
    condition.kind = Kind::flux;
    map.need("flux", "Heat that comes in through the face.", condition.value, Table{Measure::heat_flux});
  }
  if (choice.takes(2)) {
    condition.kind = Kind::ambient;
    need_temperature(map, "ambient", "Temperature of what is around.", condition.value);
    map.need("coefficient", "Heat that comes in, a kelvin that the face is colder.", condition.coefficient,
             Number{Measure::conductance, kPositive});
  }
}

void describe_condition(Slot& slot, const Scene& scene, HeatConditionSpec& condition) {
  const FaceName* face = face_named(condition.name);
  condition.face = face != nullptr;
  if (face) {
    if (slot.reads() && face->axis >= scene.dimension()) return slot.report("exists in 3-D only");
    condition.axis = face->axis;
    condition.upper = face->upper;
  } else if (slot.reads() && !slot.value()->is(Node::Kind::map)) {
    const std::string meant = did_you_mean(condition.name, names_of(kFaces));
    return slot.complain(
        "not a face of the grid, and not a map {box, temperature}",
        meant.empty() ? "The faces are left, right, bottom, top, in 3-D also back and front" : meant);
  }
  if (slot.reads() && !face && !is_name(condition.name))
    slot.report("not a name (letters, digits, '_' and '-')");
  slot.map(face ? "a map {temperature | flux | ambient, coefficient}" : "a map {box, temperature}",
           [&](Keys& map) {
             if (!face)
               map.need_at("box", "All nodes in this box.", "a map {from, to}", [&](Slot& box) {
                 describe_region(box, scene.dimension(), condition.lower, condition.corner);
               });
             describe_value(map, condition);
           });
}

void describe_conditions(Keys& map, const Scene& scene, std::vector<HeatConditionSpec>& conditions) {
  map.allow_other_keys();
  std::vector<HeatConditionSpec> entries;
  const auto add = [&](const std::string& name, Kind kind) {
    HeatConditionSpec entry;
    entry.name = name;
    entry.kind = kind;
    entry.value = TimeTable{{0}, {scene.heat.temperature}};
    entries.push_back(entry);
  };
  if (map.writes()) entries = conditions;
  if (map.describes()) {
    add(kFaces[0].name, Kind::temperature);
    add("", Kind::temperature);
  }
  if (map.reads())
    for (const Key& key : map.reader().value().node().keys) add(key.text, Kind::temperature);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const bool face = face_named(entries[k].name);
    const bool good =
        map.entry(k, face ? "FACE" : "NAME",
                  face ? "A face of the grid, or where its wall stands: what it does to heat."
                       : "A temperature given at some nodes.",
                  entries[k].name, [&](Slot& slot) { describe_condition(slot, scene, entries[k]); });
    if (map.reads() && good) conditions.push_back(entries[k]);
  }
}

/// none or {order, every}.
void describe_filter(Slot& slot, HeatSpec& heat) {
  if (slot.is_keyword("none", heat.filter_order == 0)) {
    heat.filter_order = 0;
    return;
  }
  HeatSpec filtered = heat;
  if (filtered.filter_order == 0) filtered.filter_order = 2;
  slot.map("none or a map {order, every}", [&](Keys& map) {
    // With more terms, what slopes overshoot at surfaces grows: (1 - 2.2)^4 > 1.
    map.key("order", "Terms of the inverse of the full capacity matrix: 2, or 1, which smooths more.",
            filtered.filter_order, Whole{1, 2});
    map.key("every", "Time from one to the next, over that in which heat crosses a cell (h^2/kappa).",
            filtered.filter_every, Number{Measure::number, kNotNegative});
  });
  if (slot.reads()) heat = filtered;
}

}  // namespace

void describe_heat(Keys& top, bool, Scene& scene) {
  HeatSpec& heat = scene.heat;
  top.at("heat", "Temperatures that are conducted; none: heat stays where it is made.", [&](Slot& slot) {
    if (slot.writes() && !heat.active) return;
    if (slot.is_keyword("none", !heat.active)) return;
    slot.map("none or a map {temperature, boundaries, filter}", [&](Keys& map) {
      if (map.reads()) heat.active = true;
      map.key("temperature", "Of bodies at the start.", heat.temperature, kTemperature);
      map.section("boundaries", "What faces of the grid and nodes do to heat; others let none through.",
                  "a map {left: {temperature: …}, …}",
                  [&](Keys& conditions) { describe_conditions(conditions, scene, heat.conditions); });
      map.at("filter", "Takes from the temperatures of particles what the grid cannot see of them.",
             [&](Slot& filter) { describe_filter(filter, heat); });
    });
  });
}

namespace {

/// What the particles of a material have by its law.
struct LawHeat {
  bool temperature = false, plastic = false;
};
LawHeat heat_of(const MaterialSpec& material) {
  return std::visit(
      []<class Law>(const Law&) {
        LawHeat heat;
        if constexpr (Evolving<Law>) heat = {Law::kColumns.temperature, Law::kColumns.plastic_strain};
        return heat;
      },
      material.model);
}

/// Pictures of what no particle has.
void check_picture(const Value& top, const Scene& scene) {
  bool temperature = scene.heat.active, plastic = false;
  for (const MaterialSpec& material : scene.materials) {
    temperature |= heat_of(material).temperature;
    plastic |= heat_of(material).plastic;
  }
  const std::string& picture = scene.output.picture;
  if ((picture == "temperature" && !temperature) || (picture == "plastic_strain" && !plastic))
    top.find("output")->find("picture")->report(
        fmt::format("no body of this scene has a {}", picture == "temperature" ? picture : "plastic strain"));
}

}  // namespace

void check_heat(const Value& top, const Scene& scene, const std::vector<BodyLocation>& locations) {
  check_picture(top, scene);
  if (!scene.heat.active) {
    for (std::size_t b = 0; b < scene.bodies.size() && b < locations.size(); ++b)
      if (scene.bodies[b].temperature)
        if (const auto stated = locations[b].entry.find("temperature"))
          stated->report("bodies have temperatures where the scene has heat", "heat: {}");
    return;
  }
  const Value stated = *top.find("heat");
  if (scene.method.extended) stated.report("heat does not know extended splines (method.extension)");
  if (scene.contact.family == ContactFamily::penalty)
    stated.report("heat does not cross surfaces that are followed (contact.family: penalty) yet");
  const auto ties = [](const SurfaceLaw& law) { return std::holds_alternative<Perfect>(law.acts); };
  if (scene.contact.active && scene.contact.any(ties) &&
      std::any_of(scene.bodies.begin(), scene.bodies.end(),
                  [&](const BodySpec& body) { return is_rigid(scene, body); }))
    stated.report("heat does not know bodies that are tied to rigid ones (law: perfect)", "law: stick");
  if (scene.space == Space::axisymmetric && scene.grid.origin[0] == 0)
    for (const HeatConditionSpec& condition : scene.heat.conditions)
      if (condition.face && condition.axis == 0 && !condition.upper)
        stated.find("boundaries")->find(condition.name)->report("the axis of the scene is no face");
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const MaterialSpec& material = scene.materials[m];
    const bool used = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                  [&](const BodySpec& body) { return body.material == static_cast<int>(m); });
    if (!used || std::holds_alternative<Rigid>(material.model)) continue;
    const auto entry = top.find("materials")->find(material.name);
    const Value location = entry ? *entry : stated;
    const LawHeat law = heat_of(material);
    if (!law.temperature && material.heat_capacity == 0)
      location.report(fmt::format("'{}' needs its heat_capacity in a scene with heat", material.name));
  }
}

}  // namespace mpmfast
