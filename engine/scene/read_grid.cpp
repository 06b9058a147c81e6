#include <fmt/format.h>

#include <cmath>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr double kMostCells = 1e6;  // along an edge
constexpr double kFurthest = 1e9;   // cells: there doubles still tell 1e-7 of a cell apart

/// A size must be a whole number of cells, or the far face would lie inside one.
bool check_cells(const Value& size, int dimension, const GridSpec& grid) {
  bool good = true;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const double cells = grid.size[k] / grid.cell;
    const double whole = std::max(std::round(cells), 1.0);
    const Value edge = size.item(k);
    if (cells > kMostCells) {
      edge.complain(fmt::format("{:.3g} cells of {} m (at most {:g})", cells, grid.cell, kMostCells));
      good = false;
    } else if (cells < 1 - 1e-6) {
      edge.complain(fmt::format("smaller than one cell of {} m", grid.cell));
      good = false;
    } else if (std::abs(cells - whole) > 1e-6 * whole) {
      edge.complain(fmt::format("not a whole number of cells of {} m (nearest: {:.9g} m)", grid.cell,
                                whole * grid.cell));
      good = false;
    }
  }
  return good;
}

}  // namespace

bool read_grid(MapReader& top, int dimension, GridSpec& grid) {
  const auto section = top.need("grid", "{origin, size, cell, leaving}");
  if (!section) return false;
  MapReader map(*section, "a map {origin, size, cell, leaving}");
  if (!map.valid()) return false;
  bool good = map.vector("origin", Measure::length, dimension, kAny, grid.origin);
  const auto size_value = map.need("size", fmt::format("a list of {} lengths", dimension));
  const auto size = size_value ? size_value->vector(Measure::length, dimension, kPositive) : std::nullopt;
  map.need_quantity("cell", Measure::length, kPositive, grid.cell);
  map.word("leaving", kLeaving, grid.leaving);
  map.finish();
  if (!good || !size || grid.cell <= 0) return false;
  grid.size = *size;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    if (std::abs(grid.origin[k]) > kFurthest * grid.cell) {
      map.find("origin")->item(k).complain(
          fmt::format("{:.2g} cells from zero (at most {:g}, or places would be rounded too far)",
                      std::abs(grid.origin[k]) / grid.cell, kFurthest));
      return false;
    }
  return check_cells(*size_value, dimension, grid);
}

void read_time(MapReader& top, TimeSpec& time) {
  const auto section = top.need("time", "{end, cfl, max_step, collapse}");
  if (!section) return;
  MapReader map(*section, "a map {end, cfl, max_step, collapse}");
  constexpr Limit kCourant{"in (0, 1]", 0, 1, true}, kShare{"in [0, 1)", 0, 1, false, true};
  map.need_quantity("end", Measure::time, kPositive, time.end);
  map.quantity("cfl", Measure::number, kCourant, time.cfl);
  map.quantity("collapse", Measure::number, kShare, time.collapse);
  const auto longest = map.find("max_step");
  map.otherwise("max_step", "none");
  if (longest && !longest->is_word("none")) {
    time.max_step = longest->quantity(Measure::time, kPositive).value_or(time.max_step);
  }
  map.finish();
}

void read_gravity(MapReader& top, int dimension, GravitySpec& gravity) {
  const auto section = top.find("gravity");
  if (!section) return;
  if (section->is(Node::Kind::scalar))
    return section->complain("not a vector or a map {acceleration, ramp}",
                             section->vector_hint(Measure::acceleration, dimension));
  if (section->is(Node::Kind::list)) {
    gravity.acceleration = section->vector(Measure::acceleration, dimension).value_or(Vec3{});
    return;
  }
  MapReader map(*section, "a vector or a map {acceleration, ramp}");
  if (const auto value = map.need("acceleration", "a list of accelerations")) {
    gravity.acceleration = value->vector(Measure::acceleration, dimension).value_or(Vec3{});
  }
  map.quantity("ramp", Measure::time, kNotNegative, gravity.ramp);
  map.finish();
}

/// By wall time, by steps, or both; what is not asked for is off.
void read_checkpoint(const Value& value, CheckpointSpec& checkpoint) {
  if (value.is_word("none")) {
    checkpoint.active = false;
    return;
  }
  if (value.is(Node::Kind::scalar))
    return value.complain("not none or a map {every, steps}", "Write {steps: 1000} or {every: 10 min}");
  MapReader map(value, "none or a map {every, steps}");
  if (!map.valid()) return;
  constexpr int kMostSteps = 2000000000;
  const auto every = map.find("every"), steps = map.find("steps");
  map.otherwise("every", checkpoint.every, Measure::time);
  map.otherwise("steps", "none");
  if (steps && !steps->is_word("none")) checkpoint.steps = steps->integer(1, kMostSteps).value_or(0);
  if (every || checkpoint.steps > 0) checkpoint.every = 0;
  if (every && !every->is_word("none"))
    checkpoint.every = every->quantity(Measure::time, kPositive).value_or(0);
  map.finish();
}

void read_output(MapReader& top, int dimension, OutputSpec& output) {
  const auto section = top.find("output");
  if (!section) return;
  MapReader map(*section, "a map {frames, history, picture, overlap, grid, checkpoint}");
  constexpr int kMostFrames = 999999;  // frames are numbered with six digits
  constexpr int kMostRows = 100000000;
  map.integer("frames", 0, kMostFrames, output.frames);
  map.integer("history", 1, kMostRows, output.history);
  map.boolean("grid", output.grid);
  map.boolean("overlap", output.overlap);
  if (output.overlap && dimension == 3)
    map.find("overlap")->complain("the overlap of bodies is measured in 2-D only");
  if (const auto checkpoint = map.find("checkpoint")) read_checkpoint(*checkpoint, output.checkpoint);
  map.otherwise("picture", output.picture);
  if (const auto picture = map.find("picture")) {
    std::vector<std::string> known;
    for (const char* name : kPictures) {
      const std::string field = name;
      const bool needs_depth = field == "stress_yz" || field == "stress_xz";
      if (dimension == 3 || !needs_depth) known.push_back(field);
    }
    const int index = picture->word_index(known);
    if (index >= 0) output.picture = known[static_cast<std::size_t>(index)];
  }
  map.finish();
}

}  // namespace mpmfast
