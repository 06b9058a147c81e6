#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// The shapes that a place may have: those that no file describes.
/// @param dimension  of the scene; 0: those of any
std::vector<ShapeKind> region_kinds(int dimension) {
  std::vector<ShapeKind> out;
  for (const ShapeKind& kind : shape_kinds())
    if (kind.describe && !std::holds_alternative<StlShape>(kind.standard) &&
        (kind.dimension == 0 || dimension == 0 || kind.dimension == dimension))
      out.push_back(kind);
  return out;
}

/// {box: …} or another shape; absent where nothing is given.
void describe_place(Slot& slot, const Scene& scene, std::optional<Shape>& location) {
  if (slot.writes() && !location) return;
  Shape shape = location.value_or(BoxShape{});
  const bool of_scene = slot.reads() || slot.writes();  // else all that the format knows is listed
  const std::vector<ShapeKind> kinds = region_kinds(of_scene ? scene.dimension() : 0);
  const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const ShapeKind& kind) {
    return kind.written && kind.standard.index() == shape.index();
  });
  KeyGroups groups;
  for (const ShapeKind& kind : kinds) groups.push_back({kind.name});
  slot.map("a map {box | …}", [&](Keys& map) {
    const auto choice = map.one_of(groups, static_cast<int>(known - kinds.begin()));
    if (choice.none()) map.report(fmt::format("needs a shape (one of {})", fmt::join(names_of(kinds), ", ")));
    for (std::size_t k = 0; k < kinds.size(); ++k)
      if (choice.takes(static_cast<int>(k)) &&
          (kinds[k].dimension == 0 || kinds[k].dimension == scene.dimension()))
        map.need_at(kinds[k].name, kinds[k].note, "",
                    [&](Slot& one) { kinds[k].describe(one, shape, scene); });
  });
  if (slot.reads() && slot.good()) location = shape;
}

void describe_load(Slot& slot, const Scene& scene, PressureSpec& pressure) {
  slot.map("a map {body, value, where, along}", [&](Keys& map) {
    map.need_at("body", "Whose surface; of bodies that share a velocity field, that around all of them.",
                "the name of a body", [&](Slot& body) {
                  if (!body.reference(pressure.body, names_of(scene.bodies)) || !body.reads()) return;
                  if (is_rigid(scene, scene.bodies[static_cast<std::size_t>(pressure.body)]))
                    body.complain("a rigid body, which moves as it is told");
                });
    map.need("value", "The pressure; a negative one pulls.", pressure.value, Table{Measure::pressure});
    map.at("where",
           "The part of the surface that lies here at the start, two cells or more from any other part; all "
           "of it if not given.",
           [&](Slot& where) { describe_place(where, scene, pressure.where); });
    map.at("along",
           "Only what the pressure has along this direction: of a flat end nothing on the faces beside it.",
           [&](Slot& along) {
             if (along.writes() && !pressure.along) return;
             Vec3 direction = pressure.along.value_or(Vec3{1, 0, 0});
             describe_direction(along, scene.dimension(), true, direction);
             if (along.reads() && along.good()) pressure.along = direction;
           });
  });
}

/// The loads of one kind, a list.
template <class Spec>
void describe_kind(Keys& map, const char* name, const char* description, const char* expected, Scene& scene) {
  map.at(name, description, [&](Slot& slot) {
    std::vector<Spec> known;
    for (const LoadSpec& load : scene.loads)
      if (const auto* spec = std::get_if<Spec>(&load)) known.push_back(*spec);
    if (slot.writes() && known.empty()) return;
    std::size_t count = known.size();
    slot.list(expected, 1, Form::kNoEnd, count, [&](Slot& item, std::size_t k) {
      Spec spec = item.writes() ? known[k] : Spec{};
      describe_load(item, scene, spec);
      if (item.reads() && item.good()) scene.loads.push_back(spec);
    });
  });
}

}  // namespace

void describe_loads(Keys& top, Scene& scene) {
  top.at("loads", "What acts on bodies from outside, beside gravity.", [&](Slot& slot) {
    if (slot.writes() && scene.loads.empty()) return;
    slot.map("a map {pressure}", [&](Keys& map) {
      describe_kind<PressureSpec>(map, "pressure", "Pressures on surfaces of bodies.",
                                  "a list of maps {body, value, …}", scene);
    });
  });
}

void check_loads(const Value& top, const Scene& scene) {
  const bool surface = std::any_of(scene.loads.begin(), scene.loads.end(), [](const LoadSpec& load) {
    return std::visit([](const auto& spec) { return spec.needs().surface; }, load);
  });
  if (!surface) return;
  const Value stated = *top.find("loads");
  if (!scene.cracks.empty()) stated.report("loads on surfaces do not know cracks yet");
  if (scene.method.extended)
    stated.report("loads on surfaces do not know extended splines (method.extension) yet");
}

}  // namespace mpmfast
