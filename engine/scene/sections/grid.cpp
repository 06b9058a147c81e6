#include <fmt/format.h>

#include <cmath>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

constexpr double kMostCells = 1e6;  // along an edge
constexpr double kFurthest = 1e9;   // cells: there doubles still tell 1e-7 of a cell apart

/// A size must be a whole number of cells, or the far face would lie inside one.
void check_cells(Slot& size, int dimension, const GridSpec& grid) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const double cells = grid.size[k] / grid.cell;
    const double whole = std::round(cells);
    if (whole > kMostCells)
      size.refuse_item(k, fmt::format("{:.3g} cells of {} m (at most {:g})", cells, grid.cell, kMostCells));
    else if (cells < 1 - 1e-6)
      size.refuse_item(k, fmt::format("smaller than one cell of {} m", grid.cell));
    else if (std::abs(cells - whole) > 1e-6 * whole)
      size.refuse_item(k, fmt::format("not a whole number of cells of {} m (nearest: {:.9g} m)", grid.cell,
                                      whole * grid.cell));
  }
}

void check_origin(Slot& origin, int dimension, const GridSpec& grid) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension) && origin.good(); ++k)
    if (std::abs(grid.origin[k]) > kFurthest * grid.cell)
      origin.refuse_item(
          k, fmt::format("{:.2g} cells from zero (at most {:g}, or places would be rounded too far)",
                         std::abs(grid.origin[k]) / grid.cell, kFurthest));
}

}  // namespace

bool describe_grid(Keys& top, int dimension, GridSpec& grid) {
  return top.need_section(
      "grid", "The grid of cubic cells, and with it the room that bodies may move in.",
      "a map {origin, size, cell, leaving}", [&](Keys& map) {
        map.key("origin", "Lower corner of the grid.", grid.origin, Vector{Measure::length, dimension});
        map.need("size", "Edges of the grid, each a whole number of cells.", grid.size,
                 Vector{Measure::length, dimension, kPositive});
        map.need("cell", "Edge of a cell.", grid.cell, Number{Measure::length, kPositive});
        map.key("leaving", "What becomes of a particle that goes a cell beyond the grid.", grid.outflow,
                kOutflowKinds);
        if (!map.reads() || !map.good()) return;
        map.check("origin", [&](Slot& origin) { check_origin(origin, dimension, grid); });
        if (map.good()) map.check("size", [&](Slot& size) { check_cells(size, dimension, grid); });
      });
}

void describe_time(Keys& top, TimeSpec& time) {
  top.need_section(
      "time", "How long the run lasts, and its time step.", "a map {end, cfl, max_step, collapse}",
      [&](Keys& map) {
        constexpr Limit kCourant{"in (0, 1]", 0, 1, true}, kShare{"in [0, 1)", 0, 1, false, true};
        map.need("end", "When the run ends.", time.end, Number{Measure::time, kPositive});
        map.key("cfl", "Time step over the time that the fastest wave or particle takes through a cell.",
                time.cfl, Number{Measure::number, kCourant});
        map.key("collapse", "A time step below this share of the first ends the run as failed; 0: never.",
                time.collapse, Number{Measure::number, kShare});
        map.at("max_step", "Longest time step; none: as long as `cfl` allows.", [&](Slot& slot) {
          if (slot.is_keyword("none", std::isinf(time.max_step)))
            time.max_step = kInfinity;
          else
            slot.take(time.max_step, Number{Measure::time, kPositive});
        });
      });
}

void describe_gravity(Keys& top, int dimension, GravitySpec& gravity) {
  const Vector components{Measure::acceleration, dimension};
  top.at("gravity", "Acceleration of all bodies: its components, or a map with a ramp.", [&](Slot& slot) {
    const bool map = slot.is_map(true, [&](Keys& keys) {
      keys.need("acceleration", "Its components.", gravity.acceleration, components);
      keys.key("ramp", "It grows linearly from zero to full over this time.", gravity.ramp,
               Number{Measure::time, kNotNegative});
    });
    if (map) return;
    if (slot.reads() && !slot.value()->is(Node::Kind::list))
      return slot.complain("not a vector or a map {acceleration, ramp}",
                           slot.value()->vector_hint(Measure::acceleration, dimension));
    slot.take(gravity.acceleration, components);
  });
}

}  // namespace mpmfast
