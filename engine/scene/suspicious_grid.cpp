#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/shapes.hpp"
#include "engine/quantities/quantity.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/suspicions.hpp"

namespace mpmfast {

namespace {

constexpr double kFewestCells = 1e5;   // fewer cost nothing
constexpr double kLeastReached = 0.1;  // of all cells

double speed_of(const BodySpec& body, const Bounds& box) {
  Vec3 speed = body.velocity, size{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (body.rigid_velocity[k]) speed[k] = largest(*body.rigid_velocity[k]);
    size[k] = box.upper[k] - box.lower[k];
  }
  const double turns = body.rotation ? largest(body.rotation->speed) : 0;
  return std::hypot(speed[0], speed[1], speed[2]) + turns * std::hypot(size[0], size[1], size[2]);
}

/// Nothing is likely to go further: a light body that a heavy one hits leaves at twice its speed.
double reach(const Scene& scene, const std::vector<Bounds>& boxes) {
  double fastest = 0;
  for (std::size_t b = 0; b < boxes.size(); ++b)
    fastest = std::max(fastest, speed_of(scene.bodies[b], boxes[b]));
  for (const BoundarySpec& boundary : scene.boundaries)
    fastest =
        std::max(fastest, std::visit([](const auto& one) { return largest(one.speed); }, boundary.condition));
  const Vec3& gravity = scene.gravity.acceleration;
  fastest += std::hypot(gravity[0], gravity[1], gravity[2]) * scene.time.end;
  return 2 * fastest * scene.time.end;
}

std::string lengths_text(const Vec3& lengths, std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(fmt::format("{:.6g} m", lengths[k]));
  return fmt::format("[{}]", fmt::join(out, ", "));
}

}  // namespace

void find_idle_cells(const SourceLocation& location, const Scene& scene, Problems& found) {
  const GridSpec& grid = scene.grid;
  const auto dimension = static_cast<std::size_t>(scene.dimension());
  std::vector<Bounds> boxes;
  for (const BodySpec& body : scene.bodies) boxes.push_back(bounds(body.shape));
  const double margin = reach(scene, boxes) + 2 * grid.cell;
  double cells = 1, reached = 1;
  Vec3 origin{}, size{};
  for (std::size_t k = 0; k < dimension; ++k) {
    double lower = kInfinity, upper = -kInfinity;
    for (const Bounds& box : boxes) {
      lower = std::min(lower, box.lower[k]);
      upper = std::max(upper, box.upper[k]);
    }
    const double all = std::round(grid.size[k] / grid.cell);
    const double first = std::clamp(std::floor((lower - margin - grid.origin[k]) / grid.cell), 0.0, all);
    const double last = std::clamp(std::ceil((upper + margin - grid.origin[k]) / grid.cell), first, all);
    cells *= all;
    reached *= last - first;
    origin[k] = grid.origin[k] + first * grid.cell;
    size[k] = (last - first) * grid.cell;
  }
  if (cells < kFewestCells || reached > kLeastReached * cells) return;
  found.add(location, "grid.size",
            fmt::format("bodies can reach {:.2g} % of its {:.3g} cells", 100 * reached / cells, cells),
            fmt::format("origin: {}, size: {} would do, with less memory and time",
                        lengths_text(origin, dimension), lengths_text(size, dimension)));
}

}  // namespace mpmfast
