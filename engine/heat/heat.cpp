#include "engine/heat/heat.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/constants.hpp"
#include "engine/plan/materials.hpp"
#include "engine/state/slots.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// The largest eigenvalue of C⁻¹K is 4κ/h², whatever the dimension. With slopes of the step before steps are
/// stable while Δt times that is below 1 (theory.md, "Heat"); here it is at most a half.
template <int Dim>
Heat<Dim>::Heat(const Scene& scene, const Plan& plan)
    : scene_(&scene), active_(plan.heat), crosses_(plan.contact), ties_(plan.exact_fields) {
  sums_.conditions.assign(scene.heat.conditions.size(), 0);
  if (!active_) return;
  scale_.reference = scene.heat.temperature;
  row_.assign(scene.heat.conditions.size(), 0);
  plane_.assign(scene.heat.conditions.size(), std::numeric_limits<double>::quiet_NaN());
  effusivity_.assign(plan.fields.size(), 0);
  rigid_ = plan.field_rigid;
  workspaces_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  double diffusivity = 0, conductivity = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const MaterialSpec& material = scene.materials[static_cast<std::size_t>(scene.bodies[b].material)];
    const double capacity = heat_capacity_of(material) * density_of(material);
    auto& effusivity = effusivity_[static_cast<std::size_t>(plan.body_field[b])];
    effusivity = std::max(effusivity, std::sqrt(material.conductivity * capacity));
    conductivity = std::max(conductivity, material.conductivity);
    if (!is_rigid(scene, scene.bodies[b]))
      diffusivity = std::max(diffusivity, material.conductivity / capacity);
  }
  const double h = scene.grid.cell;
  stiffest_ = constants::heat::kMostConductance * conductivity / h;
  filter_time_ = diffusivity > 0 ? scene.heat.filter_every * h * h / diffusivity
                                 : std::numeric_limits<double>::infinity();
  stable_dt_ = diffusivity > 0 ? std::min(scene.time.cfl, constants::heat::kMostCfl) *
                                     constants::heat::kFourierNumber * h * h / diffusivity
                               : std::numeric_limits<double>::infinity();
}

template <int Dim>
bool Heat<Dim>::advance(State<Dim>& state, HeatCarrier<Dim>& carrier, const Contact<Dim>& contact,
                        double dt) {
  auto& nodes = state.nodes;
  const auto clear = [&](std::int64_t begin, std::int64_t end) {
    for (Nodal q : {Nodal::heat_capacity, Nodal::heat_content, Nodal::heat_flow})
      std::fill(nodes.column(q) + begin, nodes.column(q) + end, 0.0);
    for (Nodal q : {Nodal::heat_slope, Nodal::conducting_surface})
      for (int d = 0; d < nodes.width(q); ++d)
        std::fill(nodes.column(q, d) + begin, nodes.column(q, d) + end, 0.0);
  };
  for_each_slot(state, clear);
  carrier.project_heat(state, scale_);
  find_temperatures(state, Nodal::temperature);
  if (crosses_) find_crossings(state, contact);
  if (ties_) tie(state, contact, Nodal::temperature);
  feed(state, state.time, dt);
  if (crosses_) {
    add_friction_heat(state, contact, dt);
    cross(state, contact, dt);
  }
  if (ties_) tie(state, contact, Nodal::heat_flow);
  end(state, state.time, dt);
  unfiltered_ += dt;
  const bool filtered = scene_->heat.filter_order > 0 && unfiltered_ >= filter_time_;
  if (filtered) {
    filter(state, carrier, contact);
    unfiltered_ = 0;
  }
  const HeatReport report = carrier.update_heat(state, scale_, filtered);
  sums_.stored += report.stored;
  sums_.worked += report.worked;
  return report.sound;
}

/// Contents led to the nodes along their slopes, over capacities.
template <int Dim>
void Heat<Dim>::find_temperatures(State<Dim>& state, Nodal out) const {
  auto& nodes = state.nodes;
  const auto& blocks = state.tiling.node_blocks;
  const auto n = static_cast<std::int64_t>(blocks.size());
  const double *capacity = nodes.column(Nodal::heat_capacity), *content = nodes.column(Nodal::heat_content);
  double* temperature = nodes.column(out);
  for_each_of(n, state.threads, constants::threads::kFewBlocks, [&](std::int64_t s) {
    const auto& block = blocks[static_cast<std::size_t>(s)];
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const NodeIndex<Dim> node = state.tiling.node(block, local);
      for (int t = block.begin; t < block.end; ++t) {
        const int slot = t * kTileNodes<Dim> + local;
        double sum = content[slot];
        for (int d = 0; d < Dim; ++d)
          sum += nodes.column(Nodal::heat_slope, d)[slot] * (node[d] * state.grid.cell);
        temperature[slot] = capacity[slot] > 0 ? sum / capacity[slot] : 0;
      }
    }
  });
}

