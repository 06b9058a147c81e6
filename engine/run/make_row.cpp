#include "engine/run/make_row.hpp"

#include "engine/scene/crack_tips.hpp"

namespace mpmfast {

namespace {

template <int Dim>
void fill_forces(const Step<Dim>& step, const Scene& scene, const RunCounters<Dim>& counters,
                 HistoryRow& row) {
  const Sums<Dim>&sums = step.sums(), &last = counters.last_sums;
  const double elapsed = row.time - counters.last_row_time;
  const auto mean_force = [&](const auto& now, const auto& before) {
    Vec3 force{};
    for (int d = 0; d < now.size() && elapsed > 0; ++d)
      force[static_cast<std::size_t>(d)] = (now[d] - before[d]) / elapsed;
    return force;
  };
  for (std::size_t b = 0; b < sums.boundary_impulse.size(); ++b)
    row.boundary_force.push_back(mean_force(sums.boundary_impulse[b], last.boundary_impulse[b]));
  row.rigid_force.assign(scene.bodies.size(), Vec3{});
  row.rigid_moment.assign(scene.bodies.size(), Vec3{});
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto f = static_cast<std::size_t>(step.plan().body_field[b]);
    if (!step.plan().field_rigid[f]) continue;
    row.rigid_force[b] = mean_force(sums.rigid_impulse[f], last.rigid_impulse[f]);
    row.rigid_moment[b] = mean_force(sums.rigid_moment[f], last.rigid_moment[f]);
  }
  for (std::size_t k = 0; k < sums.pair_impulse.size(); ++k)
    row.pair_force.push_back(mean_force(sums.pair_impulse[k], last.pair_impulse[k]));
  row.pair_friction = sums.pair_friction_work;
  row.pair_area = step.penalty().ledger().pair_area;
}

template <int Dim>
std::optional<HistoryRow::Heat> heat_of(const Step<Dim>& step, const HistoryRow& row, const Scene& scene) {
  if (!step.heat().active()) return std::nullopt;
  const HeatSums& sums = step.heat().sums();
  HistoryRow::Heat heat;
  for (std::size_t b = 0; b < row.bodies.size(); ++b)
    if (!step.state().bodies[b].rigid)
      heat.content += row.bodies[b].mass * step.state().bodies[b].heat.capacity *
                      (row.bodies[b].temperature - scene.heat.temperature);
  heat.conditions = sums.conditions;
  heat.in = sums.rigid;
  for (double in : sums.conditions) heat.in += in;
  heat.friction = sums.friction;
  heat.worked = sums.worked;
  return heat;
}

template <int Dim>
std::optional<Overlap> overlap_of(const State<Dim>& state, const Scene& scene) {
  if constexpr (Dim == 2)
    if (scene.output.overlap)
      return measure_overlap(state.particles, state.bodies, state.body_field, state.surfaces, state.threads);
  return std::nullopt;
}

/// Stresses must be those of the moment.
template <int Dim>
void fill_tips(Step<Dim>& step, const Scene& scene, HistoryRow& row) {
  for (const CrackLine<Dim>& line : step.cracks().lines()) row.crack_lengths.push_back(line.length());
  for (const CrackTip& tip : crack_tips(scene)) {
    const TipLoad load = step.tip_load(tip.crack, tip.end);
    row.tips.push_back(
        {load.position[0], load.position[1], load.energy_release_rate, load.mode_i, load.mode_ii});
    row.crack_lengths[static_cast<std::size_t>(tip.crack)] -= load.bonded_length;
  }
}

}  // namespace

template <int Dim>
HistoryRow make_row(Step<Dim>& step, const Scene& scene, double dt, RunCounters<Dim>& counters) {
  const State<Dim>& state = step.state();
  const Sums<Dim>& sums = step.sums();
  step.find_stresses();
  HistoryRow row;
  row.step = state.step;
  row.time = state.time;
  row.dt = dt;
  row.stored = step.stored_energy();
  row.dissipated = step.dissipated_energy();
  row.friction = sums.friction_work;
  row.interface = sums.interface_loss;
  row.joints = step.interface_energy();
  row.boundary_work = sums.boundary_work;
  row.body_force_work = sums.body_force_work;
  fill_particle_sums(state.particles, scene, row);
  fill_forces(step, scene, counters, row);
  row.overlap = counters.overlap = overlap_of(state, scene);
  const Spacing spacing = widest_spacing(state.particles, scene);
  if (spacing.cells > counters.spacing.cells) counters.spacing = spacing;
  row.outflow = outflow_of(step, scene);
  row.heat = heat_of(step, row, scene);
  fill_tips(step, scene, row);
  counters.last_sums = sums;
  counters.last_row_time = state.time;
  counters.last_row_step = state.step;
  return row;
}

template HistoryRow make_row(Step<2>&, const Scene&, double, RunCounters<2>&);
template HistoryRow make_row(Step<3>&, const Scene&, double, RunCounters<3>&);

}  // namespace mpmfast
