#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/shapes.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

const WallSpec* wall_of(const BoundarySpec& boundary) { return std::get_if<WallSpec>(&boundary.condition); }

double position_at(const WallSpec& wall, double time) {
  return wall.position + integral_to(wall.speed, time);
}

/// A round shape across the axis of an axisymmetric scene is its right half, so the axis is no limit.
bool is_axis(const Scene& scene, const WallSpec& wall) {
  return scene.space == Space::axisymmetric && wall.axis == 0 && !wall.upper && wall.position <= 0;
}

/// Material that lies more than a cell behind a wall is held there for good. Rigid bodies do not feel walls,
/// and the edge of a picture may be empty.
void check_bodies_behind(const Value& value, const BoundarySpec& boundary, const WallSpec& wall,
                         const Scene& scene) {
  const auto axis = static_cast<std::size_t>(wall.axis);
  for (const BodySpec& body : scene.bodies) {
    if (is_rigid(scene, body) || std::holds_alternative<BitmapShape>(body.shape)) continue;
    const Bounds box = bounds(body.shape);
    const double lower = axis == 0 && is_halved(scene, body) ? std::max(box.lower[0], 0.0) : box.lower[axis];
    const double behind = wall.upper ? box.upper[axis] - wall.position : wall.position - lower;
    if (behind > (1 + 1e-6) * scene.grid.cell)
      value.report(fmt::format("body '{}' reaches {:.6g} m behind the {} wall, which is at {} = {:.6g} m",
                               body.name, behind, boundary.name, "xyz"[axis], wall.position));
  }
}

/// When two walls that face each other have met; nothing if they do not before the end.
std::optional<double> time_of_meeting(const WallSpec& lower, const WallSpec& upper, double end) {
  std::vector<double> times{end};
  for (const WallSpec* wall : {&lower, &upper})
    for (const double time : wall->speed.time)
      if (time > 0 && time < end) times.push_back(time);
  std::sort(times.begin(), times.end());
  for (const double time : times)
    if (position_at(lower, time) >= position_at(upper, time)) return time;
  return std::nullopt;
}

}  // namespace

void check_walls(const Value& top, const Scene& scene) {
  const auto section = top.find("boundaries");
  if (!section || !section->problems().empty()) return;
  for (const BoundarySpec& boundary : scene.boundaries) {
    const WallSpec* wall = wall_of(boundary);
    const auto value = section->find(boundary.name);
    if (!wall || !value || is_axis(scene, *wall)) continue;
    check_bodies_behind(*value, boundary, *wall, scene);
    const bool moves = largest(wall->speed) > 0;
    for (const BoundarySpec& other : scene.boundaries) {
      const WallSpec* opposite = wall_of(other);
      if (!moves || !opposite || opposite->axis != wall->axis || opposite->upper == wall->upper) continue;
      const WallSpec &lower = wall->upper ? *opposite : *wall, &upper = wall->upper ? *wall : *opposite;
      const auto met = time_of_meeting(lower, upper, scene.time.end);
      if (!met) continue;
      value->report(
          fmt::format(
              "the piston goes through the {} wall: {:.6g} m apart at first, it has moved {:.6g} m by "
              "{:.6g} s",
              other.name, upper.position - lower.position,
              std::abs(position_at(*wall, *met) - wall->position), *met),
          "A shorter time.end, a slower piston, or a table of speeds that stops it");
    }
  }
}

}  // namespace mpmfast
