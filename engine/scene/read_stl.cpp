#include <fmt/format.h>

#include <cmath>

#include "engine/scene/sections.hpp"
#include "engine/scene/surface.hpp"

namespace mpmfast {

std::optional<Shape> read_stl(const Value& value, const Scene& scene) {
  MapReader map(value, "a map {file, scale, angle, axis, translate}");
  if (!map.valid()) return std::nullopt;
  const std::size_t before = value.problems().count();
  StlShape shape;
  const auto file = map.need("file", "an STL file, text or binary");
  const auto path = file ? file->text() : std::nullopt;
  // The format knows no units, and metres are rarely meant.
  map.need_quantity("scale", Measure::length, kPositive, shape.scale);
  map.quantity("angle", Measure::angle, kAny, shape.angle);
  map.otherwise("axis", "z");
  if (const auto axis = map.find("axis")) shape.axis = read_direction(*axis, 3, true).value_or(shape.axis);
  map.vector("translate", Measure::length, 3, kAny, shape.translate);
  map.finish();
  if (!path) return std::nullopt;
  shape.file = std::filesystem::absolute(scene.file.parent_path() / *path).lexically_normal();
  std::string why_not;
  const auto surface = load_stl(shape.file, why_not);
  if (!surface) {
    file->complain(fmt::format("cannot read the surface {}: {}", shape.file.string(), why_not));
    return std::nullopt;
  }
  if (value.problems().count() > before) return std::nullopt;
  auto placed =
      std::make_shared<Surface>(surface->placed(shape.scale, shape.axis, shape.angle, shape.translate));
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::isfinite(placed->bounds().lower[k]) && std::isfinite(placed->bounds().upper[k])) continue;
    value.report("the surface is out of range once scaled and moved (finite places)");
    return std::nullopt;
  }
  shape.surface = std::move(placed);
  return shape;
}

}  // namespace mpmfast
