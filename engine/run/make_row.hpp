#pragma once

/// @file A row of the history from the state as it is.

#include <optional>

#include "engine/output/output.hpp"
#include "engine/run/run_counters.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

/// What left the grid so far, in a scene where that is allowed.
template <int Dim>
std::optional<Outflow> outflow_of(const Step<Dim>& step, const Scene& scene) {
  return scene.grid.outflow == OutflowKind::outflow ? std::optional(step.sums().outflow) : std::nullopt;
}

/// Forces are means since the last row, which the counters remember; this one becomes the last.
template <int Dim>
HistoryRow make_row(Step<Dim>& step, const Scene& scene, double dt, RunCounters<Dim>& counters);

}  // namespace mpmfast
