#include <fmt/format.h>

#include <type_traits>

#include "engine/scene/keys/names.hpp"
#include "engine/scene/sections/describe.hpp"
#include "kernels/materials/out_of_plane.hpp"

namespace mpmfast {

namespace {

/// Can it be asked for its stress where nothing presses along z?
bool relaxes(const MaterialModel& model) {
  return std::visit([]<class Law>(const Law&) { return HasPlaneStress<Law> || std::is_same_v<Law, Rigid>; },
                    model);
}

/// Contact areas are found in the plane, not on the surface that turns about the axis.
void refuse_areas(const Value& top, const ContactSpec& contact) {
  const auto refuse = [](const std::optional<Value>& value, const SurfaceLaw& law) {
    if (value && std::visit([](const auto& one) { return one.uses_area; }, law.acts))
      value->complain("needs contact areas, which an axisymmetric scene does not have");
  };
  const auto section = top.find("contact");
  if (!section) return;
  refuse(section->find("law"), contact.law);
  const auto pairs = section->find("pairs");
  if (!pairs || !pairs->is(Node::Kind::list)) return;
  for (std::size_t k = 0; k < pairs->size() && k < contact.pairs.size(); ++k)
    refuse(pairs->item(k).find("law"), contact.pairs[k].law);
}

/// The axis is a wall: by default, and nothing else.
void make_axis(const Value& top, Scene& scene) {
  if (scene.grid.origin[0] > 0) return;
  const auto section = top.find("boundaries");
  const auto left = section ? section->find("left") : std::nullopt;
  if (!left) {
    scene.boundaries.push_back({"left", WallSpec{0, false, 0, TimeTable{{0}, {0}}, false}});
    return;
  }
  for (const BoundarySpec& boundary : scene.boundaries) {
    const auto* wall = std::get_if<WallSpec>(&boundary.condition);
    if (boundary.name != "left" || !wall) continue;
    const bool slides = !wall->fixed && wall->speed.value == std::vector<double>{0};
    if (slides || wall->position > 0) return;
  }
  left->complain("the left face is the axis here (wall or symmetry, or a wall or piston at a position > 0)");
}

}  // namespace

void check_plane_stress(const Value& top, const Scene& scene) {
  const auto section = top.find("materials");
  std::string relaxing;
  for (const MaterialKind& kind : material_kinds())
    if (relaxes(kind.laws[0].standard) && !std::holds_alternative<Rigid>(kind.laws[0].standard))
      relaxing += (relaxing.empty() ? "" : ", ") + std::string(kind.name);
  for (const MaterialSpec& material : scene.materials) {
    if (relaxes(material.model)) continue;
    const auto stated = section ? section->find(material.name) : std::nullopt;
    if (const auto model = stated ? stated->find("model") : std::nullopt)
      model->complain(fmt::format("plane_stress takes elastic laws ({})", relaxing));
  }
}

void check_axisymmetric(const Value& top, bool grid_known, Scene& scene) {
  if (scene.grid.origin[0] < 0)  // which only a scene that states it has
    top.find("grid")->find("origin")->item(0).complain(
        "x is the radius in an axisymmetric scene: it must be zero or more");
  if (scene.gravity.acceleration[0] != 0) {
    const auto section = top.find("gravity");
    const auto nested = section->find("acceleration");
    (nested ? *nested : *section).item(0).complain("an axisymmetric scene falls along its axis, y, only");
  }
  refuse_areas(top, scene.contact);
  const auto bodies = top.find("bodies");
  for (std::size_t b = 0; bodies && bodies->is(Node::Kind::list) && b < bodies->size(); ++b)
    if (const auto rotation = bodies->item(b).find("rotation"))
      rotation->report("an axisymmetric body cannot turn about an axis across the plane");
  if (grid_known) make_axis(top, scene);
}

}  // namespace mpmfast