/// ΔT = QΔt/C; where it is held, what that takes.
template <int Dim>
void Heat<Dim>::end(State<Dim>& state, double t, double dt) {
  auto& nodes = state.nodes;
  const double* capacity = nodes.column(Nodal::heat_capacity);
  double *flow = nodes.column(Nodal::heat_flow), *temperature = nodes.column(Nodal::temperature);
  for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
    divide_by_mass(capacity, flow, dt, begin, end, flow);
  });
  const auto face = [&](const Fed& fed, double time) {
    return value_at(scene_->heat.conditions[static_cast<std::size_t>(fed.condition)].value, time) -
           scale_.reference;
  };
  for (Fed& fed : fed_)
    if (holds(fed))
      fed.end = held(fed, face(fed, t + dt), [&](int slot) { return temperature[slot] + flow[slot]; });
  for (const Fed& fed : fed_) {
    if (!holds(fed) || !(capacity[fed.slot] > 0)) continue;
    const double rise = fed.end - temperature[fed.slot];
    sums_.conditions[static_cast<std::size_t>(fed.condition)] += capacity[fed.slot] * (rise - flow[fed.slot]);
    flow[fed.slot] = rise;
  }
  // What slopes are taken from: as the step began.
  for (const Fed& fed : fed_)
    if (holds(fed))
      temperature[fed.slot] = held(fed, face(fed, t), [&](int slot) { return temperature[slot]; });
}

/// Σ_{k<m} (I − B)ᵏ T⁺, B what the grid gets back of what particles have of it; m = 1: T⁺ itself. Nodes with
/// prescribed temperatures keep them.
template <int Dim>
void Heat<Dim>::filter(State<Dim>& state, HeatCarrier<Dim>& carrier, const Contact<Dim>& contact) {
  auto& nodes = state.nodes;
  const double *temperature = nodes.column(Nodal::temperature), *rise = nodes.column(Nodal::heat_flow),
               *capacity = nodes.column(Nodal::heat_capacity);
  double *rest = nodes.column(Nodal::temperature_filter), *series = nodes.column(Nodal::temperature_series);
  for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) rest[i] = temperature[i] + rise[i];
  });
  for (const Fed& fed : fed_)
    if (holds(fed)) rest[fed.slot] = fed.end;
  for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
    std::copy(rest + begin, rest + end, series + begin);
  });
  double* seen = nodes.column(Nodal::heat_content);  // B of the rest, after its slopes have been led
  for (int k = 1; k < scene_->heat.filter_order; ++k) {
    for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
      std::fill(seen + begin, seen + end, 0.0);
      for (int d = 0; d < Dim; ++d)
        std::fill(nodes.column(Nodal::heat_slope, d) + begin, nodes.column(Nodal::heat_slope, d) + end, 0.0);
    });
    carrier.filter_heat(state);
    find_temperatures(state, Nodal::heat_content);
    if (ties_) tie(state, contact, Nodal::heat_content);
    for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) rest[i] -= seen[i];
    });
    // What the filter would do to nodes that are held comes in through their condition instead.
    for (const Fed& fed : fed_) {
      if (!holds(fed)) continue;
      sums_.conditions[static_cast<std::size_t>(fed.condition)] -= capacity[fed.slot] * rest[fed.slot];
      rest[fed.slot] = 0;
    }
    for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) series[i] += rest[i];
    });
  }
}

template <int Dim>
void Heat<Dim>::visit(Archive& archive) {
  archive.column("heat/conditions", sums_.conditions.data(), sums_.conditions.size());
  archive.number("heat/friction", sums_.friction);
  archive.number("heat/rigid", sums_.rigid);
  archive.number("heat/stored", sums_.stored);
  archive.number("heat/worked", sums_.worked);
  archive.number("heat/unfiltered", unfiltered_);
  if (archive.reading()) stale_ = true;
}

template class Heat<2>;
template class Heat<3>;

}  // namespace mpmfast
